//! The line editor.

use core::fmt::{self, Write};

use heapless::{Deque, Vec};

use super::completion::complete;
use super::syntax::Names;

/// The prompt.
pub const PROMPT: &str = "glint> ";
/// Longest line in bytes.
pub const LINE_MAX: usize = 640;
/// Maximum number of lines in the history.
pub const HISTORY: usize = 8;

type Line = Vec<u8, LINE_MAX>;

/// Event that the caller must handle after a byte from the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// No event; at most the echo was written.
    None,
    /// A complete line: ASCII without control characters.
    Line(&'a str),
    /// The end of a line longer than [`LINE_MAX`]; the caller answers with an error.
    Overlong,
    /// Ctrl-C: the line was cancelled.
    Interrupt,
}

/// Turns the bytes of a terminal into lines, with echo, editing keys and a history.
///
/// | key | effect |
/// |---|---|
/// | Enter (CR, LF or both) | ends the line |
/// | Backspace, Delete | delete the character before or at the cursor |
/// | ←, →, Home, End, Ctrl-B, -F, -A, -E | move the cursor |
/// | ↑, ↓, Ctrl-P, Ctrl-N | bring back an earlier or later line |
/// | Ctrl-U, Ctrl-K, Ctrl-W | delete to the start, to the end, or the word before the cursor |
/// | Tab | completes a command, a word of its arguments or a name, or lists the candidates |
/// | Ctrl-L | redraws prompt and line |
/// | Ctrl-C | cancels the line |
///
/// A zero byte discards the line without an answer, because it ends the remains of a binary transfer. Other control
/// characters, unknown escape sequences and bytes beyond ASCII are ignored.
#[derive(Debug)]
pub struct LineEditor {
    line: Line,
    /// Cursor: the index in the line at which the next character is inserted, at most the line's length.
    cursor: usize,
    /// Whether the typed line is longer than its buffer.
    overlong: bool,
    /// Whether the line has ended and was returned to the caller; if so, the next byte first clears the line.
    ended: bool,
    /// Whether the last byte was a carriage return; if so, a following line feed belongs to the same line end.
    returned: bool,
    escape: Escape,
    /// The history, newest line last.
    history: Deque<Line, HISTORY>,
    /// Number of the shown line: 0 for the typed line, 1 for the newest line of the history, and higher numbers for older lines.
    shown: usize,
    /// The typed line, while a line of the history is shown.
    typed: Line,
}

/// State of the parser within an escape sequence.
#[derive(Clone, Copy, Debug)]
enum Escape {
    No,
    /// The Escape byte was received.
    Begun,
    /// Escape and `[` or `O` were received. The value is the decimal number in the sequence, from the digits received so far.
    Number(u8),
}

enum Input {
    Nothing,
    Character(u8),
    Key(Key),
}

/// An editing key.
enum Key {
    Left,
    Right,
    Home,
    End,
    Up,
    Down,
    Backspace,
    Delete,
    DeleteToStart,
    DeleteToEnd,
    DeleteWord,
    Complete,
    Redraw,
}

impl LineEditor {
    /// An editor with an empty line and an empty history.
    pub const fn new() -> Self {
        Self {
            line: Vec::new(),
            cursor: 0,
            overlong: false,
            ended: false,
            returned: false,
            escape: Escape::No,
            history: Deque::new(),
            shown: 0,
            typed: Vec::new(),
        }
    }

