//! Other crates' sines, to compare with.

use core::f32::consts::TAU;

use micromath::F32Ext;

use super::measure;
use crate::terminal::Terminal;

/// Measures the sine and cosine of other crates, each in its own formats.
pub fn sine(terminal: &mut Terminal) {
    // The phase as an angle in radians, in ±π: what the crates with radians take.
    let radians = |phase: u32| phase.cast_signed() as f32 * (TAU / 4_294_967_296.0);
    measure(terminal, "micromath", radians, |angle: f32| {
        (angle.sin(), angle.cos())
    });
    measure(terminal, "idsp", u32::cast_signed, idsp::cossin);
    measure(
        terminal,
        "cordic",
        |phase| fixed::types::I8F24::from_num(radians(phase)),
        cordic::sin_cos,
    );
    measure(terminal, "libm", radians, libm::sincosf);
}
