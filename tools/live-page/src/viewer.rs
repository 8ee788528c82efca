//! One open page, and the processing of its messages.

use crate::beside::{Beside, MAX_UPLOAD};
use crate::channels::{Channels, Program, Request, Upload};
use crate::hub::{Hub, Id};
use crate::message::{FileHead, FromPage, ToPage};
use crate::orbit::Drag;
use crate::scene::{self, Scene};
use glint_board_api::transfer::MODEL;
use glint_core::console::{LINE_MAX, complete};
use glint_mesh::convert::{Options, TextureOptions};
use glint_mesh::model::{self, board_name};
use glint_mesh::texture::{self, CUTOFF};
use glint_program_image as image;

/// Maximum number of auxiliary files of an upload. With names of any characters, the list of these
/// files fits a message.
const MAX_BESIDE: usize = 192;

/// Maximum number of characters of a file's path.
const MAX_NAME: usize = 100;

/// The reason to close a page's connection.
pub type Reason = &'static str;

/// A mesh or a scene file with its auxiliary files, a texture file or a program, which the page is sending.
struct Sent {
    /// The files; the first one is the mesh, the scene, the texture or the program.
    files: Vec<FileHead>,
    /// Size of all files.
    bytes: usize,
    /// The received bytes of all files.
    data: Vec<u8>,
}

impl Sent {
    /// Starts an upload that a page announces; `None` if it is too large.
    fn new(mesh: FileHead, beside: Vec<FileHead>) -> Option<Self> {
        let is_short = |file: &FileHead| file.name.chars().count() <= MAX_NAME;
        let is_mesh = mesh.bytes > 0 && beside.len() <= MAX_BESIDE;
        let files: Vec<_> = [mesh].into_iter().chain(beside).collect();
        let mut sizes = files.iter().map(|file| file.bytes);
        let bytes = sizes.try_fold(0, usize::checked_add)?;
        let is_accepted = is_mesh && bytes <= MAX_UPLOAD && files.iter().all(is_short);
        let data = Vec::new();
        is_accepted.then_some(Self { files, bytes, data })
    }

    /// Converts the mesh, the scene, the texture or the program of a complete upload to a request.
    ///
    /// # Errors
    /// A file violates its format, or a buffer is missing. The error is one line for the user.
    fn converted(self) -> Result<Request, String> {
        match &self.files[..] {
            [FileHead { name, .. }] if image::may_be_program(name, &self.data) => {
                let image = image::of_file(&self.data);
                let image = image.map_err(|found| {
                    format!("{name}: expected a program for Glint's boards, found {found}")
                })?;
                Ok(Request::Start(Program {
                    name: name.clone(),
                    image,
                    places: image::Places::new(self.data),
                }))
            }
            _ => self.converted_model(),
        }
    }

    /// Converts a mesh, a scene or a texture.
    fn converted_model(self) -> Result<Request, String> {
        let mut rest = self.data;
        let mut files = self.files.into_iter().map(|file| {
            let after = rest.split_off(file.bytes);
            (file.name, std::mem::replace(&mut rest, after))
        });
        let (name, mesh) = files.next().unwrap_or_default();
        if texture::is_texture(&name) {
            let converted = texture::of_bytes(&mesh, &TextureOptions::default(), None, CUTOFF);
            let converted = converted.map_err(|error| error.in_path(name.as_ref()).to_string());
            let (bytes, report) = converted?;
            return Ok(Request::Upload(Upload {
                name: board_name(&name).unwrap_or_default(),
                bytes,
                up: None,
                remarks: report.remarks,
            }));
        }
        let mut beside = Beside::new(&name, files);
        if scene::is_scene(&name) {
            return Scene::of_file(&name, &mesh, &mut beside).map(Request::Scene);
        }
        let options = Options::default();
        let model = model::of_file(&name, mesh, options, &mut |name| beside.read(name));
        let hint = beside.hint();
        let model = model.map_err(|error| match &hint {
            Some(hint) => format!("{error}; {hint}"),
            None => error.to_string(),
        })?;
        let remarks = model.remarks().iter().cloned();
        let inside_out = model.inside_out().map(str::to_owned);
        Ok(Request::Upload(Upload {
            remarks: remarks.chain(hint).chain(inside_out).collect(),
            name: MODEL.to_owned(),
            bytes: model.mesh,
            up: Some(model.up),
        }))
    }
}

