//! `glint imu replay`.

use super::source::read_log;
use crate::cli::common::{TransferArguments, bad_value};
use crate::cli::messages::{print_json, say, warn};
use crate::cli::output::{Output, TABLE};
use crate::cli::progress::{Step, advance, bar, count_bar, spinner};
use clap::Args;
use glint::board::Route;
use glint::board::{Board, ModelOrBoard};
use glint::console::Console;
use glint::error::quote;
use glint::imu::log::Entry;
use glint::imu::replay::{self, Options, Prepared, Replayed, Stage};
use glint::imu::timeline;
use glint_core::calibration::Report;
use glint_core::fixed::{Q2_30, Q32_32};
use glint_core::orientation::{
    Counts, LONGEST_STEP, LSB_PER_DPS, LSB_PER_G, Quaternion, Scale, Units,
};
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Compute the attitudes of a log with the firmware's integer arithmetic.
///
/// LOG.csv has a header with t_us,ax,ay,az,gx,gy,gz and optionally temp, in any order, then one
/// sample a line in raw counts. ORIENTATION.csv gets t_us,w,x,y,z,yaw,pitch,roll for each sample:
/// the quaternion from body to world (z up), and intrinsic z-y-x angles in degrees. The first
/// attitude is the identity; with tilt correction it has yaw 0 and the measured direction of
/// gravity. Samples whose time stamp is not later than the previous time stamp, or does not fit the
/// next time stamps, are ignored. The attitude does not change over a gap of more than half a
/// second or a restart of the clock. A 32-bit clock may wrap.
#[derive(Args)]
pub struct ReplayArguments {
    /// Log to read; `-` is standard input.
    #[arg(value_name = "LOG.csv")]
    log: PathBuf,
    /// Backend: `model` (the firmware's arithmetic on this host), `emulated` (the firmware in an emulator), `virtual` (the
    /// verilated SoC) or a serial port. All backends write identical attitudes.
    #[arg(long, default_value = "model")]
    board: ModelOrBoard,
    /// File to write the attitudes to.
    #[arg(long, value_name = "ORIENTATION.csv")]
    out: PathBuf,
    /// Fixed sample period in microseconds, instead of the time stamps; ORIENTATION.csv contains the time stamps of the log.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(LONGEST_STEP)))]
    dt_us: Option<u32>,
    /// Gyroscope scale in LSB per °/s: 131, 65.5, 32.8, 16.4 for an MPU-6050 at ±250, 500, 1000, 2000 °/s.
    #[arg(long, value_name = "LSB", default_value = "16.4")]
    gyro_lsb: String,
    /// Accelerometer scale in LSB per g: 16384, 8192, 4096, 2048 for an MPU-6050 at ±2, 4, 8, 16 g.
    #[arg(long, value_name = "LSB", default_value = "4096")]
    accel_lsb: String,
    /// Duration of the rest at the start of the log, in seconds. The mean rate during this time is
    /// the gyroscope's bias; motion during this time is an error. 0 disables the measurement of the
    /// bias.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    still: Option<String>,
    /// Disable tilt correction by the accelerometer.
    #[arg(long)]
    no_tilt: bool,
    /// Track the gyroscope's bias whenever the sensor is at rest.
    #[arg(long)]
    follow_bias: bool,
    #[command(flatten)]
    transfer: TransferArguments,
}

/// The summary of a replay, in the form that the command prints.
#[derive(Serialize)]
struct Summary<'a> {
    log: &'a Path,
    out: &'a Path,
    samples: usize,
    seconds: f64,
    steps: u64,
    stale: u64,
    gaps: u64,
    saturated: u64,
    rejected: u64,
    /// Mean number of cycles of a sample on a board.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycles_per_sample: Option<u64>,
    calibration: Option<Calibrated>,
    end: Attitude,
}

/// The result of a calibration, in the form that the command prints: bias and deviation in LSB of the gyroscope, drift in °/h.
#[derive(Serialize)]
struct Calibrated {
    samples: u32,
    bias: [f64; 3],
    deviation: [f64; 3],
    drift: [f64; 3],
}

