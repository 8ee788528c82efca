//! Textures and fog at extreme sizes and distances, with many repeats and layers, compared with f64.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};
use glint_core::colour::Rgb565;
use glint_core::fixed::U4_28;
use glint_core::light::{Light, MeshLighting};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::texture::{Blend, Sampler, Source, encode};
use glint_model::{DepthScale, Fog, Frame, MeshSubject, Subject};
use glint_texture::convert::convert;
use glint_texture::levels::srgb;
use glint_texture::options::Options;
use glint_texture::picture::Picture as Drawing;
use glint_vectors::camera::Size as Pixels;
use glint_vectors::meshes::{textured_layers, textured_square};
use glint_vectors::{Camera, Picture};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;
use crate::triangle::textured::{Scene, blank};

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("texture-position", |floor: Floor| {
            let (worst, _) = floor.measured()?;
            Ok(Outcome::Error(worst, "texels"))
        }),
        Kind::new("texture-levels", |floor: Floor| {
            let (_, levels) = floor.measured()?;
            let ends = levels.first().zip(levels.last());
            let (first, last) = ends.context("a level")?;
            Ok(Outcome::exact(format!("levels {first} to {last}")))
        }),
        Kind::new("texture-mean", mean_error),
        Kind::new("texture-opaque", opaque_share),
        Kind::new("texture-blends", blend_error),
        Kind::new("fog-share", fog_error),
    ]
}

/// A square of 4 world units at the height 0 with a texture, before a camera.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Floor {
    /// Base-2 logarithms of the sides of the texture.
    side_log2: [u8; 2],
    /// Repeats of the texture per world unit.
    repeats: f64,
    eye: [f64; 3],
    towards: [f64; 3],
    half_width: f64,
    near: f64,
}

impl Floor {
    fn camera(&self) -> Camera {
        Camera::looking(self.eye, self.towards, self.half_width, self.near)
    }

    /// The largest error of a pixel's position against the exact hit of its ray, in texels of the level that is read, and the levels.
    fn measured(&self) -> Result<(f64, BTreeSet<u32>)> {
        let mesh = textured_square(&[blank(true)(self.side_log2)], self.repeats);
        let scene = Scene::new("a floor", Size::W320, mesh, self.camera());
        let camera = Camera::of(&self.camera().rounded());
        let [width, height] = Size::W320.pixels();
        let (mut worst, mut levels, mut pixels) = (0.0_f64, BTreeSet::new(), 0);
        scene.rows(&mut |drawn, row, covered| {
            for (pixel, level) in covered.iter().zip(drawn.levels(covered)) {
                let place = [pixel.column, row].map(f64::from);
                let ray = camera.ray(place, Pixels { width, height });
                let hit = ray.at(-ray.origin[2] / ray.direction[2]);
                let found = drawn.textured.places(pixel.depth, pixel.values);
                for axis in 0..2 {
                    let side = f64::from(1 << self.side_log2[axis]);
                    // Found positions have 8 fraction bits, are rounded down, and are modulo two repeats.
                    let found = (found[axis] as f64 + 0.5) / 256.0;
                    let error = found - hit[axis] * self.repeats * side;
                    let error = error - (error / (2.0 * side)).round() * 2.0 * side;
                    worst = worst.max(error.abs() / f64::from(1 << level));
                }
                levels.insert(level);
                pixels += 1;
            }
        });
        ensure!(pixels > 0, "no pixel of the floor is in the picture");
        Ok((worst, levels))
    }

    /// The picture of the floor with a texture.
    fn picture(&self, texture: Vec<u8>) -> Result<Picture> {
        let mesh = textured_square(&[texture], self.repeats);
        let mesh = Mesh::new_checked(&mesh).context("the mesh")?;
        let subject = Subject::Mesh(MeshSubject {
            cull: false,
            ..MeshSubject::new(mesh)
        });
        let frame = Frame {
            lighting: full_light(),
            ..Frame::new(subject, self.camera().rounded(), Size::W320)
        };
        Ok(Picture::of_frame(&frame))
    }
}

/// Light that leaves colours unchanged.
fn full_light() -> MeshLighting {
    MeshLighting {
        ambient: [255; 3],
        light: Light::at_camera([0; 3]),
    }
}

/// A chequerboard of black and white texels, or of holes and white texels with a cutoff.
fn chequerboard(side_log2: [u8; 2], one_in: u32, cutoff: Option<f32>) -> Result<Vec<u8>> {
    let size = side_log2.map(|side| 1 << side);
    let picture = Drawing::drawn(size, |x, y| {
        let is_white = (x + y) % one_in == 0;
        match (is_white, cutoff) {
            (true, _) => [255; 4],
            (false, None) => [0, 0, 0, 255],
            (false, Some(_)) => [255, 255, 255, 0],
        }
    });
    let options = Options {
        cutoff,
        ..Options::default()
    };
    Ok(convert(&picture, &options)?.0)
}

