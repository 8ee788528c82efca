//! The firmware's orientation on the samples of a log.

use super::log::Entry;
use crate::error::{FormatError, Place};
use glint_core::calibration::{Calibration, MOST_SAMPLES, Progress, Report, RestBias, Units};
use glint_core::orientation::{
    Counts, LONGEST_STEP, Outcome, Quaternion, Sample, Scale, TIME_CONSTANT, Tilt, Tracker,
};

/// How a log is replayed.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// What a count of the gyroscope is worth.
    pub scale: Scale,
    /// The same for people, and what a count of the accelerometer is worth.
    pub units: Units,
    /// The time between two samples in µs, instead of their stamps.
    pub period: Option<u32>,
    /// How many µs at the start are a calibration.
    pub still: Option<u64>,
    /// Whether the accelerometer holds the tilt.
    pub tilt: bool,
    /// Whether the bias is followed at rest.
    pub follow_bias: bool,
}

/// The samples of a log, stamped as the firmware stamps them.
struct Stamps<'a> {
    entries: &'a [Entry],
    period: Option<u32>,
}

impl Stamps<'_> {
    /// Stamps of 32 bits. A step back is no step, and one longer than any that is integrated is a little longer than that.
    fn samples(&self) -> impl Iterator<Item = Sample> {
        let mut latest = self.entries.first().map_or(0, |entry| entry.t_us);
        let mut stamp = 0_u32;
        let mut first = true;
        self.entries.iter().map(move |entry| {
            let step = match self.period {
                Some(period) if !first => period,
                Some(_) => 0,
                None => entry
                    .t_us
                    .saturating_sub(latest)
                    .min(u64::from(LONGEST_STEP) + 1) as u32,
            };
            first = false;
            latest = latest.max(entry.t_us);
            stamp = stamp.wrapping_add(step);
            Sample {
                t_us: stamp,
                accel: entry.accel,
                gyro: entry.gyro,
            }
        })
    }
}

/// What came of a log.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// The attitude at each sample.
    pub attitudes: Vec<Quaternion>,
    /// What happened to the samples.
    pub counts: Counts,
    /// The calibration, if there was one.
    pub calibration: Option<Report>,
}

/// Replays a log.
///
/// # Errors
/// It is to be still at the start and is not.
pub fn replay(entries: &[Entry], options: &Options) -> Result<Replayed, FormatError> {
    let stamps = Stamps {
        entries,
        period: options.period,
    };
    let calibration = match options.still {
        Some(still) => Some(calibrate(&stamps, options.units, still)?),
        None => None,
    };
    let bias = calibration.map_or([0; 3], |report| report.bias);
    let tilt = options
        .tilt
        .then(|| Tilt::new(options.units.per_g, TIME_CONSTANT));
    let mut tracker: Tracker = Tracker::new(options.scale, tilt);
    tracker.set_bias(bias);
    if options.follow_bias {
        tracker.follow_bias(RestBias::new(options.units, bias));
    }
    let attitudes = stamps
        .samples()
        .map(|sample| {
            let _: Outcome = tracker.on_sample(&sample);
            tracker.attitude()
        })
        .collect();
    Ok(Replayed {
        attitudes,
        counts: tracker.counts(),
        calibration,
    })
}

/// The bias at the start of a log. A long start counts as far as a calibration goes.
fn calibrate(stamps: &Stamps, units: Units, still: u64) -> Result<Report, FormatError> {
    let mut elapsed = 0_u64;
    let mut last = 0_u32;
    let count = stamps
        .samples()
        .take_while(|sample| {
            elapsed += u64::from(sample.t_us.wrapping_sub(last));
            last = sample.t_us;
            elapsed < still
        })
        .count();
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
            Ok(Progress::Done(report)) => return Ok(report),
            Ok(Progress::Going(_)) => {}
            Err(refusal) => {
                return Err(FormatError::new(
                    Place::Line(entry.line),
                    format!("a sensor at rest in the first {seconds} s"),
                    refusal.to_string(),
                ));
            }
        }
    }
    Err(FormatError::whole(
        format!("{wanted} samples with stamps of their own in the first {seconds} s"),
        "stamps that stand still",
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
        scale: Scale::MPU_6050,
        units: Units::MPU_6050,
        period: None,
        still: None,
        tilt: true,
        follow_bias: false,
    };

    fn yaw(attitude: Quaternion) -> f64 {
        attitude.angles().yaw.to_signed_degrees().to_num()
    }

    #[test]
    fn stamps_of_any_size() {
        // 100 °/s: back in time, across 2^32, and an hour later.
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
        let counts = replayed.counts;
        assert_eq!((counts.steps, counts.stale, counts.gaps), (3, 1, 1));
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
