//! The wireframe simulator's segments, from the program to the picture.

use anyhow::{Context, Result};
use glint_core::choice::Choice;
use glint_core::colour::Rgb565;
use glint_core::fixed::Q5_11;
use glint_core::picture::{Samples, Size};
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{Key, Motion, Point, Program, Projection};
use glint_model::wireframe::render_wireframe;
use glint_model::{WireframeStats, WireframeSubject};
use glint_vectors::Picture;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("wireframe-segment", segment),
        Kind::new("wireframe-segments", segments),
        Kind::new("wireframe-there-and-back", there_and_back),
        Kind::new("wireframe-pan", pan),
        Kind::new("wireframe-program", |text: String| {
            Ok(Outcome::of(assemble(&text), |program| {
                format!("{} bytes", program.len())
            }))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Viewed {
    /// The coordinates of both end points.
    segment: String,
    /// z of the view plane. The eye is at z = 4; the window has 160 pixels per unit in a picture 640 wide.
    #[serde(default = "two")]
    plane: String,
}

fn two() -> String {
    "2".to_owned()
}

/// The start of a program with a window of ±2 × ±1.125.
fn head(plane: &str) -> String {
    format!("eye 0 0 4\nplane {plane}\nwindow -2 -1.125 2 1.125\n")
}

/// Projects and draws a segment.
fn segment(Viewed { segment, plane }: Viewed) -> Result<Outcome> {
    let text = format!("{}segment {segment}\nend\n", head(&plane));
    let bytes = match assemble(&text) {
        Ok(bytes) => bytes,
        Err(error) => return Ok(Outcome::Refused(error.to_string())),
    };
    let program = Program::new_checked(&bytes)?;
    let moved = Motion::default()
        .pose()
        .segment(program.segments().next().context("no segment")?);
    let ends = Projection::new(program.viewing(), Size::W640).line(moved);
    let pixels = draw(&bytes, Size::W640)?.pixels;
    Ok(Outcome::exact(match ends {
        None => format!("left out, {pixels} pixels"),
        Some(ends) => {
            let [[ax, ay], [bx, by]] = ends.map(|end| end.map(|x| f64::from(x) / 256.0));
            format!("from ({ax}, {ay}) to ({bx}, {by}), {pixels} pixels")
        }
    }))
}

fn draw(bytes: &[u8], size: Size) -> Result<WireframeStats> {
    let subject = WireframeSubject {
        program: Program::new_checked(bytes).map_err(|error| anyhow::anyhow!("{error}"))?,
        pose: Motion::default().pose(),
    };
    let [width, height] = size.pixels();
    let mut picture = Picture::blank((width, height));
    Ok(render_wireframe(
        &subject,
        Rgb565(0),
        size.into(),
        Samples::One,
        &mut picture.target(),
        &mut || {},
    )?)
}

/// Draws the given number of horizontal segments across the window, 1/1024 apart.
fn segments(count: u32) -> Result<Outcome> {
    let y = |i: u32| f64::from(i % 2304) / 1024.0 - 1.125;
    let lines: String = (0..count)
        .map(|i| format!("segment -2 {y} 2 2 {y} 2\n", y = y(i)))
        .collect();
    match assemble(&format!("{}{lines}end\n", head("2"))) {
        Ok(bytes) => {
            let stats = draw(&bytes, Size::W320)?;
            Ok(Outcome::exact(format!(
                "{} lines of {} segments",
                stats.lines, stats.segments
            )))
        }
        Err(error) => Ok(Outcome::Refused(error.to_string())),
    }
}

/// The position of the point (1, 1, 1) after a motion.
fn place(motion: &Motion) -> String {
    let point: Point = [Q5_11::ONE; 3];
    let [x, y, z] = motion.pose().point(point);
    format!("(1, 1, 1) at ({x}, {y}, {z})")
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turns {
    /// Two keys that rotate in opposite directions.
    keys: [String; 2],
    times: u32,
}

/// Rotates this many times by the first key, then as often by the second key.
fn there_and_back(Turns { keys, times }: Turns) -> Result<Outcome> {
    let mut motion = Motion::default();
    for name in keys {
        let key = Key::from_word(&name).with_context(|| format!("no key {name:?}"))?;
        for _ in 0..times {
            motion.apply(key.step(true));
        }
    }
    Ok(Outcome::exact(place(&motion)))
}

/// Pans to the right until the limit is reached, at most `times` times.
fn pan(times: u32) -> Result<Outcome> {
    let mut motion = Motion::default();
    let steps = (0..times).take_while(|_| motion.apply(Key::Right.step(false)));
    let steps = steps.count();
    Ok(Outcome::exact(format!("{steps} steps; {}", place(&motion))))
}
