//! Access to a board's sensor through the board's console.

use super::log::Entry;
use super::timeline;
use crate::board::Board;
use crate::console::{self, Console, ConsoleError};
use virtual_board::virtual_mpu6050::{Chip, Counts, Imperfections, Source, State, Wires};

/// Time-out of the first sample after the board's start, in ms of the board's time. It covers
/// detection, reset and set-up of the sensor.
const START_MS: u64 = 1_000;
/// Header of the output of `imu stream`, and of a log.
pub const HEADER: &str = "t_us,ax,ay,az,gx,gy,gz";

/// Maximum length of a sample's line in bytes.
const MAX_SAMPLE: usize = 64;

/// An error of a sensor or of its board.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The board reports an error, or does not answer.
    #[error(transparent)]
    Console(#[from] ConsoleError),
    /// There is no sensor, or it does not work.
    #[error("no sample within {START_MS} ms of board time: {0}")]
    Failure(String),
    /// The board printed a malformed sample.
    #[error("sample of the board: expected {HEADER} in whole numbers, found {0:?}")]
    Sample(String),
}

/// Waits for the sensor's first sample; returns the sensor's name.
///
/// # Errors
/// No sample arrives in time.
pub fn wait<B: Board + ?Sized>(console: &mut Console<B>) -> Result<String, Error> {
    const COMMAND: &str = "imu";
    let end = console.board().now_ms() + START_MS;
    loop {
        let lines = console.command(COMMAND)?;
        let failure: String = console::value(COMMAND, &lines, "failure")?;
        let samples: u32 = console::value(COMMAND, &lines, "samples")?;
        if failure == "none" && samples > 0 {
            return Ok(console::value(COMMAND, &lines, "sensor")?);
        }
        if console.board().now_ms() >= end {
            return Err(Error::Failure(match failure.as_str() {
                "none" => "no sensor found yet".to_owned(),
                _ => failure,
            }));
        }
    }
}

/// Streams `samples` samples from the board to `on_sample`. The time of a sample is in µs of the
/// board's time since the first sample. A time stamp before the first sample counts as 0.
///
/// # Errors
/// The sensor or the board fails.
pub fn stream<B: Board + ?Sized>(
    console: &mut Console<B>,
    samples: u32,
    on_sample: &mut dyn FnMut(Entry),
) -> Result<(), Error> {
    let command = format!("imu stream {samples}");
    console.send(&command)?;
    console.allow((samples as usize).saturating_mul(MAX_SAMPLE));
    let mut first = None;
    let mut malformed = None;
    console.lines(&command, &mut |line| {
        if line == HEADER {
            return;
        }
        match sample(line) {
            Some((stamp, accel, gyro)) => on_sample(Entry {
                line: 0,
                t_us: stamp.saturating_sub(*first.get_or_insert(stamp)),
                accel,
                gyro,
                temp: None,
            }),
            None => malformed = malformed.take().or_else(|| Some(line.to_owned())),
        }
    })?;
    malformed.map_or(Ok(()), |line| Err(Error::Sample(line)))
}

fn sample(line: &str) -> Option<(u64, [i16; 3], [i16; 3])> {
    let (stamp, counts) = line.split_once(',')?;
    let counts: Vec<i16> = counts
        .split(',')
        .map(|count| count.parse().ok())
        .collect::<Option<_>>()?;
    let &[ax, ay, az, gx, gy, gz] = counts.as_slice() else {
        return None;
    };
    Some((stamp.parse().ok()?, [ax, ay, az], [gx, gy, gz]))
}

/// Result of a calibration. Each array contains the values about the axes x, y and z.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Calibrated {
    /// Number of averaged samples.
    pub samples: u32,
    /// Mean rate at rest, in °/s.
    pub bias: [f64; 3],
    /// Standard deviation of the samples, in °/s.
    pub deviation: [f64; 3],
    /// Expected drift of an attitude, in °/h.
    pub drift_per_hour: [f64; 3],
}

/// Calibrates the gyroscope with `samples` samples. Calls `progress` with the number of samples so far.
///
/// # Errors
/// The firmware reports that the sensor moves or fails.
pub fn calibrate<B: Board + ?Sized>(
    console: &mut Console<B>,
    samples: u32,
    progress: &mut dyn FnMut(u32),
) -> Result<Calibrated, Error> {
    let command = format!("imu calibrate {samples}");
    console.send(&command)?;
    let mut lines = Vec::new();
    console.lines(
        &command,
        &mut |line| match line.strip_prefix("calibrating ").map(str::parse) {
            Some(Ok(samples)) => progress(samples),
            _ => lines.push(line.to_owned()),
        },
    )?;
    let three = |key| -> Result<[f64; 3], ConsoleError> {
        let Triple(numbers) = console::value(&command, &lines, key)?;
        Ok(numbers)
    };
    Ok(Calibrated {
        samples: console::value(&command, &lines, "calibrated")?,
        bias: three("bias")?,
        deviation: three("deviation")?,
        drift_per_hour: three("drift_per_hour")?,
    })
}

/// Three numbers, parsed from a text that separates them by single spaces.
struct Triple([f64; 3]);

impl std::str::FromStr for Triple {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let numbers: Result<Vec<f64>, _> = text.split(' ').map(str::parse).collect();
        let numbers = numbers.map_err(drop)?;
        <[f64; 3]>::try_from(numbers).map(Self).map_err(drop)
    }
}

/// Returns a virtual sensor for a simulated board. Without a log the sensor is at rest, with
/// typical errors. With a log, which starts together with the board, the sensor outputs the counts
/// of the log, and repeats the last sample after its end.
#[must_use]
pub fn virtual_sensor(log: Option<&[Entry]>) -> Wires {
    let source = match log {
        None => Source::Motion(Box::new(|_| State::default())),
        Some(entries) => {
            let counts = |entry: &Entry| Counts {
                accel: entry.accel,
                temperature: entry.temp.unwrap_or_default(),
                gyro: entry.gyro,
            };
            let times = timeline::times(entries).into_iter();
            let times = times.map(|time| time.saturating_mul(1_000));
            Source::Log(times.zip(entries.iter().map(counts)).collect())
        }
    };
    Wires::new(Chip::new(source, Imperfections::TYPICAL, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_samples_are_parsed() {
        assert_eq!(
            sample("18446744073709551615,1,-2,4096,0,32767,-32768"),
            Some((u64::MAX, [1, -2, 4096], [0, i16::MAX, i16::MIN]))
        );
        for line in [
            "",
            "1,2,3",
            "1,2,3,4,5,6,7,8",
            "1,2,3,4,5,6,40000",
            "-1,0,0,0,0,0,0",
        ] {
            assert_eq!(sample(line), None, "{line}");
        }
    }
}
