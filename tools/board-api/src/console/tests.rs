//! Tests of the console with boards that send prepared output.

use super::*;
use std::collections::VecDeque;

/// A simulated board that answers each received line with the next of its prepared replies.
struct Script {
    replies: VecDeque<&'static str>,
    output: Vec<u8>,
    now_ms: u64,
}

impl Board for Script {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        assert!(bytes.ends_with(b"\r"));
        self.output
            .extend(self.replies.pop_front().unwrap_or_default().bytes());
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        // Each read returns one byte, so that every line arrives in parts.
        if self.output.is_empty() {
            self.now_ms += wait_ms;
        } else {
            bytes.push(self.output.remove(0));
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.now_ms
    }
}

fn script(start: &str, replies: &[&'static str]) -> Script {
    Script {
        replies: replies.iter().copied().collect(),
        output: start.into(),
        now_ms: 0,
    }
}

#[test]
fn replies() {
    let mut board = script(
        "banner\r\nglint> ",
        &[
            "info\r\nversion 1\r\ntriangles 12\r\nok\r\nglint> ",
            "noise\r\nglint> \x1b[2Kleds x\r\nerror: leds `x`: expected a number\r\nglint> ",
            "load 1 2\r\nready\r\n",
            "load 1 2\r\nok\r\nglint> ",
            "hello",
        ],
    );
    let mut console = Console::new(&mut board);
    assert_eq!(console.greet().unwrap(), "banner\n");
    let lines = console.command("info").unwrap();
    assert_eq!(lines, ["version 1", "triangles 12"]);
    assert_eq!(value::<u32>("info", &lines, "triangles").unwrap(), 12);
    assert!(value::<u32>("info", &lines, "tri").is_err());
    let refused = console.command("leds x").unwrap_err().to_string();
    assert_eq!(
        refused,
        "the board refused `leds x`: leds `x`: expected a number"
    );
    assert_eq!(console.take_earlier(), "glint> noise\r\nglint> ");
    assert_eq!(console.take_earlier(), "");
    let mut start = || console.command_with_transfer("load 1 2", &mut |_| {});
    assert!(start().is_ok());
    assert_eq!(
        start().unwrap_err().to_string(),
        "the reply to `load 1 2`: expected `ready`, found \"`ok`\""
    );
    let silence = console.command("hello").unwrap_err();
    assert!(
        matches!(silence, ConsoleError::Silence { ref last, .. } if last == "glint> hello"),
        "{silence}"
    );
}

/// A board that repeats a text without end.
struct Endless {
    text: &'static [u8],
    sent: usize,
}

impl Board for Endless {
    fn write(&mut self, _: &[u8]) -> Result<(), BoardError> {
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, _: u64) -> Result<(), BoardError> {
        bytes.extend(self.text);
        self.sent += self.text.len();
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        0
    }
}

/// A conversation with a board.
type Conversation<B> = fn(&mut Console<'_, B>) -> Result<(), ConsoleError>;

/// Conversations that must end although the output of the board does not.
fn conversations<B: Board>() -> [Conversation<B>; 4] {
    [
        |console| console.greet().map(drop),
        |console| console.synchronise(),
        |console| console.command("info").map(drop),
        |console| console.reply("info").map(drop),
    ]
}

fn is_endless(error: &ConsoleError, maximum: usize) -> bool {
    matches!(error, ConsoleError::Endless { limit, .. } if *limit == maximum)
}

#[test]
fn a_board_that_never_stops_is_given_up() {
    for (text, limit) in [
        (&b"noise noise noise noise\r\n"[..], MAX_REPLY),
        (b"a line without an end ", MAX_LINE),
    ] {
        let mut board = Endless { text, sent: 0 };
        for converse in conversations() {
            board.sent = 0;
            let error = converse(&mut Console::new(&mut board)).unwrap_err();
            assert!(is_endless(&error, limit), "{error}");
            assert!(error.to_string().len() < 500);
            assert!(board.sent < limit + 1000);
        }
    }
}

/// An error may be the reply to a line of an earlier program, but a board that only sends errors
/// must not block the host.
#[test]
fn synchronising_with_a_board_that_always_refuses_ends() {
    let text = b"error: expected a command\r\n";
    let mut board = Endless { text, sent: 0 };
    let error = Console::new(&mut board).synchronise().unwrap_err();
    assert!(is_endless(&error, MAX_REPLY), "{error}");
    assert!(board.sent < MAX_REPLY + 1000);
}

/// A board that repeats a text without end, one byte per second.
struct Dripping {
    text: std::iter::Cycle<std::slice::Iter<'static, u8>>,
    now_ms: u64,
}

impl Board for Dripping {
    fn write(&mut self, _: &[u8]) -> Result<(), BoardError> {
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        if wait_ms >= 1000 {
            bytes.extend(self.text.next());
        }
        self.now_ms += wait_ms.min(1000);
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.now_ms
    }
}

/// Received bytes and lines do not extend the wait without limit.
#[test]
fn slow_endless_output_times_out() {
    for text in [&b"drip "[..], b"drip\r\n", b"error: drip\r\n"] {
        for (number, converse) in conversations().into_iter().enumerate() {
            let mut board = Dripping {
                text: text.iter().cycle(),
                now_ms: 0,
            };
            let result = converse(&mut Console::new(&mut board));
            let is_refused = matches!(result, Err(ConsoleError::Refused { .. }));
            let is_silent = matches!(result, Err(ConsoleError::Silence { .. }));
            assert!(is_silent || is_refused, "{number}: {result:?}");
            let limit = (1 + REPLY_PATIENCE) * PATIENCE_MS;
            assert!(board.now_ms <= limit, "{number}: {} ms", board.now_ms);
        }
    }
}

/// A board that echoes a command at once, and sends the reply after a delay.
struct Slow {
    output: Vec<u8>,
    reply: Option<(u64, &'static [u8])>,
    now_ms: u64,
}

impl Board for Slow {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.output.extend(bytes.iter().filter(|&&byte| byte != 0));
        self.output.push(b'\n');
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        if !self.output.is_empty() {
            bytes.append(&mut self.output);
            return Ok(());
        }
        self.now_ms += wait_ms.min(500);
        if let Some((_, reply)) = self.reply.take_if(|(time, _)| *time <= self.now_ms) {
            bytes.extend(reply);
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.now_ms
    }
}

/// An orbit of 3600 frames takes a minute at 60 frames per second.
#[test]
fn commands_that_draw_several_frames_have_longer_time_outs() {
    let reply = |command: &str, ms: u64| {
        let mut board = Slow {
            output: Vec::new(),
            reply: Some((ms, b"ok\r\n")),
            now_ms: 0,
        };
        Console::new(&mut board).command(command).map(drop)
    };
    assert!(reply("orbit 3600", 60_000).is_ok());
    assert!(reply("orbit", 60_000).is_ok());
    assert!(reply("scene cubes", 60_000).is_ok());
    assert!(reply("bench triangle 100", 60_000).is_ok());
    assert!(reply("render", 60_000).is_err());
    assert!(reply("orbit 1", 60_000).is_err());
}

#[test]
fn control_characters_of_a_reply_are_removed() {
    let hostile = "info\r\nname \x1b[31m\x0e\x0f\x05\x7f\u{9b}2J\u{90}\tx\x08\x07\r\nok\r\n";
    let mut board = script("", &[hostile]);
    let lines = Console::new(&mut board).command("info").unwrap();
    assert_eq!(lines, ["name 2J\tx"]);
    let refused = "info\r\nerror: \u{9b}2J\x0e\r\n";
    let mut board = script("", &[refused]);
    let error = Console::new(&mut board).command("info").unwrap_err();
    assert_eq!(error.to_string(), "the board refused `info`: 2J");
}

/// A board that shows the prompt of its BIOS, alone or after the end of a serial boot.
struct AtBios {
    is_booting: bool,
    output: Vec<u8>,
    now_ms: u64,
}

impl Board for AtBios {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        if self.is_booting {
            self.is_booting = bytes != END_BOOT;
            self.output
                .extend(if self.is_booting { b"E" } else { b"K" });
        } else if bytes.ends_with(b"\r") {
            self.output.extend(b"Command not found\r\n\x1b[92;1m");
            self.output.extend(BIOS_PROMPT);
        }
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        if self.output.is_empty() {
            self.now_ms += wait_ms;
        }
        bytes.append(&mut self.output);
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.now_ms
    }
}

#[test]
fn a_board_in_its_bios_is_recognised_at_once() {
    for is_booting in [false, true] {
        let mut board = AtBios {
            is_booting,
            output: Vec::new(),
            now_ms: 0,
        };
        let error = Console::new(&mut board).synchronise().unwrap_err();
        assert!(matches!(error, ConsoleError::Bios), "{error}");
        assert_eq!(board.now_ms, FIRST_PATIENCE_MS);
    }
}
