//! Frames by the gateware: the triangle engine, and the raymarcher in its raster pass.
//!
//! ```text
//! renderer ── repeat (benchmark loops)
//!    ├── buffers (memory of the passes)
//!    ├── watchdog (progress of the engine)
//!    └── fallback (reasons to draw by the CPU)
//! ```

mod buffers;
mod fallback;
#[allow(unsafe_code)] // Memory that the triangle engine reads and writes.
mod renderer;
mod repeat;
mod watchdog;

pub use fallback::Fallback;
pub use renderer::{GatewareRenderer, Output, Rendered};
