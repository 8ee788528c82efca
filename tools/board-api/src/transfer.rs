//! Uploads and downloads over a board's line, with the transfer protocol of `glint-core`.

use crate::console::{self, Console, ConsoleError};
use crate::line::{Board, BoardError};
use glint_core::matrix::Axis;
use glint_core::mesh::{self, MeshHeader};
use glint_core::wire::{
    Endpoint, Failure, MAX_FRAME, Manifest, Receiver, Role, Sender, State, Timing,
};

/// An error of a transfer.
#[derive(Debug, thiserror::Error)]
pub enum TransferError {
    /// An error of the console.
    #[error(transparent)]
    Console(#[from] ConsoleError),
    /// An error of the board.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// An error of the transfer protocol.
    #[error("{0}")]
    Failed(Failure),
    /// The transfer failed after this program had been stopped, for example while a laptop was
    /// suspended.
    #[error("{0}, after this program had been stopped")]
    Stopped(Failure),
    /// The mesh has more triangles than the board can draw.
    #[error("mesh of {found} triangles: expected at most {most}, which this board can draw")]
    Triangles {
        /// Number of triangles of the mesh.
        found: u32,
        /// Maximum number of triangles, as reported by the board.
        most: u32,
    },
    /// A transfer through memory was requested, but the board offers no direct access to its
    /// memory.
    #[error(
        "memory transfer: expected the emulated or the virtual board, found a board with a serial line only"
    )]
    NoMemory,
}

/// A callback that receives the number of bytes transferred so far and the total number of bytes.
pub type Progress<'p> = dyn FnMut(u64, u64) + 'p;

/// Longest wait for bytes from the board in one read, in milliseconds of the board's time.
const POLL_MS: u64 = 2;

/// Longest time between two polls of the line that counts for the time-outs of a transfer, in milliseconds of the board's time.
/// A longer time means that this program was stopped, and could not read the board's bytes.
const MAX_STEP_MS: u64 = 500;
/// Name of an upload without a name.
pub const MODEL: &str = "model";
/// Maximum number of attempts at a transfer. A transfer is repeated only if it failed after this program had been stopped.
const ATTEMPTS: u32 = 5;

/// Number of triangles that every board can draw.
const ANY_BOARD: u32 = 1 << 15;

/// Uploads a mesh or a texture under a name, by default `model`, and draws it. A mesh with more triangles than the board can draw is
/// refused before the transfer, which may take minutes. Returns the notes of the board.
///
/// # Errors
/// The mesh has too many triangles, the transfer fails or the firmware refuses the upload; the board then still shows its last frame.
pub fn upload<B: Board + ?Sized>(
    console: &mut Console<B>,
    bytes: &[u8],
    name: Option<&str>,
    session: u8,
    progress: &mut Progress,
) -> Result<Vec<String>, TransferError> {
    let header = bytes
        .first_chunk()
        .filter(|_| bytes.starts_with(&mesh::MAGIC));
    let found = header.map_or(0, |header| MeshHeader::from_bytes(header).triangles);
    if found > ANY_BOARD {
        let most = console.info("mesh_triangles")?;
        if let Ok(most) = most.parse()
            && found > most
        {
            return Err(TransferError::Triangles { found, most });
        }
    }
    upload_by(console, "load", bytes, name, session, progress)
}

/// Uploads a wireframe program in binary form under a name, by default `program`, and draws it. Returns the notes of the board.
///
/// # Errors
/// The transfer fails or the firmware refuses the program; the board then still shows its last frame.
pub fn upload_program<B: Board + ?Sized>(
    console: &mut Console<B>,
    bytes: &[u8],
    name: Option<&str>,
    session: u8,
    progress: &mut Progress,
) -> Result<Vec<String>, TransferError> {
    upload_by(console, "program", bytes, name, session, progress)
}

