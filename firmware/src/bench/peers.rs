//! Benchmark of the sine and cosine of third-party crates, for comparison with `glint-core`.

use core::f32::consts::TAU;

use micromath::F32Ext;

use super::measure::{Report, measure};

/// Measures the sine and cosine of third-party crates, each in its own formats.
pub fn sine(report: Report) {
    // Converts the phase to radians, within ±π.
    let radians = |phase: u32| phase.cast_signed() as f32 * (TAU / 4_294_967_296.0);
    measure(report, "micromath", radians, |angle: f32| {
        (angle.sin(), angle.cos())
    });
    measure(report, "idsp", u32::cast_signed, idsp::cossin);
    measure(
        report,
        "cordic",
        |phase| fixed::types::I8F24::from_num(radians(phase)),
        cordic::sin_cos,
    );
    measure(report, "libm", radians, libm::sincosf);
}
