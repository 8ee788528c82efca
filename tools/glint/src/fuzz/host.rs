//! The fuzz target of the host's protocols: console replies, transfers and the serial boot, with a board that sends arbitrary
//! bytes.

use super::transfer::{SESSION, exchange, upload_data};
use crate::board::{Board, BoardError, Route};
use crate::console::{Console, value};
use crate::imu::log::Entry;
use crate::imu::{replay, sensor};
use crate::render::BoardRenderer;
use crate::transfer::{download, upload};
use crate::{flash, gesture, view};
use glint_core::mesh::MAGIC;
use glint_core::orientation::Units;
use glint_core::orientation::log::{self as image, HEADER_BYTES};

/// Keywords of a board's output.
pub const WORDS: &str = "ok\r\n ready\r\n present\r\n error: glint> mask samples cycles backend rays 0x K \r\n \x1b[ \x1e\n";

/// Size in bytes of the uploaded and downloaded data.
const LENGTH: usize = 100;
/// Load address of the program of a serial boot.
const ADDRESS: u32 = 0x4000_0000;
/// Length of the program of a serial boot, in bytes.
const PROGRAM: usize = 200;

/// Separator of the parts of a stream. The board sends the next part after a command or a silence.
const WAIT: &[u8] = b"\x1e\n";

/// A board that sends the bytes of a stream, regardless of the received bytes.
struct Stream<'s> {
    /// Remaining bytes of the current part.
    rest: &'s [u8],
    /// All remaining parts in reverse order.
    later: Vec<&'s [u8]>,
    /// Maximum number of bytes that a read returns.
    piece: usize,
    /// Duration of a read in milliseconds.
    pace: u64,
    /// Whether the board echoes commands before the stream continues, and answers `echo`.
    echoes: bool,
    echo: Vec<u8>,
    now_ms: u64,
}

impl Board for Stream<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        let command = bytes.strip_prefix(&[0]);
        if let (true, Some([command @ .., b'\r'])) = (self.echoes, command) {
            if self.rest.is_empty() {
                self.rest = self.later.pop().unwrap_or_default();
            }
            self.echo.extend([command, b"\r\n"].concat());
            if let Some(word) = command.strip_prefix(b"echo ") {
                self.echo.extend([word, b"\r\nok\r\n"].concat());
            }
        }
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        self.now_ms += self.pace;
        if !self.echo.is_empty() {
            bytes.append(&mut self.echo);
        } else if self.rest.is_empty() {
            self.rest = self.later.pop().unwrap_or_default();
            // A wait for a silent board counts as at least 1 s, so that a few reads exceed every
            // time-out.
            self.now_ms += wait_ms.max(1000);
        } else {
            let (piece, rest) = self.rest.split_at(self.piece.min(self.rest.len()));
            bytes.extend(piece);
            self.rest = rest;
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.now_ms
    }
}

/// Runs a host protocol with a board that sends the input. The first three bytes select the protocol, the duration of a read and
/// the length of a piece. Returns whether the protocol ended without an error.
pub fn run(input: &[u8]) -> bool {
    let &[kind, pace, piece, ref rest @ ..] = input else {
        return false;
    };
    let mut later = Vec::new();
    let mut rest = rest;
    while let Some(at) = rest.windows(WAIT.len()).position(|window| window == WAIT) {
        later.push(&rest[..at]);
        rest = &rest[at + WAIT.len()..];
    }
    later.push(rest);
    later.reverse();
    let mut board = Stream {
        rest: later.pop().unwrap_or_default(),
        later,
        piece: usize::from(piece) + 1,
        pace: u64::from(pace),
        echoes: kind & 0x80 == 0,
        echo: Vec::new(),
        now_ms: 0,
    };
    let outcome = converse(kind & 0x7f, &mut board, input.len());
    if let Err(error) = &outcome {
        let text = error.to_string();
        assert!(text.len() <= 4096 + 16 * input.len(), "an error is short");
    }
    outcome.is_ok()
}

/// Runs the protocol number `kind`. Checks that its results and callbacks contain no more bytes
/// than the board has sent or the host has requested.
fn converse(kind: u8, board: &mut Stream, length: usize) -> Result<(), Box<dyn std::error::Error>> {
    let quiet = &mut |_, _| {};
    if kind == 0 {
        let report = flash::flash(
            board,
            &upload_data(PROGRAM),
            ADDRESS,
            2_500,
            &mut |done, all| assert!(done <= all),
        )?;
        assert!(report.bytes == PROGRAM && report.said.len() <= length);
        return Ok(());
    }
    let console = &mut Console::new(board);
    match kind % 8 {
        0 => {
            console.greet()?;
            let lines = console.command("info")?;
            // Each damaged byte becomes a replacement character of three bytes.
            assert!(lines.iter().map(String::len).sum::<usize>() <= 3 * length);
            let _: u32 = value("info", &lines, "triangles")?;
            console.info("staging")?;
        }
        1 => {
            let view = view::spherical("4,30,60")?;
            let mut renderer = BoardRenderer::new(Console::new(console.board()));
            let stats = renderer.redraw()?;
            serde_json::to_string(&stats)?;
            renderer.look(&view)?;
        }
        2 => drop(upload(console, &mesh_data(), None, SESSION, quiet)?),
        3 => {
            let data = download(console, "frame", LENGTH, quiet)?;
            assert_eq!(data.len(), LENGTH);
        }
        4 => {
            sensor::wait(console)?;
            // The board may send times in any order, because only the replay of a log checks them.
            sensor::stream(console, 3, &mut |_| {})?;
        }
        5 => {
            let calibrated = sensor::calibrate(console, 100, &mut |_| {})?;
            serde_json::to_string(&calibrated)?;
        }
        6 => {
            let mask = gesture::mask(console, quiet)?;
            assert_eq!(
                8 * mask.bits.len() as u64,
                u64::from(mask.width) * u64::from(mask.height)
            );
            mask.write(std::io::sink())?;
        }
        _ => {
            console.synchronise()?;
            let log = log()?;
            let replayed = replay::on_board(&log, console, Route::Serial, &mut |_, _, _| {})?;
            assert_eq!(replayed.attitudes.len(), log.samples);
        }
    }
    Ok(())
}

