//! One open page: acts on its messages.

use crate::channels::{Channels, Request};
use crate::hub::{Hub, Id};
use crate::message::FromPage;
use glint_mesh::convert::Options;
use glint_mesh::model;

/// Maximum length of a line for the console.
const MAX_LINE: usize = 200;

/// Maximum size of a file for an upload in bytes.
const MAX_UPLOAD: usize = 64 << 20;

/// Maximum length of a file's name.
const MAX_NAME: usize = 100;

/// The reason to close a page's connection.
pub type Reason = &'static str;

/// A mesh file on its way from the page.
struct Upload {
    name: String,
    bytes: usize,
    data: Vec<u8>,
}

/// An open page.
pub struct Viewer {
    id: Id,
    upload: Option<Upload>,
}

impl Viewer {
    /// Adds a page. Returns `None` if there are too many.
    pub fn join(channels: &Channels) -> Option<Self> {
        let id = channels.hub.join()?;
        Some(Self { id, upload: None })
    }

    /// The number of the page at the hub.
    pub const fn id(&self) -> Id {
        self.id
    }

    /// Removes the page.
    pub fn leave(self, channels: &Channels) {
        if channels.hub.has_control(self.id) {
            channels.inputs.press(0);
        }
        channels.hub.leave(self.id);
    }

    /// Acts on a text from the page.
    ///
    /// # Errors
    /// It is no message of the page, or a value in it is out of range.
    pub fn receive_text(&mut self, text: &str, channels: &Channels) -> Result<(), Reason> {
        let message =
            serde_json::from_str(text).map_err(|_| "expected a message of docs/live-page.md")?;
        let hub: &Hub = &channels.hub;
        match message {
            FromPage::Take => hub.take_control(self.id),
            FromPage::Release => hub.release_control(self.id),
            FromPage::Help { command } => {
                check_line(&command)?;
                channels.request(Request::Help(command));
            }
            // Messages of a page that has lost control are on their way for some time.
            _ if !hub.has_control(self.id) => {}
            FromPage::Command { line } => {
                check_line(&line)?;
                channels.request(Request::Command(line));
            }
            FromPage::Interrupt => channels.request(Request::Interrupt),
            FromPage::Picture => channels.request(Request::Picture),
            FromPage::Buttons { pressed } => channels.inputs.press(pressed),
            FromPage::Switches { on } => channels.inputs.switch(on),
            FromPage::Turn { attitude } => {
                let motion = channels.motion.as_ref();
                let is_set = motion.is_none_or(|motion| motion.turn(attitude));
                return is_set.then_some(()).ok_or("expected an attitude");
            }
            FromPage::Hand { place } => {
                let motion = channels.motion.as_ref();
                let is_set = motion.is_none_or(|motion| motion.move_hand(place));
                return is_set.then_some(()).ok_or("expected a place in the frame");
            }
            FromPage::Upload { name, bytes } => {
                if bytes == 0 || bytes > MAX_UPLOAD || name.len() > MAX_NAME {
                    let expected =
                        "expected a file of 1 byte to 64 MiB with a name of at most 100 bytes";
                    return Err(expected);
                }
                let data = Vec::new();
                self.upload = Some(Upload { name, bytes, data });
            }
        }
        Ok(())
    }

    /// Takes bytes of an announced file from the page, and hands the whole file to the board.
    ///
    /// # Errors
    /// No file has been announced, or it has fewer bytes.
    pub fn receive_bytes(&mut self, bytes: &[u8], channels: &Channels) -> Result<(), Reason> {
        let expected = "expected the bytes of an announced file";
        let file = self.upload.as_mut().ok_or(expected)?;
        if bytes.len() > file.bytes - file.data.len() {
            return Err(expected);
        }
        file.data.extend_from_slice(bytes);
        if file.data.len() == file.bytes
            && let Some(file) = self.upload.take()
        {
            match model::of_file(&file.name, file.data, Options::default()) {
                Ok(model) => channels.request(Request::Upload(model.mesh)),
                Err(error) => channels.hub.notify(error.to_string(), true),
            }
        }
        Ok(())
    }
}

