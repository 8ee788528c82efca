//! Tests of the gyroscope's calibration: results, rejected samples, and tracking of the bias at rest.

use glint_core::calibration::{Calibration, Progress, Report, SAMPLES, SampleError};
use glint_core::orientation::{RestBias, Sample, Units};

use crate::random::Random;

impl Random {
    /// Returns an approximately normal random number with mean 0 and variance 1, from the sum of twelve uniform numbers.
    fn normal(&mut self) -> f64 {
        (0..12)
            .map(|_| (self.next() >> 11) as f64 / 2f64.powi(53))
            .sum::<f64>()
            - 6.0
    }
}

const BIAS: [f64; 3] = [73.8, -0.77, 18.4];

/// Calibrates with samples of a sensor at rest with noise of 0.1 °/s. `change` may modify each sample. Returns the report, and
/// the exact mean of the rate about each axis in LSB.
fn calibrate(
    samples: u32,
    mut change: impl FnMut(u32, &mut Sample),
) -> Result<(Report, [f64; 3]), SampleError> {
    let mut calibration = Calibration::new(Units::MPU_6050, samples);
    let mut random = Random(5);
    let mut sum = [0.0; 3];
    for i in 0.. {
        let mut sample = Sample {
            t_us: u64::from(i) * 1_000,
            accel: [90, -30, 4_100].map(|a: i16| a + (random.next() % 17) as i16),
            gyro: BIAS.map(|bias| (bias + 1.64 * random.normal()).round() as i16),
        };
        change(i, &mut sample);
        for (sum, gyro) in sum.iter_mut().zip(sample.gyro) {
            *sum += f64::from(gyro);
        }
        match calibration.on_sample(&sample)? {
            Progress::Done(report) => {
                return Ok((report, sum.map(|sum| sum / f64::from(report.samples))));
            }
            Progress::Going(count) => assert_eq!(count, i + 1),
        }
    }
    unreachable!("a calibration ends");
}

#[test]
fn the_mean_is_kept_to_a_256th() {
    let (report, mean) = calibrate(SAMPLES, |_, _| ()).expect("at rest");
    assert_eq!(report.samples, SAMPLES);
    for axis in 0..3 {
        let exact = mean[axis] * 256.0;
        assert!(
            (f64::from(report.bias[axis]) - exact).abs() <= 0.5,
            "{report:?} {exact}"
        );
        // The noise is 1.64 LSB, and rounding to whole LSB adds 1/12 LSB² to the variance.
        let deviation = f64::from(report.deviation[axis]) / 256.0;
        assert!(
            (deviation - (1.64_f64.powi(2) + 1.0 / 12.0).sqrt()).abs() < 0.05,
            "{deviation}"
        );
        let error = f64::from(report.error[axis]) / 65_536.0;
        assert!((error - deviation / f64::from(SAMPLES).sqrt()).abs() < 1e-3 * error + 2e-5);
        // The actual error agrees with the reported standard error.
        assert!((mean[axis] - BIAS[axis]).abs() < 4.0 * error);
    }
    // The expected drift is 1.67 LSB of noise, divided by 16.4 LSB per °/s and by the root of 8192 samples, converted to °/h.
    for drift in report.drift(Units::MPU_6050) {
        assert!((drift.to_num::<f64>() - 4.05).abs() < 0.15, "{drift}");
    }
}

/// A mean between two integers is rounded away from 0 for both signs.
#[test]
fn a_mean_that_is_too_large_is_rounded_away_from_zero() {
    for (sign, stated) in [(1, 657), (-1, -657)] {
        let outcome = calibrate(1_000, |i, sample| {
            sample.gyro[1] = sign * (656 + (i % 2) as i16);
        });
        let mean = SampleError::TooLarge {
            axis: 1,
            mean: stated,
            most: 656,
        };
        assert_eq!(outcome, Err(mean));
    }
}

