//! The connection to one open page.

use glint_live_page::message::MAX_MESSAGE;
use glint_live_page::viewer::Reason;
use glint_live_page::{Channels, Message as ToPage, Viewer};
use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, Role, WebSocketConfig};
use tungstenite::{Bytes, Error, Message, WebSocket};

/// Longest wait for a message from the page before the messages to the page are sent.
const POLL: Duration = Duration::from_millis(4);

/// Time limits for the silence of a page. A browser answers a ping even if the page's script is
/// busy.
#[derive(Clone, Copy)]
pub struct Patience {
    /// Silence after which the server sends a ping.
    pub quiet: Duration,
    /// Silence after which the connection is closed, so that an unreachable page does not keep control.
    pub lost: Duration,
}

/// Time limits for a page on a slow network.
pub const PATIENCE: Patience = Patience {
    quiet: Duration::from_secs(10),
    lost: Duration::from_secs(30),
};

/// Serves a page whose request has been accepted; `rest` is the data received after the request.
pub fn serve(
    stream: TcpStream,
    rest: Vec<u8>,
    channels: &Channels,
    patience: Patience,
) -> tungstenite::Result<()> {
    stream.set_read_timeout(Some(POLL))?;
    stream.set_write_timeout(Some(POLL))?;
    let config = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE))
        .max_frame_size(Some(MAX_MESSAGE));
    let mut socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
    let Some(mut viewer) = Viewer::join(channels) else {
        return close(&mut socket, "expected at most 16 open pages");
    };
    let result = exchange(&mut socket, &mut viewer, channels, patience);
    viewer.leave(channels);
    match result? {
        Some(reason) => close(&mut socket, reason),
        None => Ok(()),
    }
}

/// Exchanges messages until the page is closed, or the server has a reason to close the connection.
fn exchange(
    socket: &mut WebSocket<TcpStream>,
    viewer: &mut Viewer,
    channels: &Channels,
    patience: Patience,
) -> tungstenite::Result<Option<Reason>> {
    let mut is_sent = true;
    let mut heard = Instant::now();
    let mut is_asked = false;
    loop {
        let silence = heard.elapsed();
        if silence >= patience.lost {
            return Ok(Some("the page does not answer"));
        }
        if silence >= patience.quiet && !is_asked {
            is_done(socket.write(Message::Ping(Bytes::new())))?;
            is_asked = true;
        }
        // While a picture is being sent, a newer picture replaces the picture in the queue.
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
        heard = Instant::now();
        is_asked = false;
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

/// Whether all bytes were written; false if the page currently accepts no more bytes.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;
    use std::thread::scope;

    const SHORT: Patience = Patience {
        quiet: Duration::from_millis(100),
        lost: Duration::from_secs(1),
    };

    #[test]
    fn a_page_that_does_not_answer_is_closed_and_one_that_does_is_not() {
        let (channels, _requests) = Channels::to_board(None);
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let open = || TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let serve = || serve(listener.accept().unwrap().0, Vec::new(), &channels, SHORT);

        let silent = open();
        serve().unwrap();
        assert!(!channels.hub.has_viewers());
        drop(silent);

        let stream = open();
        scope(|threads| {
            // The thread ends when the stream is closed.
            threads.spawn(serve);
            let mut page = WebSocket::from_raw_socket(stream, Role::Client, None);
            let pings = SHORT.lost.as_millis() / SHORT.quiet.as_millis() + 1;
            for _ in 0..pings {
                while !matches!(page.read().unwrap(), Message::Ping(_)) {}
            }
            drop(page);
        });
    }
}
