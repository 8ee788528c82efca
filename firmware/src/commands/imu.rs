//! Commands of the sensor, an MPU-6050: its state, calibration, samples, mounting and sensitivity, and the replay of logs.

use core::fmt::{self, Display};
use core::task::Poll;

use glint_core::choice::OrWord;
use glint_core::console::{ImuAction, ImuCommands};
use glint_core::feature::IMU;
use glint_core::fixed::Q32_32;
use glint_core::mpu6050::degrees_per_second;
use glint_core::orientation::Units;
use glint_core::steering::Mounting;
use glint_core::wire::Manifest;
use glint_program::sensor;

use super::{replay, upload};
use crate::error::CommandError;
use crate::job::{CommandResult, Job, JobResult, Reply, SensorJob};
use crate::machine::Machine;
use crate::transfer::Purpose;

/// Number of samples between two reports of the progress of a calibration.
const PROGRESS: u32 = 1_024;

impl<'l> ImuCommands<'l> for Machine {
    fn imu(&mut self, action: Option<ImuAction>) -> CommandResult<'l> {
        let imu = &mut self.imu;
        match action {
            None => print_status(self),
            Some(ImuAction::Calibrate(samples)) => {
                imu.calibrate(samples);
                let job = SensorJob::Calibrate { reported: 0 };
                return Ok(Reply::After(Job::Sensor(job)));
            }
            Some(ImuAction::Stream(left)) => {
                if let Some(error) = imu.error() {
                    return Err(CommandError::Sensor(error));
                }
                let last = imu.samples();
                self.terminal
                    .print(format_args!("t_us,ax,ay,az,gx,gy,gz\n"));
                let job = SensorJob::Stream { left, last };
                return Ok(Reply::After(Job::Sensor(job)));
            }
            Some(ImuAction::Follow(follow)) => imu.set_follow(follow),
            Some(ImuAction::Recentre) => imu.recentre(),
        }
        Ok(Reply::Done)
    }

    fn mounting(&mut self, mounting: Option<Mounting>) -> CommandResult<'l> {
        match mounting {
            Some(mounting) => self.imu.set_mounting(mounting),
            None => {
                let mounting = self.imu.mounting();
                self.terminal.print_entry("mounting", &mounting);
            }
        }
        Ok(Reply::Done)
    }

    fn sensitivity(&mut self, gain: Option<u16>) -> CommandResult<'l> {
        match gain {
            Some(gain) => self.imu.set_sensitivity(gain),
            None => {
                let gain = Q32_32::from_num(self.imu.sensitivity()) / 256;
                self.terminal.print_entry("sensitivity", &gain);
            }
        }
        Ok(Reply::Done)
    }

    fn replay(&mut self, upload: Option<Manifest>) -> CommandResult<'l> {
        match upload {
            Some(manifest) => upload::begin(self, "replay", Purpose::Log, manifest),
            None => replay::send(self),
        }
    }
}

/// Continues a job of the sensor: reports the progress of a calibration, or prints new samples.
pub fn poll(machine: &mut Machine, job: &mut SensorJob) -> JobResult {
    if !IMU.is_built {
        return Poll::Ready(Ok(Reply::Done));
    }
    let Machine {
        terminal,
        imu,
        uart,
        ..
    } = machine;
    match job {
        SensorJob::Calibrate { reported } => {
            let Some(samples) = imu.calibrated_samples() else {
                return Poll::Ready(match imu.calibration() {
                    Some(Err(error)) => Err(CommandError::Calibration(error)),
                    _ => {
                        print_calibration(machine);
                        Ok(Reply::Done)
                    }
                });
            };
            if samples >= *reported + PROGRESS {
                terminal.print_entry("calibrating", &samples);
                *reported = samples;
            }
        }
        SensorJob::Stream { left: Some(0), .. } => return Poll::Ready(Ok(Reply::Done)),
        SensorJob::Stream { left, last } => {
            if let Some(error) = imu.error() {
                return Poll::Ready(Err(CommandError::Sensor(error)));
            }
            let samples = imu.samples();
            // Prints only the newest sample, after all text has been sent, so that a slow serial line gets fewer samples, and not outdated
            // ones.
            if let Some(sample) = imu.latest()
                && samples != *last
                && uart.has_sent()
            {
                let ([ax, ay, az], [gx, gy, gz]) = (sample.accel, sample.gyro);
                let time = sample.t_us;
                terminal.print(format_args!("{time},{ax},{ay},{az},{gx},{gy},{gz}\n"));
                *left = left.map(|left| left - 1);
                *last = samples;
            }
        }
    }
    Poll::Pending
}

fn print_status(machine: &mut Machine) {
    let Machine { terminal, imu, .. } = machine;
    match imu.identity() {
        Some(identity) => terminal.print_entry("sensor", &identity),
        None => terminal.print_entry("sensor", &"none"),
    }
    match imu.error() {
        Some(error) => terminal.print_entry("failure", &error),
        None => terminal.print_entry("failure", &"none"),
    }
    terminal.print_entry("failures", &imu.errors());
    terminal.print_entry("samples", &imu.samples());
    let [read, tracked] = sensor::cycles().map(|all| all / u64::from(imu.samples().max(1)));
    terminal.print_entry("cycles_read", &read);
    terminal.print_entry("cycles_tracked", &tracked);
    if let Some(temperature) = imu.temperature() {
        let sign = if temperature < 0 { "-" } else { "" };
        let temperature = temperature.unsigned_abs();
        let (whole, part) = (temperature / 100, temperature % 100);
        terminal.print(format_args!("temperature {sign}{whole}.{part:02}\n"));
    }
    let counts = imu.counts();
    terminal.print_entry("saturated", &counts.saturated);
    terminal.print_entry("rejected", &counts.rejected);
    terminal.print_entry("gaps", &counts.gaps);
    terminal.print_entry("stale", &counts.stale);
    let attitude = imu.attitude();
    let [w, x, y, z] = attitude.parts();
    terminal.print(format_args!("attitude {w:.9} {x:.9} {y:.9} {z:.9}\n"));
    let angles = attitude.angles();
    let angles = [angles.yaw, angles.pitch, angles.roll].map(|angle| angle.to_signed_degrees());
    terminal.print_entry("angles", &Vector(angles));
    terminal.print_entry("follow", &OrWord(imu.follow(), "off"));
    print_calibration(machine);
}

fn print_calibration(machine: &mut Machine) {
    let Machine { terminal, imu, .. } = machine;
    match (imu.calibrated_samples(), imu.calibration()) {
        (Some(samples), _) => terminal.print_entry("calibrating", &samples),
        (None, None) => terminal.print_entry("calibrated", &"never"),
        (None, Some(Err(error))) => terminal.print_entry("refused", &error),
        (None, Some(Ok(report))) => {
            terminal.print_entry("calibrated", &report.samples);
            let deviation = Vector(report.deviation.map(|rate| degrees_per_second(rate.into())));
            terminal.print_entry("deviation", &deviation);
            let [x, y, z] = report.drift(Units::MPU_6050);
            terminal.print(format_args!("drift_per_hour {x:.2} {y:.2} {z:.2}\n"));
        }
    }
    terminal.print_entry("bias", &Vector(imu.bias()));
}

/// Displays the three components of a vector with six decimals each.
struct Vector([Q32_32; 3]);

impl Display for Vector {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "{x:.6} {y:.6} {z:.6}")
    }
}
