//! Options that several commands share, and their access to boards.

use super::config;
use super::loading::Loading;
use super::progress::{show_simulation, spinner};
use anyhow::Context;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glint::board::{
    self, AnyBoard, Board, BoardName, ModelOrBoard, Route, SerialBoard, built_firmware,
};
use glint::console::Console;
use glint::error::{FormatError, InputError, quote};
use glint::program::{self, Program};
use glint::render::BoardRenderer;
use glint::scene::Changes;
use glint_core::colour::Shading;
use glint_core::picture::{Backend, Samples, Size};
use glint_core::quality::Quality;
use glint_live_page::Places;
use glint_scene::{Defaults, Scene};
use std::path::PathBuf;

/// Quality and size of pictures.
#[derive(clap::Args)]
pub struct SizeArguments {
    /// Quality: `fast` (320x180, one sample a pixel), `balanced` (640x360) or `exact` (1280x720, four samples a pixel). It also sets the
    /// precision of the rays of a field [default: the scene's; without a scene, 1280x720 with the precision of `balanced`].
    #[arg(long, value_parser = named(Quality::ALL, Quality::name))]
    quality: Option<Quality>,
    /// Size of the picture: 320x180, 640x360 or 1280x720; overrides the size of the quality.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Antialiasing: number of samples whose average is a pixel [default: the quality's or the scene's; otherwise 4, but 1
    /// with --depth and for the soft core].
    #[arg(long, value_parser = named(Samples::ALL, Samples::name))]
    aa: Option<Samples>,
}

impl SizeArguments {
    /// The options as changes of a scene.
    pub fn changes(&self) -> anyhow::Result<Changes> {
        Ok(Changes {
            quality: self.quality,
            size: self.size.as_deref().map(size).transpose()?,
            samples: self.aa,
            ..Changes::default()
        })
    }

    /// The start scene with these options.
    pub fn scene(&self, defaults: Defaults) -> anyhow::Result<Scene> {
        let size = self.changes()?.size;
        let preset = self.quality.map(Quality::preset);
        Ok(Scene {
            quality: self.quality.unwrap_or_default(),
            size: size
                .or(preset.map(|preset| preset.size))
                .unwrap_or(defaults.size),
            fixed_samples: (self.aa)
                .or(preset.and_then(|preset| preset.samples))
                .or(Some(defaults.samples)),
            ..Scene::new(defaults)?
        })
    }
}

/// The speed of a serial port.
#[derive(clap::Args)]
pub struct Baud {
    /// Baud rate of a serial port, in bits per second [default: from GLINT_BAUD or the configuration file, otherwise 115200].
    #[arg(long, value_name = "BITS")]
    baud: Option<u32>,
}

impl Baud {
    /// The baud rate.
    ///
    /// # Errors
    /// The value is not a baud rate, or the configuration file is damaged.
    pub fn rate(&self) -> anyhow::Result<u32> {
        config::baud(self.baud)
    }

    /// Rejects the option for a board that is not on a serial port.
    pub fn check(&self, name: &BoardName) -> Result<(), InputError> {
        if self.baud.is_some() && name.is_simulated() {
            return Err(bad_value(
                "--baud",
                "a serial port",
                format!("--board {name}"),
            ));
        }
        Ok(())
    }
}

/// Options of the connection to a board.
#[derive(clap::Args)]
pub struct LineArguments {
    #[command(flatten)]
    pub baud: Baud,
    /// Program of the board, an ELF file or a flat binary: a simulated board starts with it, and the BIOS of a board on a serial port loads
    /// it [default: the firmware of `cargo xtask firmware`; of a serial port, the program that runs].
    #[arg(long, value_name = "FILE")]
    pub firmware: Option<PathBuf>,
}

impl LineArguments {
    /// Opens a board on a serial port, and cancels an unfinished command or transfer of an earlier program.
    pub fn serial_board(&self, port: &str) -> anyhow::Result<SerialBoard> {
        let mut board = self.loaded(port)?.board;
        let spinner = spinner("waiting for the board");
        Console::new(&mut board).synchronise()?;
        spinner.finish();
        Ok(board)
    }