/// An open page.
pub struct Viewer {
    id: Id,
    upload: Option<Sent>,
}

impl Viewer {
    /// Adds a page. Returns `None` if there are too many pages.
    pub fn join(channels: &Channels) -> Option<Self> {
        let id = channels.hub.join()?;
        let viewer = Self { id, upload: None };
        viewer.tell_motion(channels);
        Some(viewer)
    }

    /// The page's identifier in the hub.
    pub const fn id(&self) -> Id {
        self.id
    }

    /// Removes the page.
    pub fn leave(self, channels: &Channels) {
        self.release(channels);
        channels.hub.leave(self.id);
    }

    /// Releases control and the pressed buttons.
    fn release(&self, channels: &Channels) {
        if channels.hub.has_control(self.id) {
            channels.inputs.press(0);
            channels.hub.release_control(self.id);
        }
    }

    /// Sends the attitude of the motion sensor and the position of the hand to the page.
    fn tell_motion(&self, channels: &Channels) {
        if let Some(motion) = &channels.motion {
            channels.hub.send_one(self.id, &motion.message());
        }
    }

    /// Returns whether the console accepts a line. If not, sends a notice with the reason to the page.
    fn is_line(&self, line: &str, channels: &Channels) -> bool {
        let is_line = line.len() <= LINE_MAX && !line.chars().any(char::is_control);
        if !is_line {
            let expected = "expected a line of at most 640 bytes without control characters";
            channels.hub.notify_one(self.id, expected);
        }
        is_line
    }

    /// Processes a text message from the page.
    ///
    /// # Errors
    /// The text is not a message of the page, or a value in it is out of range.
    pub fn receive_text(&mut self, text: &str, channels: &Channels) -> Result<(), Reason> {
        let message =
            serde_json::from_str(text).map_err(|_| "expected a message of docs/live-page.md")?;
        let hub: &Hub = &channels.hub;
        match message {
            FromPage::Take => {
                hub.take_control(self.id);
                self.tell_motion(channels);
            }
            FromPage::Release => self.release(channels),
            FromPage::Help { command } => {
                if self.is_line(&command, channels) {
                    channels.request(self.id, Request::Help(command));
                }
            }
            FromPage::Complete { line } => {
                if self.is_line(&line, channels) {
                    let mut words = Vec::new();
                    let mut offer = |word: &str, _: &str| words.push(word.to_owned());
                    complete(&line, &*channels.choices(), &mut offer);
                    hub.send_one(self.id, &ToPage::Completions { line, words });
                }
            }
            // Messages from a page that has just lost control may still arrive; they are ignored.
            _ if !hub.has_control(self.id) => {}
            FromPage::Command { line } => {
                if self.is_line(&line, channels) {
                    channels.request(self.id, Request::Command(line));
                }
            }
            FromPage::Choose { list, name } => {
                channels.request(self.id, Request::Choose(list, name));
            }
            FromPage::Interrupt => channels.request(self.id, Request::Interrupt),
            FromPage::Picture => channels.request(self.id, Request::Picture),
            FromPage::Buttons { pressed } => channels.inputs.press(pressed),
            FromPage::Switches { on } => channels.inputs.switch(on),
            FromPage::Orbit { turn, zoom } => {
                let drag = Drag { turn, zoom };
                if !drag.is_valid() {
                    return Err("expected a motion of the camera");
                }
                channels.drag(drag);
            }
            FromPage::Turn { attitude } => {
                let motion = channels.motion.as_ref();
                let is_set = motion.is_none_or(|motion| motion.turn(attitude));
                return is_set.then_some(()).ok_or("expected an attitude");
            }
            FromPage::Hand { place } => {
                let motion = channels.motion.as_ref();
                let is_set = motion.is_none_or(|motion| motion.move_hand(place));
                return is_set
                    .then_some(())
                    .ok_or("expected a position in the frame");
            }
            FromPage::Upload {
                name,
                bytes,
                beside,
            } => {
                let expected =
                    "expected a file of 1 byte to 64 MiB with a name of at most 100 characters";
                let mesh = FileHead { name, bytes };
                self.upload = Some(Sent::new(mesh, beside).ok_or(expected)?);
            }
        }
        Ok(())
    }

