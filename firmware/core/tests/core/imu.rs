//! Tests of a camera that is steered by the samples of a sensor.

use glint_core::calibration;
use glint_core::fixed::Q32_32;
use glint_core::imu::{CalibrationError, Follow, Imu};
use glint_core::mpu6050::{Error, Identity, Measurement, Sink};
use glint_core::steering::{Direction, Mounting};

type TestImu = Imu<&'static str>;

const EYE: [Q32_32; 3] = [Q32_32::ZERO; 3];
const RADIUS: Q32_32 = Q32_32::lit("2.5");

/// Returns a measurement of a flat sensor at rest, whose gyroscope has a bias of (10, −20, 30) LSB and some noise.
fn rest(index: u64) -> Measurement {
    let noise = (index * 7 % 3) as i16 - 1;
    Measurement {
        accel: [0, 0, 4_096],
        temperature: -521,
        gyro: [10, -20, 30].map(|bias| bias + noise),
    }
}

fn running() -> TestImu {
    let mut imu = Imu::default();
    imu.on_start(Identity::Mpu6050);
    imu
}

#[test]
fn a_calibrated_sensor_at_rest_stays_where_it_is() {
    let mut imu = running();
    imu.calibrate(8_192);
    for index in 0..8_192 {
        assert_eq!(imu.calibrated_samples(), Some(index as u32));
        assert!(imu.calibrated_eighths().is_some_and(|eighths| eighths < 8));
        imu.on_sample(index * 1_000, &rest(index));
    }
    let report = imu.calibration().expect("an end").expect("at rest");
    assert_eq!(report.bias.map(|bias| (bias + 128) >> 8), [10, -20, 30]);
    let bias = imu.bias().map(|bias| bias.to_num::<f64>() * 16.4);
    assert!((bias[2] - 30.0).abs() < 0.01, "{bias:?}");
    assert_eq!(imu.temperature(), Some(3_500));
    // Before the calibration the bias caused a tilt, which now decays.
    for index in 8_192..40_000 {
        imu.on_sample(index * 1_000, &rest(index));
    }
    let before = imu.attitude();
    for index in 40_000..44_000 {
        imu.on_sample(index * 1_000, &rest(index));
    }
    let turn = before.inverse().times(imu.attitude());
    assert!(turn.angles().yaw.to_signed_degrees().abs() < Q32_32::lit("0.01"));
}

#[test]
fn a_calibration_ends_when_it_moves_fails_or_has_no_sensor() {
    let mut imu = running();
    imu.calibrate(64);
    imu.on_sample(0, &rest(0));
    let mut moving = rest(1);
    moving.gyro[2] = 500;
    imu.on_sample(1_000, &moving);
    assert!(matches!(
        imu.calibration(),
        Some(Err(CalibrationError::Samples(
            calibration::SampleError::Turned { axis: 2, .. }
        )))
    ));
    imu.calibrate(64);
    imu.on_error(Error::Silent);
    assert_eq!(
        imu.calibration(),
        Some(Err(CalibrationError::Failed(Error::Silent)))
    );
    imu.calibrate(64);
    assert_eq!(
        imu.calibration(),
        Some(Err(CalibrationError::Failed(Error::Silent)))
    );
    assert_eq!((imu.errors(), imu.is_running()), (1, false));
    imu.on_start(Identity::Mpu6050);
    assert!(imu.is_running());
    let mut absent = TestImu::default();
    absent.calibrate(64);
    assert_eq!(absent.calibration(), Some(Err(CalibrationError::Absent)));
}

#[test]
fn the_camera_follows_and_can_be_recentred() {
    let mut imu = running();
    assert_eq!(imu.view(EYE, RADIUS), None);
    imu.set_follow(Some(Follow::Look));
    assert_eq!(imu.view(EYE, RADIUS), None, "no sample has arrived yet");
    // The sensor turns by 90° to the left in a second.
    let turning = Measurement {
        gyro: [0, 0, 1_476],
        ..rest(0)
    };
    for index in 0..=1_000 {
        imu.on_sample(index * 1_000, &turning);
    }
    let near = |found: [f64; 3], expected: [f64; 3]| {
        let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-3, "{found:?} {expected:?}");
    };
    let forward = |imu: &mut TestImu| {
        let view = imu
            .view(EYE, RADIUS)
            .expect("it has moved")
            .expect("in range");
        (view.n().map(|x| x.to_num()), view.eye().map(|x| x.to_num()))
    };
    near(forward(&mut imu).0, [-1.0, 0.0, 0.0]);
    assert_eq!(
        imu.view(EYE, RADIUS),
        None,
        "the camera has not moved since the last call"
    );
    imu.recentre();
    near(forward(&mut imu).0, [0.0, 1.0, 0.0]);
    imu.set_follow(Some(Follow::Orbit));
    let (n, eye) = forward(&mut imu);
    near(n, [0.0, 1.0, 0.0]);
    near(eye, [0.0, -2.5, 0.0]);
    // First the sensor is mounted so that it faces backwards. Then the mounting is the default again, and
    // the sensitivity is halved.
    imu.set_mounting(Mounting::new(Direction::MinusY, Direction::Z).expect("perpendicular"));
    near(forward(&mut imu).0, [0.0, -1.0, 0.0]);
    imu.set_mounting(Mounting::default());
    imu.set_sensitivity(128);
    for index in 1_001..=2_000 {
        imu.on_sample(index * 1_000, &turning);
    }
    let half = std::f64::consts::FRAC_1_SQRT_2;
    near(forward(&mut imu).0, [-half, half, 0.0]);
    // The attitude stays constant while the sensor fails.
    imu.on_error(Error::Bus("gone"));
    assert_eq!(imu.view(EYE, RADIUS), None);
    imu.set_follow(None);
    assert_eq!(imu.view(EYE, RADIUS), None);
}
