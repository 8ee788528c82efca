//! Benchmark of other kernels of sine and cosine, for comparison with that of `glint-core`.

use core::f32::consts::TAU;

use fixed::types::{I4F28, I8F24, I16F16};
use glint_core::fixed::Turns;
use glint_core::trig::{sin_cos_q30, sin_cos_q30_order};
use micromath::F32Ext;

use super::measure::{Report, measure};

/// Measures `glint-core` with polynomials of lower order, and the sine and cosine of third-party crates, each in its own formats.
pub fn sine(report: Report) {
    measure(report, "sin_cos_q30_order2", Turns, sin_cos_q30_order::<2>);
    measure(report, "sin_cos_q30_order1", Turns, sin_cos_q30_order::<1>);
    measure(report, "sin_cos_q30_order0", Turns, sin_cos_q30_order::<0>);
    // Converts the phase to radians, within ±π.
    let radians = |phase: u32| phase.cast_signed() as f32 * (TAU / 4_294_967_296.0);
    measure(report, "micromath", radians, |angle: f32| {
        (angle.sin(), angle.cos())
    });
    measure(report, "idsp", u32::cast_signed, idsp::cossin);
    let narrow = |phase| I16F16::from_num(radians(phase));
    measure(report, "cordic_i16f16", narrow, cordic::sin_cos);
    let middle = |phase| I8F24::from_num(radians(phase));
    measure(report, "cordic", middle, cordic::sin_cos);
    let wide = |phase| I4F28::from_num(radians(phase));
    measure(report, "cordic_i4f28", wide, cordic::sin_cos);
    measure(report, "libm", radians, libm::sincosf);
    degree_table(report);
}

/// Measures a table of sines of one entry per degree, from an original design, for angles in degrees with 16 fraction bits.
fn degree_table(report: Report) {
    let table: [i32; 181] = core::array::from_fn(|degree| {
        let (sine, _) = sin_cos_q30(Turns((degree as u64 * (1 << 32) / 360) as u32));
        (sine.to_bits() + (1 << 13)) >> 14
    });
    let sine = |degree: u32| match degree % 360 {
        low @ 0..=180 => table[low as usize],
        high => -table[high as usize - 180],
    };
    let degrees = |phase: u32| ((u64::from(phase) * (360 << 16)) >> 32) as u32;
    measure(report, "degree_table", degrees, |angle: u32| {
        (sine(angle >> 16), sine(450 - (angle >> 16)))
    });
}
