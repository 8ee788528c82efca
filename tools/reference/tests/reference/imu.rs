//! Compares the firmware's attitude with the same method in f64, and both with the true attitude.
//!
//! With `GLINT_IMU=long`, long motions have their full duration of an hour each.

use glint_core::orientation;
use glint_core::orientation::Units;
use glint_reference::imu::measure::{
    Largest, against_f64, calibrated, inclination, method_error, yaw_drift,
};
use glint_reference::imu::method::{Integrator, Method};
use glint_reference::imu::motion::Motion;
use glint_reference::imu::quaternion::Quaternion;
use glint_reference::imu::sensor::Sensor;

/// Returns the duration of a motion in seconds: `whole` with `GLINT_IMU=long`, otherwise `part`.
fn seconds(whole: f64, part: f64) -> f64 {
    if std::env::var("GLINT_IMU").is_ok_and(|value| value == "long") {
        whole
    } else {
        part
    }
}

#[test]
fn the_firmware_is_its_method_in_f64() {
    let uneven = Sensor {
        jitter: 0.3,
        lost: 0.01,
        ..Sensor::real(200.0)
    };
    let spin = Motion::Spin([0.0, 0.0, 1990.0]);
    for (sensor, motion, seconds, most) in [
        (Sensor::real(1000.0), Motion::Hand, 190.0, 1e-3),
        (Sensor::real(50.0), Motion::Nod, 190.0, 1e-3),
        (uneven, Motion::Walk, 190.0, 1e-3),
        (Sensor::ideal(1000.0), spin, seconds(3600.0, 60.0), 0.04),
    ] {
        for tilt in [false, true] {
            let Largest { angle: error, norm } = against_f64(sensor, motion, seconds, tilt);
            println!(
                "{motion:?} at {} Hz, {seconds} s, tilt {tilt}: {error:.1e}°, norm {norm:.1e}",
                sensor.rate
            );
            assert!(error <= most, "{motion:?}: {error:e}");
            assert!(norm <= 2e-9, "{motion:?}: {norm:e}");
        }
    }
    let tumble = Motion::Tumble(500.0);
    let Largest { angle: error, norm } =
        against_f64(Sensor::ideal(1000.0), tumble, seconds(3600.0, 60.0), false);
    println!("{tumble:?}: {error:.1e}°, norm {norm:.1e}");
    assert!(error <= 0.002 && norm <= 2e-9, "{error:e} {norm:e}");
}

/// Measures the largest error of the firmware's integration of order `ORDER` against `method` in f64, in degrees.
fn order_against_f64<const ORDER: u32>(method: Method) -> f64 {
    let sensor = Sensor::ideal(200.0);
    let rate = |gyro: [i16; 3]| gyro.map(|x| (f64::from(x) / sensor.gyro_lsb).to_radians());
    let mut samples = sensor.samples(Motion::Tumble(700.0), 4_000, 1);
    let first = samples.next().expect("a sample").gyro;
    let mut firmware = orientation::Integrator::new(
        orientation::Scale::MPU_6050,
        orientation::Quaternion::IDENTITY,
        first.map(|x| i32::from(x) << 8),
    );
    let mut reference = Integrator::new(method, Quaternion::IDENTITY, rate(first));
    let mut largest = 0.0_f64;
    for sample in samples {
        firmware.advance_order::<ORDER>(sample.gyro.map(|x| i32::from(x) << 8), 5_000, [0; 3]);
        reference.advance(rate(sample.gyro), 5e-3);
        let attitude = Quaternion::from(firmware.attitude());
        largest = largest.max(attitude.angle_to(reference.attitude()));
    }
    largest
}

#[test]
fn each_order_is_its_method_in_f64() {
    for (order, error) in [
        (1, order_against_f64::<1>(Method::Newest)),
        (2, order_against_f64::<2>(Method::Trapezoid)),
        (3, order_against_f64::<3>(Method::Parabola)),
        (4, order_against_f64::<4>(Method::Cubic)),
    ] {
        println!("order {order}: {error:.1e}°");
        assert!(error <= 1e-3, "order {order}: {error:e}");
    }
}

const CONING: Motion = Motion::Coning {
    angle: 5.0,
    frequency: 10.0,
};

/// Each method must have its known order. The cubic is of order 4 only after its first steps, which have too few samples. In the
/// tumble, the errors of these first steps are of order 3 and dominate.
#[test]
fn orders_are_those_of_the_methods() {
    let tumble = Motion::Tumble(700.0);
    for (method, order) in [
        (Method::FirstOrder, 1.0),
        (Method::Newest, 1.0),
        (Method::Trapezoid, 2.0),
        (Method::Coning, 2.0),
        (Method::Parabola, 3.0),
        (Method::PlainCubic, 3.0),
        (Method::Cubic, 3.0),
    ] {
        let [slow, fast] = [400.0, 800.0].map(|rate| method_error(method, tumble, 5.0, rate));
        let observed = (slow / fast).log2();
        println!(
            "{}: {slow:.1e}°, {fast:.1e}°, order {observed:.2}",
            method.name()
        );
        assert!((observed - order).abs() < 0.4, "{method:?}: {observed}");
    }
    let [slow, fast] =
        [100.0, 200.0].map(|rate| method_error(Method::PlainCubic, CONING, 20.0, rate));
    let observed = (slow / fast).log2();
    println!("plain cubic, coning: order {observed:.2}");
    assert!((observed - 4.0).abs() < 0.4, "{observed}");
    // Integration of the angles does not converge, because the rates about the body's axes are not the derivatives of yaw, pitch and roll.
    assert!(method_error(Method::Angles, Motion::Tumble(700.0), 20.0, 1000.0) > 10.0);
}

#[test]
fn the_tilt_holds_in_a_hand_and_at_a_walk() {
    for rate in [200.0, 1000.0] {
        for motion in [Motion::Rest, Motion::Hand, Motion::Nod, Motion::Walk] {
            let rms = inclination(Sensor::real(rate), motion, 60.0).rms();
            println!("{motion:?} at {rate} Hz: {rms:.2}° RMS");
            assert!(rms <= 1.0, "{motion:?}: {rms}");
        }
    }
}

#[test]
fn yaw_stays_after_calibration() {
    let sensor = Sensor::real(1000.0);
    let report = calibrated(sensor, Motion::Rest).expect("at rest");
    let hours = seconds(3600.0, 360.0) / 3600.0;
    let [held, followed] = [false, true].map(|follow| yaw_drift(sensor, &report, hours, follow));
    let expected: f64 = report.drift(Units::MPU_6050)[2].to_num();
    println!("expected ±{expected:.1}°/h, held {held:.1}°/h, followed {followed:.1}°/h");
    assert!(
        held.abs() <= 10.0 && followed.abs() <= 10.0,
        "{held} {followed}"
    );
    assert!(calibrated(sensor, Motion::Hand).is_err());
}