/// Uploads data by the console command `command` under a name. Returns the notes of the board.
fn upload_by<B: Board + ?Sized>(
    console: &mut Console<B>,
    command: &str,
    bytes: &[u8],
    name: Option<&str>,
    session: u8,
    progress: &mut Progress,
) -> Result<Vec<String>, TransferError> {
    let mut command = command_for(command, bytes);
    if let Some(name) = name {
        command = format!("{command} {name}");
    }
    let mut notes = Vec::new();
    let mut on_line = |line: &str| notes.extend(line.strip_prefix("note: ").map(str::to_owned));
    announce(console, &command, bytes, session, progress, &mut on_line)?;
    Ok(notes)
}

/// Shows the whole mesh `name` with the axis `up` pointing up on the screen. The rest of the scene
/// is the default scene, so no earlier setting hides the mesh. Firmware without the command `fit`
/// keeps the camera of the default scene.
///
/// # Errors
/// The firmware refuses the mesh, or does not answer.
pub fn show<B: Board + ?Sized>(
    console: &mut Console<B>,
    name: &str,
    up: Axis,
) -> Result<(), ConsoleError> {
    console.command("scene default")?;
    console.command(&format!("scene {name}"))?;
    match console.command(&format!("fit {up}")) {
        Ok(_) | Err(ConsoleError::Refused { .. }) => Ok(()),
        Err(error) => Err(error),
    }
}

/// Sends the console command `name` with the length and CRC-32 of `data`, and uploads the data if the board requests them. Calls
/// `on_line` with each line of the reply except `present`, `ready` and `ok`.
///
/// # Errors
/// The transfer fails, or the firmware refuses the command.
pub fn upload_for<B: Board + ?Sized>(
    console: &mut Console<B>,
    name: &str,
    data: &[u8],
    session: u8,
    progress: &mut Progress,
    on_line: &mut dyn FnMut(&str),
) -> Result<(), TransferError> {
    let command = command_for(name, data);
    announce(console, &command, data, session, progress, on_line)
}

/// Returns the console command `name` with the length and CRC-32 of `data`.
fn command_for(name: &str, data: &[u8]) -> String {
    let Manifest { length, crc32 } = Manifest::of(data);
    format!("{name} {length} {crc32:08x}")
}

/// Sends a console command that announces `data`, and uploads the data if the board requests them.
fn announce<B: Board + ?Sized>(
    console: &mut Console<B>,
    command: &str,
    data: &[u8],
    session: u8,
    progress: &mut Progress,
    on_line: &mut dyn FnMut(&str),
) -> Result<(), TransferError> {
    persistently(console, &mut |console| {
        announce_once(console, command, data, session, progress, on_line)
    })
}

/// Repeats a transfer that has failed because this program was stopped.
fn persistently<'b, B: Board + ?Sized, T>(
    console: &mut Console<'b, B>,
    transfer: &mut dyn FnMut(&mut Console<'b, B>) -> Result<T, TransferError>,
) -> Result<T, TransferError> {
    for _ in 1..ATTEMPTS {
        match transfer(console) {
            Err(TransferError::Stopped(_)) => console.synchronise()?,
            result => return result,
        }
    }
    transfer(console)
}

/// Makes one attempt of [`announce`].
fn announce_once<B: Board + ?Sized>(
    console: &mut Console<B>,
    command: &str,
    data: &[u8],
    session: u8,
    progress: &mut Progress,
    on_line: &mut dyn FnMut(&str),
) -> Result<(), TransferError> {
    console.send(command)?;
    let mut is_present = false;
    let is_ready = console.lines(command, &mut |line| match line {
        "present" => is_present = true,
        line => on_line(line),
    })?;
    if is_ready {
        let (board, pending) = console.line();
        let sent = send(board, pending, data, session, progress);
        if let Err(TransferError::Stopped(_)) = sent {
            // The reply may be lost.
            return sent;
        }
        // The rest of the reply is read even after a failed transfer: otherwise it would be read as the reply to the next
        // command.
        let reply = console.lines(command, on_line);
        sent?;
        reply?;
    } else if !is_present {
        let expected = "`ready`, or `present` for data that the board has";
        return Err(console::unexpected(command, expected, "`ok`").into());
    }
    Ok(())
}

