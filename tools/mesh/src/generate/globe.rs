//! A globe: a sphere with the generated map of an imaginary planet as its texture.

use crate::error::{FormatError, Location};
use crate::polygons::{Content, Corner, Polygons, Rgb8, Texture, Vector};
use glint_core::texture::{Filter, Sampler, Wrap};
use glint_texture::picture::Picture;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Number of bands of quads from pole to pole.
const BANDS: u32 = 24;
/// Number of sectors around the axis.
const SECTORS: u32 = 48;
/// Width and height of the map in texels.
const MAP: [u32; 2] = [512, 256];
/// Colours of the map at some heights; heights between them have blended colours.
const COLOURS: [(f64, [u8; 3]); 8] = [
    (-0.3, [10, 36, 96]),
    (-0.01, [30, 100, 176]),
    (0.0, [218, 200, 146]),
    (0.03, [120, 156, 80]),
    (0.08, [52, 124, 48]),
    (0.22, [112, 108, 62]),
    (0.3, [126, 104, 86]),
    (0.36, SNOW),
];
const SNOW: [u8; 3] = [236, 240, 244];
/// Extent of the polar ice as a fraction of the distance from pole to equator.
const ICE: f64 = 0.2;

/// The point of the unit sphere at a place of the map; s and t are from 0 to 1.
fn direction([s, t]: [f64; 2]) -> Vector {
    let ((sin, cos), (down, up)) = ((TAU * s).sin_cos(), (PI * t).sin_cos());
    [cos * down, sin * down, up]
}

/// The globe, of radius 1.
pub fn globe() -> Result<Polygons, FormatError> {
    let mut polygons = Polygons::default();
    let place = |[sector, band]: [u32; 2]| {
        [
            f64::from(sector) / f64::from(SECTORS),
            f64::from(band) / f64::from(BANDS),
        ]
    };
    let mut corners = Vec::new();
    for band in 0..=BANDS {
        let mut points = Vec::new();
        for sector in 0..=SECTORS {
            // Each pole is a single point, and the last sector ends at the first point of its ring.
            let point = match (points.first(), sector) {
                (Some(&first), _) if band % BANDS == 0 => first,
                (Some(&first), SECTORS) => first,
                _ => polygons.add_point(direction(place([sector, band])), Location::Whole)?,
            };
            points.push(point);
            let place = place([sector, band]);
            let normal = polygons.add_normal(direction(place), Location::Whole)?;
            let coordinates = polygons.add_coordinates(place, Location::Whole)?;
            corners.push(Corner {
                point,
                normal,
                coordinates,
            });
        }
    }
    let map = map()
        .png()
        .map_err(|error| FormatError::whole("a map that can be written", error.to_string()))?;
    let texture = polygons.add_texture(Texture {
        name: "map".into(),
        content: Content::Picture(Arc::new(map)),
        sampler: Sampler {
            wrap: [Wrap::Repeat, Wrap::Clamp],
            filter: Filter::Bilinear,
        },
        cutoff: None,
        opacity: None,
    })?;
    let at = |sector: u32, band: u32| corners[(band * (SECTORS + 1) + sector) as usize];
    for band in 0..BANDS {
        for sector in 0..SECTORS {
            let [upper, lower] =
                [band, band + 1].map(|band| [sector, sector + 1].map(|x| at(x, band)));
            let mut face = vec![upper[0], lower[0], lower[1], upper[1]];
            face.dedup_by_key(|corner| corner.point);
            if face.first().map(|corner| corner.point) == face.last().map(|corner| corner.point) {
                face.pop();
            }
            polygons.add_face(&face, Some(Rgb8::WHITE), Location::Whole)?;
            if let Some(face) = polygons.faces.last_mut() {
                face.texture = texture;
            }
        }
    }
    Ok(polygons)
}

/// The map: longitude increases to the right, and north is up.
fn map() -> Picture {
    let [width, height] = MAP;
    Picture::drawn(MAP, |x, y| {
        let t = (f64::from(y) + 0.5) / f64::from(height);
        let point = direction([(f64::from(x) + 0.5) / f64::from(width), t]);
        let height = height_at(point);
        let edge = 1.0 - (2.0 * t - 1.0).abs() + 0.2 * height;
        let [r, g, b] = if edge < ICE { SNOW } else { colour_at(height) };
        [r, g, b, 255]
    })
}

/// The colour of the ground at a height.
fn colour_at(height: f64) -> [u8; 3] {
    let [(_, lowest), ..] = COLOURS;
    let mut below = (f64::MIN, lowest);
    for (upper, colour) in COLOURS {
        if height < upper {
            let share = (height - below.0) / (upper - below.0);
            let blend = |a: u8, b: u8| f64::from(a) + share * (f64::from(b) - f64::from(a));
            return [0, 1, 2].map(|i| blend(below.1[i], colour[i]).round() as u8);
        }
        below = (upper, colour);
    }
    below.1
}

/// The height of the ground at a point: a sum of noise of six frequencies, from about −0.5 to 0.5.
fn height_at(point: Vector) -> f64 {
    let octave = |octave: i32| {
        let frequency = 1.6 * f64::from(1 << octave);
        noise(point.map(|c| c * frequency)) * 0.55_f64.powi(octave)
    };
    0.6 * (0..6).map(octave).sum::<f64>()
}

/// Noise at a point: random numbers from −0.5 to 0.5 at the points of a grid, and a smooth blend between them.
fn noise(point: Vector) -> f64 {
    let cell = point.map(f64::floor);
    let shares = [0, 1, 2].map(|i| {
        let x = point[i] - cell[i];
        x * x * (3.0 - 2.0 * x)
    });
    let corner = |corner: u32| {
        let mut key = 0_u32;
        let mut weight = 1.0;
        for axis in 0..3 {
            let step = corner >> axis & 1;
            key = (key ^ (cell[axis] as i32 as u32).wrapping_add(step)).wrapping_mul(0x9E37_79B1);
            key ^= key >> 15;
            weight *= if step == 1 {
                shares[axis]
            } else {
                1.0 - shares[axis]
            };
        }
        weight * (f64::from(key.wrapping_mul(0x85EB_CA6B) >> 8) / f64::from(1 << 24) - 0.5)
    };
    (0..8).map(corner).sum()
}
