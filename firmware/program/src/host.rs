//! The same program on a host: without a window, drawn by the model, with scripted input. Its pictures are those of the engines, bit for
//! bit.
//!
//! ```
//! # use glint_program::{Board, Picture, PictureError, Program};
//! use glint_program::Button;
//! use glint_program::host::Host;
//!
//! # struct Game;
//! # impl Program for Game {
//! #     fn start(_: &mut Board) -> Self { Self }
//! #     fn update(&mut self, board: &mut Board) { if board.is_pressed(Button::Up) { board.leds = 1; } }
//! #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
//! # }
//! let mut host = Host::<Game>::start();
//! host.hold(&[Button::Up]);
//! host.run(3)?;
//! assert_eq!(host.board().leds, 1);
//! # Ok::<(), glint_program::host::HostError>(())
//! ```

use std::fmt;
use std::fs;
use std::process::ExitCode;
use std::time::Duration;

use glint_core::picture::Size;
use glint_core::shape::{self, Shape};
use glint_model::edges::EdgeList;
use glint_model::{Projected, RenderError};
use glint_scene::Defaults;

use crate::board::{Board, Button, Hand, Levels, Motion};
use crate::canvas::{Canvas, Pixels};
use crate::picture::{Picture, PictureError};
use crate::program::Program;
use crate::shapes::Shapes;
use crate::soft_core::SoftCore;

/// Time between two pictures.
const STEP: Duration = Duration::from_micros(16_667);

/// Memory for all built-in meshes.
const SHAPES: usize = shape::MAX_BYTES * Shape::ALL.len();
/// Memory for the edges of a mesh, in words.
const EDGES: usize = 1 << 20;

/// Reason why a picture is not drawn.
#[derive(Debug)]
pub enum HostError {
    /// The program's description is faulty.
    Picture(PictureError),
    /// The model cannot draw the frame.
    Render(RenderError),
}

impl fmt::Display for HostError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Picture(error) => write!(f, "picture: {error}"),
            Self::Render(error) => write!(f, "picture: {error}"),
        }
    }
}

impl std::error::Error for HostError {}

impl From<PictureError> for HostError {
    fn from(error: PictureError) -> Self {
        Self::Picture(error)
    }
}

/// A program on the host.
pub struct Host<P> {
    program: P,
    board: Board,
    levels: Levels,
    picture: Vec<u16>,
    size: Size,
    samples: Vec<u16>,
    depth: Vec<u32>,
    edges: EdgeList<'static>,
    log: String,
}

impl<P: Program> Host<P> {
    /// Starts the program on a board with the engines of the virtual board, in 640×360.
    ///
    /// The memory of its meshes and edges stays until the end of the process.
    #[must_use]
    pub fn start() -> Self {
        let shapes = Shapes::new(vec![0; SHAPES].leak()).expect("the built-in cube is a mesh");
        let defaults = Defaults {
            size: Size::W640,
            ..Defaults::GATEWARE
        };
        let mut board = Board::new(defaults, shapes);
        Self {
            program: P::start(&mut board),
            board,
            levels: Levels::default(),
            picture: Vec::new(),
            size: Size::W640,
            samples: Vec::new(),
            depth: Vec::new(),
            edges: EdgeList::new(vec![0; EDGES].leak()),
            log: String::new(),
        }
    }

    /// Holds these buttons, and no others, for the next pictures.
    pub fn hold(&mut self, buttons: &[Button]) {
        let bits = buttons.iter().map(|&button| 1 << button as u8);
        self.levels.buttons = bits.fold(0, |all, bit: u8| all | bit);
    }

    /// Sets the switches for the next pictures.
    pub const fn switch(&mut self, switches: u16) {
        self.levels.switches = switches;
    }

    /// Adds a sample of the motion sensor to the next picture.
    pub fn move_sensor(&mut self, motion: Motion) {
        self.board.add_sample(motion);
    }

    /// Sets the hand in front of the image sensor for the next pictures; `None` without an image sensor.
    pub fn show_hand(&mut self, hand: Option<Hand>) {
        self.board.set_hand(hand);
    }

    /// Sends bytes over the serial line. Bytes beyond 256 for a picture are dropped.
    pub fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let _ = self.board.received_mut().push(byte);
        }
    }

    /// Updates and draws `count` pictures, 1/60 s apart.
    ///
    /// # Errors
    /// [`HostError`] for a picture that cannot be drawn.
    pub fn run(&mut self, count: u32) -> Result<(), HostError> {
        (0..count).try_for_each(|_| self.next())
    }

    fn next(&mut self) -> Result<(), HostError> {
        self.board.begin(self.levels);
        self.levels.time += STEP;
        self.program.update(&mut self.board);
        self.log.push_str(&self.board.end());
        let mut picture = Picture::new(self.board.defaults()).map_err(PictureError::from)?;
        self.program.draw(&mut picture)?;
        let frame = picture.frame()?;
        self.size = frame.size;
        self.picture.resize(frame.size.pixel_count(), 0);
        let samples = frame.window().size.pixel_count();
        self.samples.resize(samples, 0);
        self.depth.resize(samples, 0);
        let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
        let mut memory = SoftCore {
            samples: &mut self.samples,
            depth: &mut self.depth,
            scratch: &mut scratch,
            edges: &mut self.edges,
        };
        let drawn = memory.draw(&frame, &mut self.picture, &mut || {});
        drawn.map_err(HostError::Render)?;
        let mut source = Colours(&mut self.picture);
        self.program.paint(&mut Canvas::new(&mut source, self.size));
        Ok(())
    }

    /// The colours of the last picture: RGB565, row by row.
    #[must_use]
    pub fn picture(&self) -> &[u16] {
        &self.picture
    }

    /// Width and height of the last picture.
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// The board, with its output.
    #[must_use]
    pub const fn board(&self) -> &Board {
        &self.board
    }

    /// The program.
    #[must_use]
    pub const fn program(&self) -> &P {
        &self.program
    }

    /// All log text so far.
    #[must_use]
    pub fn log(&self) -> &str {
        &self.log
    }

    /// The last picture as a file in the portable pixmap format (PPM, 8 bits a channel).
    #[must_use]
    pub fn pixmap(&self) -> Vec<u8> {
        let mut file =
            format!("P6\n{} {}\n255\n", self.size.width(), self.size.height()).into_bytes();
        for &colour in &self.picture {
            file.extend(glint_core::colour::Rgb565(colour).to_rgb888());
        }
        file
    }
}

/// A picture in memory.
struct Colours<'p>(&'p mut [u16]);

impl Pixels for Colours<'_> {
    fn pixels(&mut self) -> &mut [u16] {
        self.0
    }
}

/// The main function of a program on a host: draws 60 pictures, or the number in the first argument, prints the log, and writes the last
/// picture to the file in the second argument.
#[must_use]
pub fn main<P: Program>() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next();
    let count = count.map_or(Ok(60), |text| text.parse());
    let Ok(count) = count else {
        eprintln!(
            "expected the number of pictures, and a file name for the last: PROGRAM [PICTURES [FILE.ppm]]"
        );
        return ExitCode::from(2);
    };
    let mut host = Host::<P>::start();
    let drawn = host.run(count);
    print!("{}", host.log());
    if let Err(error) = drawn {
        eprintln!("error: {error}");
        return ExitCode::FAILURE;
    }
    if let Some(path) = arguments.next()
        && let Err(error) = fs::write(&path, host.pixmap())
    {
        eprintln!("error: {path}: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