impl Calibrated {
    fn new(report: &Report, units: Units) -> Self {
        Self {
            samples: report.samples,
            bias: report.bias.map(|x| f64::from(x) / 256.0),
            deviation: report.deviation.map(|x| f64::from(x) / 256.0),
            drift: report.drift(units).map(Q32_32::to_num),
        }
    }
}

/// An attitude in the units of ORIENTATION.csv.
#[derive(Serialize)]
struct Attitude {
    w: f64,
    x: f64,
    y: f64,
    z: f64,
    yaw: f64,
    pitch: f64,
    roll: f64,
}

impl From<Quaternion> for Attitude {
    fn from(quaternion: Quaternion) -> Self {
        let [w, x, y, z] = quaternion.parts().map(Q2_30::to_num);
        let angles = quaternion.angles();
        let [yaw, pitch, roll] =
            [angles.yaw, angles.pitch, angles.roll].map(|angle| angle.to_signed_degrees().to_num());
        Self {
            w,
            x,
            y,
            z,
            yaw,
            pitch,
            roll,
        }
    }
}

impl ReplayArguments {
    pub fn run(self) -> anyhow::Result<()> {
        self.transfer.check(&self.board, None)?;
        let options = self.options()?;
        let out = Output::open(&self.out, TABLE, [&self.log])?;
        let entries = read_log(&self.log)?;
        let prepared = replay::prepare(&entries, &options).map_err(|error| match error {
            replay::Error::Still(error) => error.in_path(&self.log).into(),
            replay::Error::Log(_)
            | replay::Error::Transfer(_)
            | replay::Error::Console(_)
            | replay::Error::Attitude(_) => anyhow::Error::from(error),
        })?;
        let replayed = self.replay(prepared)?;
        out.write(|out| write(out, &entries, &replayed.attitudes))?;
        self.report(&entries, &replayed, options.units)
    }

    fn replay(&self, prepared: Prepared) -> anyhow::Result<Replayed> {
        match &self.board {
            ModelOrBoard::Model => {
                let spinner = spinner("replaying");
                let replayed = replay::on_model(prepared)?;
                spinner.finish();
                Ok(replayed)
            }
            ModelOrBoard::Board(name) => {
                let mut board = self.transfer.line.board(name)?;
                self.on_board(&prepared, &mut *board, Route::of(name))
            }
        }
    }

    fn on_board(
        &self,
        prepared: &Prepared,
        board: &mut dyn Board,
        route: Route,
    ) -> anyhow::Result<Replayed> {
        let bars = [bar("log and attitudes"), count_bar("replaying", "samples")];
        let mut stage = Stage::Transfer;
        let mut progress = |now, done, all| {
            let [transfer, replay] = &bars;
            let bar = match now {
                Stage::Transfer => transfer,
                Stage::Replay => replay,
            };
            if now != stage {
                // Resetting both progress bars leaves only the bar of the new stage visible.
                bars.iter().for_each(Step::reset);
                stage = now;
            }
            advance(bar)(done, all);
        };
        let route = self.transfer.transfer.unwrap_or(route);
        let replayed = replay::on_board(prepared, &mut Console::new(board), route, &mut progress)?;
        bars.iter().for_each(Step::finish);
        Ok(replayed)
    }

