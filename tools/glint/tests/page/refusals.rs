//! Tests that invalid requests and messages are rejected, and that the board continues to run.

use crate::served::{Served, wait_for};
use std::io::{Read, Write};
use std::time::{Duration, Instant};
use tungstenite::http::StatusCode;
use tungstenite::{Error, Message};

/// Number of bytes of invalid data.
const INVALID_BYTES: usize = 10_000_000;

/// The first line of the reply to a request.
fn answer(served: &Served, request: &str) -> String {
    let mut stream = served.connect();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer.lines().next().unwrap_or_default().to_owned()
}

#[test]
fn other_addresses_and_origins_are_refused() {
    let served = Served::start("page-refusals");
    let host = served.host();
    let path = served.url.split(host).nth(1).unwrap();
    let get = |path: &str, host: &str| {
        answer(
            &served,
            &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"),
        )
    };
    assert_eq!(get(path, host), "HTTP/1.1 200 OK");
    assert_eq!(get(&format!("{path}page.css"), host), "HTTP/1.1 200 OK");
    assert_eq!(
        get(&format!("{path}../secret"), host),
        "HTTP/1.1 404 Not Found"
    );
    let wrong = format!("/{}/", "0".repeat(32));
    for (path, host) in [(wrong.as_str(), host), ("/", host), (path, "other.example")] {
        assert_eq!(get(path, host), "HTTP/1.1 403 Forbidden", "{path} {host}");
    }
    assert_eq!(
        answer(
            &served,
            &format!("POST {path} HTTP/1.1\r\nHost: {host}\r\n\r\n")
        ),
        "HTTP/1.1 400 Bad Request"
    );
    assert_eq!(
        get(path, &"x".repeat(20_000)),
        "HTTP/1.1 431 Request Header Fields Too Large"
    );
    for origin in ["http://other.example", "null"] {
        match served.socket(origin) {
            Err(Error::Http(response)) => assert_eq!(response.status(), StatusCode::FORBIDDEN),
            other => panic!("{origin}: {other:?}"),
        }
    }
}

#[test]
fn rubbish_does_no_harm() {
    let served = Served::start("page-rubbish");
    let mut viewer = served.viewer();
    wait_for(&mut viewer, r#""holder":"you""#);

    // Bytes that are not a frame of the protocol are sent after the handshake and in place of it.
    let rubbish: Vec<u8> = (0..INVALID_BYTES).map(|i| ((i * i) >> 7) as u8).collect();
    let mut other = served.viewer();
    // The server closes the connection before all bytes are written.
    let _ = other.get_mut().write_all(&rubbish);
    let _ = served.connect().write_all(&rubbish);
    // Messages that are too long, and messages of an unknown type.
    let texts = [
        "x",
        "{}",
        r#"{"type":"buttons","pressed":256}"#,
        r#"{"type":"help","command":"x","more":1}"#,
    ];
    let long = Message::binary(rubbish);
    let others = texts.map(Message::text);
    for message in others.into_iter().chain([long, Message::binary(vec![1])]) {
        let mut other = served.viewer();
        let _ = other.send(message.clone());
        let ended = loop {
            match other.read() {
                Ok(Message::Close(frame)) => break frame.is_some(),
                Ok(_) => {}
                Err(_) => break true,
            }
        };
        assert!(ended);
    }

    // Messages from a viewer without control have no effect; the first viewer keeps control.
    let mut second = served.viewer();
    wait_for(&mut second, r#""holder":"other""#);
    let line = |line: &str| Message::text(format!(r#"{{"type":"command","line":"{line}"}}"#));
    second.send(line("echo stranger")).unwrap();
    second.send(Message::text(r#"{"type":"take"}"#)).unwrap();
    wait_for(&mut second, r#""holder":"other""#);
    viewer.send(line("echo friend")).unwrap();
    let mut console = String::new();
    while !console.contains("ok") {
        console += &wait_for(&mut second, r#""type":"console""#);
    }
    assert!(
        console.contains("friend") && !console.contains("stranger"),
        "{console}"
    );
    drop(viewer);
    wait_for(&mut second, r#""holder":"nobody""#);
    second.send(Message::text(r#"{"type":"take"}"#)).unwrap();
    wait_for(&mut second, r#""holder":"you""#);
}

/// Connections without the token that send a byte every second cannot block a page.
#[test]
fn slow_connections_do_not_keep_a_page_out() {
    const STRANGERS: usize = 100;
    let served = Served::start("page-strangers");
    let host = served.host();
    let path = served.url.split(host).nth(1).unwrap();
    let page = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n");
    let rejected = format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n");
    for start in ["G", rejected.as_str()] {
        let mut strangers: Vec<_> = (0..STRANGERS).map(|_| served.connect()).collect();
        for _ in 0..3 {
            for stranger in &mut strangers {
                // An error means that the server has closed this connection, one of the oldest.
                let _ = stranger.write_all(start.as_bytes());
            }
            let begun = Instant::now();
            assert_eq!(answer(&served, &page), "HTTP/1.1 200 OK");
            assert!(begun.elapsed() < Duration::from_secs(2));
            std::thread::sleep(Duration::from_secs(1));
        }
    }
}

/// A rejected peer cannot keep its connection open by sending more bytes.
#[test]
fn a_rejected_connection_is_closed_in_time() {
    let served = Served::start("page-rejected");
    let mut stream = served.connect();
    let begun = Instant::now();
    let request = format!("GET / HTTP/1.1\r\nHost: {}\r\n\r\n", served.host());
    stream.write_all(request.as_bytes()).unwrap();
    while stream.write_all(b"x").is_ok() {
        assert!(begun.elapsed() < Duration::from_secs(10), "it stays open");
        std::thread::sleep(Duration::from_millis(300));
    }
}
