//! Experiment: colours of textures by filter and mip level, compared with the average of 64 samples of a pixel.

use glint_core::colour::{Rgb565, Rounding};
use glint_core::texture::{Filter, Format, Sampler, Texture};
use glint_texture::convert::convert;
use glint_texture::levels::{linear, srgb};
use glint_texture::options::{Options, filter_name, format_name};
use glint_texture::picture::Picture;
use serde::{Deserialize, Serialize};

use crate::errors::Errors;
use crate::triangle::textured::{Drawn, Pixel, Scene, scenes};

/// Errors of a filter in a scene: a line of `textures-filters.csv`. Errors are in steps of 1/255 of a channel.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the filter.
    pub filter: String,
    /// Name of the mip level that is read.
    pub level: String,
    /// Whether Glint reads this level.
    pub shipped: bool,
    /// Number of texels that the filter reads per pixel.
    pub texels: u32,
    /// Description of the scene.
    pub scene: String,
    /// Number of compared pixels: those with all samples in one triangle.
    pub pixels: u64,
    /// Largest error.
    pub max_err: f64,
    /// RMS of the errors.
    pub rms: f64,
}

/// Size and error of a texture: a line of `textures-formats.csv`. Errors are in steps of 1/255 of a channel.
#[derive(Serialize, Deserialize)]
pub struct FormatRow {
    /// Description of the picture.
    pub picture: String,
    /// Name of the format.
    pub format: String,
    /// Bytes of the texture, with its mip levels.
    pub bytes: usize,
    /// RMS of the errors of the texels of the largest level.
    pub rms: f64,
    /// Largest error of a texel of the largest level.
    pub max_err: f64,
}

/// Names of the levels, and their differences from Glint's choice; `None` for level 0, the largest.
const LEVELS: [(&str, Option<i32>); 4] = [
    ("0", None),
    ("one finer", Some(-1)),
    ("by distance", Some(0)),
    ("one coarser", Some(1)),
];
/// Samples of a pixel in each direction.
const SAMPLES: usize = 8;
/// Only every `ROWS`-th row of a picture is compared, because the samples take time.
const ROWS: i32 = 7;

/// Measures filters and levels in all scenes.
///
/// # Panics
/// If a texture cannot be made.
#[must_use]
pub fn measure() -> Vec<Row> {
    [Filter::Nearest, Filter::Bilinear]
        .into_iter()
        .flat_map(|filter| {
            let texture = |size_log2: [u8; 2]| {
                let [width, height] = size_log2.map(|side| 1 << side);
                let sampler = Sampler {
                    filter,
                    ..Sampler::default()
                };
                let options = Options {
                    sampler,
                    ..Options::default()
                };
                convert(&tiles([width, height]), &options)
                    .expect("a good texture")
                    .0
            };
            let scenes = scenes(&texture);
            scenes
                .iter()
                .flat_map(|scene| measure_scene(scene, filter))
                .collect::<Vec<_>>()
        })
        .collect()
}

fn measure_scene(scene: &Scene, filter: Filter) -> Vec<Row> {
    let mut errors = [Errors::default(); LEVELS.len()];
    let mut pixels = 0;
    scene.rows(&mut |drawn, number, row| {
        if number % ROWS != 0 {
            return;
        }
        let last = drawn.textured.texture.levels() as i32 - 1;
        for (pixel, chosen) in row.iter().zip(drawn.levels(row)) {
            let Some(exact) = average(drawn, number, pixel) else {
                continue;
            };
            pixels += 1;
            for ((_, difference), errors) in LEVELS.iter().zip(&mut errors) {
                let level = difference.map_or(0, |by| (chosen as i32 + by).clamp(0, last));
                let textured = &drawn.textured;
                let (level, rounding) = (level as u32, Rounding::Nearest);
                let colour = textured.colour(pixel.depth, pixel.values, level, None, rounding);
                let colour = Rgb565::rounded(colour.unwrap_or_default(), rounding, [0; 2]);
                let colour = colour.to_rgb888();
                for channel in 0..3 {
                    errors.add(f64::from(colour[channel]) - exact[channel]);
                }
            }
        }
    });
    LEVELS
        .iter()
        .zip(errors)
        .map(|((level, difference), errors)| Row {
            filter: filter_name(filter).to_owned(),
            level: (*level).to_owned(),
            shipped: *difference == Some(0),
            texels: match filter {
                Filter::Nearest => 1,
                Filter::Bilinear => 4,
            },
            scene: scene.name.to_owned(),
            pixels,
            max_err: errors.max,
            rms: errors.rms(),
        })
        .collect()
}

/// The average, in linear light and converted to sRGB, of the texels of level 0 at 8×8 places of a pixel; `None` if the triangle does
/// not cover all of these places.
fn average(drawn: &Drawn, row: i32, pixel: &Pixel) -> Option<[f64; 3]> {
    let texture = &drawn.textured.texture;
    let (sides, wrap) = (texture.size_log2(), texture.sampler().wrap);
    let mut sums = [0.0; 3];
    for sample in 0..SAMPLES * SAMPLES {
        let offset =
            [sample % SAMPLES, sample / SAMPLES].map(|i| (i as f64 + 0.5) / SAMPLES as f64 - 0.5);
        let place = drawn.exact_beside(pixel, row, offset)?;
        let place = [0, 1].map(|i: usize| wrap[i].place(place[i].floor() as i32, sides[i]));
        let colour = texture.colour(0, place).unwrap_or_default().to_rgb888();
        for (sum, channel) in sums.iter_mut().zip(colour) {
            *sum += f64::from(linear(channel));
        }
    }
    let samples = (SAMPLES * SAMPLES) as f64;
    Some(sums.map(|sum| f64::from(srgb((sum / samples) as f32))))
}

/// A picture of tiles of 16 texels in random colours, with dark joints of two texels and some noise.
fn tiles(size: [u32; 2]) -> Picture {
    let random = |x: u32, y: u32| {
        let mut key = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA6B);
        key = (key ^ key >> 15).wrapping_mul(0x2C1B_3C6D);
        (key ^ key >> 12).to_le_bytes()
    };
    Picture::drawn(size, |x, y| {
        let [r, g, b, _] = random(x / 16, y / 16);
        let [noise, ..] = random(x + 7777, y);
        let is_joint = x % 16 < 2 || y % 16 < 2;
        let channel = |c: u8| if is_joint { 40 } else { 70 + c / 2 + noise / 8 };
        [channel(r), channel(g), channel(b), 255]
    })
}

/// Measures the formats of textures for pictures.
///
/// # Panics
/// If a texture cannot be made.
#[must_use]
pub fn measure_formats() -> Vec<FormatRow> {
    let globe = glint_mesh::generate::named("globe").expect("a generator");
    let map = match globe.textures.first().map(|texture| &texture.content) {
        Some(glint_mesh::polygons::Content::Picture(file)) => Picture::decode(file),
        _ => panic!("the globe has a picture"),
    };
    let pictures = [
        ("map of the globe, 512×256", map.expect("a good picture")),
        ("tiles in random colours, 256×256", tiles([256, 256])),
    ];
    let rows = pictures.iter().flat_map(|(name, picture)| {
        Format::ALL.map(|format| {
            let options = Options {
                format,
                ..Options::default()
            };
            let (bytes, report) = convert(picture, &options).expect("a good texture");
            assert!(Texture::new_checked(&bytes).is_ok());
            FormatRow {
                picture: (*name).to_owned(),
                format: format_name(format).to_owned(),
                bytes: bytes.len(),
                rms: report.error_rms,
                max_err: report.error_max,
            }
        })
    });
    rows.collect()
}
