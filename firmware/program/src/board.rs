//! The board's inputs and outputs, for programs.

use core::fmt::{self, Write};
use core::time::Duration;

use glint_core::camera::{View, ViewError};
use glint_core::digits::Display;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::gesture::Pose;
use glint_core::mesh::Mesh;
use glint_core::orientation::{Quaternion, Sample};
use glint_core::picture::Size;
use glint_core::shape::Shape;
use glint_core::steering::{Mounting, free_look};
use glint_core::wireframe::Debouncer;
use glint_scene::Defaults;
use heapless::{String, Vec};

use crate::shapes::Shapes;

/// Maximum number of bytes of log text per picture. Further text is dropped.
const LOG: usize = 1024;
/// Maximum number of received bytes per picture. Further bytes wait for the next picture.
pub(crate) const RECEIVED: usize = 256;
/// Maximum number of samples of the motion sensor per picture: those of 64 ms. If a picture takes longer, the oldest samples are dropped.
const SAMPLES: usize = 64;

/// A button of the board, named by its position.
///
/// ```
/// # use glint_program::host::Host;
/// use glint_program::Button;
///
/// let mut host = Host::<()>::start();
/// host.hold(&[Button::Left, Button::Up]);
/// host.run(1)?;
/// let board = host.board();
/// assert!(board.is_held(Button::Left) && board.is_held(Button::Up) && !board.is_held(Button::Right));
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Button 0 of the board.
    Up = 0,
    /// Button 1 of the board.
    Down = 1,
    /// Button 2 of the board.
    Left = 2,
    /// Button 3 of the board.
    Right = 3,
}

/// The attitude and the newest sample of the motion sensor.
///
/// ```
/// use glint_program::core::camera::View;
/// use glint_program::core::fixed::Q32_32;
/// use glint_program::Board;
///
/// /// The camera at the origin that looks in the direction of the sensor; `None` without a sensor.
/// fn look(board: &Board) -> Option<View> {
///     board.motion()?.view([Q32_32::ZERO; 3]).ok()
/// }
/// # use glint_program::core::orientation::{Quaternion, Sample};
/// # let mut host = glint_program::host::Host::<()>::start();
/// # assert!(look(host.board()).is_none());
/// # host.move_sensor(glint_program::Motion { attitude: Quaternion::IDENTITY, sample: Sample::default() });
/// # assert!(look(host.board()).is_some());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    /// The rotation from the sensor's axes to the world's axes.
    pub attitude: Quaternion,
    /// The newest sample of the sensor.
    pub sample: Sample,
}

impl Motion {
    /// The camera at `eye` that looks in the direction of the sensor.
    ///
    /// ```
    /// use glint_program::Motion;
    /// use glint_program::core::fixed::Q32_32;
    /// use glint_program::core::orientation::{Quaternion, Sample};
    ///
    /// let level = Motion { attitude: Quaternion::IDENTITY, sample: Sample::default() };
    /// let eye = [Q32_32::ZERO, Q32_32::ONE, Q32_32::ZERO];
    /// assert_eq!(level.view(eye)?.eye(), eye);
    /// assert!(level.view([Q32_32::lit("33"); 3]).is_err());
    /// # Ok::<(), glint_program::core::camera::ViewError>(())
    /// ```
    ///
    /// # Errors
    /// [`ViewError`] for an eye more than 32 world units from the origin.
    pub fn view(&self, eye: [Q32_32; 3]) -> Result<View, ViewError> {
        free_look(eye, self.attitude, Mounting::default())
    }
}

/// A hand in front of the image sensor.
///
/// ```
/// use glint_program::core::camera::View;
/// use glint_program::{Board, Hand};
///
/// /// The camera at the position that a hand sets; `None` without a hand.
/// fn steer(board: &mut Board) -> Option<View> {
///     board.watches_hand = true;
///     match board.hand()? {
///         Hand { pose, is_seen: true } => View::spherical(pose.r, pose.theta, pose.phi).ok(),
///         _ => None,
///     }
/// }
/// # use glint_program::core::{fixed::{Q32_32, Turns}, gesture::Pose};
/// # use glint_program::{Picture, PictureError, Program, host::Host};
/// # struct Steered(Option<View>);
/// # impl Program for Steered {
/// #     fn start(_: &mut Board) -> Self { Self(None) }
/// #     fn update(&mut self, board: &mut Board) { self.0 = steer(board); }
/// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
/// # }
/// # let mut host = Host::<Steered>::start();
/// # let pose = Pose { theta: Turns(0), phi: Turns::QUARTER, r: Q32_32::lit("3") };
/// # for is_seen in [false, true] {
/// #     host.show_hand(Some(Hand { pose, is_seen }));
/// #     host.run(1)?;
/// #     assert_eq!(host.program().0.is_some(), is_seen);
/// # }
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hand {
    /// The position of the camera in spherical coordinates about the origin, set by the hand: left and right change the azimuth, up and
    /// down the angle from the z axis, nearer and farther the distance.
    pub pose: Pose,
    /// Whether the image sensor sees a hand. If not, `pose` is unchanged since the last hand.
    pub is_seen: bool,
}

