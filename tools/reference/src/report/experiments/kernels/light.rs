//! Errors of light on round surfaces, of its highlight, and of occlusion.

use anyhow::{Context, Result};
use glint_core::field::{Field, FixedSphere, FixedSpheres, MAX_SPHERES};
use glint_core::fixed::Q32_32;
use glint_core::light::{Highlight, Light, Lighting, Material, highlight_share};
use glint_model::raymarch::{Lights, Palette};

use super::trial::{Errors, Trial, trial};

/// Number of measured points of a sphere.
const POINTS: u32 = 1 << 16;
/// Radius of the measured sphere in units of 2^-12 field units.
const RADIUS: i32 = 300 << 12;
/// Directions to the lights and their colours; the last one is behind most points.
const LIGHTS: [([i64; 3], [u8; 3]); 2] =
    [([1, -3, 5], [255, 240, 216]), ([2, 0, -1], [48, 64, 92])];

/// A direction of length 1, evenly distributed for evenly distributed numbers.
fn direction(i: u32) -> [f64; 3] {
    let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(POINTS);
    let (sin, cos) = (f64::from(i) * std::f64::consts::PI * (5_f64.sqrt() - 1.0)).sin_cos();
    let across = (1.0 - z * z).sqrt();
    [across * cos, across * sin, z]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Measures the errors of the colours of points on a sphere, in 255ths of a channel before they are rounded to RGB565, in ambient light and
/// two lights. The cost is the number of bits of a cosine.
pub fn rounds(thinning: u32) -> Result<Vec<Trial>> {
    let mut lighting = Lighting {
        ambient: [48, 52, 56],
        ..Lighting::PLAIN
    };
    for (towards, colour) in LIGHTS {
        let light = Light::new(towards.map(Q32_32::from_num), colour)?;
        lighting
            .lights
            .push(light)
            .ok()
            .context("a place for a light")?;
    }
    let lights = Lights::new(Material::Ivory, &lighting);
    let spheres = FixedSpheres {
        list: [FixedSphere::new([0; 3], RADIUS); MAX_SPHERES],
        count: 1,
        repeated: false,
        cone: None,
    };
    let material = lights.materials[0].map(f64::from);
    let towards = LIGHTS.map(|(towards, colour)| {
        let towards = towards.map(|x| x as f64);
        let length = dot(towards, towards).sqrt();
        (towards.map(|x| x / length), colour.map(f64::from))
    });
    // The colour with cosines that `cosine` has rounded.
    let colour = |normal: [f64; 3], cosine: &dyn Fn(f64) -> f64| {
        [0, 1, 2].map(|i: usize| {
            let ambient = f64::from(lighting.ambient[i]);
            let shares = towards
                .iter()
                .map(|(l, c)| cosine(dot(normal, *l).max(0.0)) * c[i]);
            material[i] / 255.0 * (ambient + shares.sum::<f64>()).min(255.0)
        })
    };
    let sweep = |found: &dyn Fn([f64; 3]) -> [f64; 3]| {
        let mut errors = Errors::default();
        for i in (0..POINTS).step_by(thinning as usize) {
            let normal = direction(i);
            let (found, wanted) = (found(normal), colour(normal, &|cosine| cosine));
            let off = [0, 1, 2].map(|i: usize| found[i] - wanted[i]);
            errors.add(&off, || normal.map(|x| format!("{x:.4}")).join(", "));
        }
        errors
    };
    let rounded = |bits: u32, by: fn(f64) -> f64, name: &str| {
        let unit = f64::from(bits).exp2();
        let found = |normal| colour(normal, &|cosine| by(cosine * unit) / unit).map(f64::floor);
        trial(
            "round_cosine",
            format!("{name}: cosines of {bits} bits"),
            false,
            bits,
            sweep(&found),
        )
    };
    let mut trials = vec![
        rounded(4, f64::floor, "rounded down"),
        rounded(6, f64::floor, "rounded down"),
        rounded(8, f64::floor, "rounded down"),
    ];
    trials.push(trial(
        "round_light",
        "all rounded down, of fields: cosines of 8 bits".to_owned(),
        true,
        8,
        sweep(&|normal| {
            let place = normal.map(|x| (x * f64::from(RADIUS)).floor() as i32);
            lights.shine_on(0, &spheres, place).map(f64::from)
        }),
    ));
    trials.extend([
        rounded(8, f64::round, "to nearest"),
        rounded(12, f64::floor, "rounded down"),
    ]);
    Ok(trials)
}

/// Measures the errors of a highlight, in 255ths of its strength, for all exponents, and cosines of 12 bits. The cost is the number of bits
/// of a factor.
pub fn highlights(thinning: u32) -> Result<Vec<Trial>> {
    const COSINES: i32 = 1 << 12;
    let sweep = |found: &dyn Fn(Highlight, f64, i32) -> f64| -> Result<Errors> {
        let mut errors = Errors::default();
        for exponent in (4..=128).step_by(thinning as usize) {
            let highlight = Highlight::parse(&format!("1,{exponent}")).context("a highlight")?;
            for i in 0..=COSINES {
                let cosine = f64::from(i) / f64::from(COSINES);
                let exact = 255.0 * cosine.powi(exponent);
                let found = found(highlight, f64::from(exponent), i * ((1 << 16) / COSINES));
                errors.add(&[found - exact], || format!("{cosine:.4}^{exponent}"));
            }
        }
        Ok(errors)
    };
    // A power of 1 - k(1 - cosine), with factors of some bits; the tangent in 1 has the exponent of the cosine.
    let tangent = |squares: i32, bits: u32| {
        let found = move |_: Highlight, exponent: f64, cosine: i32| {
            let unit = f64::from(bits).exp2();
            let away = (1.0 - f64::from(cosine) / 65_536.0) * exponent / f64::from(squares).exp2();
            let start = ((1.0 - away).max(0.0) * unit).floor() / unit;
            255.0 * (0..squares).fold(start, |x, _| (x * x * unit).floor() / unit)
        };
        let power = 1 << squares;
        let config = format!("same tangent: power {power}, {bits} bits");
        Ok(trial(
            "highlight_tangent",
            config,
            false,
            bits,
            sweep(&found)?,
        ))
    };
    let fitted = |bits: u32| {
        let found = move |highlight: Highlight, _: f64, cosine: i32| {
            let unit = f64::from(bits).exp2();
            let steepness = f64::from(highlight.steepness()) / 256.0;
            let away = (1.0 - f64::from(cosine) / 65_536.0) * steepness;
            let start = ((1.0 - away).max(0.0) * unit).floor() / unit;
            255.0 * (0..2).fold(start, |x, _| (x * x * unit).floor() / unit)
        };
        let config = format!("least error: power 4, {bits} bits");
        Ok(trial(
            "highlight_fitted",
            config,
            false,
            bits,
            sweep(&found)?,
        ))
    };
    let trials: Vec<Result<Trial>> = vec![
        tangent(1, 16),
        tangent(2, 16),
        tangent(3, 16),
        tangent(4, 16),
        fitted(6),
        fitted(8),
        fitted(12),
        sweep(&|highlight, _, cosine| highlight_share(highlight.steepness(), cosine).into()).map(
            |errors| {
                let config = "least error: power 4, 16 bits, of fields".to_owned();
                trial("highlight", config, true, 16, errors)
            },
        ),
        fitted(24),
    ];
    trials.into_iter().collect()
}

/// The share of light that occlusion leaves to the rays of a field, by the number of their steps.
struct Occlusion {
    table: [u8; 256],
    /// Number of steps that leave half of the light.
    half: f64,
    /// Number of steps that leave all of the light.
    free: f64,
}

impl Occlusion {
    fn of(field: &str, half: f64, free: f64) -> Result<Self> {
        let field = Field::parse(field).map_err(|error| anyhow::anyhow!("{error}"))?;
        let table = Palette::default().with_occlusion(&field).occlusion;
        Ok(Self { table, half, free })
    }

    /// The exact share in 255ths.
    fn exact(&self, steps: f64) -> f64 {
        255.0 * self.half / (self.half + (steps - self.free).max(0.0))
    }
}

/// Measures the errors of the share of light that occlusion leaves, in 255ths, for all numbers of steps of marching rays and of rays by
/// exits. The cost is the number of bits of a table.
pub fn occlusions(_: u32) -> Result<Vec<Trial>> {
    let kinds = [
        Occlusion::of("smooth:0.35,box:1.4,1.4,0.2+sphere:0.75", 40.0, 0.0)?,
        Occlusion::of("menger:3", 6.0, 1.0)?,
    ];
    let sweep = |found: &dyn Fn(&Occlusion, usize) -> f64| {
        let mut errors = Errors::default();
        for kind in &kinds {
            for steps in 0..256 {
                let off = found(kind, steps) - kind.exact(steps as f64);
                errors.add(&[off], || format!("{steps}, half at {}", kind.half));
            }
        }
        errors
    };
    let entries = |number: usize, bits: u32| {
        let steps = 256 / number;
        let unit = (f64::from(bits).exp2() - 1.0) / 255.0;
        let found = |kind: &Occlusion, n: usize| {
            let middle = (n / steps * steps) as f64 + (steps - 1) as f64 / 2.0;
            (kind.exact(middle) * unit).round() / unit
        };
        trial(
            "occlusion_entries",
            format!("to nearest: {number} entries of {bits} bits"),
            false,
            bits * number as u32,
            sweep(&found),
        )
    };
    let mut trials = vec![
        entries(32, 8),
        entries(64, 8),
        entries(128, 8),
        entries(256, 4),
        entries(256, 6),
    ];
    trials.push(trial(
        "occlusion",
        "rounded down: 256 entries of 8 bits".to_owned(),
        true,
        8 * 256,
        sweep(&|kind, steps| kind.table[steps].into()),
    ));
    trials.push(entries(256, 8));
    Ok(trials)
}
