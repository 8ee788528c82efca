//! The library of programs for a Glint machine: games, instruments and demos on the soft core, drawn by the engines.
//!
//! A [`Program`] has three main functions: `start` creates it, `update` changes it by the [`Board`]'s input, and `draw` describes the next
//! [`Picture`]. [`run!`] makes a binary of the program. On the soft core, the program has exclusive use of the machine. On a host, the
//! model draws the pictures, without a window, for tests ([`host`]).
//!
//! ```
//! use glint_program::{Board, Picture, PictureError, Program};
//! use glint_program::core::fixed::{Q32_32, Turns};
//! use glint_program::core::camera::View;
//! use glint_program::core::matrix::Matrix;
//! use glint_program::core::mesh::Mesh;
//!
//! /// A cube, seen by a camera that moves around it.
//! struct Cube {
//!     mesh: Mesh<'static>,
//!     azimuth: Turns,
//! }
//!
//! impl Program for Cube {
//!     fn start(board: &mut Board) -> Self {
//!         Self { mesh: board.cube(), azimuth: Turns(0) }
//!     }
//!
//!     fn update(&mut self, board: &mut Board) {
//!         // One turn in four seconds.
//!         self.azimuth = board.turns(Q32_32::lit("0.25"));
//!     }
//!
//!     fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
//!         picture.view = View::spherical(Q32_32::lit("2.5"), self.azimuth, Turns::QUARTER)?;
//!         picture.mesh(self.mesh, Matrix::IDENTITY)?;
//!         Ok(())
//!     }
//! }
//!
//! glint_program::run!(Cube);
//! ```
//!
//! | module | subject |
//! |---|---|
//! | [`Board`] | buttons, switches, LEDs, digits, motion sensor, hand, time, serial line |
//! | [`Picture`] | camera, light, meshes, field, lines, rectangles |
//! | [`Canvas`] | text and shapes of `embedded-graphics` on the drawn picture |
//! | [`ShownScene`] | a scene of console commands, as in scene files |
//! | [`lines`] | segments in space, drawn by the line engine |
//! | [`triangles`] | triangles in pixels, for other libraries and a program's own geometry |
//! | [`core`], [`model`], [`scene`] | the crates whose types the interface uses |
//! | [`host`] | the same program on a host |
//!
//! Most other modules exist only on the soft core, for programs that need more than this interface: `hardware` starts the machine, and
//! `renderer` draws frames. The firmware with the console is such a program.
#![cfg_attr(target_arch = "riscv32", no_std)]
#![deny(unsafe_code)]

mod aligned;
mod board;
mod canvas;
mod cube;
pub mod lines;
mod picture;
mod program;
pub mod shapes;
mod shown_scene;
mod soft_core;
pub mod triangles;

#[cfg(not(target_arch = "riscv32"))]
pub mod host;

#[cfg(target_arch = "riscv32")]
pub mod drawn;
#[cfg(target_arch = "riscv32")]
pub mod gateware;
#[cfg(target_arch = "riscv32")]
pub mod gesture;
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Uses the UART before it has an owner.
pub mod hardware;
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Enables interrupts.
pub mod interrupts;
#[cfg(target_arch = "riscv32")]
pub mod machine;
#[cfg(target_arch = "riscv32")]
pub mod marker;
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Makes slices of the memory at linker symbols.
pub mod memory;
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Exports the trap handler's symbol, and takes the UART after a panic.
pub mod panic;
#[cfg(target_arch = "riscv32")]
pub mod renderer;
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Polls a pinned future from interrupts.
pub mod sensor;
#[cfg(target_arch = "riscv32")]
pub mod serial;
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Names the linker's symbol of the stack.
mod supervision;

pub use aligned::Aligned;
pub use board::{Board, Button, Hand, Motion};
pub use canvas::{Canvas, Pixels};
pub use embedded_graphics as graphics;
pub use glint_core as core;
pub use glint_model as model;
pub use glint_scene as scene;
pub use picture::{MAX_RECTANGLES, Picture, PictureError};
pub use program::Program;
pub use shown_scene::{SceneError, SceneFiles, ShownScene};

/// Clock cycles of the soft core since reset, for measurements of a program's own code; always 0 on a host.
///
/// ```
/// let start = glint_program::cycles();
/// let root = std::hint::black_box(1_000_000_u32).isqrt();
/// let taken = glint_program::cycles() - start;
/// # assert_eq!((root, taken), (1000, 0));
/// ```
#[must_use]
pub fn cycles() -> u64 {
    #[cfg(target_arch = "riscv32")]
    return litex_pac::cpu::cycles();
    #[cfg(not(target_arch = "riscv32"))]
    0
}

/// Defines the main function of a binary that runs a [`Program`]. The argument is the program's type.
///
/// ```
/// # use glint_program::{Board, Picture, PictureError, Program};
/// # struct Game;
/// # impl Program for Game {
/// #     fn start(_: &mut Board) -> Self { Self }
/// #     fn update(&mut self, _: &mut Board) {}
/// #     fn draw<'p>(&'p self, _: &mut Picture<'p>) -> Result<(), PictureError> { Ok(()) }
/// # }
/// glint_program::run!(Game);
/// # assert_eq!(main(), std::process::ExitCode::SUCCESS);
/// ```
#[macro_export]
macro_rules! run {
    ($program:ty) => {
        #[cfg(target_arch = "riscv32")]
        #[allow(unsafe_code)] // The start-up code calls this symbol.
        #[unsafe(export_name = "main")]
        extern "C" fn glint_main() -> ! {
            $crate::machine::run::<$program>()
        }

        #[cfg(not(target_arch = "riscv32"))]
        fn main() -> std::process::ExitCode {
            $crate::host::main::<$program>()
        }
    };
}