    fn options(&self) -> anyhow::Result<Options> {
        let gyro = Q32_32::from_str(&self.gyro_lsb).ok();
        let per_dps = gyro
            .filter(|&lsb| Scale::new(lsb).is_some())
            .ok_or_else(|| {
                let [low, high] = LSB_PER_DPS;
                let expected = format!("a number of LSB per °/s from {low} to {high}");
                bad_value("--gyro-lsb", &expected, quote(self.gyro_lsb.as_bytes()))
            })?;
        let accel = self.accel_lsb.parse::<u32>().ok();
        let [low, high] = LSB_PER_G;
        let per_g = accel
            .filter(|lsb| (low..=high).contains(lsb))
            .ok_or_else(|| {
                let expected = format!("a whole number of LSB per g from {low} to {high}");
                bad_value("--accel-lsb", &expected, quote(self.accel_lsb.as_bytes()))
            })?;
        let still = match &self.still {
            None => None,
            Some(text) => {
                let seconds = text.parse::<f64>().ok();
                let seconds = seconds.filter(|seconds| (0.0..=86_400.0).contains(seconds));
                let seconds = seconds.ok_or_else(|| {
                    let expected = "a number of seconds from 0 to 86400";
                    bad_value("--still", expected, quote(text.as_bytes()))
                })?;
                Some((seconds * 1e6) as u64).filter(|still| *still > 0)
            }
        };
        Ok(Options {
            units: Units { per_dps, per_g },
            period: self.dt_us,
            still,
            tilt: !self.no_tilt,
            follow_bias: self.follow_bias,
        })
    }

    /// Warns of gaps, and of samples that were ignored because of their time stamps.
    fn warn(&self, counts: &Counts) {
        let log = self.log.display();
        if counts.stale > 0 {
            warn(format_args!(
                "{log}: ignored samples: {}, with time stamps that are not later than the previous one, or do not fit the next ones",
                counts.stale
            ));
        }
        if counts.gaps > 0 {
            warn(format_args!(
                "{log}: gaps: {}, each a restart of the time stamps or a step of more than half a second; the attitude is kept across each gap",
                counts.gaps
            ));
        }
    }

    fn report(&self, entries: &[Entry], replayed: &Replayed, units: Units) -> anyhow::Result<()> {
        let Replayed {
            attitudes,
            counts,
            calibration,
            cycles,
        } = replayed;
        let seconds = match self.dt_us {
            Some(period) => f64::from(period) * (entries.len() - 1) as f64,
            None => timeline::times(entries).last().copied().unwrap_or(0) as f64,
        } / 1e6;
        self.warn(counts);
        let summary = Summary {
            log: &self.log,
            out: &self.out,
            samples: entries.len(),
            seconds,
            steps: counts.steps,
            stale: counts.stale,
            gaps: counts.gaps,
            saturated: counts.saturated,
            rejected: counts.rejected,
            cycles_per_sample: *cycles,
            calibration: calibration
                .as_ref()
                .map(|report| Calibrated::new(report, units)),
            end: attitudes
                .last()
                .copied()
                .unwrap_or(Quaternion::IDENTITY)
                .into(),
        };
        if self.transfer.json {
            return print_json(&summary);
        }
        say(format_args!(
            "samples     {} in {:.3} s: {} steps, {} stale, {} gaps, {} saturated, {} without tilt correction",
            summary.samples,
            summary.seconds,
            summary.steps,
            summary.stale,
            summary.gaps,
            summary.saturated,
            summary.rejected
        ))?;
        if let Some(cycles) = summary.cycles_per_sample {
            say(format_args!("cycles      {cycles} a sample"))?;
        }
        if let Some(Calibrated {
            samples,
            bias,
            deviation,
            drift,
        }) = &summary.calibration
        {
            say(format_args!(
                "calibration {samples} samples: bias {bias:.2?} LSB, deviation {deviation:.2?} LSB, expected drift {drift:.1?} °/h",
            ))?;
        }
        let Attitude {
            yaw, pitch, roll, ..
        } = summary.end;
        say(format_args!(
            "end         yaw {yaw:.3}°, pitch {pitch:.3}°, roll {roll:.3}°"
        ))
    }
}

fn write(out: &mut dyn Write, entries: &[Entry], attitudes: &[Quaternion]) -> std::io::Result<()> {
    writeln!(out, "t_us,w,x,y,z,yaw,pitch,roll")?;
    for (entry, &attitude) in entries.iter().zip(attitudes) {
        let Attitude {
            w,
            x,
            y,
            z,
            yaw,
            pitch,
            roll,
        } = attitude.into();
        writeln!(
            out,
            "{},{w:.10},{x:.10},{y:.10},{z:.10},{yaw:.7},{pitch:.7},{roll:.7}",
            entry.t_us
        )?;
    }
    Ok(())
}