#[test]
fn stale_samples_do_not_count_and_extremes_fit() {
    let mut calibration = Calibration::new(Units::MPU_6050, 0);
    let sample = Sample {
        t_us: 5,
        ..Sample::default()
    };
    assert_eq!(calibration.on_sample(&sample), Ok(Progress::Going(1)));
    assert_eq!(calibration.on_sample(&sample), Ok(Progress::Going(1)));
    // The largest number of samples with the largest rates must not overflow.
    for units in [
        Units::MPU_6050,
        Units {
            per_g: u32::MAX / 8,
            ..Units::MPU_6050
        },
    ] {
        let mut calibration = Calibration::new(units, u32::MAX);
        let mut outcome = Ok(Progress::Going(0));
        for t_us in 0..65_536_u64 {
            let gyro = [i16::MIN, i16::MAX, i16::MIN + (t_us % 2) as i16];
            outcome = calibration.on_sample(&Sample {
                t_us,
                accel: [i16::MIN; 3],
                gyro,
            });
        }
        assert!(
            matches!(outcome, Err(SampleError::TooLarge { axis: 0, .. })),
            "{outcome:?}"
        );
    }
}

/// Tracks a bias for `seconds` at 1 kHz, from the initial value `start` in 1/256 LSB. The gyroscope reads
/// `rate`, in LSB, plus noise.
fn followed(seconds: u32, start: [i32; 3], mut rate: impl FnMut(u32) -> [f64; 3]) -> RestBias {
    let mut resting = RestBias::new(Units::MPU_6050, start);
    let mut random = Random(9);
    for i in 0..seconds * 1_000 {
        let gyro = rate(i).map(|rate| (rate + 1.64 * random.normal()).round() as i16);
        let accel = [0, 0, 4_096].map(|a: i16| a + (random.next() % 17) as i16);
        resting.on_sample(
            &Sample {
                t_us: u64::from(i) * 1_000,
                accel,
                gyro,
            },
            1_000,
        );
    }
    resting
}

#[test]
fn a_bias_that_wanders_is_followed_at_rest() {
    // The bias changes by 0.5 °/s (8.2 LSB) and is tracked for three time constants.
    let resting = followed(300, [0; 3], |_| [8.2, -8.2, 0.0]);
    assert!(resting.is_at_rest());
    let bias = resting.bias().map(|x| f64::from(x) / 256.0);
    let expected = 8.2 * (1.0 - (-298.5_f64 / 100.0).exp());
    assert!(
        (bias[0] - expected).abs() < 0.05 && (bias[1] + expected).abs() < 0.05,
        "{bias:?}"
    );
    assert!(bias[2].abs() < 0.05, "{bias:?}");
}

#[test]
fn motion_is_not_learnt() {
    // The motions are two oscillations of ±1500 °/s with different periods, a slow sway, and a steady turn that is too fast to be
    // a bias. None of these motions may change the bias.
    let square = |i: u32, period: u32| if i % period < period / 2 { 1.0 } else { -1.0 };
    for rate in [
        Box::new(move |i| [0.0, 0.0, 24_600.0 * square(i, 1_000)])
            as Box<dyn FnMut(u32) -> [f64; 3]>,
        Box::new(move |i| [0.0, 0.0, 24_600.0 * square(i, 20_000)]),
        Box::new(move |i| [82.0 * square(i, 9_000), 0.0, 0.0]),
        Box::new(|_| [0.0, 50.0, 0.0]),
    ] {
        let resting = followed(60, [256, 0, 0], rate);
        assert_eq!(resting.bias(), [256, 0, 0]);
    }
}

#[test]
fn at_rest_the_bias_does_not_cycle() {
    // Without noise the tracked bias must reach a constant value; rounding must not make it cycle.
    let mut resting = RestBias::new(Units::MPU_6050, [256, -256, 128]);
    let mut seen = Vec::new();
    for i in 0..3_000_000 {
        let sample = Sample {
            t_us: i * 1_000,
            accel: [0, 0, 4_096],
            gyro: [1, -2, 0],
        };
        resting.on_sample(&sample, 1_000);
        if i > 2_900_000 {
            seen.push(resting.bias());
        }
    }
    seen.dedup();
    assert_eq!(seen, [[256, -512, 0]]);
}
