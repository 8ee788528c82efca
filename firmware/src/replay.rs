//! The command `replay`: a log comes in as meshes do, and each of its records becomes the attitude after it, where it lies.

use glint_core::orientation::Tracker;
use glint_core::orientation::log::{self, HEADER_BYTES, RECORD_BYTES, Record};
use glint_core::wire::Manifest;
use litex_pac::cpu;

use crate::commands::{self, Refusal, Reply};
use crate::machine::{Job, Machine};

/// Samples of a turn of the main loop: some milliseconds.
const SLICE: usize = 256;
/// Samples between two lines of progress.
const PROGRESS: usize = 1_024;

/// A log in the staging memory, as far as it has become attitudes.
pub struct Replay {
    tracker: Tracker,
    samples: usize,
    done: usize,
    /// How many of them have been told.
    told: usize,
    /// Cycles of the tracker, and of interrupts that came meanwhile.
    cycles: u64,
}

/// Takes a log and begins.
pub fn begin<'l>(machine: &mut Machine, manifest: Manifest) -> Reply<'l> {
    let opened = commands::stage(machine, "replay", manifest)
        .and_then(|staged| log::open(staged).map_err(Refusal::Log))
        .map(|(setup, records)| Replay {
            tracker: setup.tracker(),
            samples: records.len(),
            done: 0,
            told: 0,
            cycles: 0,
        });
    match opened {
        Ok(replay) => {
            machine.replay = Some(replay);
            Reply::After(Job::Replay)
        }
        Err(refusal) => Reply::Now(Err(refusal)),
    }
}

/// Goes on by a slice; how it has ended, if it has.
pub fn pursue(machine: &mut Machine) -> Option<Result<(), Refusal<'static>>> {
    let Machine {
        terminal,
        models,
        replay,
        uart,
        ..
    } = machine;
    let Some(replay) = replay else {
        return Some(Err(Refusal::NoReplay));
    };
    let records = models
        .staging()
        .get_mut(HEADER_BYTES..HEADER_BYTES + RECORD_BYTES * replay.samples)
        .unwrap_or_default();
    // The memory is aligned, header and records are whole words, and this core has their byte order.
    let records = bytemuck::try_cast_slice_mut::<u8, Record>(records).unwrap_or_default();
    let end = replay.samples.min(replay.done + SLICE);
    let records = records.get_mut(replay.done..end).unwrap_or_default();
    replay.cycles += track(&mut replay.tracker, records);
    replay.done = end;
    if end < replay.samples {
        // A slow line is told less often.
        if end - replay.told >= PROGRESS && uart.has_sent() {
            replay.told = end;
            terminal.print(format_args!("replaying {end}\n"));
        }
        return None;
    }
    let counts = replay.tracker.counts();
    let samples = replay.samples as u64;
    // There is at least one.
    let mean = (replay.cycles + samples / 2) / samples.max(1);
    for (key, value) in [
        ("samples", samples),
        ("steps", counts.steps),
        ("stale", counts.stale),
        ("gaps", counts.gaps),
        ("saturated", counts.saturated),
        ("rejected", counts.rejected),
        ("cycles_per_sample", mean),
    ] {
        terminal.print(format_args!("{key} {value}\n"));
    }
    Some(Ok(()))
}

/// Makes attitudes of samples where they lie, and gives the cycles that the tracker took.
// It is called with many samples, and lies beside the tracker: memory.x.
#[inline(never)]
pub fn track(tracker: &mut Tracker, records: &mut [Record]) -> u64 {
    // What reading the counter twice takes by itself.
    let start = cpu::cycles_low();
    let own = cpu::cycles_low().wrapping_sub(start);
    let mut all = 0;
    for record in records {
        let sample = log::sample(*record);
        let start = cpu::cycles_low();
        tracker.on_sample(&sample);
        let cycles = cpu::cycles_low().wrapping_sub(start);
        all += u64::from(cycles.saturating_sub(own));
        *record = log::attitude_record(tracker.attitude());
    }
    all
}

/// Sends the attitudes of the last log.
pub fn send(machine: &mut Machine) -> Result<(), Refusal<'static>> {
    let Machine {
        terminal,
        models,
        replay,
        downloads,
        ..
    } = machine;
    let replay = replay
        .as_ref()
        .filter(|replay| replay.done == replay.samples);
    let samples = replay.ok_or(Refusal::NoReplay)?.samples;
    let attitudes = models
        .staging()
        .get(HEADER_BYTES..HEADER_BYTES + RECORD_BYTES * samples)
        .unwrap_or_default();
    downloads
        .send(terminal, attitudes)
        .map_err(Refusal::Transfer)
}
