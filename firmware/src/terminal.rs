//! The console's line: what is typed becomes lines, what is said goes out.

use core::fmt;
use core::time::Duration;

use embedded_io::Write as _;
use glint_core::console::{Event, LINE_MAX, LineEditor, PROMPT};
use glint_hal::timer::Clock;
use glint_hal::uart::{Uart, Writer};
use heapless::String;

/// Bytes that may wait to be read: more than a second of typing at 115,200 baud, and several windows of an upload.
const RECEIVE_QUEUE: usize = 16 << 10;
/// Bytes that may wait to be sent.
const SEND_QUEUE: usize = 4 << 10;

/// The UART of the SoC.
pub type ConsoleUart = Uart<RECEIVE_QUEUE, SEND_QUEUE>;

/// How long text waits for a line that takes nothing before it is dropped.
const PATIENCE: Duration = Duration::from_millis(500);

/// What somebody has typed.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the line on, and there is one of these"
)]
pub enum Input {
    /// A whole line.
    Line(String<LINE_MAX>),
    /// A line longer than [`LINE_MAX`].
    Overlong,
    /// Ctrl-C.
    Interrupt,
}

/// The line editor between the UART and the commands.
pub struct Terminal {
    uart: &'static ConsoleUart,
    editor: LineEditor,
    output: Output,
    waiting: Option<Input>,
}

impl Terminal {
    /// A terminal on `uart`.
    pub fn new(uart: &'static ConsoleUart, clock: Clock) -> Self {
        let output = Output {
            writer: uart.writer(clock, PATIENCE),
        };
        Self {
            uart,
            editor: LineEditor::new(),
            output,
            waiting: None,
        }
    }

    /// Takes what was typed until a line is complete, and echoes it. Further lines wait their turn in the UART's queue.
    pub fn listen(&mut self) {
        let mut byte = [0];
        while self.waiting.is_none() && self.uart.receive(&mut byte) > 0 {
            self.waiting = match self.editor.on_byte(byte[0], &mut self.output) {
                Event::None => None,
                // The editor keeps to the length, so that nothing is cut.
                Event::Line(line) => Some(Input::Line(String::try_from(line).unwrap_or_default())),
                Event::Overlong => Some(Input::Overlong),
                Event::Interrupt => Some(Input::Interrupt),
            };
        }
    }

    /// The input that is complete, if any.
    pub fn input(&mut self) -> Option<Input> {
        self.waiting.take()
    }

    /// Whether [`input`](Self::input) has something.
    pub const fn has_input(&self) -> bool {
        self.waiting.is_some()
    }

    /// Says that a command is welcome.
    pub fn prompt(&mut self) {
        self.print(format_args!("{PROMPT}"));
    }

    /// Prints text. A line that takes nothing loses it: nobody is there to read.
    pub fn print(&mut self, text: fmt::Arguments) {
        let _ = fmt::Write::write_fmt(&mut self.output, text);
    }

    /// Where text goes.
    pub const fn output(&mut self) -> &mut Output {
        &mut self.output
    }

    /// Waits until all text is on its way.
    pub fn flush(&mut self) {
        let _ = self.output.writer.flush();
    }
}

/// Text for a terminal: a line feed also returns the carriage.
pub struct Output {
    writer: Writer<'static, RECEIVE_QUEUE, SEND_QUEUE>,
}

impl fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut send = |text: &str| {
            self.writer
                .write_all(text.as_bytes())
                .map_err(|_| fmt::Error)
        };
        let mut lines = text.split('\n');
        send(lines.next().unwrap_or_default())?;
        for line in lines {
            send("\r\n")?;
            send(line)?;
        }
        Ok(())
    }
}
