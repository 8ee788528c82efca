//! Errors of fog, sky, luminance and the ends of lines: functions of pixels that are tables or few bits in the gateware.

use anyhow::{Context, Result};
use glint_core::colour::{Rgb565, luminance};
use glint_core::field::Field;
use glint_core::fixed::{Q5_11, Q12_20, U4_28};
use glint_core::light::Background;
use glint_core::picture::Size;
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{Program, Projection};
use glint_model::raymarch::{FieldOptions, FieldSetup, Palette};
use glint_model::{DepthScale, Fog, Sky};
use glint_vectors::camera::Size as Pixels;

use super::trial::{Errors, Trial, trial};
use crate::camera::Camera;

/// Largest product of density and depth that is measured: the fog hides all but 0.03 % there.
const DENSEST: f64 = 8.0;
/// Bits of the whole pixels of a position in the guard band, with the sign.
const WHOLE: u32 = 12;
/// Number of measured depths, and of measured lines.
const INPUTS: u32 = 1 << 16;

/// The share of a colour that the fog hides at a product of density and depth, in 255ths.
fn hidden(x: f64) -> f64 {
    255.0 * (1.0 - (-x).exp())
}

/// Measures the errors of a share of fog, in 255ths, for products of density and depth up to [`DENSEST`]. The products are evenly spaced on
/// a logarithmic scale over 12 octaves. A table has 8 bits for each entry.
pub fn fogs(thinning: u32) -> Result<Vec<Trial>> {
    let sweep = |share: &dyn Fn(f64) -> f64| {
        let mut errors = Errors::default();
        for i in (0..INPUTS).step_by(thinning as usize) {
            let x = DENSEST * (-12.0 * (f64::from(i) + 0.5) / f64::from(INPUTS)).exp2();
            errors.add(&[share(x) - hidden(x)], || format!("{x:.5}"));
        }
        errors
    };
    // A table of the shares at the middles of equal steps.
    let steps = |entries: u32| {
        let step = DENSEST / f64::from(entries);
        let share = |x: f64| hidden(((x / step).floor() + 0.5) * step).round();
        trial(
            "fog_steps",
            format!("equal steps: {entries}"),
            false,
            8 * entries,
            sweep(&share),
        )
    };
    // A table of the shares at the middles of steps of the exact logarithm.
    let octaves = |number: u32| {
        let steps = f64::from(number);
        let share = |x: f64| {
            let middle = ((x.log2() * steps).floor() + 0.5) / steps;
            hidden(middle.exp2()).round()
        };
        trial(
            "fog_octaves",
            format!("exact logarithm: {number} steps an octave"),
            false,
            8 * 12 * number,
            sweep(&share),
        )
    };
    let mut trials: Vec<_> = [64, 128, 256, 512, 1024].map(steps).into();
    trials.push(trial(
        "fog_field",
        "growing steps: 64 equal, 32 in each further octave, of fields".to_owned(),
        true,
        8 * 256,
        of_field(sweep)?,
    ));
    trials.extend([16, 32, 64].map(octaves));
    trials.push(trial(
        "fog_mesh",
        "logarithm of 7 bits: 128 steps an octave, of meshes".to_owned(),
        true,
        8 * 12 * 128,
        of_mesh(sweep)?,
    ));
    trials.push(octaves(128));
    Ok(trials)
}

/// The errors of the fog on fields.
fn of_field(sweep: impl Fn(&dyn Fn(f64) -> f64) -> Errors) -> Result<Errors> {
    let field = Field::parse("menger:3").map_err(|error| anyhow::anyhow!("{error}"))?;
    let view = Camera::looking([0.0, -2.0, 0.0], [0.0; 3], 0.9, 0.1).view()?;
    let setup = FieldSetup::new(&field, &view, (640, 360), &FieldOptions::of(&field))?;
    let density = U4_28::from_num(0.5);
    let palette = Palette::default().with_fog(&setup, density);
    // The product of density and depth at a depth of one field unit times 2^e.
    let unit =
        density.to_num::<f64>() / (setup.scale.to_num::<f64>() * f64::from(setup.exponent).exp2());
    let fine = 21_f64.exp2();
    Ok(sweep(&|x| {
        f64::from(palette.fog_at((x / unit * fine) as u64))
    }))
}

