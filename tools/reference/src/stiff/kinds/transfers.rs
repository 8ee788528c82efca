//! The receiver of a transfer on a line with silences.

use anyhow::{Result, ensure};
use glint_core::wire::{MAX_FRAME, Manifest, Receiver, Sender, State, Timing};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("transfer-silence", silence),
        Kind::new("transfer-blocks", |length: u32| {
            let manifest = Manifest { length, crc32: 0 };
            Ok(Outcome::exact(format!("{} blocks", manifest.blocks())))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    /// Start of the transfer in ms.
    start: u64,
    /// Silences in ms, each ended by a repetition of the sender's first frame.
    silences: Vec<u64>,
    /// Capacity of the receiver in bytes.
    room: usize,
}

/// The state of the receiver after silences of the line.
fn silence(line: Line) -> Result<Outcome> {
    let data = [7; 100];
    let mut room = vec![0; line.room];
    let mut now = line.start;
    let manifest = Some(Manifest::of(&data));
    let mut receiver = Receiver::new(&mut room, manifest, Timing::CONSOLE, now);
    let (mut frame, mut answer) = ([0; MAX_FRAME], [0; MAX_FRAME]);
    let length = Sender::new(&data, 1, Timing::CONSOLE, now).poll(now, &mut frame);
    ensure!(length > 0, "a sender begins with a frame");
    for silence in line.silences {
        now += silence;
        receiver.poll(now, &mut answer);
        receiver.on_bytes(now, &frame[..length]);
        receiver.poll(now, &mut answer);
    }
    // A failed transfer sends its last message three times. Then it waits for a quiet line, ten times as long as a completed transfer.
    for _ in 0..6 {
        now += 10 * Timing::CONSOLE.quiet_ms;
        receiver.poll(now, &mut answer);
    }
    Ok(Outcome::exact(match receiver.state() {
        State::Running => "running".to_owned(),
        State::Done => "done".to_owned(),
        State::Failed(failure) => failure.to_string(),
    }))
}
