//! `glint imu`.

mod replay;
mod sensor;
mod source;

use clap::Subcommand;
use replay::ReplayArguments;
use sensor::{CalibrateArguments, RecordArguments, StreamArguments};

/// Stream, calibrate, record and replay gyroscope and accelerometer data.
#[derive(Subcommand)]
pub enum ImuCommand {
    Stream(StreamArguments),
    Calibrate(CalibrateArguments),
    Record(RecordArguments),
    Replay(ReplayArguments),
}

impl ImuCommand {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Stream(arguments) => arguments.run(),
            Self::Calibrate(arguments) => arguments.run(),
            Self::Record(arguments) => arguments.run(),
            Self::Replay(arguments) => arguments.run(),
        }
    }
}
