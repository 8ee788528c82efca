//! The wireframe simulator: its programs, the motion of the picture by keys, and the projection to the screen (docs/wireframe.md).
//!
//! A program is a list of 99-bit instructions: the eye, the view plane, the window, segments, and an end.
//! [`Program::new_checked`] checks the binary form without a copy; [`text`] implements the text form. [`Requests`] stores the
//! pressed keys; each frame takes one of them. [`Motion`] is the motion of all segments so far; [`accumulate`] implements the
//! rotation of the original design, which rounds the end points in place and therefore drifts. [`Projection`] maps a moved
//! segment to the screen.

pub mod accumulate;
mod cube;
mod edges;
mod error;
mod format;
mod instruction;
mod keys;
mod motion;
mod program;
mod projection;
pub mod text;

pub use cube::{CUBE, CUBE_NAME};
pub use edges::unique_edges;
pub use error::{Expected, Found, Location, ProgramError, Violation};
pub use format::{
    EXTENSIONS, MAX_SEGMENTS, Opcode, Point, Segment, WORD_BYTES, Window, is_program_file,
};
pub use instruction::Instruction;
pub use keys::{DEBOUNCE_MS, Debouncer, Key, Requests};
pub use motion::{Motion, PAN, Pose, ROTATION_COSINE, ROTATION_SINE, Step};
pub use program::{Checker, Program, Viewing};
pub use projection::{GUARD, Projection, ScreenLine};
