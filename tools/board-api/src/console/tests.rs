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

/// Runs a command on a board whose output does not end.
type Conversation = Box<dyn FnMut(&mut Console<'_, Endless>) -> Result<(), ConsoleError>>;

#[test]
fn a_board_that_never_stops_is_given_up() {
    for (text, limit) in [
        (&b"noise noise noise noise\r\n"[..], MAX_REPLY),
        (b"a line without an end ", MAX_LINE),
    ] {
        let mut board = Endless { text, sent: 0 };
        let mut conversations: [Conversation; 4] = [
            Box::new(|console| console.greet().map(drop)),
            Box::new(|console| console.synchronise()),
            Box::new(|console| console.command("info").map(drop)),
            Box::new(|console| console.reply("info").map(drop)),
        ];
        for converse in &mut conversations {
            board.sent = 0;
            let error = converse(&mut Console::new(&mut board)).unwrap_err();
            assert!(
                matches!(error, ConsoleError::Endless { limit: found, .. } if found == limit),
                "{error}"
            );
            assert!(error.to_string().len() < 500);
            assert!(board.sent < limit + 1000);
        }
    }
}

/// Each error may be the reply to a line of an earlier program, but such errors do not continue forever.
#[test]
fn a_board_that_never_stops_refusing_is_given_up() {
    let text = b"error: expected a command\r\n";
    let mut board = Endless { text, sent: 0 };
    let error = Console::new(&mut board).synchronise().unwrap_err();
    assert!(
        matches!(
            error,
            ConsoleError::Endless {
                limit: MAX_REPLY,
                ..
            }
        ),
        "{error}"
    );
    assert!(board.sent < MAX_REPLY + 1000);
}
