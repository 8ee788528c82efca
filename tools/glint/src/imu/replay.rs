//! Computes the attitudes of a log with the firmware's arithmetic, on this host or on a board.

use super::log::Entry;
use super::timeline;
use crate::board::{Board, Route};
use crate::console::{self, Console, ConsoleError};
use crate::error::{FormatError, Location};
use crate::transfer::{self, TransferError};
use glint_core::calibration::{Calibration, MOST_SAMPLES, Progress as Going, Report};
use glint_core::orientation::log::{
    self as image, HEADER_BYTES, LogError, RECORD_BYTES, Setup, attitude, from_bytes, record,
    to_bytes,
};
use glint_core::orientation::{Counts, LONGEST_STEP, Quaternion, Sample, Units};

/// Options of a replay.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Scales of the raw counts: LSB per °/s and LSB per g.
    pub units: Units,
    /// Fixed sample period in µs, used instead of the time stamps.
    pub period: Option<u32>,
    /// Duration in µs of the calibration at the log's start; `None` for no calibration.
    pub still: Option<u64>,
    /// Whether tilt correction is on.
    pub tilt: bool,
    /// Whether the bias is tracked while the sensor is at rest.
    pub follow_bias: bool,
}

/// A log with corrected time stamps, which have no long steps. A log in a board's format contains
/// their low words.
struct Stamps<'a> {
    entries: &'a [Entry],
    /// Time stamp of each sample in µs.
    stamps: Vec<u64>,
}

impl<'a> Stamps<'a> {
    /// Corrects the time stamps of a log: they become multiples of `period` µs, or come from the
    /// [`timeline`]. The firmware does not integrate over a step longer than `LONGEST_STEP`, so
    /// such a step is shortened to `LONGEST_STEP` + 1 µs.
    fn new(entries: &'a [Entry], period: Option<u32>) -> Self {
        let stamps = match period {
            Some(period) => (0..entries.len() as u64)
                .map(|i| i * u64::from(period))
                .collect(),
            None => {
                let (mut last, mut stamp) = (0, 0);
                let shorten = |time| {
                    stamp += u64::min(time - last, u64::from(LONGEST_STEP) + 1);
                    last = time;
                    stamp
                };
                timeline::times(entries).into_iter().map(shorten).collect()
            }
        };
        Self { entries, stamps }
    }

    fn samples(&self) -> impl Iterator<Item = Sample> {
        self.entries
            .iter()
            .zip(&self.stamps)
            .map(|(entry, &t_us)| Sample {
                t_us,
                accel: entry.accel,
                gyro: entry.gyro,
            })
    }
}

/// A log in the format that boards replay, and the calibration at its start.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(crate) image: Vec<u8>,
    pub(crate) samples: usize,
    calibration: Option<Report>,
}

/// Result of a replay.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// Attitude at each sample.
    pub attitudes: Vec<Quaternion>,
    /// Counts of samples by their effect on the attitude.
    pub counts: Counts,
    /// The calibration, if requested.
    pub calibration: Option<Report>,
    /// Mean number of clock cycles of a sample on the board; `None` for a replay on this host.
    pub cycles: Option<u64>,
}

