//! Drawing of frames by the gateware: by the triangle engine, and by the raymarcher in the triangle engine's raster pass.
//!
//! ```text
//! renderer (with its parts lines: wireframes and edges of meshes, and repeat: benchmark loops)
//!    ├── geometry (passes of the meshes, clipping)
//!    ├── buffers (memory of the passes, and rectangles)
//!    ├── watchdog (progress of the engine)
//!    ├── rendered (result and cost of a frame)
//!    └── fallback (reasons to draw, or to make descriptors, by the CPU)
//! eyes ── renderer (stereo pictures with meshes)
//! ```

mod buffers;
mod eyes;
mod fallback;
#[allow(unsafe_code)] // Memory that the geometry passes read and write.
mod geometry;
mod quarters;
mod rectangles;
mod rendered;
#[allow(unsafe_code)] // Memory that the triangle engine reads and writes.
mod renderer;
mod watchdog;

pub use eyes::RightEye;
pub use fallback::{Fallback, Unsupported};
pub use geometry::Cpu;
pub use rendered::Rendered;
pub use renderer::{GatewareRenderer, Output};
