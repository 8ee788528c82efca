//! The line editor.

/// The longest line in bytes.
pub const LINE_MAX: usize = 320;

/// What a byte led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// Nothing to do; the echo has been written.
    None,
    /// A line was ended.
    Line(&'a str),
    /// A line was ended that was longer than [`LINE_MAX`]: answer with an error.
    Overlong,
    /// Ctrl-C.
    Interrupt,
}

/// Turns bytes into lines, with echo, editing keys and a history.
#[derive(Debug, Default)]
pub struct LineEditor {}

impl LineEditor {
    /// An empty line and no history.
    pub const fn new() -> Self {
        Self {}
    }

    /// Takes a byte; what the terminal shall show is written to `echo`.
    pub fn on_byte(&mut self, _byte: u8, _echo: &mut dyn core::fmt::Write) -> Event<'_> {
        Event::None
    }
}
