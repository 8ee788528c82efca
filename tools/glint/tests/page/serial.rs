//! The page of a board on a serial port.

use crate::served::{Served, wait_for};
use glint::board::{self, built_firmware};
use glint::console::Console;
use glint::transfer::download;
use glint_board_api::built;
use glint_core::picture::Size;
use serde_json::json;
use std::net::TcpStream;
use tungstenite::{Message, WebSocket};

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

/// Drops a file on the page.
fn drop_file(socket: &mut WebSocket<TcpStream>, name: &str, bytes: &[u8]) {
    let head = json!({ "type": "upload", "name": name, "bytes": bytes.len() });
    socket.send(Message::text(head.to_string())).unwrap();
    for part in bytes.chunks(64 << 10) {
        socket.send(Message::binary(part.to_vec())).unwrap();
    }
}

/// A board in its BIOS takes the firmware from the page, then a mesh, then a program without a prompt in place of the firmware. That
/// program does not answer the host, so the wait for the BIOS is stopped.
#[test]
fn a_board_in_its_bios_is_loaded_from_the_page() {
    let port = Served::start_with("page-bios", &["--bios"]);
    let served = Served::start_with("page-loaded", &["--web", "--board", &port.url]);
    let mut socket = served.viewer();
    wait_for(&mut socket, "found the prompt of the BIOS");
    drop_file(&mut socket, "glint.bin", &built_firmware(None).unwrap());
    wait_for(&mut socket, r#""type":"progress""#);
    wait_for(&mut socket, "glint.bin runs, ");
    drop_file(
        &mut socket,
        "a.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    );
    wait_for(&mut socket, "the model is shown");
    let kernel = built::find("firmware/programs/kernel.bin", "cargo xtask programs").unwrap();
    let kernel = std::fs::read(kernel).unwrap();
    drop_file(&mut socket, "kernel.bin", &kernel);
    wait_for(&mut socket, "newton: ");
    drop_file(&mut socket, "kernel.bin", &kernel);
    wait_for(&mut socket, "waiting for the board's BIOS");
    let stop = r#"{"type":"interrupt"}"#;
    socket.send(Message::text(stop)).unwrap();
    wait_for(&mut socket, "kernel.bin: stopped");
}

#[test]
fn the_page_loads_the_program_of_its_option() {
    let port = Served::start_with("page-option-bios", &["--bios"]);
    let kernel = built::find("firmware/programs/kernel.elf", "cargo xtask programs").unwrap();
    let kernel = kernel.to_str().unwrap();
    let arguments = ["--web", "--board", &port.url, "--firmware", kernel];
    let served = Served::start_with("page-option", &arguments);
    let mut socket = served.viewer();
    wait_for(&mut socket, "newton: ");
}
