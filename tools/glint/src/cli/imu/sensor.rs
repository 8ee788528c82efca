//! `glint imu stream`, `calibrate` and `record`.

use super::source::SensorArguments;
use crate::cli::messages::{print_json, say};
use crate::cli::output::{Output, TABLE};
use crate::cli::progress::{advance, count_bar};
use clap::Args;
use glint::console::Console;
use glint::imu::log::Entry;
use glint::imu::sensor;
use glint_core::calibration::{MOST_SAMPLES, SAMPLES};
use std::path::PathBuf;

/// Stream samples: t_us,ax,ay,az,gx,gy,gz in raw counts.
///
/// The sensor takes 1,000 samples a second. A serial line at 115,200 baud carries about 250 samples a second.
#[derive(Args)]
pub struct StreamArguments {
    /// Number of samples to stream.
    #[arg(long, value_name = "N", default_value_t = 1_000, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES[1])))]
    samples: u32,
    #[command(flatten)]
    sensor: SensorArguments,
}

impl StreamArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let mut board = self.sensor.open()?;
        say(sensor::HEADER)?;
        let mut said = Ok(());
        sensor::stream(
            &mut Console::new(board.as_mut()),
            self.samples,
            &mut |entry| {
                if said.is_ok() {
                    said = say(line(&entry));
                }
            },
        )?;
        said
    }
}

/// Formats a sample as a line of a log: time stamp, accelerometer, gyroscope.
fn line(entry: &Entry) -> String {
    let ([ax, ay, az], [gx, gy, gz]) = (entry.accel, entry.gyro);
    format!("{},{ax},{ay},{az},{gx},{gy},{gz}", entry.t_us)
}

/// Measure the gyroscope's bias at rest. The board stores the bias, and tracks it from then on.
#[derive(Args)]
pub struct CalibrateArguments {
    /// Number of samples to average.
    #[arg(long, value_name = "N", default_value_t = SAMPLES, value_parser = clap::value_parser!(u32).range(i64::from(MOST_SAMPLES[0])..=i64::from(MOST_SAMPLES[1])))]
    samples: u32,
    #[command(flatten)]
    sensor: SensorArguments,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl CalibrateArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let mut board = self.sensor.open()?;
        let bar = count_bar("calibrating", "samples");
        let mut progress = advance(&bar);
        let found = sensor::calibrate(
            &mut Console::new(board.as_mut()),
            self.samples,
            &mut |samples| progress(samples.into(), self.samples.into()),
        )?;
        bar.finish();
        if self.json {
            return print_json(&found);
        }
        let sensor::Calibrated {
            samples,
            bias,
            deviation,
            drift_per_hour,
        } = found;
        say(format_args!(
            "calibrated  {samples} samples\nbias        {bias:.4?} °/s\ndeviation   {deviation:.4?} °/s\ndrift       {drift_per_hour:.1?} °/h expected"
        ))
    }
}

/// Record a board's samples to a log for `glint imu replay`.
///
/// The sensor takes 1,000 samples a second. A serial line at 115,200 baud carries about 250 samples a second, with their time
/// stamps.
#[derive(Args)]
pub struct RecordArguments {
    /// Log to write.
    #[arg(value_name = "LOG.csv")]
    log: PathBuf,
    /// Number of samples to record.
    #[arg(long, value_name = "N", default_value_t = 1_000, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES[1])))]
    samples: u32,
    #[command(flatten)]
    sensor: SensorArguments,
}

impl RecordArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let out = Output::open(&self.log, TABLE, self.sensor.file())?;
        let mut board = self.sensor.open()?;
        let bar = count_bar("recording", "samples");
        let mut progress = advance(&bar);
        let mut entries = Vec::new();
        sensor::stream(
            &mut Console::new(board.as_mut()),
            self.samples,
            &mut |entry| {
                entries.push(entry);
                progress(entries.len() as u64, self.samples.into());
            },
        )?;
        bar.finish();
        out.write(|out| {
            writeln!(out, "{}", sensor::HEADER)?;
            entries
                .iter()
                .try_for_each(|entry| writeln!(out, "{}", line(entry)))
        })?;
        say(format_args!(
            "recorded    {} samples in {:.3} s",
            entries.len(),
            entries.last().map_or(0, |entry| entry.t_us) as f64 / 1e6
        ))
    }
}