/// The errors of the fog on meshes. The depth codes are large, so that their own rounding has no effect.
fn of_mesh(sweep: impl Fn(&dyn Fn(f64) -> f64) -> Errors) -> Result<Errors> {
    let scale = DepthScale {
        mantissa: 1 << 20,
        exponent: 0,
        origin: None,
    };
    let density = U4_28::from_num(0.5);
    let fog = Fog::new(density, scale, [255; 3]).context("fog")?;
    let largest = density.to_num::<f64>() * f64::from(scale.mantissa);
    Ok(sweep(&|x| {
        f64::from(fog.share((largest / x).round() as u32))
    }))
}

/// Measures the errors of the sky's colours, in steps of 1/255 of a channel before they are rounded to RGB565, over the pixels of a
/// picture with a sloping horizon.
pub fn skies(thinning: u32) -> Result<Vec<Trial>> {
    let size = Size::W640;
    let [width, height] = size.pixels();
    let level = Camera::looking([0.0, -2.0, 0.3], [0.3, 0.0, 0.1], 0.9, 0.1);
    let camera = level.turned([0.1, 0.5, 0.2]);
    let gradient = Background::Sky.gradient().context("a gradient")?;
    let sky = Sky::new(&camera.view()?, [width, height], gradient);
    let exact = |pixel: [f64; 2]| {
        let ray = camera.ray(pixel, Pixels { width, height });
        let n: f64 = ray.direction.iter().zip(camera.n).map(|(a, b)| a * b).sum();
        ray.direction[2] / n
    };
    let colour = |high: f64, share: f64| {
        let [zenith, horizon, nadir] = gradient.colours.map(|colour| colour.map(f64::from));
        let end = if high < 0.0 { nadir } else { zenith };
        [0, 1, 2].map(|i: usize| horizon[i] + (end[i] - horizon[i]) * share)
    };
    let sweep = |found: &dyn Fn(u32, u32) -> [f64; 3]| {
        let mut errors = Errors::default();
        for y in (0..height).step_by(thinning as usize) {
            for x in 0..width {
                let high = exact([x, y].map(f64::from));
                let wanted = colour(high, high.abs().min(1.0));
                let found = found(x, y);
                let off = [0, 1, 2].map(|i: usize| found[i] - wanted[i]);
                errors.add(&off, || format!("{x}, {y}"));
            }
        }
        errors
    };
    let groups = |pixels: u32, bits: u32| {
        let steps = f64::from(bits).exp2();
        let found = |x: u32, y: u32| {
            let middle = f64::from(x / pixels * pixels) + f64::from(pixels - 1) / 2.0;
            let high = exact([middle, y.into()]);
            let share = (high.abs() * steps).floor().min(steps - 1.0) / (steps - 1.0);
            colour(high, share).map(f64::round)
        };
        let place = match pixels {
            1 => "each pixel".to_owned(),
            _ => format!("{pixels} pixels"),
        };
        trial(
            "sky_group",
            format!("a colour for {place}: share of {bits} bits"),
            false,
            bits,
            sweep(&found),
        )
    };
    let mut trials = vec![groups(8, 6), groups(16, 8)];
    trials.push(trial(
        "sky",
        "a colour for 8 pixels: share of 8 bits".to_owned(),
        true,
        8,
        sweep(&|x, y| sky.colour(x / 8, y).map(f64::from)),
    ));
    trials.extend([groups(8, 10), groups(1, 8), groups(1, 10)]);
    Ok(trials)
}

