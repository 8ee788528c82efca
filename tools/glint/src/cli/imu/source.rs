//! The two sources of samples: a board's sensor, and a log file.

use crate::cli::common::{LineArguments, Opened};
use crate::cli::config::BoardChoice;
use crate::cli::messages::warn;
use crate::cli::progress::spinner;
use clap::Args;
use glint::board::Board;
use glint::console::Console;
use glint::formats::read_file;
use glint::imu::log::{self, Entry};
use glint::imu::sensor;
use std::path::{Path, PathBuf};

/// Options of a board with a sensor: simulated boards have a virtual MPU-6050.
#[derive(Args)]
pub struct SensorArguments {
    #[command(flatten)]
    board: BoardChoice,
    /// Motion of the virtual sensor: a log of raw counts that starts together with the board
    /// [default: at rest, with noise and bias].
    #[arg(long, value_name = "LOG.csv")]
    sensor: Option<PathBuf>,
    #[command(flatten)]
    line: LineArguments,
}

impl SensorArguments {
    /// The log with the motion of the virtual sensor, if given.
    pub fn file(&self) -> Option<&Path> {
        self.sensor.as_deref()
    }

    /// Opens the board and waits for the first sample of its sensor.
    pub fn open(&self) -> anyhow::Result<Box<dyn Board>> {
        let name = self.board.name()?;
        anyhow::ensure!(
            name.is_simulated() || self.sensor.is_none(),
            "--sensor: expected --board emulated or --board virtual"
        );
        let entries = match &self.sensor {
            None => None,
            Some(path) => Some(read_log(path)?),
        };
        let mut board: Box<dyn Board> = match self.line.open_any(&name)? {
            Opened::Simulated(mut board) => {
                board
                    .inner()
                    .plug(sensor::virtual_sensor(entries.as_deref()));
                Box::new(board)
            }
            Opened::Serial(board) => Box::new(board),
        };
        let spinner = spinner("waiting for the sensor");
        let found = sensor::wait(&mut Console::new(board.as_mut()));
        spinner.finish();
        eprintln!("{}", found?);
        Ok(board)
    }
}

/// Reads and parses the log at `path`. A warning names the ignored columns.
pub fn read_log(path: &Path) -> anyhow::Result<Vec<Entry>> {
    let text = read_file(path)?;
    let log = log::parse(&text).map_err(|error| error.in_path(path))?;
    if !log.ignored.is_empty() {
        warn(format_args!(
            "{}: ignored columns: {}",
            path.display(),
            log.ignored.join(", ")
        ));
    }
    Ok(log.entries)
}
