//! The command `imu`, and what of it goes on after the line.

use core::fmt;

use glint_core::calibration::Units;
use glint_core::console::ImuAction;
use glint_core::fixed::Q32_32;
use glint_core::fixed::fixed::FixedI64;
use glint_core::fixed::fixed::types::extra::U32;
use glint_core::imu::Follow;

use crate::commands::{self, Reply};
use crate::machine::{Job, Machine};
use crate::sensor;

/// Why the sensor was not calibrated.
pub type Refusal = glint_core::imu::Refusal<glint_hal::i2c::BusError>;

/// Why there are no samples.
pub type Failure = glint_core::mpu6050::Error<glint_hal::i2c::BusError>;

/// Samples between two lines of progress of a calibration.
const PROGRESS: u32 = 1_024;

/// A job of the sensor's.
#[derive(Clone, Copy)]
pub enum SensorJob {
    /// Until the calibration has ended; so many samples have been told.
    Calibrate(u32),
    /// So many samples are to be printed, if there is a number; the last one that was.
    Stream(Option<u32>, u32),
}

/// Does what is asked.
pub fn execute<'l>(machine: &mut Machine, action: Option<ImuAction>) -> Reply<'l> {
    let imu = &mut machine.imu;
    match action {
        None => print(machine),
        Some(ImuAction::Calibrate(samples)) => {
            imu.calibrate(samples);
            return Reply::After(Job::Sensor(SensorJob::Calibrate(0)));
        }
        Some(ImuAction::Stream(count)) => {
            if let Some(error) = imu.error() {
                return Reply::Now(Err(commands::Refusal::Sensor(error)));
            }
            let job = SensorJob::Stream(count, imu.samples());
            machine
                .terminal
                .print(format_args!("t_us,ax,ay,az,gx,gy,gz\n"));
            return Reply::After(Job::Sensor(job));
        }
        Some(ImuAction::Follow(follow)) => imu.set_follow(follow),
        Some(ImuAction::Recentre) => imu.recentre(),
    }
    Reply::Now(Ok(()))
}

/// Goes on with a job; how it has ended, if it has.
pub fn pursue(
    machine: &mut Machine,
    job: SensorJob,
) -> Result<SensorJob, Result<(), commands::Refusal<'static>>> {
    let Machine {
        terminal,
        imu,
        uart,
        ..
    } = machine;
    match job {
        SensorJob::Calibrate(told) => {
            let Some(samples) = imu.calibrated_samples() else {
                return Err(match imu.calibration() {
                    Some(Err(refusal)) => Err(commands::Refusal::Calibration(refusal)),
                    _ => {
                        print_calibration(machine);
                        Ok(())
                    }
                });
            };
            if samples < told + PROGRESS {
                return Ok(job);
            }
            terminal.print(format_args!("calibrating {samples}\n"));
            Ok(SensorJob::Calibrate(samples))
        }
        SensorJob::Stream(Some(0), _) => Err(Ok(())),
        SensorJob::Stream(left, last) => {
            if let Some(error) = imu.error() {
                return Err(Err(commands::Refusal::Sensor(error)));
            }
            let (samples, Some(sample)) = (imu.samples(), imu.latest()) else {
                return Ok(job);
            };
            // A slow line gets fewer samples rather than old ones.
            if samples == last || !uart.has_sent() {
                return Ok(job);
            }
            let ([ax, ay, az], [gx, gy, gz]) = (sample.accel, sample.gyro);
            let time = sample.t_us;
            terminal.print(format_args!("{time},{ax},{ay},{az},{gx},{gy},{gz}\n"));
            Ok(SensorJob::Stream(left.map(|left| left - 1), samples))
        }
    }
}

/// Three numbers with six decimals.
struct Three([Q32_32; 3]);

impl fmt::Display for Three {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "{x:.6} {y:.6} {z:.6}")
    }
}

/// A number of 1/256 LSB as °/s.
fn rate(bits: u32) -> Q32_32 {
    // 16.4 LSB are 1 °/s.
    FixedI64::<U32>::from_bits((i64::from(bits) << 24) * 10 / 164)
}

fn print(machine: &mut Machine) {
    let Machine { terminal, imu, .. } = machine;
    match imu.identity() {
        Some(identity) => terminal.print(format_args!("sensor {identity}\n")),
        None => terminal.print(format_args!("sensor none\n")),
    }
    match imu.error() {
        Some(error) => terminal.print(format_args!("failure {error}\n")),
        None => terminal.print(format_args!("failure none\n")),
    }
    terminal.print(format_args!("failures {}\n", imu.errors()));
    terminal.print(format_args!("samples {}\n", imu.samples()));
    let [read, tracked] = sensor::cycles().map(|all| all / u64::from(imu.samples().max(1)));
    terminal.print(format_args!(
        "cycles_read {read}\ncycles_tracked {tracked}\n"
    ));
    if let Some(temperature) = imu.temperature() {
        let sign = if temperature < 0 { "-" } else { "" };
        let temperature = temperature.unsigned_abs();
        let (whole, part) = (temperature / 100, temperature % 100);
        terminal.print(format_args!("temperature {sign}{whole}.{part:02}\n"));
    }
    let counts = imu.counts();
    terminal.print(format_args!("saturated {}\n", counts.saturated));
    terminal.print(format_args!("rejected {}\n", counts.rejected));
    terminal.print(format_args!("gaps {}\n", counts.gaps));
    let attitude = imu.attitude();
    let [w, x, y, z] = attitude.parts();
    terminal.print(format_args!("attitude {w:.9} {x:.9} {y:.9} {z:.9}\n"));
    let angles = attitude.angles();
    let angles = [angles.yaw, angles.pitch, angles.roll].map(|angle| angle.to_signed_degrees());
    terminal.print(format_args!("angles {}\n", Three(angles)));
    let follow = match imu.follow() {
        None => "off",
        Some(Follow::Look) => "look",
        Some(Follow::Orbit) => "orbit",
    };
    terminal.print(format_args!("follow {follow}\n"));
    print_calibration(machine);
}

fn print_calibration(machine: &mut Machine) {
    let Machine { terminal, imu, .. } = machine;
    match (imu.calibrated_samples(), imu.calibration()) {
        (Some(samples), _) => terminal.print(format_args!("calibrating {samples}\n")),
        (None, None) => terminal.print(format_args!("calibrated never\n")),
        (None, Some(Err(refusal))) => terminal.print(format_args!("refused {refusal}\n")),
        (None, Some(Ok(report))) => {
            terminal.print(format_args!("calibrated {}\n", report.samples));
            let deviation = Three(report.deviation.map(rate));
            terminal.print(format_args!("deviation {deviation}\n"));
            let [x, y, z] = report.drift(Units::MPU_6050);
            terminal.print(format_args!("drift_per_hour {x:.2} {y:.2} {z:.2}\n"));
        }
    }
    terminal.print(format_args!("bias {}\n", Three(imu.bias())));
}