    /// Takes a byte and writes the echo for the terminal to `echo`, which must send a carriage return with every line feed. `names` are
    /// the machine's names, for completion. Errors of `echo` are ignored, because they only mean that no terminal is connected.
    pub fn on_byte(&mut self, byte: u8, names: &dyn Names, echo: &mut dyn Write) -> Event<'_> {
        if self.ended {
            self.clear();
        }
        let returned = core::mem::replace(&mut self.returned, byte == b'\r');
        match byte {
            0 => self.clear(),
            0x03 => {
                self.clear();
                let _ = echo.write_str("^C\n");
                return Event::Interrupt;
            }
            b'\n' if returned => {}
            b'\r' | b'\n' => return self.end(echo),
            _ => {
                // Errors of the echo are ignored, because they only mean that no terminal is connected.
                let _ = match self.decode(byte) {
                    Input::Nothing => Ok(()),
                    Input::Character(byte) => self.insert(byte, echo),
                    Input::Key(key) => self.press(key, names, echo),
                };
            }
        }
        Event::None
    }

    /// Ends the line and adds the line to the history.
    fn end(&mut self, echo: &mut dyn Write) -> Event<'_> {
        let _ = echo.write_str("\n");
        self.ended = true;
        if self.overlong {
            return Event::Overlong;
        }
        let blank = self.line.iter().all(|&byte| byte == b' ');
        if !blank && self.history.back() != Some(&self.line) {
            if self.history.is_full() {
                self.history.pop_front();
            }
            // This cannot fail: the oldest line was removed above if the history was full.
            let _ = self.history.push_back(self.line.clone());
        }
        Event::Line(text(&self.line))
    }

    fn clear(&mut self) {
        self.line.clear();
        self.cursor = 0;
        self.overlong = false;
        self.ended = false;
        self.escape = Escape::No;
        self.shown = 0;
    }

    /// Decodes the next byte to a character or an editing key; `Nothing` until the last byte of a key that
    /// is sent as several bytes.
    fn decode(&mut self, byte: u8) -> Input {
        let key = match (self.escape, byte) {
            (_, 0x1B) => {
                self.escape = Escape::Begun;
                return Input::Nothing;
            }
            (Escape::Begun, b'[' | b'O') => {
                self.escape = Escape::Number(0);
                return Input::Nothing;
            }
            (Escape::Number(number), b'0'..=b'9') => {
                self.escape = Escape::Number(number.saturating_mul(10).saturating_add(byte - b'0'));
                return Input::Nothing;
            }
            // Separators such as `;` are skipped: the parameters after them are the modifiers Shift, Alt and Ctrl.
            (Escape::Number(_), b' '..=b'?') => return Input::Nothing,
            (Escape::Number(number), last) => {
                self.escape = Escape::No;
                match (last, number) {
                    (b'A', _) => Key::Up,
                    (b'B', _) => Key::Down,
                    (b'C', _) => Key::Right,
                    (b'D', _) => Key::Left,
                    (b'H', _) | (b'~', 1 | 7) => Key::Home,
                    (b'F', _) | (b'~', 4 | 8) => Key::End,
                    (b'~', 3) => Key::Delete,
                    _ => return Input::Nothing,
                }
            }
            (Escape::Begun, _) => {
                self.escape = Escape::No;
                return Input::Nothing;
            }
            (Escape::No, b' '..=b'~') => return Input::Character(byte),
            (Escape::No, 0x01) => Key::Home,
            (Escape::No, 0x02) => Key::Left,
            (Escape::No, 0x05) => Key::End,
            (Escape::No, 0x06) => Key::Right,
            (Escape::No, 0x08 | 0x7F) => Key::Backspace,
            (Escape::No, b'\t') => Key::Complete,
            (Escape::No, 0x0B) => Key::DeleteToEnd,
            (Escape::No, 0x0C) => Key::Redraw,
            (Escape::No, 0x0E) => Key::Down,
            (Escape::No, 0x10) => Key::Up,
            (Escape::No, 0x15) => Key::DeleteToStart,
            (Escape::No, 0x17) => Key::DeleteWord,
            (Escape::No, _) => return Input::Nothing,
        };
        Input::Key(key)
    }

    fn insert(&mut self, byte: u8, echo: &mut dyn Write) -> fmt::Result {
        if self.overlong || self.line.is_full() {
            self.overlong = true;
            return Ok(());
        }
        let mut carried = byte;
        for place in self.line.iter_mut().skip(self.cursor) {
            core::mem::swap(place, &mut carried);
        }
        // This cannot fail: the check above ensures that the line is not full.
        let _ = self.line.push(carried);
        self.cursor += 1;
        echo.write_char(byte.into())?;
        self.write_tail(echo)
    }

    fn press(&mut self, key: Key, names: &dyn Names, echo: &mut dyn Write) -> fmt::Result {
        let length = self.line.len();
        match key {
            Key::Left => self.move_to(self.cursor.saturating_sub(1), echo),
            Key::Right => self.move_to((self.cursor + 1).min(length), echo),
            Key::Home => self.move_to(0, echo),
            Key::End => self.move_to(length, echo),
            Key::Up => self.show(self.shown + 1, echo),
            Key::Down => self
                .shown
                .checked_sub(1)
                .map_or(Ok(()), |shown| self.show(shown, echo)),
            Key::Backspace => self.delete(self.cursor.saturating_sub(1), self.cursor, echo),
            Key::Delete => self.delete(self.cursor, (self.cursor + 1).min(length), echo),
            Key::DeleteToStart => self.delete(0, self.cursor, echo),
            Key::DeleteToEnd => self.delete(self.cursor, length, echo),
            Key::DeleteWord => {
                let before = self.line.get(..self.cursor).unwrap_or_default();
                let word = before.trim_ascii_end();
                let start = word
                    .iter()
                    .rposition(|&byte| byte == b' ')
                    .map_or(0, |blank| blank + 1);
                self.delete(start, self.cursor, echo)
            }
            Key::Complete => self.complete(names, echo),
            Key::Redraw => self.redraw(echo),
        }
    }

    /// Returns the text of the line before the cursor.
    fn before(&self) -> &str {
        text(self.line.get(..self.cursor).unwrap_or_default())
    }

    /// Clears the terminal's line, and writes prompt and line again. If the line has ended, the new line is empty.
    ///
    /// # Errors
    /// The errors of `echo`.
    pub fn redraw(&self, echo: &mut dyn Write) -> fmt::Result {
        write!(echo, "\r\x1B[K{PROMPT}")?;
        if self.ended {
            return Ok(());
        }
        echo.write_str(self.before())?;
        self.write_tail(echo)
    }

    /// Completes the word at the cursor: inserts the text that all candidates have in common, or lists the candidates.
    fn complete(&mut self, names: &dyn Names, echo: &mut dyn Write) -> fmt::Result {
        let (mut count, mut common) = (0, Line::new());
        complete(self.before(), names, &mut |_, rest| {
            if count == 0 {
                // Candidates longer than a line are completed only in part.
                common.extend(rest.bytes().take(LINE_MAX));
            }
            let pairs = rest.bytes().zip(&common);
            let length = pairs.take_while(|(a, b)| a == *b).count();
            common.truncate(length);
            count += 1;
        });
        if self.line.capacity() - self.line.len() <= common.len() {
            return Ok(());
        }
        for byte in &common {
            self.insert(*byte, echo)?;
        }
        match count {
            // After a colon the user types numbers, so no blank follows.
            1 if self.before().ends_with(':') => Ok(()),
            1 => self.insert(b' ', echo),
            2.. if common.is_empty() => {
                let mut result = echo.write_str("\n");
                complete(self.before(), names, &mut |word, _| {
                    result = result.and_then(|()| write!(echo, "{word} "));
                });
                result?;
                echo.write_str("\n")?;
                self.redraw(echo)
            }
            _ => Ok(()),
        }
    }

    fn move_to(&mut self, cursor: usize, echo: &mut dyn Write) -> fmt::Result {
        let from = core::mem::replace(&mut self.cursor, cursor);
        match cursor {
            _ if cursor < from => write!(echo, "\x1B[{}D", from - cursor),
            _ if cursor > from => write!(echo, "\x1B[{}C", cursor - from),
            _ => Ok(()),
        }
    }

    /// Deletes the characters from index `start` up to, but not including, index `end`. One of the two indices is the cursor.
    fn delete(&mut self, start: usize, end: usize, echo: &mut dyn Write) -> fmt::Result {
        if start >= end {
            return Ok(());
        }
        let mut place = 0;
        self.line.retain(|_| {
            place += 1;
            !(start + 1..=end).contains(&place)
        });
        // The characters that did not fit into the line are lost; the rest after the deletion is a valid line.
        self.overlong = false;
        self.move_to(start, echo)?;
        echo.write_str("\x1B[K")?;
        self.write_tail(echo)
    }

    /// Shows the line with the number `shown`: 0 is the typed line, 1 the newest line of the history.
    fn show(&mut self, shown: usize, echo: &mut dyn Write) -> fmt::Result {
        if self.shown == 0 {
            self.typed.clone_from(&self.line);
        }
        let line = match shown.checked_sub(1) {
            Some(back) => self.history.iter().rev().nth(back),
            None => Some(&self.typed),
        };
        let Some(line) = line else { return Ok(()) };
        self.line.clone_from(line);
        self.shown = shown;
        self.overlong = false;
        self.move_to(0, echo)?;
        write!(echo, "\x1B[K{}", text(&self.line))?;
        self.cursor = self.line.len();
        Ok(())
    }

    /// Writes the text after the cursor to the terminal, and moves the terminal's cursor back to the editor's cursor.
    fn write_tail(&self, echo: &mut dyn Write) -> fmt::Result {
        match self.line.get(self.cursor..) {
            Some(tail) if !tail.is_empty() => write!(echo, "{}\x1B[{}D", text(tail), tail.len()),
            _ => Ok(()),
        }
    }
}

impl Default for LineEditor {
    fn default() -> Self {
        Self::new()
    }
}

/// Converts the bytes of a line to a string. This cannot fail, because all bytes of a line are ASCII.
fn text(bytes: &[u8]) -> &str {
    core::str::from_utf8(bytes).unwrap_or_default()
}