/// Data with the header of a mesh. The mesh has more triangles than every board can draw, so the host asks the board for its limit.
fn mesh_data() -> Vec<u8> {
    [&MAGIC, &upload_data(LENGTH)[MAGIC.len()..]].concat()
}

/// A log of four samples.
fn log() -> Result<replay::Prepared, replay::Error> {
    let entries = [0, 1, 2, 3].map(|number| Entry {
        line: 0,
        t_us: 1_000 * number,
        accel: [5, -40, 4_090],
        gyro: [400, -100 * number as i16, 9],
        temp: None,
    });
    replay::prepare(
        &entries,
        &replay::Options {
            units: Units::MPU_6050,
            period: None,
            still: None,
            tilt: true,
            follow_bias: false,
        },
    )
}

/// The board's output in a complete run of each protocol.
pub fn seeds() -> Vec<Vec<u8>> {
    let seed = |kind: u8, parts: &[&[u8]]| {
        // One byte per read ensures that a reply does not arrive before its command is sent.
        [&[kind, 1, 0], parts.concat().as_slice()].concat()
    };
    let [_, acknowledged] = exchange(&mesh_data(), SESSION);
    let [sent, _] = exchange(&upload_data(LENGTH), SESSION);
    let [mask, _] = exchange(&[0x5A; 16], SESSION);
    let stats = b"render\r\nbackend gateware\r\ncycles 29373\r\ntriangles_in 12\r\ntriangles_culled 6\r\ntriangles_clipped 0\r\ntriangles_drawn 6\r\npixels_covered 8744\r\npixels_drawn 8744\r\nrays 57600\r\nevaluations 90000\r\nhits 9\r\nmisses 8\r\nundecided 0\r\nclock 81250000\r\ncycles_busy 7\r\nok\r\n";
    let limit = b"mesh_triangles 4294967295\r\nok\r\n\x1e\n";
    let again = stats.strip_prefix(b"render\r\n").unwrap_or_default();
    let mut seeds = vec![
        seed(0, &[b"BIOS\r\n", flash::REQUEST, WAIT, b"KKKKKLiftoff!\r\n"]),
        seed(
            0x88,
            &[b"Glint 0.1.0\r\n\r\nglint> info\r\nversion 1\r\ntriangles 12\r\nok\r\nglint> \x1b[2Kinfo staging\r\nstaging 0x42000000 67108864\r\nok\r\n"],
        ),
        seed(1, &[again, b"\x1e\nok\r\n\x1e\n", again]),
        seed(2, &[limit, b"ready\r\n", &acknowledged, b"triangles 12\r\nok\r\nglint> "]),
        seed(2, &[limit, b"present\r\nok\r\nglint> "]),
        seed(3, &[b"ready\r\n", &sent, b"ok\r\nglint> "]),
        seed(
            4,
            &[b"sensor MPU-6050\r\nfailure none\r\nsamples 12\r\nok\r\n\x1e\n", sensor::HEADER.as_bytes(), b"\r\n4294967290,1,-2,4096,0,32767,-32768\r\n5,1,2,3,4,5,6\r\n1005,1,2,3,4,5,6\r\nok\r\n"],
        ),
        seed(
            5,
            &[b"calibrating 50\r\ncalibrated 100\r\nbias 0.5 -1.25 0\r\ndeviation 0.1 0.1 0.1\r\ndrift_per_hour 3 2 1\r\nok\r\n"],
        ),
        seed(6, &[b"ok\r\n\x1e\nmask 16 8\r\nready\r\n", &mask, b"ok\r\n"]),
    ];
    if let Ok(mut log) = log() {
        const REPLAYED: u8 = 1;
        let [_, acknowledged] = exchange(&log.image, REPLAYED);
        if image::replay(&mut log.image).is_ok() {
            let [attitudes, _] = exchange(&log.image[HEADER_BYTES..], SESSION);
            let counts = b"replaying 2\r\nsteps 3\r\nstale 0\r\ngaps 0\r\nsaturated 0\r\nrejected 0\r\ncycles_per_sample 900\r\nok\r\n\x1e\n";
            let parts = [
                b"ready\r\n",
                &acknowledged[..],
                counts,
                b"ready\r\n",
                &attitudes,
                b"ok\r\n",
            ];
            seeds.push(seed(7, &parts));
        }
    }
    seeds
}

#[cfg(test)]
mod tests {
    /// Every seed runs its protocol without an error; otherwise mutations of it would test only the first check.
    #[test]
    fn every_seed_completes_its_protocol() {
        for (number, seed) in super::seeds().iter().enumerate() {
            assert!(super::run(seed), "seed {number}: {}", seed.escape_ascii());
        }
        assert_eq!(super::seeds().len(), 10);
    }
}