    /// Opens a serial port. The firmware of its board may not be running yet.
    ///
    /// # Errors
    /// The port cannot be opened.
    pub fn open(&self, port: &str) -> anyhow::Result<SerialBoard> {
        Ok(SerialBoard::open(port, self.baud.rate()?)?)
    }

    /// Opens a serial port, and loads the program of `--firmware`, if it is given.
    ///
    /// # Errors
    /// The port cannot be opened, or the program cannot be read or loaded.
    pub fn loaded(&self, port: &str) -> anyhow::Result<Unsynchronised<SerialBoard>> {
        let program = self.firmware.as_deref().map(program::read).transpose()?;
        let mut board = self.open(port)?;
        let (said, places) = match program {
            Some(Program { image, places }) => {
                let report = Loading::USUAL.load(&mut board, &image)?;
                (Some(report.said), places)
            }
            None => Default::default(),
        };
        Ok(Unsynchronised {
            board,
            places,
            said,
        })
    }

    /// Opens the board `name`. Its firmware may not be running yet, and its program may have no prompt.
    pub fn unsynchronised_board(
        &self,
        name: &BoardName,
    ) -> anyhow::Result<Unsynchronised<Box<dyn Board>>> {
        if let BoardName::Serial(port) = name {
            let loaded = self.loaded(port)?;
            return Ok(Unsynchronised {
                board: Box::new(loaded.board),
                places: loaded.places,
                said: loaded.said,
            });
        }
        self.baud.check(name)?;
        let (board, places) = self.start(name)?;
        Ok(Unsynchronised {
            board: Box::new(board),
            places,
            said: None,
        })
    }

    /// Opens the board `name`. A simulated board is started, and runs its firmware.
    pub fn board(&self, name: &BoardName) -> anyhow::Result<Box<dyn Board>> {
        Ok(match self.open_any(name)? {
            Opened::Simulated(board) => Box::new(board),
            Opened::Serial(board) => Box::new(board),
        })
    }

    /// Starts the simulated board `name`. The program runs when the board's serial line is read. It may be a program without a prompt.
    /// Returns the board, and the source locations of the program.
    pub fn start(&self, name: &BoardName) -> anyhow::Result<(AnyBoard, Places)> {
        self.start_by(|image| {
            let board = board::simulated(name, Some(image))?;
            board.context("expected a simulated board")
        })
    }

    /// Starts a board that `build` makes from the image of its program, like [`start`](Self::start).
    pub fn start_by(
        &self,
        build: impl FnOnce(&[u8]) -> anyhow::Result<AnyBoard>,
    ) -> anyhow::Result<(AnyBoard, Places)> {
        let (image, places) = match &self.firmware {
            Some(path) => {
                let Program { image, places } = program::read(path)?;
                (image, places)
            }
            None => (built_firmware(None)?, Places::default()),
        };
        let board = build(&image)?;
        show_simulation(board.meter());
        Ok((board, places))
    }

    /// Opens the board `name` like [`board`](Self::board), but returns the board's type too.
    pub fn open_any(&self, name: &BoardName) -> anyhow::Result<Opened> {
        if let BoardName::Serial(port) = name {
            return Ok(Opened::Serial(self.serial_board(port)?));
        }
        self.baud.check(name)?;
        let (mut board, _) = self.start(name)?;
        let _starting = spinner("the board starts");
        Console::new(&mut board).greet()?;
        Ok(Opened::Simulated(board))
    }
}

/// A board whose program may not wait for a command.
pub struct Unsynchronised<B> {
    pub board: B,
    /// The source locations of the program of `--firmware`.
    pub places: Places,
    /// The output of the BIOS and the program so far; `None` if no program was loaded.
    pub said: Option<Vec<u8>>,
}

/// A board whose firmware waits for a command.
pub enum Opened {
    Simulated(AnyBoard),
    Serial(SerialBoard),
}

