//! Runs the same program on a host, without a window, with scripted input. The model draws the pictures, which are bit-identical to the
//! pictures of the engines.
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
///
/// ```
/// # use glint_program::core::{field::Field, quality::Quality};
/// # use glint_program::{Board, Picture, PictureError, Program};
/// use glint_program::host::{Host, HostError};
///
/// # struct Two(Field);
/// # impl Program for Two {
/// #     fn start(_: &mut Board) -> Self { Self(Field::parse("menger:3").unwrap()) }
/// #     fn update(&mut self, _: &mut Board) {}
/// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
///     picture.field(&self.0, Quality::Fast)?;
///     picture.field(&self.0, Quality::Fast)
/// }
/// # }
/// let drawn = Host::<Two>::start().run(1);
/// assert!(matches!(drawn, Err(HostError::Picture(PictureError::Subjects))));
/// ```
#[derive(Debug)]
pub enum HostError {
    /// The program's description is faulty.
    Picture(PictureError),
    /// The model cannot draw the frame, for this reason.
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

/// A program on the host, with the board on which it runs.
///
/// ```
/// use glint_program::Board;
/// use glint_program::host::Host;
///
/// /// The speed that the lowest four switches set.
/// fn speed(board: &Board) -> u16 {
///     board.switches() & 0xf
/// }
///
/// let mut host = Host::<()>::start();
/// host.switch(0b10_0101);
/// host.run(1)?;
/// assert_eq!(speed(host.board()), 5);
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
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
    /// Starts the program on a board with the engines of the virtual board. Pictures have 640×360 pixels.
    ///
    /// The memory of the built-in meshes and of the edges is not freed until the end of the process.
    ///
    /// ```
    /// use glint_program::host::Host;
    ///
    /// let host = Host::<()>::start();
    /// assert_eq!(host.board().pictures(), 0);
    /// assert!(host.picture().is_empty(), "nothing is drawn yet");
    /// ```
    #[must_use]
    pub fn start() -> Self {
        let shapes = Shapes::new(vec![0; SHAPES].leak());
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

    /// Holds these buttons for the next pictures, and releases all others.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// use glint_program::Button;
    ///
    /// let mut host = Host::<()>::start();
    /// host.hold(&[Button::Down]);
    /// host.run(1)?;
    /// assert!(host.board().is_held(Button::Down));
    /// host.hold(&[]);
    /// host.run(1)?;
    /// assert!(!host.board().is_held(Button::Down));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn hold(&mut self, buttons: &[Button]) {
        let bits = buttons.iter().map(|&button| 1 << button as u8);
        self.levels.buttons = bits.fold(0, |all, bit: u8| all | bit);
    }

