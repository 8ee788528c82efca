//! Benchmark of the methods that integrate a gyroscope's rates to an attitude: clock cycles per sample.

use core::cell::RefCell;

use glint_core::orientation::{
    Integrator, Quaternion, Sample, Scale, TIME_CONSTANT, Tilt, Tracker, Units, log,
};

use super::measure::{Cycles, Report, measure};
use crate::replay;

/// The time between two samples, in µs.
const STEP: u32 = 5_000;

/// Number of consecutive samples in one measurement. The result of a measurement is the mean number of cycles per sample.
const RUN: u32 = 64;
/// Number of measurements.
const RUNS: usize = 16;

/// Measures the clock cycles of each method, and reports them under the name that `cargo xtask report imu` gives the method.
pub fn attitude(report: Report) {
    let angles = RefCell::new([0_u32; 3]);
    measure(report, "angles", rate, |rate: [i32; 3]| {
        for (angle, rate) in angles.borrow_mut().iter_mut().zip(rate) {
            // A rate of 2^−8 LSB changes the angle in 2^20 µs by 2^32/(16.4·360·256)·2^20/10^6 = 2,980 units of 2^−32
            // turns.
            let turned = (i64::from(rate) * i64::from(STEP) * 2_980) >> 20;
            *angle = angle.wrapping_add(turned as u32);
        }
    });
    let first = RefCell::new([1 << 30, 0, 0, 0]);
    measure(report, "first_order", rate, |rate| {
        first_order(&mut first.borrow_mut(), rate);
    });
    let integrator = || {
        RefCell::new(Integrator::new(
            Scale::MPU_6050,
            Quaternion::IDENTITY,
            [0; 3],
        ))
    };
    let newest = integrator();
    measure(report, "newest", rate, |rate| {
        newest.borrow_mut().advance_order::<1>(rate, STEP, [0; 3]);
    });
    let trapezoid = integrator();
    measure(report, "trapezoid", rate, |rate| {
        trapezoid
            .borrow_mut()
            .advance_order::<2>(rate, STEP, [0; 3]);
    });
    let parabola = integrator();
    measure(report, "parabola", rate, |rate| {
        parabola.borrow_mut().advance_order::<3>(rate, STEP, [0; 3]);
    });
    // Measures the method that the firmware uses, with the code that replays logs.
    let tilt = || Some(Tilt::new(Units::MPU_6050.per_g, TIME_CONSTANT));
    for (name, jitter, tilt) in [
        ("cubic", 0, None),
        ("cubic_jitter", 7, None),
        ("cubic_tilt", 0, tilt()),
        ("cubic_tilt_jitter", 7, tilt()),
    ] {
        let mut tracker = Tracker::new(Scale::MPU_6050, tilt);
        let (mut samples, mut time) = (0_u32, log::START);
        let mut run = || {
            let mut records = [0; RUN as usize].map(|_| {
                samples += 1;
                let phase = samples.wrapping_mul(0x9e37_79b9);
                log::record(&Sample {
                    t_us: u64::from(samples * STEP + (phase & jitter)),
                    accel: [0, 0, 4_096],
                    gyro: rate(phase).map(|rate| (rate >> 8) as i16),
                })
            });
            let cycles =
                riscv::interrupt::free(|| replay::track(&mut tracker, &mut time, &mut records));
            (cycles / u64::from(RUN)) as u32
        };
        // Runs without measurement for the time constant of the tilt correction, because the gain of the correction varies during this
        // time.
        for _ in 0..=TIME_CONSTANT / STEP / RUN {
            run();
        }
        let mut means: [u32; RUNS] = core::array::from_fn(|_| run());
        report(name, Cycles::of(&mut means));
    }
}

/// A slow pseudo-random rate for the measurements, in 1/256 LSB. The mean is so small that the attitude remains almost level.
fn rate(phase: u32) -> [i32; 3] {
    [0, 8, 16].map(|turn| phase.rotate_left(turn).cast_signed() >> 14)
}

/// Integrates one sample with the first-order formula q + ½·q·ω·dt, normalised by one Newton step, with 30 fraction bits.
fn first_order(q: &mut [i32; 4], rate: [i32; 3]) {
    // Half the angle of a rotation at 2^−8 LSB for 2^20 µs: 2^50·π/360/16.4/256/10^6 units of 2^−30 rad.
    const HALF: i64 = 2_340;
    let [x, y, z] = rate.map(|rate| (i64::from(rate) * i64::from(STEP) * HALF) >> 20);
    let [w0, x0, y0, z0] = q.map(i64::from);
    let turned = [
        w0 - ((x0 * x + y0 * y + z0 * z) >> 30),
        x0 + ((w0 * x + y0 * z - z0 * y) >> 30),
        y0 + ((w0 * y - x0 * z + z0 * x) >> 30),
        z0 + ((w0 * z + x0 * y - y0 * x) >> 30),
    ];
    let excess = (1 << 60) - turned.iter().map(|x| x * x).sum::<i64>();
    *q = turned.map(|x| (x + ((x * (excess >> 31)) >> 30)) as i32);
}
