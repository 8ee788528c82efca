//! Experiment: clocks of pictures with smooth shading on the verilated rasterizer, for different numbers of shaded pixels per clock.

use anyhow::{Context, Result};
use glint_core::colour::Rgb565;
use glint_model::Shading;
use glint_model::triangle::descriptor::{GROUP, band_rows};
use glint_model::triangle::setup::Setup;
use glint_testbench::Rasterizer;
use serde::{Deserialize, Serialize};

use crate::triangle::smooth::scenes;

/// Clocks of the rasterizer for a picture: a line of `gouraud-clocks.csv`.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the shading rate.
    pub rate: String,
    /// Description of the scene.
    pub scene: String,
    /// Number of triangles, each counted once.
    pub triangles: u64,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// Number of groups with at least one covered pixel.
    pub groups: u64,
    /// Number of clocks for all bands.
    pub clocks: u64,
    /// Whether the clocks were measured; otherwise they were computed. A computed number of clocks is a sum over the bands. The summand of
    /// a band is the larger of two numbers: the measured clocks with flat triangles, and the sum of the clocks of its groups.
    pub measured: bool,
}

/// Name of the rate of Glint's rasterizer.
pub const SHIPPED: &str = "a pixel a clock";
/// Name of the rate of flat triangles.
pub const GROUPS: &str = "a group a clock";
/// Name of the rate of two pixels per clock.
pub const PAIRS: &str = "two pixels a clock";
/// Name of the rate with one division per clock, where only two pixels of each group are divided.
pub const ENDS: &str = "a division a clock";

/// Measures the pictures.
///
/// # Errors
/// When a scene is missing.
pub fn measure() -> Result<Vec<Row>> {
    let scenes = scenes();
    let mut rasterizer = Rasterizer::new(Shading::Smooth, 1, [0.0; 2]);
    let mut rows = Vec::new();
    for name in [
        "icosphere:6 from 2",
        "icosphere:2 from 2",
        "inside icosphere:2, back faces",
    ] {
        eprintln!("{name} on the verilated rasterizer …");
        let scene = scenes.iter().find(|scene| scene.name == name);
        let triangles = scene
            .with_context(|| format!("no scene {name}"))?
            .triangles();
        let size = triangles.first().context("the scene has no triangle")?.size;
        let smooth: Vec<Setup> = triangles
            .iter()
            .filter_map(|triangle| triangle.setup())
            .collect();
        let flat: Vec<Setup> = smooth
            .iter()
            .map(|setup| Setup {
                light: None,
                ..*setup
            })
            .collect();
        let shipped = draw(&mut rasterizer, &smooth, size);
        let groups = draw(&mut rasterizer, &flat, size);
        let masks = || shipped.iter().flat_map(|band| &band.masks);
        let mut row = |rate: &str, clocks, measured| {
            rows.push(Row {
                rate: rate.to_owned(),
                scene: name.to_owned(),
                triangles: smooth.len() as u64,
                pixels: masks().map(|mask| u64::from(mask.count_ones())).sum(),
                groups: masks().count() as u64,
                clocks,
                measured,
            });
        };
        let sum = |bands: &[Band]| bands.iter().map(|band| band.clocks).sum();
        row(SHIPPED, sum(&shipped), true);
        row(GROUPS, sum(&groups), true);
        row(
            PAIRS,
            computed(&groups, |mask| pixels(mask).div_ceil(2)),
            false,
        );
        row(
            ENDS,
            computed(&groups, |mask| mask.count_ones().min(2)),
            false,
        );
        row(SHIPPED, computed(&groups, pixels), false);
    }
    Ok(rows)
}

/// A drawn band (strip of lines) of a picture.
struct Band {
    clocks: u64,
    /// The covered pixels of each group; bit 0 is the leftmost pixel.
    masks: Vec<u8>,
}

/// Draws a picture of this width and height band by band. A triangle is drawn smooth if its setup has light, and flat otherwise.
fn draw(rasterizer: &mut Rasterizer, setups: &[Setup], (width, height): (u32, u32)) -> Vec<Band> {
    let rows = band_rows(width);
    let bands = (0..height).step_by(rows as usize).map(|y0| {
        let touched = setups.iter().filter(|setup| {
            setup.bounds.top < (y0 + rows) as i32 && setup.bounds.bottom > y0 as i32
        });
        let triangles = touched.map(|setup| (setup, Rgb565::WHITE));
        let settings = [y0, rows, width / GROUP as u32];
        let (clocks, groups) = rasterizer.band(settings, triangles, |_| ());
        let masks = groups.iter().map(|group| group[1].number() as u8);
        Band {
            clocks,
            masks: masks.collect(),
        }
    });
    bands.collect()
}

/// Computes the number of clocks for all bands; `flat` are the bands with flat triangles, and `of` returns the number of clocks for a
/// group.
fn computed(flat: &[Band], of: fn(u8) -> u32) -> u64 {
    let bands = flat.iter().map(|band| {
        let shading: u64 = band.masks.iter().map(|&mask| u64::from(of(mask))).sum();
        shading.max(band.clocks)
    });
    bands.sum()
}

/// Returns the number of shaded pixels of a group: the pixels from the first pixel (from the fifth pixel if the first four are not covered)
/// to the last covered pixel.
fn pixels(mask: u8) -> u32 {
    let first = if mask & 0xF == 0 { 4 } else { 0 };
    8 - mask.leading_zeros() - first
}
