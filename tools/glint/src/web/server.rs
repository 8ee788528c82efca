//! Listens for browsers, checks their requests, and serves the files of the page.

use super::connection::{self, PATIENCE};
use super::watch::Watched;
use crate::board::BoardError;
use glint_live_page::channels::Program;
use glint_live_page::files::{FILES, File, SCRIPT};
use glint_live_page::hub::MAX_VIEWERS;
use glint_live_page::{Channels, Live, session};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tungstenite::handshake::machine::TryParse;
use tungstenite::handshake::server::{Request, create_response, write_response};
use tungstenite::http::{HeaderMap, HeaderValue, Response, StatusCode, header};

/// Maximum size of a request's head in bytes.
const MAX_HEAD: usize = 8 << 10;
/// Time-out of receiving a request's head.
const HEAD_TIME: Duration = Duration::from_secs(5);
/// Time-out of reading the rest of a rejected request.
const REST_TIME: Duration = Duration::from_secs(1);
/// Maximum number of open connections with an accepted request, and of open connections without
/// one.
const MAX_CONNECTIONS: usize = 4 * MAX_VIEWERS;
/// The file of the page that exchanges messages with this program over a WebSocket.
const LINK: File = File {
    name: "link.js",
    media: SCRIPT,
    content: include_str!("../../web/link.js"),
};

/// Media type of error replies.
const TEXT: &str = "text/plain";

/// Header fields of all files. They forbid other pages to embed this page in a frame, and browsers
/// to send the address with the token to other sites. The page itself declares that it loads
/// nothing from other sites.
const HEADER: [(&str, &str); 5] = [
    ("content-security-policy", "frame-ancestors 'none'"),
    ("referrer-policy", "no-referrer"),
    ("x-content-type-options", "nosniff"),
    ("cache-control", "no-store"),
    ("connection", "close"),
];

/// State that the threads of the connections share.
struct Shared {
    channels: Channels,
    address: SocketAddr,
    token: String,
    /// Number of connections whose request has been accepted.
    connections: AtomicUsize,
    strangers: Mutex<Strangers>,
}

/// Connections without an accepted request. Above the limit a new connection closes the oldest
/// connection, so that connections without the token cannot block pages.
#[derive(Default)]
struct Strangers {
    /// Number of the next connection.
    next: u64,
    open: VecDeque<(u64, TcpStream)>,
}

impl Strangers {
    /// Adds a connection, and returns its number.
    fn add(&mut self, stream: &TcpStream) -> io::Result<u64> {
        if self.open.len() >= MAX_CONNECTIONS
            && let Some((_, oldest)) = self.open.pop_front()
        {
            // The peer may already have closed the connection.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        let number = self.next;
        self.next += 1;
        self.open.push_back((number, stream.try_clone()?));
        Ok(number)
    }

    /// Removes a connection that is accepted or closed.
    fn remove(&mut self, number: u64) {
        self.open.retain(|(open, _)| *open != number);
    }
}

/// A server of the live page that is already listening.
pub struct Server {
    listener: TcpListener,
    token: String,
}

impl Server {
    /// Listens at an address; port 0 selects a free port.
    ///
    /// # Errors
    /// The address is in use or does not belong to this machine, or the system provides no random numbers.
    pub fn bind(address: SocketAddr) -> io::Result<Self> {
        let mut token = [0; 16];
        getrandom::fill(&mut token).map_err(io::Error::other)?;
        Ok(Self {
            listener: TcpListener::bind(address)?,
            token: token.iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }

    /// The page's address on this machine, with the access token.
    ///
    /// # Errors
    /// The system does not report the port.
    pub fn url(&self) -> io::Result<String> {
        let mut address = self.listener.local_addr()?;
        // Some browsers do not open an unspecified address.
        match address.ip() {
            IpAddr::V4(ip) if ip.is_unspecified() => address.set_ip(Ipv4Addr::LOCALHOST.into()),
            IpAddr::V6(ip) if ip.is_unspecified() => address.set_ip(Ipv6Addr::LOCALHOST.into()),
            _ => {}
        }
        Ok(format!("http://{address}/{}/", self.token))
    }

    /// Serves the page of the board `name` until `stop` is set. The board starts the program `first`; without one, its firmware is running.
    /// Whenever the file `watched` changes, the board starts its program.
    ///
    /// # Errors
    /// The line to the board has failed.
    pub fn run(
        self,
        board: &mut dyn Live,
        name: &str,
        first: Option<Program>,
        watched: Option<Watched>,
        stop: &AtomicBool,
    ) -> Result<(), BoardError> {
        let (channels, requests) = Channels::new(board, name, true);
        let shared = Arc::new(Shared {
            channels,
            address: self.listener.local_addr()?,
            token: self.token,
            connections: AtomicUsize::new(0),
            strangers: Mutex::default(),
        });
        let listener = self.listener;
        let served = Arc::clone(&shared);
        // The thread waits in `accept` and is not joined: it ends with the program.
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                accept(stream, &served);
            }
        });
        if let Some(first) = first {
            shared.channels.start(first);
        }
        if let Some(watched) = watched {
            let shared = Arc::clone(&shared);
            // This thread ends with the program, too.
            std::thread::spawn(move || watched.watch(&shared.channels));
        }
        session::run(board, &shared.channels, requests, stop)
    }
}

