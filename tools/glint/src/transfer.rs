//! Uploads and downloads: `glint-core`'s transfer between a slice and a board's line.

use crate::board::{Board, BoardError};
use crate::console::{Console, ConsoleError};
use glint_core::wire::{Failure, MAX_FRAME, Manifest, Party, Receiver, Sender, State, Timing};

/// Why a transfer did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum TransferError {
    /// The console said no, or nothing.
    #[error(transparent)]
    Console(#[from] ConsoleError),
    /// The board cannot be talked to.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The transfer itself failed.
    #[error("{0}")]
    Failed(Failure),
    /// The way past the line was asked for where there is none.
    #[error("this board has no way into its memory but its serial line")]
    NoMemory,
}

/// How data gets into a board, and out of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Route {
    /// Over the serial line.
    Serial,
    /// Past it, into the simulated memory: the virtual board only.
    Memory,
}

/// Bytes that have arrived, and bytes in all.
pub type Progress<'p> = dyn FnMut(u64, u64) + 'p;

/// How long a look for an answer takes, in the board's time.
const LOOK_MS: u64 = 2;

/// Uploads a mesh and makes it the one that is shown.
///
/// # Errors
/// The transfer fails or the firmware refuses the mesh; the board goes on showing what it showed before.
pub fn upload<B: Board + ?Sized>(
    console: &mut Console<B>,
    mesh: &[u8],
    session: u8,
    progress: &mut Progress,
) -> Result<(), TransferError> {
    upload_for(console, "load", mesh, session, progress, &mut |_| {})
}

/// Uploads what a command takes, and gives the other lines of its reply to `on_line` as they come.
///
/// # Errors
/// The transfer fails, or the firmware refuses.
pub fn upload_for<B: Board + ?Sized>(
    console: &mut Console<B>,
    name: &str,
    data: &[u8],
    session: u8,
    progress: &mut Progress,
    on_line: &mut dyn FnMut(&str),
) -> Result<(), TransferError> {
    let Manifest { length, crc32 } = Manifest::of(data);
    let command = format!("{name} {length} {crc32:08x}");
    console.send(&command)?;
    if console.lines(&command, on_line)? {
        let (board, pending) = console.line();
        let sent = send(board, pending, data, session, progress);
        // The firmware's own words tell more than the failure on this side.
        let reply = console.lines(&command, on_line);
        sent?;
        reply?;
    }
    Ok(())
}

/// Writes data past the line to where the next upload goes: the board finds its CRC-32 right then, and skips the transfer.
///
/// # Errors
/// There is no such way, or no such room.
pub fn stage<B: Board + ?Sized>(
    console: &mut Console<B>,
    data: &[u8],
) -> Result<(), TransferError> {
    let address = address(console, "staging")?;
    let memory = console.board().memory().ok_or(TransferError::NoMemory)?;
    Ok(memory.write_memory(address, data)?)
}

/// Reads past the line what lies `offset` bytes behind an address that `info` tells.
///
/// # Errors
/// There is no such way, or no such key.
pub fn read_memory<B: Board + ?Sized>(
    console: &mut Console<B>,
    key: &str,
    offset: u32,
    length: usize,
) -> Result<Vec<u8>, TransferError> {
    let address = address(console, key)?.wrapping_add(offset);
    let memory = console.board().memory().ok_or(TransferError::NoMemory)?;
    let mut bytes = vec![0; length];
    memory.read_memory(address, &mut bytes)?;
    Ok(bytes)
}

/// An address that `info` tells.
fn address<B: Board + ?Sized>(console: &mut Console<B>, key: &str) -> Result<u32, ConsoleError> {
    let word = console.info(key)?;
    word.strip_prefix("0x")
        .and_then(|digits| u32::from_str_radix(digits, 16).ok())
        .ok_or_else(|| ConsoleError::Reply {
            command: format!("info {key}"),
            expected: "an address 0x…".to_owned(),
            found: word.clone(),
        })
}

/// Downloads what a command such as `frame` sends, `length` bytes.
///
/// # Errors
/// The command is refused, the transfer fails, or another length comes.
pub fn download<B: Board + ?Sized>(
    console: &mut Console<B>,
    command: &str,
    length: usize,
    progress: &mut Progress,
) -> Result<Vec<u8>, TransferError> {
    let mut data = vec![0; length];
    console.command_with_transfer(command)?;
    let (board, pending) = console.line();
    let received = receive(board, pending, &mut data, progress);
    let reply = console.reply(command);
    let received = received?;
    reply?;
    if received != length {
        return Err(TransferError::Console(ConsoleError::Reply {
            command: command.to_owned(),
            expected: format!("{length} bytes"),
            found: format!("{received}"),
        }));
    }
    Ok(data)
}

/// Sends data to a board that has said it is ready. What comes after the end is left in `pending`.
///
/// # Errors
/// The transfer fails.
pub fn send<B: Board + ?Sized>(
    board: &mut B,
    pending: &mut Vec<u8>,
    data: &[u8],
    session: u8,
    progress: &mut Progress,
) -> Result<(), TransferError> {
    let mut sender = Sender::new(data, session, Timing::HOST, board.now_ms());
    run(board, pending, &mut sender, progress)
}

/// Receives data from a board that has said it is ready, and returns its length. What comes after the end is left in
/// `pending`.
///
/// # Errors
/// The transfer fails.
pub fn receive<B: Board + ?Sized>(
    board: &mut B,
    pending: &mut Vec<u8>,
    buffer: &mut [u8],
    progress: &mut Progress,
) -> Result<usize, TransferError> {
    let mut receiver = Receiver::new(buffer, None, Timing::HOST, board.now_ms());
    run(board, pending, &mut receiver, progress)?;
    Ok(receiver.received().map_or(0, <[u8]>::len))
}

fn run<B: Board + ?Sized>(
    board: &mut B,
    pending: &mut Vec<u8>,
    party: &mut impl Party,
    progress: &mut Progress,
) -> Result<(), TransferError> {
    let mut frame = [0; MAX_FRAME];
    loop {
        let now = board.now_ms();
        let taken = party.on_bytes(now, pending);
        pending.drain(..taken);
        loop {
            let length = party.poll(now, &mut frame);
            if length == 0 {
                break;
            }
            board.write(&frame[..length])?;
        }
        let (done, all) = party.progress();
        progress(done.into(), all.into());
        match party.state() {
            State::Running => board.read(pending, LOOK_MS)?,
            State::Done => return Ok(()),
            State::Failed(failure) => return Err(TransferError::Failed(failure)),
        }
    }
}