/// The difference between the mean colour of a floor with a chequerboard and the mean of the texels in linear light.
fn mean_error(floor: Floor) -> Result<Outcome> {
    let picture = floor.picture(chequerboard(floor.side_log2, 2, None)?)?;
    let covered = picture.colour.iter().zip(&picture.depth);
    let colours: Vec<f64> = covered
        .filter(|(_, depth)| **depth > 0)
        .map(|(&colour, _)| f64::from(Rgb565(colour).to_rgb888()[1]))
        .collect();
    ensure!(
        !colours.is_empty(),
        "no pixel of the floor is in the picture"
    );
    let mean = colours.iter().sum::<f64>() / colours.len() as f64;
    let exact = f64::from(srgb(0.5));
    Ok(Outcome::Error((mean - exact).abs(), "of 255"))
}

/// The share of the floor's pixels that are not holes. One of four texels of the texture is opaque.
fn opaque_share(floor: Floor) -> Result<Outcome> {
    let with_holes = floor.picture(chequerboard(floor.side_log2, 4, Some(0.5))?)?;
    let whole = floor.picture(chequerboard(floor.side_log2, 4, None)?)?;
    let share = 100.0 * with_holes.covered() as f64 / whole.covered() as f64;
    Ok(Outcome::exact(format!("{share:.0} % opaque")))
}

/// Layers of glass of one colour over black.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Layers {
    count: usize,
    /// Number of the rule of blending: 1 to 7 eighths, 8 for a sum.
    blend: usize,
    /// Colour of each layer, RGB565.
    colour: u16,
}

/// The largest difference of a channel from the blend in f64, in steps of the channel. A sum saturates in both.
fn blend_error(layers: Layers) -> Result<Outcome> {
    let blend = *Blend::ALL.get(layers.blend).context("a rule of blending")?;
    let texture = encode(&Source {
        size_log2: [3, 3],
        blend,
        levels: vec![vec![layers.colour; 64]],
        sampler: Sampler::default(),
        ..Source::default()
    })?;
    let textures = vec![texture; layers.count];
    let mesh = textured_layers(&textures, 1.0, 0.0);
    let mesh = Mesh::new_checked(&mesh).context("the mesh")?;
    let frame = Frame {
        lighting: full_light(),
        ..Frame::new(
            Subject::mesh(mesh),
            Camera::looking([0.0, -0.5, 1.5], [0.0; 3], 0.5, 0.1).rounded(),
            Size::W320,
        )
    };
    let picture = Picture::of_frame(&frame);
    let found = Rgb565(picture.colour[picture.colour.len() / 2 + 160]).channels();
    let source = Rgb565(layers.colour).channels();
    let share = layers.blend as f64 / 8.0;
    let errors = [31.0, 63.0, 31.0].into_iter().zip(source).zip(found);
    let errors = errors.map(|((most, source), found)| {
        let exact = (0..layers.count).fold(0.0, |behind: f64, _| match blend {
            Blend::Additive => (behind + f64::from(source)).min(most),
            _ => behind + (f64::from(source) - behind) * share,
        });
        (exact - f64::from(found)).abs()
    });
    Ok(Outcome::Error(errors.fold(0.0, f64::max), "steps"))
}

/// A depth code in fog, with the mantissa and exponent of the scale of depth codes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Foggy {
    code: u32,
    /// Density in units of 2^-28.
    density: u32,
    mantissa: u32,
    exponent: i32,
}

/// The error of the fog's share at the depth of the code, compared with f64.
fn fog_error(foggy: Foggy) -> Result<Outcome> {
    let density = U4_28::from_bits(foggy.density);
    let scale = DepthScale {
        mantissa: foggy.mantissa,
        exponent: foggy.exponent,
        origin: None,
    };
    let Some(fog) = Fog::new(density, scale, [255; 3]) else {
        return Ok(Outcome::exact("no fog"));
    };
    let depth =
        f64::from(foggy.mantissa) * f64::from(foggy.exponent).exp2() / f64::from(foggy.code);
    let exact = 255.0 * (1.0 - (-density.to_num::<f64>() * depth).exp());
    Ok(Outcome::Error(
        (f64::from(fog.share(foggy.code)) - exact).abs(),
        "of 255",
    ))
}
