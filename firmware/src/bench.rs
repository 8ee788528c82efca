//! Benchmarks on the soft core: clock cycles of kernels (small functions such as sine and cosine).

use glint_core::fixed::Turns;
use glint_core::trig::sin_cos_q30;

#[cfg(feature = "peers")]
mod attitude;
#[cfg(feature = "peers")]
mod geometry;
#[cfg(feature = "peers")]
mod gesture;
#[cfg(feature = "peers")]
mod kernels;
mod measure;
mod object;
#[cfg(feature = "peers")]
mod peers;

#[cfg(feature = "peers")]
pub use attitude::attitude;
#[cfg(feature = "peers")]
pub use geometry::geometry;
#[cfg(feature = "peers")]
pub use gesture::gesture;
#[cfg(feature = "peers")]
pub use kernels::kernels;
pub use measure::{Cycles, Report};
pub use object::object;

use measure::measure;

/// Measures sine and cosine, and reports their clock cycles.
pub fn sine(report: Report) {
    measure(report, "sin_cos_q30", Turns, sin_cos_q30);
    #[cfg(feature = "peers")]
    peers::sine(report);
}