/// Serves a connection in its own thread.
fn accept(stream: TcpStream, shared: &Arc<Shared>) {
    let Ok(number) = lock(&shared.strangers).add(&stream) else {
        return;
    };
    let shared = Arc::clone(shared);
    std::thread::spawn(move || {
        // An error concerns only this connection, which is closed.
        let _ = serve(stream, number, &shared);
        lock(&shared.strangers).remove(number);
    });
}

/// Locks the list, even if a thread has panicked with the lock: every change leaves a valid list.
fn lock(strangers: &Mutex<Strangers>) -> MutexGuard<'_, Strangers> {
    strangers.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A rejected request: the status, and the reason with the expected value.
#[derive(Debug, PartialEq, Eq)]
struct Refused(StatusCode, &'static str);

/// The reply to a request.
#[derive(Debug, PartialEq, Eq)]
enum Answer {
    /// A file of the page.
    File(File),
    /// A WebSocket connection of a viewer.
    Socket,
}

fn serve(mut stream: TcpStream, number: u64, shared: &Shared) -> tungstenite::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(HEAD_TIME))?;
    let (request, rest) = match read_head(&mut stream)? {
        Ok(head) => head,
        Err(refused) => return refuse(&mut stream, refused),
    };
    let answer = match answer(&request, shared.address, &shared.token) {
        Ok(answer) => answer,
        Err(refused) => return refuse(&mut stream, refused),
    };
    lock(&shared.strangers).remove(number);
    let open = shared.connections.fetch_add(1, Ordering::Relaxed);
    let result = match open < MAX_CONNECTIONS {
        true => serve_accepted(stream, rest, &request, answer, shared),
        false => Ok(()),
    };
    shared.connections.fetch_sub(1, Ordering::Relaxed);
    result
}

/// Serves a connection whose request has been accepted; `rest` is the data received after the request.
fn serve_accepted(
    mut stream: TcpStream,
    rest: Vec<u8>,
    request: &Request,
    answer: Answer,
    shared: &Shared,
) -> tungstenite::Result<()> {
    match answer {
        Answer::File(file) => write_file(&mut stream, StatusCode::OK, file.media, file.content),
        Answer::Socket => match create_response(request) {
            Ok(response) => {
                write_response(&mut stream, &response)?;
                connection::serve(stream, rest, &shared.channels, PATIENCE)
            }
            Err(error) => {
                let text = format!("expected a WebSocket request: {error}\n");
                write_file(&mut stream, StatusCode::BAD_REQUEST, TEXT, &text)
            }
        },
    }
}

fn refuse(stream: &mut TcpStream, Refused(status, text): Refused) -> tungstenite::Result<()> {
    write_file(stream, status, TEXT, &format!("{text}\n"))
}

/// Reads the head of a request. Returns the request, and the bytes after its head.
fn read_head(stream: &mut TcpStream) -> io::Result<Result<(Request, Vec<u8>), Refused>> {
    let end = Instant::now() + HEAD_TIME;
    let mut bytes = Vec::new();
    loop {
        match Request::try_parse(&bytes) {
            Ok(Some((length, request))) => return Ok(Ok((request, bytes.split_off(length)))),
            Ok(None) => {}
            Err(_) => {
                let expected = "expected a GET request of HTTP 1.1";
                return Ok(Err(Refused(StatusCode::BAD_REQUEST, expected)));
            }
        }
        if bytes.len() >= MAX_HEAD {
            let status = StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE;
            return Ok(Err(Refused(status, "expected a head of at most 8 KiB")));
        }
        let left = end.saturating_duration_since(Instant::now());
        stream.set_read_timeout(Some(left.max(Duration::from_millis(1))))?;
        let mut buffer = [0; 2048];
        match stream.read(&mut buffer)? {
            0 => return Err(io::ErrorKind::UnexpectedEof.into()),
            count => bytes.extend_from_slice(&buffer[..count]),
        }
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
    }
}

/// Checks a request to a server at `address`.
fn answer(request: &Request, address: SocketAddr, token: &str) -> Result<Answer, Refused> {
    let headers = request.headers();
    let host = text(headers, header::HOST).unwrap_or_default();
    if !is_host(host, address) {
        let expected = "Host: expected the address that glint has printed";
        return Err(Refused(StatusCode::FORBIDDEN, expected));
    }
    let mut parts = request.uri().path().splitn(3, '/').skip(1);
    if !is_token(parts.next().unwrap_or_default(), token) {
        let expected = "token: expected the address that glint has printed";
        return Err(Refused(StatusCode::FORBIDDEN, expected));
    }
    let name = match parts.next() {
        Some("") => Some(FILES[0].name),
        name => name,
    };
    if name == Some("socket") {
        let origin = text(headers, header::ORIGIN).unwrap_or_default();
        if origin.strip_prefix("http://") != Some(host) {
            let expected = "Origin: expected a page from this address";
            return Err(Refused(StatusCode::FORBIDDEN, expected));
        }
        return Ok(Answer::Socket);
    }
    let mut files = FILES.into_iter().chain([LINK]);
    files
        .find(|file| name == Some(file.name))
        .map(Answer::File)
        .ok_or(Refused(StatusCode::NOT_FOUND, "no such file"))
}

