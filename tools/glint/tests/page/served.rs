//! `glint board` in a separate process, with an emulated board and its page.

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Message, WebSocket};

/// Time-out of a reply.
const PATIENCE: Duration = Duration::from_secs(20);

/// A board that serves its page.
pub struct Served {
    child: Child,
    /// Address of the page, or of the serial port.
    pub url: String,
}

impl Served {
    /// Starts an emulated board with its page. `name` is the name of its ready file.
    pub fn start(name: &str) -> Self {
        Self::start_with(name, &["--web"])
    }

    /// Starts `glint board` with additional arguments. Without `--web` the address is that of a
    /// serial port.
    pub fn start_with(name: &str, arguments: &[&str]) -> Self {
        let ready = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let mut child = Command::new(env!("CARGO_BIN_EXE_glint"))
            .arg("board")
            .args(arguments)
            .arg("--ready-file")
            .arg(&ready)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let url = lines.next().unwrap().unwrap();
        Self { child, url }
    }

    /// Host and port of the page.
    pub fn host(&self) -> &str {
        self.url.split('/').nth(2).unwrap()
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_write_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// Opens the page's socket with the header field `Origin` set to `origin`.
    pub fn socket(&self, origin: &str) -> tungstenite::Result<WebSocket<TcpStream>> {
        let url = format!("{}socket", self.url.replace("http:", "ws:"));
        let mut request = url.into_client_request().unwrap();
        let origin = HeaderValue::from_str(origin).unwrap();
        request.headers_mut().insert("origin", origin);
        match tungstenite::client(request, self.connect()) {
            Ok((socket, _)) => Ok(socket),
            Err(tungstenite::HandshakeError::Failure(error)) => Err(error),
            Err(error) => panic!("{error}"),
        }
    }

    /// Opens the page's socket with the header fields of the page.
    pub fn viewer(&self) -> WebSocket<TcpStream> {
        self.socket(&format!("http://{}", self.host())).unwrap()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // An error means that the test has already ended the program.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Reads text messages until one contains `wanted`, and returns it.
pub fn wait_for(socket: &mut WebSocket<TcpStream>, wanted: &str) -> String {
    let end = Instant::now() + 3 * PATIENCE;
    loop {
        assert!(Instant::now() < end, "{wanted} has not arrived");
        if let Message::Text(text) = socket.read().unwrap()
            && text.contains(wanted)
        {
            return text.to_string();
        }
    }
}
