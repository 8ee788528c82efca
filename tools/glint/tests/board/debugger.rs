//! Tests the control of the emulated board by a debugger, with packets of GDB's remote serial protocol.

use glint::board::{DebuggedBoard, SimulatedBoard, Uart, debugged};
use litex_pac::memories::MAIN_RAM;
use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};

/// `addi t0, t0, 1; jal zero, -4`.
const LOOP: [u32; 2] = [0x0012_8293, 0xffdf_f06f];

/// Maximum number of calls of `run` until a reply. On a stopped board, each call waits for a millisecond.
const PATIENCE: u32 = 10_000;

struct Debugger {
    board: SimulatedBoard<DebuggedBoard>,
    stream: TcpStream,
}

impl Debugger {
    /// Connects a debugger to a board that runs the program [`LOOP`], which stops the board.
    fn new() -> Self {
        let any: SocketAddr = "127.0.0.1:0".parse().unwrap();
        let mut board = debugged(LOOP.map(u32::to_le_bytes).as_flattened(), any).unwrap();
        board.run(10_000);
        assert!(
            board.cycles() >= 10_000,
            "the board runs without a debugger"
        );
        let stream = connect(&mut board);
        Self { board, stream }
    }

    fn send(&mut self, packet: &str) {
        let sum = packet.bytes().fold(0_u8, u8::wrapping_add);
        write!(self.stream, "${packet}#{sum:02x}").unwrap();
    }

    /// Runs the board until it sends a packet, and returns the packet.
    fn reply(&mut self) -> String {
        let mut text = Vec::new();
        for _ in 0..PATIENCE {
            self.board.run(1000);
            let mut byte = [0];
            loop {
                match self.stream.read(&mut byte) {
                    Ok(1) => text.push(byte[0]),
                    Ok(_) => panic!("the board has closed the connection"),
                    Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                    Err(error) => panic!("{error}"),
                }
                if let [b'+' | b'$', body @ .., b'#', _, _] = &text[..] {
                    self.stream.write_all(b"+").unwrap();
                    let body = std::str::from_utf8(body).unwrap();
                    return expanded(body.trim_start_matches('$'));
                }
            }
        }
        panic!("no reply, but {:?}", String::from_utf8_lossy(&text));
    }

    fn ask(&mut self, packet: &str) -> String {
        self.send(packet);
        self.reply()
    }

    /// Register `number`; 32 is the program counter.
    fn register(&mut self, number: usize) -> u32 {
        let all = self.ask("g");
        let digits = &all[8 * number..8 * number + 8];
        u32::from_str_radix(digits, 16).unwrap().swap_bytes()
    }

    /// Calls `run` 200 times. Returns by how many cycles the board has advanced: 0 while a debugger has stopped it.
    fn run(&mut self) -> u64 {
        let before = self.board.cycles();
        for _ in 0..200 {
            self.board.run(1000);
        }
        self.board.cycles() - before
    }
}

/// Expands the run-length encoding of a packet: `*` and a character, whose code is 29 plus the number of repetitions of the character
/// before `*`.
fn expanded(packet: &str) -> String {
    let mut text = String::new();
    let mut rest = packet.chars();
    while let Some(letter) = rest.next() {
        let count = match letter {
            '*' => u32::from(rest.next().unwrap()) - 29,
            _ => 0,
        };
        match text.chars().last() {
            Some(last) if count > 0 => text.extend((0..count).map(|_| last)),
            _ => text.push(letter),
        }
    }
    text
}

fn connect(board: &mut SimulatedBoard<DebuggedBoard>) -> TcpStream {
    let stream = TcpStream::connect(board.inner().address().unwrap()).unwrap();
    stream.set_nonblocking(true).unwrap();
    stream
}

#[test]
fn breakpoints_steps_and_ctrl_c_stop_the_board() {
    let mut debugger = Debugger::new();
    assert!(debugger.ask("?").contains("05"), "stopped by a trap");
    assert_eq!(
        debugger.run(),
        0,
        "the time of a stopped board does not advance"
    );

    let second = MAIN_RAM.base + 4;
    assert_eq!(debugger.ask(&format!("Z0,{second:x},4")), "OK");
    assert!(debugger.ask("c").contains("swbreak"));
    assert_eq!(debugger.register(32), second);
    let counted = debugger.register(5);
    assert_eq!(&debugger.ask("s")[1..3], "05");
    assert_eq!(
        (debugger.register(32), debugger.register(5)),
        (MAIN_RAM.base, counted)
    );
    assert!(debugger.ask("c").contains("swbreak"));
    assert_eq!(debugger.register(5), counted + 1);
    assert_eq!(debugger.ask(&format!("z0,{second:x},4")), "OK");

    debugger.send("c");
    assert!(debugger.run() > 100_000);
    debugger.stream.write_all(&[3]).unwrap();
    assert_eq!(&debugger.reply()[1..3], "02", "SIGINT");
    assert!(debugger.register(5) > counted + 1000);
}

#[test]
fn memory_is_read_and_written() {
    let mut debugger = Debugger::new();
    let start = MAIN_RAM.base;
    assert_eq!(debugger.ask(&format!("m{start:x},4")), "93821200");
    // The increment becomes 2.
    assert_eq!(debugger.ask(&format!("M{:x},1:22", start + 2)), "OK");
    let counted = debugger.register(5);
    for _ in 0..2 {
        debugger.ask("s");
    }
    assert_eq!(debugger.register(5), counted + 2);
    // Registers of devices and addresses beyond the memories cannot be read.
    for address in ["f0000000", "0fffffff"] {
        assert!(debugger.ask(&format!("m{address},4")).starts_with('E'));
    }
}

#[test]
fn the_board_goes_on_when_its_debugger_leaves() {
    let mut debugger = Debugger::new();
    assert_eq!(debugger.ask("D"), "OK");
    assert!(debugger.run() > 100_000);

    // Another debugger can connect. Its breakpoints are removed when its connection ends.
    debugger.stream = connect(&mut debugger.board);
    assert!(debugger.ask("?").contains("05"));
    let second = MAIN_RAM.base + 4;
    assert_eq!(debugger.ask(&format!("Z0,{second:x},4")), "OK");
    debugger.stream.shutdown(Shutdown::Both).unwrap();
    assert!(debugger.run() > 100_000);

    // After bytes that violate the protocol, the board runs again.
    debugger.stream = connect(&mut debugger.board);
    let bytes = b"GET / HTTP/1.1\r\n\r\n$$##+-\xff}$g#00$Z9,zz#00\x03";
    debugger.stream.write_all(bytes).unwrap();
    debugger.run();
    // The board may have closed the connection.
    let _ = debugger.stream.shutdown(Shutdown::Both);
    assert!(debugger.run() > 100_000);
}
