//! Sines, angles, directions, reciprocals, gains, depths and colours at the ends of their ranges.

use anyhow::Result;
use glint_core::colour::Rgb565;
use glint_core::cordic::to_polar;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::orientation::Gain;
use glint_core::trig::sin_cos_q30;
use glint_core::vector::unit;
use glint_model::DepthScale;
use glint_model::triangle::reciprocal::Reciprocal;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("sine-q30", |angle| {
            let (sin, cos) = sin_cos_q30(Turns(angle));
            Ok(Outcome::exact(format!("sin {sin}, cos {cos}")))
        }),
        Kind::new("sine-error", sine_error),
        Kind::new("degrees", |text: String| {
            let number = text.parse::<Q32_32>().map(Turns::from_degrees);
            Ok(Outcome::of(number, |angle| format!("{}/2^32", angle.0)))
        }),
        Kind::new("polar", |[x, y]: [i64; 2]| {
            let (length, angle) = to_polar(x, y);
            Ok(Outcome::exact(format!(
                "length {length}, angle {}/2^32",
                angle.0
            )))
        }),
        Kind::new("unit", |vector| {
            Ok(Outcome::exact(unit::<30>(vector).map_or_else(
                || "no direction".to_owned(),
                |[x, y, z]| format!("({x}, {y}, {z})/2^30"),
            )))
        }),
        Kind::new("unit-error", unit_error),
        Kind::new("reciprocal", |number: String| {
            let Reciprocal { y, lead } = Reciprocal::of(number.parse()?);
            Ok(Outcome::exact(format!("{y}/2^{}", 24 + lead)))
        }),
        Kind::new("reciprocal-error", reciprocal_error),
        Kind::new("gain-error", gain_error),
        Kind::new("depth", depth),
        Kind::new("colour", |rgb| {
            let colour = Rgb565::from_rgb888(rgb);
            Ok(Outcome::exact(format!(
                "{:04x}, shown as {:?}",
                colour.0,
                colour.to_rgb888()
            )))
        }),
    ]
}

/// The larger of the errors of sine and cosine, against f64.
fn sine_error(angle: u32) -> Result<Outcome> {
    let (sin, cos) = sin_cos_q30(Turns(angle));
    let exact = (f64::from(angle) / 2f64.powi(32) * std::f64::consts::TAU).sin_cos();
    let error = |found: glint_core::fixed::Q2_30, exact: f64| {
        (f64::from(found.to_bits()) - exact * 2f64.powi(30)).abs()
    };
    let larger = error(sin, exact.0).max(error(cos, exact.1));
    Ok(Outcome::Error(larger, "of 2^-30"))
}

/// The largest error of the components of a direction, against f64.
fn unit_error(vector: [i64; 3]) -> Result<Outcome> {
    let Some(found) = unit::<30>(vector) else {
        return Ok(Outcome::exact("no direction"));
    };
    let exact = vector.map(|x| x as f64);
    let length = exact.iter().map(|x| x * x).sum::<f64>().sqrt();
    let errors = [0, 1, 2].map(|i| (f64::from(found[i]) - exact[i] / length * 2f64.powi(30)).abs());
    Ok(Outcome::Error(
        errors.into_iter().fold(0.0, f64::max),
        "of 2^-30",
    ))
}

/// The relative error of a reciprocal, against f64.
fn reciprocal_error(number: String) -> Result<Outcome> {
    let number: u64 = number.parse()?;
    let Reciprocal { y, lead } = Reciprocal::of(number);
    let product = number as f64 * f64::from(y) * 2f64.powi(-24 - lead as i32);
    Ok(Outcome::Error(
        (product - 1.0).abs() * 2f64.powi(22),
        "of 2^-22 of it",
    ))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Step {
    /// Time constant and step in µs.
    time_constant: u32,
    step: u32,
}

/// The error of the gain of a filter, against 1 − exp(−dt/τ) in f64.
fn gain_error(
    Step {
        time_constant,
        step,
    }: Step,
) -> Result<Outcome> {
    let found = Gain::new(time_constant).of(step);
    let exact = -(-f64::from(step) / f64::from(time_constant)).exp_m1();
    Ok(Outcome::Error(
        (f64::from(found) - exact * 2f64.powi(32)).abs(),
        "of 2^-32",
    ))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Code {
    mantissa: u32,
    exponent: i32,
    /// In orthographic projection, the depth of the code 2^18, with 37 fraction bits.
    origin: Option<i64>,
    code: u32,
}

/// The depth of a code.
fn depth(input: Code) -> Result<Outcome> {
    let scale = DepthScale {
        mantissa: input.mantissa,
        exponent: input.exponent,
        origin: input.origin,
    };
    Ok(Outcome::exact(scale.distance(input.code).map_or_else(
        || "no surface".to_owned(),
        |depth| format!("depth {depth}"),
    )))
}