fn check_line(line: &str) -> Result<(), Reason> {
    if line.len() > MAX_LINE || line.chars().any(char::is_control) {
        return Err("expected a line of at most 200 characters");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channels::MAX_REQUESTS;
    use crate::inputs::Inputs;
    use crate::message::Message;
    use std::sync::Arc;

    fn upload(bytes: usize) -> String {
        format!(r#"{{"type":"upload","name":"a.stl","bytes":{bytes}}}"#)
    }

    /// Whether a text waits for the page that contains `wanted`.
    fn is_told(viewer: &Viewer, channels: &Channels, wanted: &str) -> bool {
        let messages = channels.hub.take(viewer.id()).unwrap();
        messages
            .iter()
            .any(|message| matches!(message, Message::Text(text) if text.contains(wanted)))
    }

    #[test]
    fn values_out_of_range_close_the_page() {
        let (channels, queue) = Channels::to_board(Some(Arc::default()));
        let mut viewer = Viewer::join(&channels).unwrap();
        let command = |line: &str| format!(r#"{{"type":"command","line":"{line}"}}"#);
        for refused in [
            "{",
            r#"{"type":"other"}"#,
            r#"{"type":"buttons","pressed":256}"#,
            r#"{"type":"switches","on":65536}"#,
            r#"{"type":"turn","attitude":[0,0,0,0]}"#,
            r#"{"type":"turn","attitude":[1,0,0]}"#,
            r#"{"type":"hand","place":[0.5,1.5]}"#,
            &upload(0),
            &upload(MAX_UPLOAD + 1),
            &command(&"x".repeat(MAX_LINE + 1)),
            &command("\\u0003"),
        ] {
            assert!(
                viewer.receive_text(refused, &channels).is_err(),
                "{refused}"
            );
        }
        assert!(viewer.receive_bytes(&[1], &channels).is_err());
        viewer.receive_text(&upload(3), &channels).unwrap();
        viewer.receive_bytes(&[1, 2], &channels).unwrap();
        assert!(viewer.receive_bytes(&[3, 4], &channels).is_err());
        assert!(queue.try_recv().is_err(), "the board gets nothing");
    }

    #[test]
    fn a_file_comes_in_parts_and_a_broken_one_is_reported() {
        let (channels, queue) = Channels::to_board(Some(Arc::default()));
        let mut viewer = Viewer::join(&channels).unwrap();
        let mut send = |name: &str, parts: &[&str]| {
            let bytes = parts.concat().len();
            let text = format!(r#"{{"type":"upload","name":"{name}","bytes":{bytes}}}"#);
            viewer.receive_text(&text, &channels).unwrap();
            for part in parts {
                viewer.receive_bytes(part.as_bytes(), &channels).unwrap();
            }
        };
        let triangle = ["v 0 0 0\nv 1 0 0\n", "v 0 1 0\nf 1 2 3\n"];
        send("a.obj", &triangle);
        assert!(matches!(queue.try_recv(), Ok(Request::Upload(mesh)) if mesh.starts_with(b"GLM")));
        send("a.ply", &triangle);
        send("../../etc/passwd", &triangle);
        assert!(queue.try_recv().is_err());
        assert!(is_told(&viewer, &channels, "a.ply: line 1: expected"));
    }

    #[test]
    fn a_page_without_control_changes_nothing() {
        let (channels, queue) = Channels::to_board(Some(Arc::default()));
        let first = Viewer::join(&channels).unwrap();
        let mut second = Viewer::join(&channels).unwrap();
        for ignored in [
            r#"{"type":"command","line":"reboot"}"#,
            r#"{"type":"interrupt"}"#,
            r#"{"type":"buttons","pressed":1}"#,
            r#"{"type":"switches","on":1}"#,
            r#"{"type":"picture"}"#,
        ] {
            second.receive_text(ignored, &channels).unwrap();
        }
        second.receive_text(&upload(1), &channels).unwrap();
        assert!(second.receive_bytes(&[1], &channels).is_err());
        assert!(queue.try_recv().is_err());
        assert_eq!(channels.inputs.take(), Inputs::default().take());
        let help = r#"{"type":"help","command":"field"}"#;
        second.receive_text(help, &channels).unwrap();
        assert!(matches!(queue.try_recv(), Ok(Request::Help(command)) if command == "field"));
        first.leave(&channels);
        second
            .receive_text(r#"{"type":"take"}"#, &channels)
            .unwrap();
        assert!(channels.hub.has_control(second.id()));
    }

    #[test]
    fn commands_that_the_board_does_not_take_are_dropped_with_a_notice() {
        let (channels, queue) = Channels::to_board(Some(Arc::default()));
        let mut viewer = Viewer::join(&channels).unwrap();
        for _ in 0..=MAX_REQUESTS {
            let command = r#"{"type":"command","line":"info"}"#;
            viewer.receive_text(command, &channels).unwrap();
        }
        assert!(is_told(&viewer, &channels, "the board is busy"));
        assert_eq!(queue.try_iter().count(), MAX_REQUESTS);
    }

    #[test]
    fn there_are_at_most_16_pages() {
        let (channels, _queue) = Channels::to_board(Some(Arc::default()));
        let mut viewers: Vec<_> = std::iter::from_fn(|| Viewer::join(&channels)).collect();
        assert_eq!(viewers.len(), 16);
        viewers.pop().unwrap().leave(&channels);
        assert!(Viewer::join(&channels).is_some());
    }
}
