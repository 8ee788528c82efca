//! Compares the model's flat shading with the product of colour and light in f64.

use glint_core::camera::View;
use glint_core::fixed::Q32_32;
use glint_core::light::{Light, MeshLighting};
use glint_core::mesh::Rgb565;
use glint_model::triangle::setup::Facing;
use glint_model::{MeshLight, Options, SIZES};
use glint_vectors::Picture;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::cameras::{direction, looking_at};
use super::scenes::{ONE, Scene};

/// Returns the red, green and blue channel of an RGB565 colour, of 5, 6 and 5 bits.
fn channels(colour: u16) -> [f64; 3] {
    [colour >> 11, colour >> 5 & 63, colour & 31].map(f64::from)
}

/// Computes the light on a triangle from its stored normal N and the direction l to the light: clamp(N·l, 0, 1) for a front face,
/// clamp(−N·l, 0, 1) for a back face.
fn intensity(normal: [i16; 3], facing: Facing, towards: [f64; 3]) -> f64 {
    let along: f64 = std::iter::zip(normal, towards)
        .map(|(a, b)| f64::from(a) / ONE * b)
        .sum();
    let towards = match facing {
        Facing::Front => along,
        Facing::Back => -along,
    };
    towards.clamp(0.0, 1.0)
}

/// A light in f64: its direction, its colour and the ambient light; 1 is the maximum.
struct Exact {
    towards: [f64; 3],
    colour: [f64; 3],
    ambient: [f64; 3],
}

impl Exact {
    fn at_camera(view: &View) -> Self {
        Self {
            towards: view.n().map(|x| -x.to_num::<f64>()),
            colour: [1.0; 3],
            ambient: [0.0; 3],
        }
    }
}

/// A random light, for the model and in f64. Directions have any length; a quarter of the colour channels are 1, a quarter 0.
fn any_light(random: &mut Pcg64, view: &View) -> (MeshLight, Exact) {
    let mut colour = || -> [u8; 3] {
        [(); 3].map(|()| [0, 255, random.random(), random.random()][random.random_range(0..4)])
    };
    let (colour, ambient) = (colour(), colour());
    let exact = |colour: [u8; 3]| colour.map(|part| f64::from(part) / 255.0);
    let exact = Exact {
        colour: exact(colour),
        ambient: exact(ambient),
        ..Exact::at_camera(view)
    };
    if random.random_range(0..4) == 0 {
        let light = Light::at_camera(colour);
        return (
            MeshLight::new(&MeshLighting { ambient, light }, view),
            exact,
        );
    }
    let towards = direction(random);
    let length = f64::powi(2.0, random.random_range(-12..20));
    let entered = towards.map(|x| Q32_32::from_num(x * length));
    let light = Light::new(entered, colour).expect("a direction");
    let lighting = MeshLighting { ambient, light };
    (MeshLight::new(&lighting, view), Exact { towards, ..exact })
}

#[test]
fn shades_are_within_one_step_of_the_exact_product() {
    shades_are_exact(40, |_, view| (None, Exact::at_camera(view)));
}

#[test]
fn shades_of_any_light_are_within_one_step_of_the_exact_product() {
    shades_are_exact(120, |random, view| {
        let (light, exact) = any_light(random, view);
        (Some(light), exact)
    });
}

fn shades_are_exact(scenes: u64, light: impl Fn(&mut Pcg64, &View) -> (Option<MeshLight>, Exact)) {
    let (mut shaded, mut worst): (u32, f64) = (0, 0.0);
    for seed in 0..scenes {
        let mut random = Pcg64::seed_from_u64(seed);
        let eye = direction(&mut random).map(|x| 3.0 * x);
        let view = looking_at(eye, [0.0; 3], 1.0, 0.9, 0.1).rounded();
        let (light, exact) = light(&mut random, &view);
        let mut scene = Scene::default();
        for _ in 0..60 {
            scene.triangle([(); 3].map(|()| direction(&mut random)));
            // Normals have lengths from 0 to 1.5, because a mesh may contain normals of any length.
            let length = random.random_range(0.0..1.5) * ONE;
            scene
                .normals
                .push(direction(&mut random).map(|x| (x * length).round() as i16));
            scene.colours.push(random.random_range(0..=u16::MAX));
        }
        let options = Options {
            light: light.as_ref(),
            ..Options::default()
        };
        let picture = Picture::with_options(&scene.encode(), &view, SIZES[0], &options);
        for drawn in &picture.drawn {
            let (normal, Rgb565(found)) = (scene.normals[drawn.index as usize], drawn.colour);
            let intensity = intensity(normal, drawn.facing, exact.towards);
            let colour = channels(scene.colours[drawn.index as usize]);
            for (i, found) in channels(found).into_iter().enumerate() {
                let share = (exact.ambient[i] + exact.colour[i] * intensity).min(1.0);
                let expected = colour[i] * share;
                shaded += 1;
                worst = worst.max((found - expected).abs());
                assert!(
                    (found - expected).abs() <= 1.0,
                    "seed {seed}, triangle {}: {found} for {expected:.3}",
                    drawn.index
                );
            }
        }
    }
    println!("shade: {shaded} channels, at most {worst:.3} steps off");
    assert!(shaded > 3000);
}
