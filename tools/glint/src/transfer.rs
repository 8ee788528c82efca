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
    let Manifest { length, crc32 } = Manifest::of(mesh);
    let command = format!("load {length} {crc32:08x}");
    if console.command_with_transfer(&command)? {
        let (board, pending) = console.line();
        let sent = send(board, pending, mesh, session, progress);
        // The firmware's own words tell more than the failure on this side.
        let reply = console.reply(&command);
        sent?;
        reply?;
    }
    Ok(())
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
