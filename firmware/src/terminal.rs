//! The console on the UART: lines of input, and text output.

use core::fmt;
use core::time::Duration;

use embedded_io::Write as _;
use glint_core::console::{Event, LINE_MAX, LineEditor, PROMPT};
use glint_core::tasks::Turn;
use glint_hal::timer::Clock;
use glint_program::serial::{ConsoleUart, ConsoleWriter};
use heapless::String;

use crate::names::MachineNames;

/// Longest time to wait for a serial line that accepts no text. After this time the text is dropped.
const SEND_TIMEOUT: Duration = Duration::from_millis(500);

/// Input from the user.
#[expect(
    clippy::large_enum_variant,
    reason = "one input exists at a time, and there is no heap"
)]
pub enum Input {
    /// A complete line of text.
    Line(String<LINE_MAX>),
    /// A line longer than [`LINE_MAX`], whose text is dropped.
    Overlong,
    /// The key Ctrl-C.
    Interrupt,
}

/// The console: the line editor between the UART and the commands.
pub struct Terminal {
    uart: &'static ConsoleUart,
    editor: LineEditor,
    output: Output,
    waiting: Option<Input>,
    /// The names that the line editor completes.
    pub names: MachineNames,
    /// Whether a transfer uses the serial line.
    is_lent: bool,
}

impl Terminal {
    /// A terminal on `uart`.
    pub fn new(uart: &'static ConsoleUart, clock: Clock) -> Self {
        let output = Output {
            writer: uart.writer(clock, SEND_TIMEOUT),
        };
        Self {
            uart,
            editor: LineEditor::new(),
            output,
            waiting: None,
            names: MachineNames::default(),
            is_lent: false,
        }
    }

    /// The UART of the console.
    pub const fn uart(&self) -> &'static ConsoleUart {
        self.uart
    }

    /// Lends the serial line to a transfer, or takes it back. While the line is lent, the console receives no input, and drops its text.
    pub const fn lend(&mut self, is_lent: bool) {
        self.is_lent = is_lent;
    }

    /// Receives and echoes input until a line is complete. Bytes after this line wait in the UART's queue.
    pub fn listen(&mut self) -> Turn {
        let mut byte = [0];
        let mut has_worked = false;
        while !self.is_lent && self.waiting.is_none() && self.uart.receive(&mut byte) > 0 {
            has_worked = true;
            self.waiting = match self.editor.on_byte(byte[0], &self.names, &mut self.output) {
                Event::None => None,
                // The editor limits lines to the string's capacity, so the conversion does not fail.
                Event::Line(line) => Some(Input::Line(String::try_from(line).unwrap_or_default())),
                Event::Overlong => Some(Input::Overlong),
                Event::Interrupt => Some(Input::Interrupt),
            };
        }
        Turn::worked(has_worked)
    }

    /// Takes the complete line or key, if any.
    pub fn input(&mut self) -> Option<Input> {
        self.waiting.take()
    }

    /// Prints the prompt, after which the user can type a line.
    pub fn prompt(&mut self) {
        self.print(format_args!("{PROMPT}"));
    }

    /// Prints a line of text above the prompt and the line being typed. After a complete line, whose reply follows, prints no prompt: the
    /// reply begins at the start of a line.
    pub fn notify(&mut self, text: fmt::Arguments) {
        if self.is_lent {
            return;
        }
        self.print(format_args!("\r\x1b[K{text}\n"));
        if self.waiting.is_none() {
            let _ = self.editor.redraw(&mut self.output);
        }
    }

    /// Prints text. The text is lost if the serial line accepts no text.
    pub fn print(&mut self, text: fmt::Arguments) {
        if self.is_lent {
            return;
        }
        let _ = fmt::Write::write_fmt(&mut self.output, text);
    }

    /// Prints a line with a key and its value.
    pub fn print_entry(&mut self, key: &str, value: &dyn fmt::Display) {
        self.print(format_args!("{key} {value}\n"));
    }

    /// Returns the output for functions that write text.
    pub const fn output(&mut self) -> &mut Output {
        &mut self.output
    }

    /// Waits until the UART has sent all text.
    pub fn flush(&mut self) {
        let _ = self.output.writer.flush();
    }
}

/// Text output: a carriage return precedes each line feed.
pub struct Output {
    writer: ConsoleWriter,
}

impl fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for line in text.as_bytes().split_inclusive(|byte| *byte == b'\n') {
            let sent = match line.strip_suffix(b"\n") {
                Some(line) => {
                    (self.writer.write_all(line)).and_then(|()| self.writer.write_all(b"\r\n"))
                }
                None => self.writer.write_all(line),
            };
            sent.map_err(|_| fmt::Error)?;
        }
        Ok(())
    }
}
