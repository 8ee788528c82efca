//! The connection to one open page.

use glint_live::message::MAX_MESSAGE;
use glint_live::viewer::Reason;
use glint_live::{Channels, Message as ToPage, Viewer};
use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::Duration;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, Role, WebSocketConfig};
use tungstenite::{Bytes, Error, Message, WebSocket};

/// Longest wait for a message from the page, after which the messages for the page are sent.
const LOOK: Duration = Duration::from_millis(4);

/// Serves a page whose request has been accepted; `rest` was received after the request.
pub fn serve(stream: TcpStream, rest: Vec<u8>, channels: &Channels) -> tungstenite::Result<()> {
    stream.set_read_timeout(Some(LOOK))?;
    stream.set_write_timeout(Some(LOOK))?;
    let config = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE))
        .max_frame_size(Some(MAX_MESSAGE));
    let mut socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
    let Some(mut viewer) = Viewer::join(channels) else {
        return close(&mut socket, "expected at most 16 open pages");
    };
    let result = exchange(&mut socket, &mut viewer, channels);
    viewer.leave(channels);
    match result? {
        Some(reason) => close(&mut socket, reason),
        None => Ok(()),
    }
}

/// Passes messages until the page is closed, or there is a reason to close it.
fn exchange(
    socket: &mut WebSocket<TcpStream>,
    viewer: &mut Viewer,
    channels: &Channels,
) -> tungstenite::Result<Option<Reason>> {
    let mut is_sent = true;
    loop {
        // Pictures that come while the last one is on its way replace each other.
        if is_sent {
            let Some(messages) = channels.hub.take(viewer.id()) else {
                return Ok(Some("the page has fallen behind"));
            };
            for message in messages {
                is_done(socket.write(encoded(message)))?;
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
        let received = match &message {
            Message::Text(text) => viewer.receive_text(text, channels),
            Message::Binary(bytes) => viewer.receive_bytes(bytes, channels),
            _ => Ok(()),
        };
        if let Err(reason) = received {
            return Ok(Some(reason));
        }
    }
}

fn encoded(message: ToPage) -> Message {
    match message {
        ToPage::Text(text) => Message::text(&*text),
        ToPage::Binary(bytes) => Message::Binary(Bytes::from_owner(bytes)),
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
