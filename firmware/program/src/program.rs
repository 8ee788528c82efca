//! The interface that a program implements.

use crate::board::Board;
use crate::canvas::Canvas;
use crate::picture::{Picture, PictureError};

/// A program. For each picture, [`update`](Self::update), [`draw`](Self::draw) and [`paint`](Self::paint) are called in this order. The
/// picture is then shown from the next vertical blanking on.
///
/// ```
/// use glint_program::{Board, Picture, PictureError, Program};
///
/// /// A lit LED that moves to the next position twice per second, with the default background on the screen.
/// struct Runner;
///
/// impl Program for Runner {
///     fn start(_: &mut Board) -> Self {
///         Self
///     }
///
///     fn update(&mut self, board: &mut Board) {
///         board.leds = 1 << (board.time().as_millis() / 500 % 16);
///     }
///
///     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> {
///         Ok(())
///     }
/// }
/// # let mut host = glint_program::host::Host::<Runner>::start();
/// # host.run(62)?;
/// # assert_eq!(host.board().leds, 0b100);
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
pub trait Program: Sized {
    /// Creates the program after reset.
    ///
    /// ```
    /// # use glint_program::core::{mesh::Mesh, shape::Shape};
    /// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
    /// # struct Game { ball: Mesh<'static>, lives: u32 }
    /// # impl Program for Game {
    /// fn start(board: &mut Board) -> Self {
    ///     board.log(format_args!("press a button"));
    ///     Self { ball: board.shape(Shape::Sphere), lives: 3 }
    /// }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Game>::start();
    /// assert_eq!(host.program().lives, 3);
    /// # assert_eq!(host.program().ball.triangle_count(), 1024);
    /// host.run(1)?;
    /// assert!(host.log().contains("press a button"));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    fn start(board: &mut Board) -> Self;

    /// Advances the program to the time of the next picture, using the board's input.
    ///
    /// ```
    /// # use glint_program::core::fixed::Q32_32;
    /// # use glint_program::{Board, Button, Picture, PictureError, Program, host::Host};
    /// # struct Car { place: Q32_32 }
    /// # impl Program for Car {
    /// #     fn start(_: &mut Board) -> Self { Self { place: Q32_32::ZERO } }
    /// fn update(&mut self, board: &mut Board) {
    ///     if board.is_held(Button::Right) {
    ///         // Half a world unit per second.
    ///         self.place += Q32_32::from_num(board.step().as_micros() as u32) / 2_000_000;
    ///     }
    /// }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// # }
    /// let mut host = Host::<Car>::start();
    /// host.hold(&[Button::Right]);
    /// host.run(121)?; // The step of the first picture is 0.
    /// assert_eq!(host.program().place.round(), 1);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    fn update(&mut self, board: &mut Board);

    /// Describes the next picture. The description may borrow meshes, textures, fields and lines of the program, which the engines read
    /// while they draw.
    ///
    /// ```
    /// # use glint_program::core::{appearance::Appearance, camera::View, colour::Rgb565, fixed::{Q32_32, Turns}};
    /// # use glint_program::core::{light::Background, matrix::Matrix, mesh::Mesh, picture::Size, shape::Shape};
    /// # use glint_program::{Board, Picture, PictureError, Program, host::Host};
    /// # struct Ball { mesh: Mesh<'static> }
    /// # impl Program for Ball {
    /// #     fn start(board: &mut Board) -> Self { Self { mesh: board.shape(Shape::Sphere) } }
    /// #     fn update(&mut self, _: &mut Board) {}
    /// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
    ///     picture.size = Size::W320;
    ///     picture.view = View::spherical(Q32_32::lit("2"), Turns(0), Turns::QUARTER)?;
    ///     picture.appearance.background = Some(Background::Colour([0; 3]));
    ///     picture.mesh(self.mesh, Matrix::IDENTITY)?;
    ///     Ok(())
    /// }
    /// # }
    /// let mut host = Host::<Ball>::start();
    /// host.run(1)?;
    /// let [corner, middle] = [0, 90 * 320 + 160].map(|place| host.picture()[place]);
    /// assert!(corner == 0 && middle != 0);
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    ///
    /// # Errors
    /// [`PictureError`] stops the program, with the error on the console.
    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError>;

    /// Draws text and flat shapes on the picture that the engines have drawn. Draws nothing by default.
    ///
    /// ```
    /// # use glint_program::{Board, Canvas, Picture, PictureError, Program, host::Host};
    /// use glint_program::graphics::mono_font::ascii::FONT_10X20;
    /// use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
    ///
    /// # struct Clock { seconds: u64 }
    /// # impl Program for Clock {
    /// #     fn start(_: &mut Board) -> Self { Self { seconds: 0 } }
    /// #     fn update(&mut self, board: &mut Board) { self.seconds = board.time().as_secs(); }
    /// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
    /// fn paint(&self, canvas: &mut Canvas) {
    ///     canvas.text([0, 0], &FONT_10X20, Rgb565::RED, format_args!("{} s", self.seconds));
    /// }
    /// # }
    /// let mut host = Host::<Clock>::start();
    /// host.run(1)?;
    /// assert!(host.picture().contains(&0xf800));
    /// # Ok::<(), glint_program::host::HostError>(())
    /// ```
    fn paint(&self, canvas: &mut Canvas) {
        let _ = canvas;
    }
}
