//! The engines: blocks that compute their results with the functions of `glint_model`.
//!
//! An engine reads its parameters from its registers and its input from main memory, as the gateware does. Its results, exact
//! counts, errors and interrupts equal those of the gateware; its time is an estimate.

mod gesture;
mod parameters;
mod pass;
mod raymarch;
mod triangle;

pub use gesture::GestureEngine;
pub use raymarch::Raymarcher;
pub use triangle::TriangleEngine;
