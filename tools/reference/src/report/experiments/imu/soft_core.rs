//! Experiment: the attitude on the soft core. Measures the cycles per sample, and compares each attitude bit for bit with the
//! same code on the host.

use anyhow::{Context, Result, ensure};
use glint::board::{self, Board, Route, built_firmware};
use glint::console::Console;
use glint::imu::log::Entry;
use glint::imu::replay::{self, Options, Stage};
use glint_core::orientation::Units;
use serde::{Deserialize, Serialize};

use crate::imu::motion::Motion;
use crate::imu::sensor::Sensor;
use crate::report::cycles::{Cycles, Source};
use crate::report::progress;

/// The kernels of the firmware's integration. Each entry contains the kernel's name in the console command `bench attitude`, its
/// description, and the required upper bound and the goal in cycles per sample.
const KERNELS: [(&str, &str, u64, u64); 4] = [
    ("cubic", "integration, even steps", 800, 500),
    ("cubic_jitter", "integration, uneven steps", 800, 500),
    ("cubic_tilt", "with tilt, even steps", 2_000, 1_200),
    ("cubic_tilt_jitter", "with tilt, uneven steps", 2_000, 1_200),
];

/// Cycles of a kernel of the firmware: a line of `imu-cycles.csv`. Figures are in cycles per sample.
#[derive(Serialize, Deserialize)]
pub struct Kernel {
    /// Description of the kernel and of its samples.
    pub what: String,
    /// Required upper bound of the cycles per sample.
    pub at_least: u64,
    /// Goal for the cycles per sample, below the required bound.
    pub aim: u64,
    /// Median of the cycles per sample, over the measured runs.
    pub median: u64,
    /// Cycles per sample of the slowest measured run.
    pub max: u64,
}

/// Result of the replay of a long motion on a board: a line of `imu-replay.csv`.
#[derive(Serialize, Deserialize)]
pub struct Replay {
    /// The board: `virtual` or `emulated`.
    pub board: String,
    /// Number of replayed samples.
    pub samples: u64,
    /// Number of samples after which the attitudes of board and host differ in any bit.
    pub differing: usize,
    /// Mean cycles per sample on the virtual board; `None` for the emulated board, whose cycles are estimates.
    pub cycles: Option<u64>,
}

/// Makes the rows of the firmware's kernels from `cycles`, the result of the console command `bench attitude`.
///
/// # Errors
/// When a kernel is missing in `cycles`.
pub fn kernels(cycles: &Cycles) -> Result<Vec<Kernel>> {
    let kernel = |(name, what, at_least, aim): (&str, &str, u64, u64)| {
        let figures = cycles
            .get(name)
            .with_context(|| format!("expected {name} in `bench attitude`"))?;
        Ok(Kernel {
            what: what.to_owned(),
            at_least,
            aim,
            median: figures.median,
            max: figures.max,
        })
    };
    KERNELS.into_iter().map(kernel).collect()
}

/// Replays a hand motion of `samples` samples at 1 kHz on the emulated board, and the first tenth of this motion on the virtual board,
/// whose cycles are exact but whose simulation takes minutes.
///
/// # Errors
/// When the virtual board is not built or a replay fails.
pub fn replays(source: &Source, samples: u64) -> Result<[Replay; 2]> {
    let firmware = built_firmware(Some(&source.firmware()))?;
    let verilated = replay("virtual", board::verilated(&firmware)?, samples / 10)?;
    ensure!(verilated.cycles.is_some(), "no cycles in the reply");
    let emulated = replay("emulated", board::emulated(&firmware)?, samples)?;
    Ok([
        verilated,
        Replay {
            cycles: None,
            ..emulated
        },
    ])
}

/// Replays a hand motion at 1 kHz on a board and on the host. Tilt correction and bias tracking are on.
fn replay(name: &str, mut board: impl Board, samples: u64) -> Result<Replay> {
    let counts = Sensor::real(1000.0).samples(Motion::Hand, samples, 1);
    let entries: Vec<Entry> = counts
        .map(|sample| Entry {
            line: 0,
            t_us: sample.t_us,
            accel: sample.accel,
            gyro: sample.gyro,
            temp: None,
        })
        .collect();
    let options = Options {
        units: Units::MPU_6050,
        period: None,
        still: None,
        tilt: true,
        follow_bias: true,
    };
    let prepared = replay::prepare(&entries, &options)?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let bar = progress::bar(samples)?;
    bar.set_message(format!("samples on the {name} board"));
    let by_board = replay::on_board(
        &prepared,
        &mut console,
        Route::Memory,
        &mut |stage, done, _| {
            if stage == Stage::Replay {
                bar.set_position(done);
            }
        },
    )?;
    bar.finish_and_clear();
    let by_model = replay::on_model(prepared)?;
    let pairs = by_board.attitudes.iter().zip(&by_model.attitudes);
    Ok(Replay {
        board: name.to_owned(),
        samples,
        differing: pairs.filter(|(board, model)| board != model).count(),
        cycles: by_board.cycles,
    })
}
