//! Errors of a pixel's stored depth and colour.

use anyhow::Result;
use glint_core::fixed::Q32_32;
use glint_model::triangle::MeshSetup;
use glint_model::triangle::vertex::{CameraVertex, snap};
use glint_variants::colour::PIXELS;

use super::trial::{Errors, Trial};
use crate::camera::Camera;

/// Depths of the near plane and of the farthest surface, in world units.
const RANGE: [f64; 2] = [0.1, 10.0];
/// Number of depths.
const DEPTHS: u32 = 1 << 18;

/// Measures the relative errors of depths that are converted to a code and back. The depths are evenly spaced on a logarithmic scale over
/// the range.
pub fn depths(thinning: u32) -> Result<Vec<Trial>> {
    let [near, far] = RANGE;
    let depth = |i: u32| near * (far / near).powf(f64::from(i) / f64::from(DEPTHS));
    let sweep = |kernel, config: String, bits, stored: &dyn Fn(f64) -> f64| {
        let mut errors = Errors::default();
        for z in (0..=DEPTHS).step_by(thinning as usize).map(depth) {
            errors.add(&[stored(z) / z - 1.0], || format!("{z:.5}"));
        }
        Trial {
            kernel,
            config,
            shipped: false,
            bits: Some(bits),
            errors,
        }
    };
    let linear = |bits: u32| {
        let codes = f64::from(bits).exp2() - 1.0;
        let step = (far - near) / codes;
        sweep(
            "depth_linear",
            format!("linear in z, {bits} bits"),
            bits,
            &|z| near + ((z - near) / step).round() * step,
        )
    };
    let inverse = |bits: u32| {
        let scale = near * (f64::from(bits).exp2() - 1.0);
        sweep("depth_inverse", format!("1/z, {bits} bits"), bits, &|z| {
            scale / (scale / z).round()
        })
    };
    let mut trials = vec![inverse(12), inverse(16)];
    trials.push(Trial {
        shipped: true,
        ..shipped(near, |stored| {
            sweep(
                "depth_code",
                "1/z, 18 bits, of the vertex stage".to_owned(),
                18,
                stored,
            )
        })?
    });
    trials.extend([
        inverse(20),
        inverse(24),
        linear(12),
        linear(16),
        linear(18),
        linear(24),
    ]);
    trials.push(sweep("depth_f32", "f32".to_owned(), 32, &|z| {
        f64::from(z as f32)
    }));
    Ok(trials)
}

/// Calls `sweep` with a function that converts a depth to the vertex stage's code and back.
fn shipped(near: f64, sweep: impl Fn(&dyn Fn(f64) -> f64) -> Trial) -> Result<Trial> {
    let camera = Camera::looking([0.0, -1.0, 0.0], [0.0; 3], 1.0, near);
    let frame = MeshSetup::new(&camera.view()?, 320, 180, 1 << 15)?;
    Ok(sweep(&|z| {
        let vertex = CameraVertex {
            z: (z * 37_f64.exp2()).round() as i64,
            ..CameraVertex::default()
        };
        let code = (snap(&frame, &vertex).w + 32) >> 6;
        frame.depth.distance(code).map_or(0.0, Q32_32::to_num)
    }))
}

/// Measures the errors of displayed colours, in steps of 1/255 of a channel, for all colours with eight bits per channel.
pub fn colours(thinning: u32) -> Vec<Trial> {
    let trial = |pixel: &glint_variants::colour::Pixel| {
        let mut errors = Errors::default();
        for rgb in (0..1_u32 << 24).step_by(thinning as usize | 1) {
            let [_, red, green, blue] = rgb.to_be_bytes();
            let shown = (pixel.shown)((pixel.pack.run)(rgb));
            let off = [0, 1, 2].map(|i| f64::from(shown[i]) - f64::from([red, green, blue][i]));
            errors.add(&off, || format!("{rgb:06x}"));
        }
        Trial {
            bits: Some(pixel.bits),
            ..Trial::of(&pixel.pack, errors)
        }
    };
    PIXELS.iter().map(trial).collect()
}
