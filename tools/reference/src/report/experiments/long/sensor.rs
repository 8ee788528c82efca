//! A day of the motion sensor on the board: the firmware's attitude against the true attitude.

use std::sync::{Arc, Mutex};
use virtual_board::{Simulation, Uart};

use anyhow::{Context, Result, anyhow};
use glint::console::value as entry;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use virtual_board::virtual_mpu6050::{Chip, Imperfections, Source, State, Wires};

use crate::basis;
use crate::emulated::{Emulated, command, cycles, start, view};
use crate::imu::motion::Motion;
use crate::imu::quaternion::Quaternion;
use crate::report::progress::bar;

/// Start of the motion in s. Before this time the sensor rests and is calibrated.
const BEGIN: f64 = 20.0;
/// Rates of the turning sensor about its axes in °/s: 30 °/s about an oblique axis.
const RATE: [f64; 3] = [10.0, 20.0, -20.0];
/// The sensor's bias in °/s, and the noise of a real sensor in °/s per √Hz (gyroscope) and g per √Hz (accelerometer).
const IMPERFECTIONS: Imperfections = Imperfections {
    bias: [4.5, 0.05, 1.1],
    noise: 0.005,
    accel_noise: 0.0004,
    clock: 0.004,
    ..Imperfections::NONE
};

/// Times of measurements in the first hour, in minutes after [`BEGIN`]; after that hour there is one measurement per hour.
const MINUTES: [f64; 9] = [1.0 / 6.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0];

/// Motion of the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// At rest.
    Rest,
    /// Rotation at 30 °/s about an oblique axis.
    Turning,
}

impl Path {
    /// All motions.
    pub const ALL: [Self; 2] = [Self::Rest, Self::Turning];

    /// Name of the motion in the results and on the progress bar.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Turning => "turning",
        }
    }

    /// The motion from [`BEGIN`] on.
    const fn motion(self) -> Motion {
        match self {
            Self::Rest => Motion::Rest,
            Self::Turning => Motion::Spin(RATE),
        }
    }

    fn state(self, time: f64) -> State {
        let since = time - BEGIN;
        let motion = if since < 0.0 {
            Motion::Rest
        } else {
            self.motion()
        };
        State {
            rate: motion.rate(since).map(f64::to_degrees),
            force: motion.force(since),
            ..State::default()
        }
    }

    fn attitude(self, time: f64) -> Result<Quaternion> {
        let attitude = self.motion().attitude((time - BEGIN).max(0.0));
        attitude.context("the motion has no attitude in closed form")
    }
}

/// Errors of the attitude at a time: a line of `long-rest.csv` or of `long-turning.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Motion of the sensor.
    pub path: String,
    /// Time since the start of the motion, in s.
    pub seconds: f64,
    /// Error of the rotation about the vertical since the start of the motion, in degrees.
    pub heading: f64,
    /// Angle between the true vertical and the vertical of the firmware's attitude, in degrees.
    pub inclination: f64,
    /// Largest error of a length or an angle in the basis of the camera, which the sensor steers.
    pub basis: f64,
    /// Number of samples that the firmware has read.
    pub samples: u64,
    /// Number of the sensor's samples that the firmware has lost.
    pub lost: u64,
    /// Number of gaps of more than half a second in the samples.
    pub gaps: u64,
}

/// Number of stored measurement times. This number exceeds the firmware's largest backlog of samples.
const KNOWN: usize = 64;

/// Number of status polls. At least one of this many polls finds the firmware without a backlog.
const POLLS: u32 = 24;

/// Number of the chip's measurements, and the times of the last [`KNOWN`] measurements.
struct Measured {
    count: u64,
    times: [f64; KNOWN],
}

impl Measured {
    /// Time of a measurement by its number, from 1; `None` if it is no longer stored.
    fn time(&self, number: u64) -> Option<f64> {
        let is_known = number <= self.count && number + KNOWN as u64 > self.count;
        is_known.then(|| self.times[number as usize % KNOWN])
    }
}

/// The board with its sensor, and the sensor's measurements.
struct Bench {
    path: Path,
    board: Emulated,
    measured: Arc<Mutex<Measured>>,
    /// Difference between the number of the chip's measurements and the number of the firmware's samples, at the start.
    ahead: u64,
    /// The rotation about the vertical at the start of the motion.
    heading: f64,
}

/// The firmware's status of the sensor.
struct Status {
    samples: u64,
    gaps: u64,
    attitude: Quaternion,
}

/// Measures the errors over a number of hours.
///
/// # Errors
/// The firmware has not been built, or refuses a command.
pub fn measure(path: Path, hours: f64) -> Result<Vec<Row>> {
    let mut bench = Bench::new(path)?;
    let first = MINUTES.into_iter().map(|minutes| 60.0 * minutes);
    let later = (2..=hours.floor() as u32).map(|hour| 3600.0 * f64::from(hour));
    let times = first.chain(later).filter(|time| *time <= 3600.0 * hours);
    let times: Vec<f64> = times.collect();
    let bar = bar((3600.0 * hours) as u64)?.with_message(path.name());
    let mut rows = Vec::new();
    for time in times {
        bench.run_to(BEGIN + time, &bar);
        rows.push(bench.row(time)?);
    }
    bar.finish_and_clear();
    Ok(rows)
}