/// Writes data directly to the board's staging memory, where uploads arrive, if they fit there. At the next upload of the same
/// data the board finds their CRC-32 in the staging memory, and skips the transfer.
///
/// # Errors
/// [`TransferError::NoMemory`], or the board's reply names a range outside its main memory.
pub fn stage<B: Board + ?Sized>(
    console: &mut Console<B>,
    data: &[u8],
) -> Result<(), TransferError> {
    let command = "info staging";
    let lines = console.command(command)?;
    let entry: String = console::value(command, &lines, "staging")?;
    let (address, room) = entry.split_once(' ').unwrap_or((&entry, "0"));
    let address = parse_address("staging", address)?;
    let room: usize = room.parse().unwrap_or(0);
    let memory = console.board().memory().ok_or(TransferError::NoMemory)?;
    if data.len() <= room {
        memory.write_memory(address, data)?;
    }
    Ok(())
}

/// Reads `length` bytes of the board's main memory directly, from `offset` bytes after the address that the command `info` prints
/// for `key`.
///
/// # Errors
/// [`TransferError::NoMemory`], the key is unknown, or the range is not in main memory.
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

/// The address that the board's command `info` prints for `key`.
fn address<B: Board + ?Sized>(console: &mut Console<B>, key: &str) -> Result<u32, ConsoleError> {
    let word = console.info(key)?;
    parse_address(key, &word)
}

fn parse_address(key: &str, word: &str) -> Result<u32, ConsoleError> {
    word.strip_prefix("0x")
        .and_then(|digits| u32::from_str_radix(digits, 16).ok())
        .ok_or_else(|| ConsoleError::Reply {
            command: format!("info {key}"),
            expected: "an address 0x…".to_owned(),
            found: word.to_owned(),
        })
}

/// Sends a console command such as `frame`, and downloads the `length` bytes that the board sends after it.
///
/// # Errors
/// The board refuses the command, the transfer fails, or the length differs.
pub fn download<B: Board + ?Sized>(
    console: &mut Console<B>,
    command: &str,
    length: usize,
    progress: &mut Progress,
) -> Result<Vec<u8>, TransferError> {
    persistently(console, &mut |console| {
        download_once(console, command, length, progress)
    })
}

/// Makes one attempt of [`download`].
fn download_once<B: Board + ?Sized>(
    console: &mut Console<B>,
    command: &str,
    length: usize,
    progress: &mut Progress,
) -> Result<Vec<u8>, TransferError> {
    let mut data = vec![0; length];
    console.command_with_transfer(command, &mut |_| {})?;
    let (board, pending) = console.line();
    let received = receive(board, pending, &mut data, progress);
    if let Err(TransferError::Stopped(failure)) = received {
        return Err(TransferError::Stopped(failure));
    }
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

/// Sends data to a board that waits for a transfer. Bytes that the board sends after the transfer remain in `pending`.
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

/// Receives data from a board that is ready to send, and returns the data's length. Bytes that the board sends after the transfer
/// remain in `pending`.
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
    endpoint: &mut Endpoint<impl Role>,
    progress: &mut Progress,
) -> Result<(), TransferError> {
    let mut frame = [0; MAX_FRAME];
    let mut last = board.now_ms();
    let mut stopped_ms = 0;
    loop {
        let time = board.now_ms();
        let step = time.saturating_sub(last);
        last = time;
        stopped_ms += step.saturating_sub(MAX_STEP_MS);
        let now = time.saturating_sub(stopped_ms);
        let taken = endpoint.on_bytes(now, pending);
        pending.drain(..taken);
        loop {
            let length = endpoint.poll(now, &mut frame);
            if length == 0 {
                break;
            }
            board.write(&frame[..length])?;
        }
        let (done, all) = endpoint.progress();
        progress(done.into(), all.into());
        match endpoint.state() {
            State::Running => board.read(pending, POLL_MS)?,
            State::Done => return Ok(()),
            State::Failed(failure) if stopped_ms > 0 => {
                return Err(TransferError::Stopped(failure));
            }
            State::Failed(failure) => return Err(TransferError::Failed(failure)),
        }
    }
}