/// The value of a header field that occurs exactly once.
fn text(headers: &HeaderMap, name: header::HeaderName) -> Option<&str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

/// Whether `host` is valid for the server's address: this port, and `localhost` or an IP address. Another name may be a domain of
/// a foreign page that resolves to this machine (DNS rebinding).
fn is_host(host: &str, address: SocketAddr) -> bool {
    let (name, port) = match host.rsplit_once(':') {
        Some((name, port)) if !port.ends_with(']') => (name, port.parse().ok()),
        _ => (host, Some(80)),
    };
    let number = name.trim_start_matches('[').trim_end_matches(']');
    let is_number = number
        .parse::<IpAddr>()
        .is_ok_and(|ip| address.ip().is_unspecified() || ip == address.ip());
    port == Some(address.port()) && (name == "localhost" || is_number)
}

/// Compares in constant time, so that the duration does not reveal the position of the first
/// difference.
fn is_token(found: &str, token: &str) -> bool {
    let differences = found
        .bytes()
        .zip(token.bytes())
        .fold(0, |all, (a, b)| all | (a ^ b));
    found.len() == token.len() && differences == 0
}

fn write_file(
    stream: &mut TcpStream,
    status: StatusCode,
    media: &'static str,
    content: &str,
) -> tungstenite::Result<()> {
    let mut response = Response::new(());
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(media));
    headers.insert(header::CONTENT_LENGTH, HeaderValue::from(content.len()));
    for (name, value) in HEADER {
        headers.insert(name, HeaderValue::from_static(value));
    }
    write_response(&mut *stream, &response)?;
    stream.write_all(content.as_bytes())?;
    // The rest of the request is read, because the system could otherwise discard the reply.
    stream.shutdown(Shutdown::Write)?;
    let end = Instant::now() + REST_TIME;
    let mut rest = [0; 4096];
    loop {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(());
        }
        stream.set_read_timeout(Some(left))?;
        if stream.read(&mut rest)? == 0 {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(path: &str, fields: &[(&'static str, &'static str)]) -> Request {
        let mut request = Request::new(());
        *request.uri_mut() = path.parse().unwrap();
        for (name, value) in fields {
            let value = HeaderValue::from_static(value);
            request.headers_mut().append(*name, value);
        }
        request
    }

    #[test]
    fn requests_are_checked() {
        let address = "127.0.0.1:8080".parse().unwrap();
        let asked = |path, fields: &[_]| {
            answer(&request(path, fields), address, "00ff").map_err(|refused| refused.0)
        };
        let host = ("host", "127.0.0.1:8080");
        let page = ("origin", "http://127.0.0.1:8080");
        assert_eq!(asked("/00ff/", &[host]), Ok(Answer::File(FILES[0])));
        assert_eq!(asked("/00ff/link.js", &[host]), Ok(Answer::File(LINK)));
        assert_eq!(asked("/00ff/socket", &[host, page]), Ok(Answer::Socket));
        assert_eq!(
            asked("/00ff/", &[("host", "localhost:8080")]),
            Ok(Answer::File(FILES[0]))
        );
        assert_eq!(asked("/00ff/other", &[host]), Err(StatusCode::NOT_FOUND));
        assert_eq!(asked("/00ff", &[host]), Err(StatusCode::NOT_FOUND));
        let forbidden = Err(StatusCode::FORBIDDEN);
        for path in ["/", "/00fe/", "/00f/", "/00ff0/", "//00ff/"] {
            assert_eq!(asked(path, &[host]), forbidden, "{path}");
        }
        for other in [
            "127.0.0.1",
            "127.0.0.1:8081",
            "rebound.example:8080",
            "10.0.0.1:8080",
            "",
        ] {
            assert_eq!(asked("/00ff/", &[("host", other)]), forbidden, "{other}");
        }
        assert_eq!(asked("/00ff/", &[host, host]), forbidden);
        assert_eq!(asked("/00ff/socket", &[host]), forbidden);
        for origin in [
            "http://localhost:8080",
            "https://127.0.0.1:8080",
            "null",
            "http://other.example",
        ] {
            let asked = asked("/00ff/socket", &[host, ("origin", origin)]);
            assert_eq!(asked, forbidden, "{origin}");
        }
    }

    #[test]
    fn a_server_on_all_addresses_accepts_each_of_them_but_no_name() {
        let all = "0.0.0.0:80".parse().unwrap();
        let url = Server::bind("0.0.0.0:0".parse().unwrap()).unwrap().url();
        assert!(url.unwrap().starts_with("http://127.0.0.1:"));
        assert!(is_host("192.168.1.7", all) && is_host("[fe80::1]:80", all));
        assert!(!is_host("rebound.example", all) && !is_host("192.168.1.7:81", all));
    }
}
