//! Drawing of frames by the gateware: by the triangle engine, and by the raymarcher in the engine's raster pass.
//!
//! ```text
//! renderer ── repeat (benchmark loops)
//!    ├── geometry (passes of the meshes, clipping)
//!    ├── lines (wireframes, edges of meshes)
//!    ├── buffers (memory of the passes)
//!    ├── watchdog (progress of the engine)
//!    └── fallback (reasons to draw, or to make descriptors, by the CPU)
//! ```

mod buffers;
mod fallback;
#[allow(unsafe_code)] // Memory that the geometry passes read and write.
mod geometry;
mod lines;
#[allow(unsafe_code)] // Memory that the triangle engine reads and writes.
mod renderer;
mod repeat;
mod watchdog;

pub use fallback::{Fallback, Lack};
pub use geometry::Cpu;
pub use renderer::{GatewareRenderer, Output, Rendered};