/// An error of a replay.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The sensor is not at rest during the calibration, or the calibration has too few samples.
    #[error(transparent)]
    Still(#[from] FormatError),
    /// The model rejects the log.
    #[error("{0}")]
    Log(LogError),
    /// The board rejects the log, or the transfer fails.
    #[error(transparent)]
    Transfer(#[from] TransferError),
    /// The console reports an error, or does not answer.
    #[error(transparent)]
    Console(#[from] ConsoleError),
    /// An attitude from the board is not a unit quaternion.
    #[error("attitude {0} of the board: expected a quaternion of length 1, found another length")]
    Attitude(usize),
}

/// Converts a log to a board's format, with a calibration if requested.
///
/// # Errors
/// The sensor moves during the calibration, the calibration has too few samples, or a scale is out of range.
pub fn prepare(entries: &[Entry], options: &Options) -> Result<Prepared, Error> {
    let stamps = Stamps::new(entries, options.period);
    let calibration = match options.still {
        Some(still) => Some(calibrate(&stamps, options.units, still)?),
        None => None,
    };
    let bias = calibration.map_or([0; 3], |report| report.bias);
    let setup =
        Setup::new(options.units, options.tilt, options.follow_bias, bias).map_err(Error::Log)?;
    // The count saturates at 32 bits. Such a log is rejected anyway: by boards because of its
    // length, and by the model because the count does not match the number of bytes.
    let count = u32::try_from(entries.len()).unwrap_or(u32::MAX);
    let mut image = setup.header(count).to_vec();
    stamps
        .samples()
        .for_each(|sample| image.extend(to_bytes(record(&sample))));
    Ok(Prepared {
        image,
        samples: entries.len(),
        calibration,
    })
}

/// Replays a log on this host.
///
/// # Errors
/// The log exceeds the maximum length.
pub fn on_model(mut prepared: Prepared) -> Result<Replayed, Error> {
    let counts = image::replay(&mut prepared.image).map_err(Error::Log)?;
    let records = prepared.image.get(HEADER_BYTES..).unwrap_or_default();
    Ok(Replayed {
        attitudes: attitudes(records)?,
        counts,
        calibration: prepared.calibration,
        cycles: None,
    })
}

/// Replays a log on a board. Calls `progress` with the stage, the completed amount and the total
/// amount, in bytes of a transfer or samples of the replay.
///
/// # Errors
/// The firmware rejects the log, or a transfer fails.
pub fn on_board<B: Board + ?Sized>(
    prepared: &Prepared,
    console: &mut Console<B>,
    route: Route,
    progress: &mut dyn FnMut(Stage, u64, u64),
) -> Result<Replayed, Error> {
    if route == Route::Memory {
        transfer::stage(console, &prepared.image)?;
    }
    let all = prepared.samples as u64;
    let mut lines = Vec::new();
    let progress = std::cell::RefCell::new(progress);
    let mut bytes = |done, all| (progress.borrow_mut())(Stage::Transfer, done, all);
    let mut on_line = |line: &str| match line.strip_prefix("replaying ").map(str::parse) {
        Some(Ok(done)) => (progress.borrow_mut())(Stage::Replay, done, all),
        _ => lines.push(line.to_owned()),
    };
    transfer::upload_for(
        console,
        COMMAND,
        &prepared.image,
        SESSION,
        &mut bytes,
        &mut on_line,
    )?;
    let number = |key| console::value::<u64>(COMMAND, &lines, key);
    let counts = Counts {
        steps: number("steps")?,
        stale: number("stale")?,
        gaps: number("gaps")?,
        saturated: number("saturated")?,
        rejected: number("rejected")?,
    };
    let cycles = number("cycles_per_sample")?;
    let length = RECORD_BYTES * prepared.samples;
    let records = match route {
        Route::Serial => transfer::download(console, COMMAND, length, &mut bytes)?,
        Route::Memory => transfer::read_memory(console, "staging", HEADER_BYTES as u32, length)?,
    };
    Ok(Replayed {
        attitudes: attitudes(&records)?,
        counts,
        calibration: prepared.calibration,
        cycles: Some(cycles),
    })
}

/// The console command that replays a log.
const COMMAND: &str = "replay";
/// Session number of the transfers. All transfers can use the same number, because a board creates a receiver for each transfer.
const SESSION: u8 = 1;

/// Stage of a replay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Transfer of the log or of the attitudes; its progress counts bytes.
    Transfer,
    /// Computation of the attitudes; its progress counts samples.
    Replay,
}

fn attitudes(records: &[u8]) -> Result<Vec<Quaternion>, Error> {
    let records = records.as_chunks().0.iter().enumerate();
    records
        .map(|(i, record)| attitude(from_bytes(record)).ok_or(Error::Attitude(i)))
        .collect()
}

/// Calibrates with the samples of the first `still` µs of a log, at most the maximum number for a
/// calibration.
fn calibrate(stamps: &Stamps, units: Units, still: u64) -> Result<Report, FormatError> {
    let at_start = |sample: &Sample| sample.t_us < still;
    let count = stamps.samples().take_while(at_start).count();
    let seconds = still as f64 / 1e6;
    let [fewest, most] = MOST_SAMPLES;
    if count < fewest as usize {
        return Err(FormatError::whole(
            format!("at least {fewest} samples in the first {seconds} s"),
            count.to_string(),
        ));
    }
    let wanted = count.min(most as usize);
    let mut calibration = Calibration::new(units, wanted as u32);
    for (sample, entry) in stamps.samples().zip(stamps.entries).take(wanted) {
        match calibration.on_sample(&sample) {
            Ok(Going::Done(report)) => return Ok(report),
            Ok(Going::Going(_)) => {}
            Err(refusal) => {
                return Err(FormatError::new(
                    Location::Line(entry.line),
                    format!("a sensor at rest in the first {seconds} s"),
                    refusal.to_string(),
                ));
            }
        }
    }
    Err(FormatError::whole(
        format!("{wanted} samples with distinct time stamps in the first {seconds} s"),
        "repeated time stamps",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(stamps: &[u64]) -> Vec<Entry> {
        let entry = |(i, &t_us): (usize, &u64)| Entry {
            line: i + 2,
            t_us,
            accel: [0, 0, 4096],
            gyro: [0, 0, 1640],
            temp: None,
        };
        stamps.iter().enumerate().map(entry).collect()
    }

    const OPTIONS: Options = Options {
        units: Units::MPU_6050,
        period: None,
        still: None,
        tilt: true,
        follow_bias: false,
    };

    fn replay(entries: &[Entry], options: &Options) -> Result<Replayed, Error> {
        on_model(prepare(entries, options)?)
    }

    /// Numbers of integrated, stale and gap samples.
    fn counts(replayed: &Replayed) -> [u64; 3] {
        [
            replayed.counts.steps,
            replayed.counts.stale,
            replayed.counts.gaps,
        ]
    }

    fn yaw(attitude: Quaternion) -> f64 {
        attitude.angles().yaw.to_signed_degrees().to_num()
    }

    #[test]
    fn stamps_of_any_size() {
        // The sensor turns at 100 °/s. The time stamps, in µs, have a step across 2^32, a step back
        // and a gap of an hour. Only the three steps of 10 ms turn the attitude, each by 1°.
        let log = entries(&[
            u64::from(u32::MAX) - 5_000,
            u64::from(u32::MAX) + 5_000,
            u64::from(u32::MAX),
            u64::from(u32::MAX) + 15_000,
            u64::from(u32::MAX) + 3_600_000_000,
            u64::from(u32::MAX) + 3_600_010_000,
        ]);
        let replayed = replay(&log, &OPTIONS).unwrap();
        let yaws: Vec<f64> = replayed.attitudes.iter().map(|&at| yaw(at)).collect();
        for (yaw, expected) in yaws.iter().zip([0.0, 1.0, 1.0, 2.0, 2.0, 3.0]) {
            assert!((yaw - expected).abs() < 1e-6, "{yaws:?}");
        }
        assert_eq!(counts(&replayed), [3, 1, 1]);
    }

    /// The 32-bit clock wraps after three samples, and all steps are integrated.
    #[test]
    fn a_clock_of_32_bits_wraps() {
        let end = 1_u64 << 32;
        let stamps = [end - 3000, end - 2000, end - 1000, 0, 1000, 2000, 3000];
        let replayed = replay(&entries(&stamps), &OPTIONS).unwrap();
        assert!((yaw(replayed.attitudes[6]) - 0.6).abs() < 1e-6);
        assert_eq!(counts(&replayed), [6, 0, 0]);
    }

    /// One wrong time stamp, or two successive ones, in a log of a thousand samples affect only their
    /// own samples.
    #[test]
    fn wrong_stamps_affect_only_their_samples() {
        let cases = [
            &[0][..],
            &[7],
            &[50_000_000_000],
            &[u64::MAX],
            &[90_000_000, 95_000_000],
            &[95_000_000, 90_000_000],
            &[90_000_000, 90_001_000],
        ];
        for wrong in cases {
            let mut stamps: Vec<u64> = (0..1000).map(|i| 9_000_000 + i * 1000).collect();
            stamps[500..][..wrong.len()].copy_from_slice(wrong);
            let replayed = replay(&entries(&stamps), &OPTIONS).unwrap();
            assert!((yaw(replayed.attitudes[999]) - 99.9).abs() < 1e-3);
            let stale = wrong.len() as u64;
            assert_eq!(counts(&replayed), [999 - stale, stale, 0]);
        }
    }

    /// The second half of a log whose clock restarts is integrated too.
    #[test]
    fn a_restart_is_a_gap() {
        let stamps: Vec<u64> = (0..500).chain(0..500).map(|i| i * 1000).collect();
        let replayed = replay(&entries(&stamps), &OPTIONS).unwrap();
        assert!((yaw(replayed.attitudes[999]) - 99.8).abs() < 1e-3);
        assert_eq!(counts(&replayed), [998, 0, 1]);
    }

    #[test]
    fn a_period_instead_of_stamps() {
        let log = entries(&[7; 11]);
        let options = Options {
            period: Some(20_000),
            ..OPTIONS
        };
        let replayed = replay(&log, &options).unwrap();
        assert!((yaw(replayed.attitudes[10]) - 20.0).abs() < 1e-6);
        assert_eq!(replayed.counts.steps, 10);
        assert_eq!(replay(&log, &OPTIONS).unwrap().counts.stale, 10);
    }
}
