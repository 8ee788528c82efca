//! One open page: the connection to it.

use super::hub::{Hub, Id};
use super::inputs::Inputs;
use super::message::{FromPage, MAX_MESSAGE};
use super::motion::Motion;
use super::session::Request;
use crate::convert::Options;
use crate::model;
use std::io::ErrorKind;
use std::net::TcpStream;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError};
use std::time::Duration;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

/// Longest wait for a message from the page, after which the messages for the page are sent.
const LOOK: Duration = Duration::from_millis(4);

/// Maximum length of a line for the console.
const MAX_LINE: usize = 200;

/// Maximum size of a file for an upload in bytes.
const MAX_UPLOAD: usize = 64 << 20;

/// Maximum length of a file's name.
const MAX_NAME: usize = 100;

/// A mesh file on its way from the page.
struct Upload {
    name: String,
    bytes: usize,
    data: Vec<u8>,
}

/// The way of messages between the pages and the board.
pub struct Channels {
    /// The viewers.
    pub hub: Hub,
    /// The levels that the viewer with control sets.
    pub inputs: Inputs,
    /// The motion sensor and the hand, if the page moves them.
    pub motion: Option<Arc<Motion>>,
    /// The commands for the board.
    pub requests: SyncSender<Request>,
}

/// The reason to close a connection.
type Reason = &'static str;

/// Serves a page whose request has been accepted; `rest` was received after the request.
pub fn serve(stream: TcpStream, rest: Vec<u8>, channels: &Channels) -> tungstenite::Result<()> {
    stream.set_read_timeout(Some(LOOK))?;
    stream.set_write_timeout(Some(LOOK))?;
    let config = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE))
        .max_frame_size(Some(MAX_MESSAGE));
    let mut socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
    let Some(id) = channels.hub.join() else {
        return close(&mut socket, "expected at most 16 open pages");
    };
    let result = exchange(&mut socket, id, channels);
    if channels.hub.has_control(id) {
        channels.inputs.press(0);
    }
    channels.hub.leave(id);
    match result? {
        Some(reason) => close(&mut socket, reason),
        None => Ok(()),
    }
}

/// Passes messages until the page is closed, or there is a reason to close it.
fn exchange(
    socket: &mut WebSocket<TcpStream>,
    id: Id,
    channels: &Channels,
) -> tungstenite::Result<Option<Reason>> {
    let mut is_sent = true;
    let mut upload = None;
    loop {
        // Pictures that come while the last one is on its way replace each other.
        if is_sent {
            let Some(messages) = channels.hub.take(id) else {
                return Ok(Some("the page has fallen behind"));
            };
            for message in messages {
                is_done(socket.write(message))?;
            }
        }
        is_sent = is_done(socket.flush())?;
        let message = match socket.read() {
            Ok(message) => message,
            Err(Error::Io(error)) if is_passing(&error) => continue,
            Err(Error::ConnectionClosed | Error::AlreadyClosed) => return Ok(None),
            Err(Error::Capacity(_)) => {
                return Ok(Some("expected a message of at most 128 KiB"));
            }
            Err(error) => return Err(error),
        };
        if let Err(reason) = handle(&message, id, channels, &mut upload) {
            return Ok(Some(reason));
        }
    }
}

fn is_passing(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}

/// Whether all has been written; false if the page does not take more now.
fn is_done(result: tungstenite::Result<()>) -> tungstenite::Result<bool> {
    match result {
        Ok(()) => Ok(true),
        Err(Error::Io(error)) if is_passing(&error) => Ok(false),
        Err(error) => Err(error),
    }
}

fn close(socket: &mut WebSocket<TcpStream>, reason: Reason) -> tungstenite::Result<()> {
    let frame = CloseFrame {
        code: CloseCode::Policy,
        reason: reason.into(),
    };
    socket.close(Some(frame))?;
    socket.flush()
}

/// Acts on a message from the page.
fn handle(
    message: &Message,
    id: Id,
    channels: &Channels,
    upload: &mut Option<Upload>,
) -> Result<(), Reason> {
    let text = match message {
        Message::Text(text) => text,
        Message::Binary(bytes) => return receive(bytes, channels, upload),
        _ => return Ok(()),
    };
    let message =
        serde_json::from_str(text).map_err(|_| "expected a message of docs/live-page.md")?;
    let hub: &Hub = &channels.hub;
    match message {
        FromPage::Take => hub.take_control(id),
        FromPage::Release => hub.release_control(id),
        FromPage::Help { command } => {
            check_line(&command)?;
            request(channels, Request::Help(command));
        }
        // Messages of a page that has lost control are on their way for some time.
        _ if !hub.has_control(id) => {}
        FromPage::Command { line } => {
            check_line(&line)?;
            request(channels, Request::Command(line));
        }
        FromPage::Interrupt => request(channels, Request::Interrupt),
        FromPage::Picture => request(channels, Request::Picture),
        FromPage::Buttons { pressed } => channels.inputs.press(pressed),
        FromPage::Switches { on } => channels.inputs.switch(on),
        FromPage::Turn { attitude } => {
            let is_set = channels.motion.as_ref().map(|motion| motion.turn(attitude));
            return is_set
                .unwrap_or(true)
                .then_some(())
                .ok_or("expected an attitude");
        }
        FromPage::Hand { place } => {
            let is_set = channels
                .motion
                .as_ref()
                .map(|motion| motion.move_hand(place));
            let expected = "expected a place in the frame";
            return is_set.unwrap_or(true).then_some(()).ok_or(expected);
        }
        FromPage::Upload { name, bytes } => {
            if bytes == 0 || bytes > MAX_UPLOAD || name.len() > MAX_NAME {
                return Err("expected a file of 1 byte to 64 MiB with a name of at most 100 bytes");
            }
            let data = Vec::new();
            *upload = Some(Upload { name, bytes, data });
        }
    }
    Ok(())
}

/// Takes bytes of an announced file, and hands the whole file to the board.
fn receive(bytes: &[u8], channels: &Channels, upload: &mut Option<Upload>) -> Result<(), Reason> {
    let expected = "expected the bytes of an announced file";
    let file = upload.as_mut().ok_or(expected)?;
    if bytes.len() > file.bytes - file.data.len() {
        return Err(expected);
    }
    file.data.extend_from_slice(bytes);
    if file.data.len() == file.bytes
        && let Some(file) = upload.take()
    {
        match convert(&file) {
            Ok(mesh) => request(channels, Request::Upload(mesh)),
            Err(error) => channels.hub.notify(error.to_string(), true),
        }
    }
    Ok(())
}

/// Converts a mesh file to the board's memory layout.
fn convert(file: &Upload) -> anyhow::Result<Vec<u8>> {
    // The readers take the format from the name, and look for further files beside the file.
    let folder = tempfile::tempdir()?;
    let name = Path::new(&file.name).extension().unwrap_or_default();
    let path = folder.path().join("model").with_extension(name);
    std::fs::write(&path, &file.data)?;
    let path = path.to_string_lossy();
    match model::load(&path, Options::default()) {
        Ok(model) => Ok(model.mesh),
        Err(error) => anyhow::bail!("{}: {}", file.name.escape_debug(), error.error),
    }
}

fn check_line(line: &str) -> Result<(), Reason> {
    if line.len() > MAX_LINE || line.chars().any(char::is_control) {
        return Err("expected a line of at most 200 characters");
    }
    Ok(())
}

fn request(channels: &Channels, request: Request) {
    // The session ends with the program.
    if let Err(TrySendError::Full(_)) = channels.requests.try_send(request) {
        channels
            .hub
            .notify("the board is busy: a command was dropped", true);
    }
}
