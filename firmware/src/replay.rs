//! Replay of a log in memory: the attitude after each sample of the sensor overwrites the record of this sample.

use core::ops::Range;

use glint_core::orientation::log::{self, HEADER_BYTES, RECORD_BYTES, Record};
use glint_core::orientation::{Counts, Tracker};
use litex_pac::cpu;

/// Number of samples that are replayed in one turn of the task. This takes a few milliseconds.
const SLICE: usize = 256;

/// The progress of the replay of a log.
pub struct Replay {
    tracker: Tracker,
    /// Time of the last replayed sample in µs.
    time: u64,
    samples: usize,
    done: usize,
    /// Number of samples processed at the last report.
    reported: usize,
    /// Clock cycles of the tracker's computations, including interrupts.
    cycles: u64,
}

impl Replay {
    /// Creates the replay of a log with this number of samples.
    pub const fn new(tracker: Tracker, samples: usize) -> Self {
        Self {
            tracker,
            time: log::START,
            samples,
            done: 0,
            reported: 0,
            cycles: 0,
        }
    }

    /// Total number of samples in the log.
    pub const fn samples(&self) -> usize {
        self.samples
    }

    /// Whether the attitudes after all samples have been computed.
    pub const fn is_done(&self) -> bool {
        self.done == self.samples
    }

    /// Counts of the samples replayed so far, by their effect on the attitude.
    pub const fn counts(&self) -> Counts {
        self.tracker.counts()
    }

    /// Number of samples processed since the last report.
    pub const fn unreported(&self) -> usize {
        self.done - self.reported
    }

    /// Returns the number of samples processed so far, and marks them as reported.
    pub const fn report(&mut self) -> usize {
        self.reported = self.done;
        self.done
    }

    /// Mean number of the tracker's clock cycles per sample, rounded to nearest.
    pub fn cycles_per_sample(&self) -> u64 {
        let samples = self.samples.max(1) as u64;
        (self.cycles + samples / 2) / samples
    }

    /// The range of the records in the memory of the log.
    pub const fn range(&self) -> Range<usize> {
        HEADER_BYTES..HEADER_BYTES + RECORD_BYTES * self.samples
    }

    /// Replays the next samples of the log in `memory`.
    pub fn advance(&mut self, memory: &mut [u8]) {
        let records = memory.get_mut(self.range()).unwrap_or_default();
        // The cast does not fail, because the memory is aligned, and the lengths of header and records are multiples of a word. The core
        // and the log are both little-endian.
        let records = bytemuck::try_cast_slice_mut::<u8, Record>(records).unwrap_or_default();
        let end = self.samples.min(self.done + SLICE);
        let records = records.get_mut(self.done..end).unwrap_or_default();
        self.cycles += track(&mut self.tracker, &mut self.time, records);
        self.done = end;
    }
}

/// Replaces each sample in `records` by the attitude after the sample, and returns the clock cycles of the tracker. `time` is the time in
/// µs of the last sample.
// The linker script places this function next to the code of the tracker.
#[inline(never)]
pub fn track(tracker: &mut Tracker, time: &mut u64, records: &mut [Record]) -> u64 {
    // The overhead of a measurement: the cycles between two consecutive reads of the cycle counter.
    let start = cpu::cycles_low();
    let own = cpu::cycles_low().wrapping_sub(start);
    let mut all = 0;
    for record in records {
        let sample = log::sample(*record, *time);
        *time = sample.t_us;
        let start = cpu::cycles_low();
        tracker.on_sample(&sample);
        let cycles = cpu::cycles_low().wrapping_sub(start);
        all += u64::from(cycles.saturating_sub(own));
        *record = log::attitude_record(tracker.attitude());
    }
    all
}