/// The board: its input since the last picture, and its output.
///
/// ```
/// # use glint_program::{Picture, PictureError, Program, host::Host};
/// use glint_program::{Board, Button};
///
/// # struct Game { lives: u64 }
/// # impl Program for Game {
/// #     fn start(_: &mut Board) -> Self { Self { lives: 3 } }
/// fn update(&mut self, board: &mut Board) {
///     if board.is_pressed(Button::Up) {
///         self.lives = self.lives.saturating_sub(1);
///         board.log(format_args!("{} lives", self.lives));
///     }
///     board.show_number(self.lives);
///     board.leds = (1 << self.lives.min(15)) - 1;
/// }
/// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
/// # }
/// let mut host = Host::<Game>::start();
/// host.hold(&[Button::Up]);
/// host.run(3)?;
/// assert_eq!(host.board().leds, 0b11);
/// assert!(host.log().contains("2 lives"));
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
pub struct Board {
    /// Levels of the sixteen LEDs; bit 0 is LED 0.
    pub leds: u16,
    /// Whether the image sensor is turned on to look for a [hand](Self::hand).
    pub watches_hand: bool,
    /// The lit segments of the eight digits. `None` shows the drawing rate in pictures per second.
    pub digits: Option<[u8; 8]>,
    defaults: Defaults,
    shapes: Shapes,
    time: Duration,
    step: Duration,
    pictures: u32,
    drawing: u64,
    debouncer: Debouncer,
    held: u8,
    pressed: u8,
    switches: u16,
    motion: Option<Motion>,
    hand: Option<Hand>,
    samples: Vec<Sample, SAMPLES>,
    received: Vec<u8, RECEIVED>,
    log: String<LOG>,
}

/// The input of the board for the next picture.
#[derive(Clone, Copy, Default)]
pub(crate) struct Levels {
    /// Time since the start of the program.
    pub time: Duration,
    /// One bit for each pressed button.
    pub buttons: u8,
    /// One bit for each switch that is on.
    pub switches: u16,
}

impl Board {
    pub(crate) fn new(defaults: Defaults, shapes: Shapes) -> Self {
        Self {
            leds: 0,
            watches_hand: false,
            digits: None,
            defaults,
            shapes,
            time: Duration::ZERO,
            step: Duration::ZERO,
            pictures: 0,
            drawing: 0,
            debouncer: Debouncer::default(),
            held: 0,
            pressed: 0,
            switches: 0,
            motion: None,
            hand: None,
            samples: Vec::new(),
            received: Vec::new(),
            log: String::new(),
        }
    }

    /// Handles a sample of the buttons. Samples may be more frequent than pictures.
    pub(crate) fn sample_buttons(&mut self, time: Duration, buttons: u8) {
        // The time wraps after 49 days, which the debouncer can handle.
        self.pressed |= self.debouncer.sample(time.as_millis() as u32, buttons);
        self.held = buttons;
    }

    /// Stores the input for the next picture.
    pub(crate) fn begin(&mut self, levels: Levels) {
        self.sample_buttons(levels.time, levels.buttons);
        self.switches = levels.switches;
        if self.pictures > 0 {
            self.step = levels.time.saturating_sub(self.time);
        }
        self.time = levels.time;
    }

    /// Handles a sample of the motion sensor.
    pub(crate) fn add_sample(&mut self, motion: Motion) {
        self.motion = Some(motion);
        if self.samples.is_full() {
            self.samples.remove(0);
        }
        // The list is not full, so the push does not fail.
        let _ = self.samples.push(motion.sample);
    }

    /// Sets the hand; `None` without an image sensor.
    pub(crate) fn set_hand(&mut self, hand: Option<Hand>) {
        self.hand = hand;
    }

    /// Stores the clock cycles of drawing a picture.
    #[cfg(target_arch = "riscv32")]
    pub(crate) const fn set_drawing(&mut self, cycles: u64) {
        self.drawing = cycles;
    }