impl Bench {
    /// Creates a board with a calibrated sensor, and runs it until one second before the start of the motion.
    fn new(path: Path) -> Result<Self> {
        let mut board = start()?;
        let measured = Arc::new(Mutex::new(Measured {
            count: 0,
            times: [0.0; KNOWN],
        }));
        let notes = measured.clone();
        let motion = move |time: f64| {
            if let Ok(mut notes) = notes.lock() {
                notes.count += 1;
                let place = notes.count as usize % KNOWN;
                notes.times[place] = time;
            }
            path.state(time)
        };
        let chip = Chip::new(Source::Motion(Box::new(motion)), IMPERFECTIONS, 1);
        board.inner().plug(Wires::new(chip));
        let wait = cycles(&mut board, 500);
        board.inner().run(wait);
        command(&mut board, "imu calibrate 4096")?;
        let mut bench = Self {
            path,
            board,
            measured,
            ahead: 0,
            heading: 0.0,
        };
        bench.run_to(BEGIN - 1.0, &ProgressBar::hidden());
        let (Status { attitude, .. }, ahead) = bench.newest()?;
        let [heading, ..] = attitude.angles();
        Ok(Self {
            ahead,
            heading,
            ..bench
        })
    }

    fn run_to(&mut self, seconds: f64, bar: &ProgressBar) {
        let board = self.board.inner();
        let hertz = f64::from(board.clock_hz());
        let end = (seconds * hertz) as u64;
        while board.cycles() < end {
            let second = end.saturating_sub(board.cycles()).min(hertz as u64);
            board.run(second);
            bar.set_position((board.cycles() as f64 / hertz - BEGIN).max(0.0) as u64);
        }
    }

    /// Number of the chip's measurements.
    fn count(&self) -> Result<u64> {
        let measured = self.measured.lock();
        Ok(measured.map_err(|_| anyhow!("the motion panicked"))?.count)
    }

    fn status(&mut self) -> Result<Status> {
        const COMMAND: &str = "imu";
        let lines = command(&mut self.board, COMMAND)?;
        let attitude: String = entry(COMMAND, &lines, "attitude")?;
        let parts = attitude
            .split(' ')
            .map(str::parse)
            .collect::<Result<Vec<f64>, _>>()?;
        let parts = <[f64; 4]>::try_from(parts);
        Ok(Status {
            samples: entry(COMMAND, &lines, "samples")?,
            gaps: entry(COMMAND, &lines, "gaps")?,
            attitude: Quaternion(parts.map_err(|_| anyhow!("{attitude:?}"))?),
        })
    }

    /// Number of the chip's measurements that the samples of a new status do not include.
    fn excess(&self, status: &Status) -> Result<u64> {
        Ok(self.count()?.saturating_sub(status.samples))
    }

    /// Polls the firmware's status [`POLLS`] times. Returns the last status, and the smallest difference between the number of the chip's
    /// measurements and the number of samples in a status. A larger difference includes samples that the firmware has not yet processed.
    fn newest(&mut self) -> Result<(Status, u64)> {
        let mut status = self.status()?;
        let mut ahead = self.excess(&status)?;
        for _ in 1..POLLS {
            let wait = cycles(&mut self.board, 10) / 3;
            self.board.inner().run(wait);
            status = self.status()?;
            ahead = ahead.min(self.excess(&status)?);
        }
        Ok((status, ahead))
    }

    fn row(&mut self, seconds: f64) -> Result<Row> {
        let (status, ahead) = self.newest()?;
        let number = status.samples + ahead;
        let measured = self.measured.lock();
        let time = measured.ok().and_then(|measured| measured.time(number));
        let truth = self
            .path
            .attitude(time.context("the last sample has no time")?)?;
        // Rotation from the true attitude to the firmware's attitude, in world axes.
        let error = status.attitude.times(truth.inverse());
        let [heading, ..] = error.angles();
        let turned = (heading - self.heading).to_degrees();
        Ok(Row {
            path: self.path.name().to_owned(),
            seconds,
            heading: (turned + 180.0).rem_euclid(360.0) - 180.0,
            inclination: status.attitude.inclination_to(truth),
            basis: self.basis()?,
            samples: status.samples,
            lost: ahead.saturating_sub(self.ahead),
            gaps: status.gaps,
        })
    }

    /// Returns the largest error of a length or an angle in the camera's basis while the sensor steers the camera.
    fn basis(&mut self) -> Result<f64> {
        command(&mut self.board, "imu look")?;
        let wait = cycles(&mut self.board, 50);
        self.board.inner().run(wait);
        let [length, angle] = basis::errors(basis::of(&view(&mut self.board)?));
        command(&mut self.board, "imu off")?;
        Ok(length.max(angle))
    }
}
