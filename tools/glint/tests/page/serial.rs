//! The page of a board on a serial port.

use crate::served::{Served, wait_for};
use glint::board::{self, built_firmware};
use glint::console::Console;
use glint::transfer::download;
use glint_core::picture::Size;
use tungstenite::Message;

/// Makes the start scene small.
const COMMAND: &str = "quality fast";

/// The pixels that a board without a page sends after the command.
fn expected() -> Vec<u8> {
    let mut board = board::emulated(&built_firmware(None).unwrap()).unwrap();
    let mut console = Console::new(&mut board);
    console.synchronise().unwrap();
    console.command(COMMAND).unwrap();
    let length = 2 * Size::W320.pixel_count();
    download(&mut console, "frame", length, &mut |_, _| {}).unwrap()
}

#[test]
fn the_picture_of_a_board_on_a_serial_port_is_fetched() {
    let port = Served::start_with("page-port", &[]);
    let served = Served::start_with("page-serial", &["--web", "--board", &port.url]);
    let mut socket = served.viewer();
    let board = wait_for(&mut socket, r#""type":"board""#);
    assert!(board.contains(r#""has_pins":false"#), "{board}");
    wait_for(&mut socket, r#""holder":"you""#);
    let command = format!(r#"{{"type":"command","line":"{COMMAND}"}}"#);
    for text in [command.as_str(), r#"{"type":"picture"}"#] {
        socket.send(Message::text(text)).unwrap();
    }
    let picture = loop {
        if let Message::Binary(picture) = socket.read().unwrap() {
            break picture;
        }
    };
    let (head, colours) = picture.split_at(8);
    assert_eq!(head, [64, 1, 180, 0, 1, 0, 0, 0], "320x180, the first one");
    assert!(colours == expected(), "the colours are those of the board");
}