    /// Sets the switches for the next pictures.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.switch(1 << 15);
    /// host.run(2)?;
    /// assert_eq!(host.board().switches(), 0x8000);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn switch(&mut self, switches: u16) {
        self.levels.switches = switches;
    }

    /// Adds a sample of the motion sensor to the next picture.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// use glint_program::Motion;
    /// use glint_program::core::fixed::Turns;
    /// use glint_program::core::orientation::{Angles, Quaternion, Sample};
    ///
    /// let mut host = Host::<()>::start();
    /// let yaw = Angles { yaw: Turns::QUARTER, ..Angles::default() };
    /// let motion = Motion { attitude: Quaternion::from_angles(yaw), sample: Sample::default() };
    /// host.move_sensor(motion);
    /// host.run(1)?;
    /// assert_eq!(host.board().motion(), Some(&motion));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn move_sensor(&mut self, motion: Motion) {
        self.board.add_sample(motion);
    }

    /// Sets the hand in front of the image sensor for the next pictures; `None` without an image sensor.
    ///
    /// ```
    /// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
    /// # struct Watcher;
    /// # impl Program for Watcher {
    /// #     fn start(board: &mut Board) -> Self { board.watches_hand = true; Self }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// use glint_program::Hand;
    /// use glint_program::core::fixed::{Q32_32, Turns};
    /// use glint_program::core::gesture::Pose;
    ///
    /// let mut host = Host::<Watcher>::start();
    /// let pose = Pose { theta: Turns(0), phi: Turns::QUARTER, r: Q32_32::lit("3") };
    /// host.show_hand(Some(Hand { pose, is_seen: true }));
    /// assert_eq!(host.board().hand().map(|hand| hand.pose), Some(pose));
    /// host.show_hand(None);
    /// assert!(host.board().hand().is_none());
    /// ```
    pub fn show_hand(&mut self, hand: Option<Hand>) {
        self.board.set_hand(hand);
    }

    /// Sends bytes over the serial line. Bytes beyond 256 per picture are dropped.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Echo;
    /// # impl Program for Echo {
    /// #     fn start(_: &mut Board) -> Self { Self }
    /// fn update(&mut self, board: &mut Board) {
    ///     board.show_number(board.received().len() as u64);
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// # use glint_program::core::digits::segments;
    /// let mut host = Host::<Echo>::start();
    /// host.send(b"three");
    /// host.run(1)?;
    /// assert_eq!(host.board().digits.map(|all| all[7]), Some(segments('5')));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let _ = self.board.received_mut().push(byte);
        }
    }

    /// Updates and draws `count` pictures, 1/60 s apart.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.run(2)?;
    /// host.run(3)?;
    /// assert_eq!(host.board().pictures(), 5);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
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
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// use glint_program::core::colour::Rgb565;
    ///
    /// let mut host = Host::<()>::start();
    /// host.run(1)?;
    /// // The default background is a gradient of greys, as grey as RGB565 can be.
    /// let [red, green, blue] = Rgb565(host.picture()[0]).to_rgb888();
    /// assert!(red.abs_diff(green) < 8 && blue.abs_diff(green) < 8);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    #[must_use]
    pub fn picture(&self) -> &[u16] {
        &self.picture
    }

    /// Width and height of the last picture.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.run(1)?;
    /// assert_eq!(host.size().pixels(), [640, 360]);
    /// assert_eq!(host.picture().len(), host.size().pixel_count());
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// The board, with the output of the program.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.run(1)?;
    /// assert_eq!(host.board().leds, 0);
    /// assert_eq!(host.board().digits, None, "a board shows the rate of drawing");
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    #[must_use]
    pub const fn board(&self) -> &Board {
        &self.board
    }

    /// The current state of the program.
    ///
    /// ```
    /// # use glint_program::{Board, Picture, PictureError, Program};
    /// use glint_program::host::Host;
    ///
    /// # struct Life { cells: Vec<bool> }
    /// # impl Program for Life {
    /// #     fn start(_: &mut Board) -> Self { Self { cells: vec![true, false] } }
    /// #     fn update(&mut self, _: &mut Board) { self.cells.rotate_left(1); }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Life>::start();
    /// host.run(1)?;
    /// assert_eq!(host.program().cells, [false, true]);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    #[must_use]
    pub const fn program(&self) -> &P {
        &self.program
    }

    /// All log text so far.
    ///
    /// ```
    /// # use glint_program::{Board, Picture, PictureError, Program};
    /// use glint_program::host::Host;
    ///
    /// # struct Talker;
    /// # impl Program for Talker {
    /// #     fn start(board: &mut Board) -> Self { board.log(format_args!("ready")); Self }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Talker>::start();
    /// assert_eq!(host.log(), "", "lines arrive with the first picture");
    /// host.run(1)?;
    /// assert_eq!(host.log().lines().count(), 1);
    /// assert!(host.log().trim_end().ends_with("ready"));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    #[must_use]
    pub fn log(&self) -> &str {
        &self.log
    }

    /// The last picture as a file in the portable pixmap format (PPM, 8 bits per channel).
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.run(1)?;
    /// let file = host.pixmap();
    /// assert!(file.starts_with(b"P6\n640 360\n255\n"));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
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

/// The empty program, which shows the background. `Host<()>` is a board without a program, for tests of functions that take a board.
impl Program for () {
    fn start(_: &mut Board) -> Self {}

    fn update(&mut self, _: &mut Board) {}

    fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> {
        Ok(())
    }
}

/// A picture in memory, as a source for a canvas.
struct Colours<'p>(&'p mut [u16]);

impl Pixels for Colours<'_> {
    fn pixels(&mut self) -> &mut [u16] {
        self.0
    }
}

/// The main function of a program on a host: draws 60 pictures, or the number in the first argument, prints the log, and writes the last
/// picture to the file in the second argument.
///
/// ```
/// use std::process::ExitCode;
///
/// fn main() -> ExitCode {
///     glint_program::host::main::<()>()
/// }
/// ```
#[must_use]
pub fn main<P: Program>() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next();
    let count = count.map_or(Ok(60), |text| text.parse());
    let Ok(count) = count else {
        eprintln!(
            "expected the number of pictures and a file name for the last picture: PROGRAM [PICTURES [FILE.ppm]]"
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