    /// The buffer into which received bytes are written.
    pub(crate) fn received_mut(&mut self) -> &mut Vec<u8, RECEIVED> {
        &mut self.received
    }

    /// Ends the update for a picture: clears the input of the picture, and returns the log.
    pub(crate) fn end(&mut self) -> String<LOG> {
        self.pictures = self.pictures.wrapping_add(1);
        self.pressed = 0;
        self.samples.clear();
        self.received.clear();
        core::mem::take(&mut self.log)
    }

    /// The default options of pictures on this board.
    pub(crate) const fn defaults(&self) -> Defaults {
        self.defaults
    }

    /// Time since the start of the program.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.run(121)?; // The first picture is drawn at 0.
    /// assert_eq!(host.board().time().as_secs(), 2);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn time(&self) -> Duration {
        self.time
    }

    /// Time since the previous picture; 0 for the first.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.run(1)?;
    /// assert!(host.board().step().is_zero());
    /// host.run(1)?;
    /// assert_eq!(host.board().step().as_millis(), 16);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn step(&self) -> Duration {
        self.step
    }

    /// Number of pictures so far, modulo 2^32.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Blink(bool);
    /// # impl Program for Blink {
    /// #     fn start(_: &mut Board) -> Self { Self(false) }
    /// fn update(&mut self, board: &mut Board) {
    ///     // Eight pictures on, eight pictures off.
    ///     self.0 = board.pictures() & 8 == 0;
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// # let mut host = Host::<Blink>::start();
    /// # host.run(8)?;
    /// # assert!(host.program().0);
    /// # host.run(1)?;
    /// # assert!(!host.program().0);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn pictures(&self) -> u32 {
        self.pictures
    }

    /// Clock cycles of drawing the last picture, without `update`, `paint` and the wait for a free frame buffer; 0 on a host.
    ///
    /// ```
    /// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
    /// # struct Meter;
    /// # impl Program for Meter {
    /// #     fn start(_: &mut Board) -> Self { Self }
    /// fn update(&mut self, board: &mut Board) {
    ///     board.show_number(board.drawing());
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// # let mut host = Host::<Meter>::start();
    /// # host.run(2)?;
    /// # assert_eq!(host.board().drawing(), 0);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn drawing(&self) -> u64 {
        self.drawing
    }

    /// The angle of a motion with this number of turns per second, at the time of the next picture. It is computed from the whole time in
    /// microseconds and rounded down to 2^−32 turns, so errors do not add up.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// use glint_program::core::fixed::{Q32_32, Turns};
    ///
    /// let mut host = Host::<()>::start();
    /// // A turn in four seconds is a quarter in one.
    /// host.run(61)?;
    /// let angle = host.board().turns(Q32_32::lit("0.25"));
    /// assert!(angle.0.abs_diff(Turns::QUARTER.0) < 1 << 16);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn turns(&self, per_second: Q32_32) -> Turns {
        // Products of 64 bits, because whole turns are dropped.
        const MICROSECONDS: u32 = 1_000_000;
        let (bits, rest) = (per_second.to_bits(), u64::from(self.time.subsec_micros()));
        let by_seconds = bits.wrapping_mul(self.time.as_secs().cast_signed()) as u32;
        let turns = ((bits >> 32) as i32).rem_euclid(MICROSECONDS.cast_signed());
        let turns = u64::from(turns.cast_unsigned()) * rest % u64::from(MICROSECONDS);
        let by_rest = ((turns << 32) + u64::from(bits as u32) * rest) / u64::from(MICROSECONDS);
        Turns(by_seconds.wrapping_add(by_rest as u32))
    }

    /// Largest size of a picture on this board.
    ///
    /// ```
    /// # use glint_program::core::mesh::Mesh;
    /// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
    /// use glint_program::core::picture::Size;
    ///
    /// # struct Quick { size: Size }
    /// # impl Program for Quick {
    /// fn start(board: &mut Board) -> Self {
    ///     // A quarter of the pixels, if the board supports more than the smallest size.
    ///     let half = Size::of(board.largest_size().width() / 2, board.largest_size().height() / 2);
    ///     Self { size: half.unwrap_or(Size::W320) }
    /// }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.size = self.size;
    ///     Ok(())
    /// }
    /// # }
    /// # let mut host = Host::<Quick>::start();
    /// # host.run(1)?;
    /// # assert_eq!(host.size(), Size::W320);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn largest_size(&self) -> Size {
        self.defaults.size
    }

    /// Whether a button is down.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// use glint_program::{Board, Button};
    ///
    /// let mut host = Host::<()>::start();
    /// /// −1, 0 or 1.
    /// fn steering(board: &Board) -> i32 {
    ///     i32::from(board.is_held(Button::Right)) - i32::from(board.is_held(Button::Left))
    /// }
    /// host.hold(&[Button::Left]);
    /// host.run(5)?;
    /// assert_eq!(steering(host.board()), -1);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn is_held(&self, button: Button) -> bool {
        self.held >> button as u8 & 1 != 0
    }

    /// Whether a button has been pressed since the previous picture; bounces of its contact are suppressed.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::{Board, Button};
    ///
    /// # struct Counter(u32);
    /// # impl Program for Counter {
    /// #     fn start(_: &mut Board) -> Self { Self(0) }
    /// fn update(&mut self, board: &mut Board) {
    ///     if board.is_pressed(Button::Up) {
    ///         self.0 += 1;
    ///     }
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Counter>::start();
    /// host.hold(&[Button::Up]);
    /// host.run(5)?;
    /// assert_eq!(host.program().0, 1, "a press lasts, but counts once");
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn is_pressed(&self, button: Button) -> bool {
        self.pressed >> button as u8 & 1 != 0
    }

    /// The sixteen switches; bit 0 is switch 0.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let mut host = Host::<()>::start();
    /// host.switch(0b1000);
    /// host.run(1)?;
    /// let is_on = |number: u32| host.board().switches() >> number & 1 != 0;
    /// assert!(is_on(3) && !is_on(0));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn switches(&self) -> u16 {
        self.switches
    }

    /// The motion sensor's attitude; `None` before its first sample, or without a sensor.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// use glint_program::Motion;
    /// use glint_program::core::orientation::{Quaternion, Sample};
    ///
    /// let mut host = Host::<()>::start();
    /// assert!(host.board().motion().is_none());
    /// let sample = Sample { gyro: [0, 0, 160], ..Sample::default() };
    /// host.move_sensor(Motion { attitude: Quaternion::IDENTITY, sample });
    /// host.run(1)?;
    /// assert_eq!(host.board().motion().map(|motion| motion.sample.gyro[2]), Some(160));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub const fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// The hand; `None` while [`watches_hand`](Self::watches_hand) is false, or without an image sensor.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Waved(Option<bool>);
    /// # impl Program for Waved {
    /// #     fn start(board: &mut Board) -> Self { board.watches_hand = true; Self(None) }
    /// fn update(&mut self, board: &mut Board) {
    ///     self.0 = board.hand().map(|hand| hand.is_seen);
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// # use glint_program::Hand;
    /// # use glint_program::core::{fixed::{Q32_32, Turns}, gesture::Pose};
    /// # let pose = Pose { theta: Turns(0), phi: Turns::QUARTER, r: Q32_32::lit("3") };
    /// let mut host = Host::<Waved>::start();
    /// host.run(1)?;
    /// assert_eq!(host.program().0, None, "no image sensor");
    /// host.show_hand(Some(Hand { pose, is_seen: true }));
    /// host.run(1)?;
    /// assert_eq!(host.program().0, Some(true));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn hand(&self) -> Option<&Hand> {
        self.hand.as_ref().filter(|_| self.watches_hand)
    }

    /// Samples of the motion sensor since the previous picture, the oldest first. The sensor sends 1,000 samples per second.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Steps(u32);
    /// # impl Program for Steps {
    /// #     fn start(_: &mut Board) -> Self { Self(0) }
    /// fn update(&mut self, board: &mut Board) {
    ///     // A shock is an upward acceleration of more than 2 g; 1 g is 4,096 counts.
    ///     let shocks = board.samples().iter().filter(|sample| sample.accel[2] > 2 * 4096);
    ///     self.0 += shocks.count() as u32;
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// # use glint_program::{Motion, core::orientation::{Quaternion, Sample}};
    /// # let mut host = Host::<Steps>::start();
    /// # for z in [4096, 9000, 4000] {
    /// #     let sample = Sample { accel: [0, 0, z], ..Sample::default() };
    /// #     host.move_sensor(Motion { attitude: Quaternion::IDENTITY, sample });
    /// # }
    /// # host.run(2)?;
    /// # assert_eq!(host.program().0, 1);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Bytes that the serial line has received since the previous picture.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Switch;
    /// # impl Program for Switch {
    /// #     fn start(_: &mut Board) -> Self { Self }
    /// fn update(&mut self, board: &mut Board) {
    ///     match board.received().last() {
    ///         Some(b'+') => board.leds = 0xffff,
    ///         Some(b'-') => board.leds = 0,
    ///         _ => {}
    ///     }
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Switch>::start();
    /// host.send(b"-+");
    /// host.run(1)?;
    /// assert_eq!(host.board().leds, 0xffff);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn received(&self) -> &[u8] {
        &self.received
    }

    /// Writes a line of text to the serial line, with the time in front. Lines beyond 1,024 bytes per picture are dropped. The text is sent
    /// after the update, so a panic in the update loses the text.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Watch;
    /// # impl Program for Watch {
    /// #     fn start(_: &mut Board) -> Self { Self }
    /// fn update(&mut self, board: &mut Board) {
    ///     if board.pictures() % 60 == 0 {
    ///         board.log(format_args!("{} pictures", board.pictures()));
    ///     }
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Watch>::start();
    /// host.run(61)?;
    /// assert_eq!(host.log(), "    0.000 0 pictures\r\n    1.000 60 pictures\r\n");
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn log(&mut self, text: fmt::Arguments) {
        let [seconds, milliseconds] = [self.time.as_secs(), u64::from(self.time.subsec_millis())];
        let before = self.log.len();
        if write!(self.log, "{seconds:5}.{milliseconds:03} {text}\r\n").is_err() {
            self.log.truncate(before);
        }
    }

    /// Shows a whole number on the digits, right-aligned.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    ///
    /// # struct Meter;
    /// # impl Program for Meter {
    /// #     fn start(_: &mut Board) -> Self { Self }
    /// fn update(&mut self, board: &mut Board) {
    ///     board.show_number(2026);
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// # use glint_program::core::digits::segments;
    /// # let mut host = Host::<Meter>::start();
    /// # host.run(1)?;
    /// # assert_eq!(host.board().digits.map(|all| [all[4], all[7]]), Some(['2', '6'].map(segments)));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    pub fn show_number(&mut self, number: u64) {
        self.digits = Some(digits([Display::default(), Display::number(number)]));
    }

    /// A built-in cube of edge length 1, with one colour per side.
    ///
    /// ```
    /// # use glint_program::host::Host;
    /// let host = Host::<()>::start();
    /// assert_eq!(host.board().cube().vertex_count(), 8);
    /// ```
    pub const fn cube(&self) -> Mesh<'static> {
        self.shapes.cube()
    }

    /// A built-in mesh. The memory suffices for all of them; if it did not, this function would return the cube.
    ///
    /// ```
    /// # use glint_program::{Picture, PictureError, Program, host::Host};
    /// use glint_program::Board;
    /// use glint_program::core::mesh::Mesh;
    /// use glint_program::core::shape::Shape;
    ///
    /// # struct Ring { mesh: Mesh<'static> }
    /// # impl Program for Ring {
    /// fn start(board: &mut Board) -> Self {
    ///     Self { mesh: board.shape(Shape::Torus) }
    /// }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// assert_eq!(Host::<Ring>::start().program().mesh.triangle_count(), 1024);
    /// ```
    pub fn shape(&mut self, shape: Shape) -> Mesh<'static> {
        self.shapes.shape(shape).unwrap_or(self.shapes.cube())
    }

    /// The built-in mesh with this name, if it has been made.
    pub(crate) fn made(&self, name: &str) -> Option<Mesh<'static>> {
        self.shapes.made(name)
    }

    /// The built-in mesh with this name.
    pub(crate) fn named(&mut self, name: &str) -> Option<Mesh<'static>> {
        self.shapes.named(name)
    }
}

/// The segments of both four-digit displays.
pub(crate) fn digits(displays: [Display; 2]) -> [u8; 8] {
    let mut segments = [0; 8];
    segments.copy_from_slice(displays.map(|display| display.digits()).as_flattened());
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_exact_and_rounded_down() {
        let mut board = Board::new(Defaults::GATEWARE, Shapes::new(&mut []));
        let rates = [
            0,
            1,
            -1,
            1 << 32,
            -(1 << 32),
            715_827_883,
            -1_234_567_890_123,
            i64::MAX,
            i64::MIN,
        ];
        let times = [
            0,
            1,
            16_667,
            999_999,
            1_000_000,
            86_399_999_999,
            u64::MAX >> 1,
        ];
        for (bits, microseconds) in rates
            .into_iter()
            .flat_map(|bits| times.map(|time| (bits, time)))
        {
            board.time = Duration::from_micros(microseconds);
            let turns = (i128::from(bits) * i128::from(microseconds)).div_euclid(1_000_000);
            assert_eq!(
                board.turns(Q32_32::from_bits(bits)),
                Turns(turns as u32),
                "{bits}, {microseconds}"
            );
        }
    }
}