/// Measures the errors of the luminance of all colours in RGB565, in 255ths. The cost is the number of bits of a weight.
pub fn luminances(thinning: u32) -> Vec<Trial> {
    const EXACT: [f64; 3] = [0.299, 0.587, 0.114];
    let sweep = |found: &dyn Fn([u8; 3]) -> f64| {
        let mut errors = Errors::default();
        for pixel in (0..=u16::MAX).step_by(thinning as usize | 1) {
            let rgb = Rgb565(pixel).to_rgb888();
            let exact: f64 = rgb.iter().zip(EXACT).map(|(&c, w)| f64::from(c) * w).sum();
            errors.add(&[found(rgb) - exact], || format!("{pixel:04x}"));
        }
        errors
    };
    let weights = |weights: [u32; 3], bits: u32| {
        let found = |rgb: [u8; 3]| {
            let sum: u32 = rgb
                .iter()
                .zip(weights)
                .map(|(&c, w)| u32::from(c) * w)
                .sum();
            f64::from((sum + (1 << (bits - 1))) >> bits)
        };
        trial(
            "luminance_weights",
            format!("weights {weights:?} of 2^{bits}"),
            false,
            bits,
            sweep(&found),
        )
    };
    let mut trials = vec![
        weights([1, 2, 1], 2),
        weights([5, 9, 2], 4),
        weights([19, 38, 7], 6),
    ];
    trials.push(trial(
        "luminance",
        "weights [77, 150, 29] of 2^8".to_owned(),
        true,
        8,
        sweep(&|rgb| luminance(rgb).into()),
    ));
    trials.push(weights([306, 601, 117], 10));
    trials
}

/// Measures the errors of the ends of a wireframe's lines, in pixels of a picture 640 wide, for random points behind the view plane. The
/// cost is the number of bits of a position, [`WHOLE`] of which are whole pixels.
pub fn lines(thinning: u32) -> Result<Vec<Trial>> {
    let program =
        assemble("eye 0 0 4\nplane 1\nwindow -2 -1.125 2 1.125\nsegment 0 0 0 1 1 0\nend\n")?;
    let program = Program::new_checked(&program)?;
    let viewing = program.viewing();
    let projection = Projection::new(viewing, Size::W640);
    let bits = |x: f64| Q5_11::from_num(x).to_num::<f64>();
    let exact = |[x, y, z]: [f64; 3]| {
        let scale = 160.0 * 3.0 / (4.0 - z);
        [320.0 + scale * x, 180.0 - scale * y]
    };
    let sweep = |found: &dyn Fn([f64; 3]) -> Option<[f64; 2]>| {
        let mut errors = Errors::default();
        let mut state = 1_u32;
        let mut random = |reach: f64| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            bits(reach * (f64::from(state) / f64::from(u32::MAX) - 0.5))
        };
        for _ in (0..INPUTS).step_by(thinning as usize) {
            let point = [random(6.0), random(3.0), random(8.0) - 3.0];
            if let Some(found) = found(point) {
                let wanted = exact(point);
                let off = [0, 1].map(|i: usize| found[i] - wanted[i]);
                errors.add(&off, || format!("{point:?}"));
            }
        }
        errors
    };
    let rounded = |bits: u32, by: fn(f64) -> f64, name: &str| {
        let unit = f64::from(bits).exp2();
        let found = |point| Some(exact(point).map(|x| by(x * unit) / unit));
        trial(
            "line_end_rounded",
            format!("{name}: {bits} fraction bits"),
            false,
            WHOLE + bits,
            sweep(&found),
        )
    };
    let mut trials = vec![
        rounded(0, f64::trunc, "truncated"),
        rounded(0, f64::round, "to nearest"),
        rounded(4, f64::round, "to nearest"),
        rounded(8, f64::trunc, "truncated"),
    ];
    trials.push(trial(
        "line_end",
        "to nearest: 8 fraction bits, of a quotient".to_owned(),
        true,
        WHOLE + 8,
        sweep(&|point| {
            let point = point.map(Q12_20::from_num);
            let [end, _] = projection.line([point, point])?;
            Some(end.map(|x| f64::from(x) / 256.0))
        }),
    ));
    trials.push(rounded(12, f64::round, "to nearest"));
    Ok(trials)
}