    /// Receives bytes of an announced file from the page, and passes the complete file to the session.
    ///
    /// # Errors
    /// No file has been announced, or more bytes arrive than announced.
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
            match file.converted() {
                Ok(request) => channels.request(self.id, request),
                Err(error) => channels.hub.notify_one(self.id, error),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channels::MAX_REQUESTS;
    use crate::inputs::Inputs;
    use crate::message::Message;
    use crate::motion::Motion;
    use glint_core::matrix::Axis;
    use glint_core::mesh::Mesh;
    use serde_json::json;
    use std::sync::Arc;

    fn upload(bytes: usize) -> String {
        format!(r#"{{"type":"upload","name":"a.stl","bytes":{bytes}}}"#)
    }

    /// Whether a text that contains `wanted` is queued for the page.
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
        for refused in [
            "{",
            r#"{"type":"other"}"#,
            r#"{"type":"buttons","pressed":256}"#,
            r#"{"type":"switches","on":65536}"#,
            r#"{"type":"choose","list":"others","name":"menger"}"#,
            r#"{"type":"turn","attitude":[0,0,0,0]}"#,
            r#"{"type":"turn","attitude":[1,0,0]}"#,
            r#"{"type":"hand","place":[0.5,1.5]}"#,
            r#"{"type":"orbit","turn":[99,0],"zoom":1}"#,
            &upload(0),
            &upload(MAX_UPLOAD + 1),
            &format!(
                r#"{{"type":"upload","name":"a.obj","bytes":1,"beside":[{{"name":"b","bytes":{MAX_UPLOAD}}}]}}"#
            ),
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
        assert!(queue.try_recv().is_err(), "no request reaches the board");
    }

    #[test]
    fn a_line_that_the_console_does_not_take_is_reported() {
        let (channels, queue) = Channels::to_board(None);
        let mut viewer = Viewer::join(&channels).unwrap();
        for line in ["x".repeat(LINE_MAX + 1), "ü".repeat(400), "\\t".into()] {
            for (kind, member) in [("command", "line"), ("help", "command")] {
                let text = format!(r#"{{"type":"{kind}","{member}":"{line}"}}"#);
                viewer.receive_text(&text, &channels).unwrap();
                assert!(is_told(&viewer, &channels, "at most 640 bytes"), "{text}");
            }
        }
        assert_eq!(LINE_MAX, 640, "as the notice says");
        assert!(queue.try_recv().is_err());
    }

    /// The next page with control does not take over pressed buttons, and receives the state of
    /// sensor and hand.
    #[test]
    fn control_passes_on_with_released_buttons_and_the_motion() {
        let motion = Arc::<Motion>::default();
        let (channels, _queue) = Channels::to_board(Some(motion));
        let (mut first, mut second) = (
            Viewer::join(&channels).unwrap(),
            Viewer::join(&channels).unwrap(),
        );
        for text in [
            r#"{"type":"buttons","pressed":1}"#,
            r#"{"type":"turn","attitude":[0,1,0,0]}"#,
            r#"{"type":"hand","place":[0.25,0.5]}"#,
            r#"{"type":"release"}"#,
        ] {
            first.receive_text(text, &channels).unwrap();
        }
        channels.hub.take(second.id());
        let take = r#"{"type":"take"}"#;
        second.receive_text(take, &channels).unwrap();
        let expected = r#""attitude":[0.0,1.0,0.0,0.0],"hand":[0.25,0.5]"#;
        assert!(is_told(&second, &channels, expected));
        channels.inputs.take();
        assert_eq!(channels.inputs.take().buttons, 0);
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
        assert!(
            matches!(queue.try_recv(), Ok(Request::Upload(upload)) if upload.bytes.starts_with(b"GLM"))
        );
        send("a.ply", &triangle);
        send("../../etc/passwd", &triangle);
        assert!(queue.try_recv().is_err());
        assert!(is_told(&viewer, &channels, "a.ply: line 1: expected"));
    }

    /// The colours of an OBJ come from its material file, and remarks on the files come with the mesh.
    #[test]
    fn auxiliary_files_come_with_the_mesh() {
        let obj = "mtllib sub/a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let mtl = "newmtl red\nKd 1 0 0\n";
        let send = |beside: &[&str]| {
            let (channels, queue) = Channels::to_board(Some(Arc::default()));
            let mut viewer = Viewer::join(&channels).unwrap();
            let head = |name: &str, text: &str| json!({ "name": name, "bytes": text.len() });
            let mut upload = head("a.obj", obj);
            upload["type"] = json!("upload");
            upload["beside"] = beside.iter().map(|text| head("a.mtl", text)).collect();
            viewer.receive_text(&upload.to_string(), &channels).unwrap();
            let bytes = [obj, &beside.concat()].concat();
            viewer.receive_bytes(bytes.as_bytes(), &channels).unwrap();
            match queue.try_recv() {
                Ok(Request::Upload(upload)) => upload,
                other => panic!("{other:?}"),
            }
        };
        let (grey, red) = (send(&[]), send(&[mtl]));
        assert_eq!([grey.up, red.up], [Some(Axis::Y); 2]);
        assert!(grey.remarks.iter().any(|remark| remark.contains("a.mtl")));
        assert!(red.remarks.is_empty());
        let colour = |upload: &Upload| {
            let mesh = Mesh::new_checked(&upload.bytes).unwrap();
            let mut triangles = mesh.chunks().flat_map(|chunk| chunk.triangles());
            triangles.next().unwrap().colour
        };
        assert_eq!(colour(&red).0, 0xF800);
        assert_ne!(colour(&grey).0, 0xF800);
    }

    #[test]
    fn a_texture_comes_under_its_name() {
        let (channels, queue) = Channels::to_board(Some(Arc::default()));
        let mut viewer = Viewer::join(&channels).unwrap();
        let mut send = |name: &str, file: &[u8]| {
            let head = json!({ "type": "upload", "name": name, "bytes": file.len() });
            viewer.receive_text(&head.to_string(), &channels).unwrap();
            viewer.receive_bytes(file, &channels).unwrap();
        };
        send("old/a wood.png", &glint_texture::example::small_png());
        let Ok(Request::Upload(upload)) = queue.try_recv() else {
            panic!("no upload");
        };
        assert!(upload.bytes.starts_with(b"GLT"));
        assert_eq!((upload.name.as_str(), upload.up), ("a-wood.png", None));
        send("a.glt", b"GLT1");
        assert!(queue.try_recv().is_err());
        assert!(is_told(
            &viewer,
            &channels,
            "a.glt: expected a valid texture"
        ));
    }

    #[test]
    fn a_page_without_control_changes_nothing() {
        let (channels, queue) = Channels::to_board(Some(Arc::default()));
        let first = Viewer::join(&channels).unwrap();
        let mut second = Viewer::join(&channels).unwrap();
        for ignored in [
            r#"{"type":"command","line":"reboot"}"#,
            r#"{"type":"interrupt"}"#,
            r#"{"type":"choose","list":"fields","name":"menger"}"#,
            r#"{"type":"buttons","pressed":1}"#,
            r#"{"type":"switches","on":1}"#,
            r#"{"type":"picture"}"#,
            r#"{"type":"orbit","turn":[1,0],"zoom":1}"#,
        ] {
            second.receive_text(ignored, &channels).unwrap();
        }
        second.receive_text(&upload(1), &channels).unwrap();
        assert!(second.receive_bytes(&[1], &channels).is_err());
        assert!(queue.try_recv().is_err());
        assert_eq!(channels.inputs.take(), Inputs::default().take());
        assert_eq!(channels.take_drag(), None);
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
