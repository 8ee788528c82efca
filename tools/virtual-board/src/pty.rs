//! Runs the board with its UART on a pseudo-terminal, for programs that expect a serial port.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;

use glint_board_api::Uart;
use glint_board_api::pace::{Pace, SystemClock};
use rustix::fs::{Mode, OFlags};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use crate::{Error, VirtualBoard};

/// Number of cycles that the board runs between two reads of the terminal.
const SLICE: u64 = 2000;

/// Largest number of bytes in the queue for the UART; while the queue is full, the board does not read the terminal.
const QUEUE: usize = 4096;

/// Largest number of bytes of unread output. Beyond this size the older half is dropped, because there may be no reader.
const UNREAD: usize = 1 << 20;

/// A closure that the board's thread calls between two slices of `SLICE` cycles.
type Task<B> = Box<dyn FnOnce(&mut B) + Send>;

/// A board in its own thread, with its UART on a pseudo-terminal. It runs at most as fast as a real board.
///
/// The terminal is raw: every byte passes unchanged in both directions. Dropping the `Pty` stops the board.
pub struct Pty<B = VirtualBoard> {
    path: PathBuf,
    tasks: Option<Sender<Task<B>>>,
    thread: Option<JoinHandle<B>>,
    /// The slave side of the terminal, for programs; it is kept open so that programs can close and reopen it.
    _terminal: OwnedFd,
}

impl<B: Uart + Send + 'static> Pty<B> {
    /// Moves the board to a new thread, and starts it.
    ///
    /// # Errors
    /// When the system provides no pseudo-terminal.
    pub fn start(board: B) -> Result<Self, Error> {
        Self::watched(board, |_, _| ())
    }

    /// Moves the board to a new thread, and starts it. Calls `watch` with the bytes passed to the
    /// board and the bytes passed from the board.
    ///
    /// # Errors
    /// When the system provides no pseudo-terminal.
    pub fn watched(
        board: B,
        watch: impl FnMut(&[u8], &[u8]) + Send + 'static,
    ) -> Result<Self, Error> {
        let (side, terminal, path) = open().map_err(io::Error::from)?;
        let (tasks, queue) = channel();
        let thread = std::thread::Builder::new()
            .name("virtual board".to_owned())
            .spawn(move || run(board, side, &queue, watch))?;
        Ok(Self {
            path,
            tasks: Some(tasks),
            thread: Some(thread),
            _terminal: terminal,
        })
    }

    /// Path of the device that programs open, such as `/dev/pts/3`.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Runs a closure on the board between two cycles and returns its result.
    ///
    /// # Panics
    /// When the board's thread has panicked.
    pub fn with<R: Send + 'static>(&self, task: impl FnOnce(&mut B) -> R + Send + 'static) -> R {
        let (reply, answer) = channel();
        let task: Task<B> = Box::new(move |board| {
            // Sending cannot fail, because the caller waits for the result.
            let _ = reply.send(task(board));
        });
        let sent = self
            .tasks
            .as_ref()
            .is_some_and(|tasks| tasks.send(task).is_ok());
        assert!(sent, "the virtual board's thread has ended");
        answer.recv().expect("the virtual board's thread has ended")
    }

    /// Stops the board and returns it.
    ///
    /// # Panics
    /// When the board's thread has panicked.
    #[must_use]
    pub fn stop(mut self) -> B {
        self.tasks = None;
        let thread = self.thread.take().expect("the thread runs until `stop`");
        thread
            .join()
            .expect("the virtual board's thread has panicked")
    }
}

impl<B> Drop for Pty<B> {
    fn drop(&mut self) {
        self.tasks = None;
        if let Some(thread) = self.thread.take() {
            // The thread's panic message has already been printed.
            let _ = thread.join();
        }
    }
}

/// Opens a raw pseudo-terminal. Returns the board's side, which does not block, the side for programs, and the path of the
/// device that programs open.
fn open() -> rustix::io::Result<(File, OwnedFd, PathBuf)> {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let side = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
    grantpt(&side)?;
    unlockpt(&side)?;
    let path = ptsname(&side, Vec::new())?;
    let terminal = rustix::fs::open(
        &*path,
        OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC,
        Mode::empty(),
    )?;
    let mut settings = tcgetattr(&terminal)?;
    settings.make_raw();
    tcsetattr(&terminal, OptionalActions::Now, &settings)?;
    rustix::io::ioctl_fionbio(&side, true)?;
    let path = PathBuf::from(path.to_string_lossy().into_owned());
    Ok((File::from(side), terminal, path))
}

/// Body of the board's thread. Repeatedly passes bytes from the terminal to the UART, runs the board for a slice, and passes bytes from
/// the UART to the terminal.
fn run<B: Uart>(
    mut board: B,
    mut terminal: File,
    tasks: &Receiver<Task<B>>,
    mut watch: impl FnMut(&[u8], &[u8]),
) -> B {
    let mut output = Vec::new();
    let mut pace = Pace::new(SystemClock::start(), board.clock_hz(), board.cycles());
    loop {
        loop {
            match tasks.try_recv() {
                Ok(task) => task(&mut board),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return board,
            }
        }
        if board.uart_queued() < QUEUE {
            let mut input = [0; QUEUE];
            match terminal.read(&mut input) {
                Ok(count) => {
                    board.uart_write(&input[..count]);
                    watch(&input[..count], &[]);
                }
                Err(error) if is_temporary(&error) => {}
                Err(error) => panic!("reading the virtual board's terminal: {error}"),
            }
        }
        pace.wait(board.cycles());
        board.run(SLICE);
        watch(&[], board.uart_output());
        board.uart_read(&mut output);
        match terminal.write(&output) {
            Ok(count) => drop(output.drain(..count)),
            Err(error) if is_temporary(&error) => {}
            Err(error) => panic!("writing the virtual board's terminal: {error}"),
        }
        if output.len() > UNREAD {
            output.drain(..output.len() - UNREAD / 2);
        }
    }
}

/// Whether the error only means that no data can be transferred at present, so that the thread continues.
fn is_temporary(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A board whose program prints consecutive numbers.
    #[derive(Default)]
    struct Talker {
        cycles: u64,
        number: u32,
        end: u32,
        output: Vec<u8>,
    }

    impl Uart for Talker {
        fn run(&mut self, cycles: u64) {
            self.cycles += cycles;
            let last = self.end.min(self.number + 10_000);
            for number in self.number..last {
                self.output.extend(format!("{number:7}\n").bytes());
            }
            self.number = last;
        }

        fn cycles(&self) -> u64 {
            self.cycles
        }

        fn clock_hz(&self) -> u32 {
            1_000_000_000
        }

        fn uart_write(&mut self, _bytes: &[u8]) {}

        fn uart_queued(&self) -> usize {
            0
        }

        fn uart_output(&mut self) -> &mut Vec<u8> {
            &mut self.output
        }
    }

    #[test]
    fn old_output_without_a_reader_is_dropped() {
        let pty = Pty::start(Talker::default()).unwrap();
        let end = 1_000_000;
        pty.with(move |talker| talker.end = end);
        while pty.with(|talker| talker.number) < end {}
        let mut terminal = File::open(pty.path()).unwrap();
        let (mut text, mut buffer) = (Vec::new(), [0; 4096]);
        let last = format!("{:7}\n", end - 1);
        while !text.ends_with(last.as_bytes()) {
            let count = terminal.read(&mut buffer).unwrap();
            text.extend_from_slice(&buffer[..count]);
        }
        let found = text.len();
        assert!((UNREAD / 2..2 * UNREAD).contains(&found), "{found} bytes");
    }
}
