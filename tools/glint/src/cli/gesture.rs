//! `glint gesture`.

use super::common::{LineArguments, Opened, named};
use super::config::BoardChoice;
use super::messages::say;
use super::output::{Output, PICTURE};
use super::progress::{advance, bar, spinner};
use anyhow::Context;
use clap::{Args, Subcommand};
use glint::board::Board;
use glint::console::Console;
use glint::gesture::{self, SensorFault};
use std::path::PathBuf;
use virtual_board::virtual_image_sensor::{ImageSensor, Images, Source};

/// Size of the synthetic hand's frames in pixels: the frame size for which the firmware sets up the
/// sensor.
const SIZE: [usize; 2] = [320, 240];

/// Show the mask of the hand in front of the image sensor.
#[derive(Subcommand)]
pub enum GestureCommand {
    Mask(MaskArguments),
}

impl GestureCommand {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Mask(arguments) => arguments.run(),
        }
    }
}

/// Options of a board with an image sensor: simulated boards have a virtual OV7670.
#[derive(Args)]
struct SensorArguments {
    #[command(flatten)]
    board: BoardChoice,
    /// Pictures that the virtual image sensor sends in turn, as if it had taken them: a folder of
    /// PNG files of 320x240 pixels [default: a synthetic moving hand].
    #[arg(long, value_name = "FOLDER")]
    pictures: Option<PathBuf>,
    /// Fault of the virtual image sensor to simulate.
    #[arg(long, value_parser = named(SensorFault::ALL, SensorFault::name))]
    fault: Option<SensorFault>,
    #[command(flatten)]
    line: LineArguments,
}

impl SensorArguments {
    /// The picture files of the virtual image sensor.
    fn files(&self) -> anyhow::Result<Vec<PathBuf>> {
        let Some(folder) = &self.pictures else {
            return Ok(Vec::new());
        };
        let files = folder
            .read_dir()
            .and_then(|files| files.map(|file| Ok(file?.path())).collect());
        files.with_context(|| folder.display().to_string())
    }

    fn sensor(&self) -> anyhow::Result<ImageSensor> {
        let source: Box<dyn Source> = match &self.pictures {
            None => Box::new(gesture::moving_hand(SIZE)),
            Some(folder) => Box::new(Images::read(folder)?),
        };
        let mut sensor = gesture::image_sensor(source);
        if let Some(fault) = self.fault {
            fault.apply(&mut sensor, SIZE[1] / 2);
        }
        Ok(sensor)
    }

    fn open(&self) -> anyhow::Result<Box<dyn Board>> {
        Ok(match self.line.open_any(&self.board.name()?)? {
            Opened::Simulated(mut board) => {
                board.inner().plug_image_sensor(self.sensor()?);
                Box::new(board)
            }
            Opened::Serial(board) => {
                anyhow::ensure!(
                    self.pictures.is_none() && self.fault.is_none(),
                    "--pictures and --fault: expected --board emulated or --board virtual"
                );
                Box::new(board)
            }
        })
    }
}

/// Set up the image sensor, and write a picture that marks the pixels of its next frame that have
/// the hand's colour.
#[derive(Args)]
pub struct MaskArguments {
    #[command(flatten)]
    sensor: SensorArguments,
    /// Picture to write (.png), white where a pixel has the hand's colour.
    #[arg(long, value_name = "FILE.png")]
    out: PathBuf,
}

impl MaskArguments {
    fn run(self) -> anyhow::Result<()> {
        let out = Output::open(&self.out, PICTURE, self.sensor.files()?)?;
        let mut board = self.sensor.open()?;
        let spinner = spinner("the image sensor is set up");
        let bar = bar("mask");
        let mask = gesture::mask(&mut Console::new(board.as_mut()), &mut advance(&bar));
        spinner.finish();
        bar.finish();
        let mask = mask.context("mask")?;
        out.write(|out| mask.write(out))?;
        let marked: u32 = mask.bits.iter().map(|byte| byte.count_ones()).sum();
        say(format_args!(
            "{}x{} pixels, {marked} of the hand's colour",
            mask.width, mask.height
        ))
    }
}