/// Options of a command that transfers data to or from a board, and prints a result.
#[derive(clap::Args)]
pub struct TransferArguments {
    /// Route of the data to and from a board [default: memory for the emulated and the virtual board, serial for a board on a serial port].
    #[arg(long, value_enum)]
    pub transfer: Option<Route>,
    #[command(flatten)]
    pub line: LineArguments,
    /// Print the result as JSON.
    #[arg(long)]
    pub json: bool,
}

impl TransferArguments {
    /// Rejects board options if the model draws on this host; `backend` is the value of
    /// `--backend`.
    pub fn check(&self, board: &ModelOrBoard, backend: Option<Backend>) -> Result<(), InputError> {
        let given = [
            ("--backend", backend.is_some()),
            ("--transfer", self.transfer.is_some()),
            ("--baud", self.line.baud.baud.is_some()),
            ("--firmware", self.line.firmware.is_some()),
        ];
        match (board, given.iter().find(|(_, is_given)| *is_given)) {
            (ModelOrBoard::Model, Some((option, _))) => {
                Err(bad_value(option, "a board", "--board model"))
            }
            (ModelOrBoard::Model, None) | (ModelOrBoard::Board(_), _) => Ok(()),
        }
    }
}

/// Settings of a picture for which no option is given.
#[derive(Clone, Copy)]
pub struct PictureDefaults {
    /// Options of the start scene. With one sample here, scenes that do not state a number of samples also have one sample.
    pub scene: Defaults,
    /// Shading of smooth surfaces: of models whose files have normals.
    pub smooth_surfaces: Shading,
}

/// Options of a command that draws.
#[derive(clap::Args)]
pub struct DrawingArguments {
    /// The renderer: `model` (the bit-exact model, in this process), `emulated` (the firmware in an emulator), `virtual`
    /// (the verilated SoC) or a serial port.
    #[arg(long, default_value = "model")]
    pub board: ModelOrBoard,
    /// Renderer of a board: `cpu` (the soft core) or `gateware` (the accelerators) [default: gateware if the board has it].
    #[arg(long, value_parser = named(Backend::ALL, Backend::name))]
    backend: Option<Backend>,
    #[command(flatten)]
    pub transfer: TransferArguments,
}

impl DrawingArguments {
    /// The defaults of a picture. The soft core takes too long for a large picture, and for smooth shading.
    pub fn defaults(&self) -> PictureDefaults {
        let scene = match self.backend {
            Some(Backend::Cpu) => Defaults::SOFT_CORE,
            Some(Backend::Gateware) | None => Defaults::GATEWARE,
        };
        PictureDefaults {
            scene: Defaults {
                background: Defaults::GATEWARE.background,
                ..scene
            },
            smooth_surfaces: match self.board {
                ModelOrBoard::Model => Shading::Smooth,
                ModelOrBoard::Board(_) => Shading::Flat,
            },
        }
    }

    /// Rejects board options if the model draws.
    pub fn check(&self) -> Result<(), InputError> {
        self.transfer.check(&self.board, self.backend)
    }

    /// The renderer on the board `name`.
    pub fn renderer<'b>(
        &self,
        board: &'b mut (dyn Board + 'b),
        name: &BoardName,
    ) -> BoardRenderer<'b, dyn Board + 'b> {
        BoardRenderer::new(Console::new(board))
            .with_backend(self.backend)
            .with_route(self.transfer.transfer.unwrap_or(Route::of(name)))
    }
}

/// Returns a clap parser that accepts the names of the values in `all` and converts a name to its value.
pub fn named<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |found| {
        let value = all.into_iter().find(|value| name(*value) == found);
        value.ok_or("not one of the names")
    })
}

/// Returns the error for an option or an argument; `expected` describes the allowed values, and
/// `found` is the value.
pub fn bad_value(name: &str, expected: &str, found: impl Into<String>) -> InputError {
    FormatError::whole(expected, found).in_file(name.escape_debug().to_string())
}

/// Parses the option `--size`.
pub fn size(text: &str) -> anyhow::Result<Size> {
    let size = Size::ALL.into_iter().find(|size| size.to_string() == text);
    size.ok_or_else(|| {
        let found = quote(text.as_bytes());
        bad_value("--size", "320x180, 640x360 or 1280x720", found).into()
    })
}
