//! Compares the model's flat shading with the product of colour and light in f64.

use glint_core::camera::View;
use glint_core::mesh::Rgb565;
use glint_model::triangle::setup::Facing;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::cameras::{direction, looking_at, view};
use crate::renderer::Renderer;
use crate::scenes::{ONE, SMALL, Scene};

/// Returns the red, green and blue channel of an RGB565 colour, which have 5, 6 and 5 bits.
fn channels(colour: u16) -> [f64; 3] {
    [colour >> 11, colour >> 5 & 63, colour & 31].map(f64::from)
}

/// Computes the light on a triangle from its stored normal N and the forward direction n of the view: clamp(−N·n, 0, 1) for a
/// front face, clamp(N·n, 0, 1) for a back face.
fn intensity(normal: [i16; 3], facing: Facing, view: &View) -> f64 {
    let along: f64 = std::iter::zip(normal, view.n())
        .map(|(a, b)| f64::from(a) / ONE * b.to_num::<f64>())
        .sum();
    let towards = match facing {
        Facing::Front => -along,
        Facing::Back => along,
    };
    towards.clamp(0.0, 1.0)
}

#[test]
fn shades_are_within_one_step_of_the_exact_product() {
    let mut renderer = Renderer::default();
    let (mut shaded, mut worst): (u32, f64) = (0, 0.0);
    for seed in 0..40 {
        let mut random = Pcg64::seed_from_u64(seed);
        let eye = direction(&mut random).map(|x| 3.0 * x);
        let view = view(&looking_at(eye, [0.0; 3], 1.0, 0.9, 0.1));
        let mut scene = Scene::default();
        for _ in 0..60 {
            scene.triangle([(); 3].map(|()| direction(&mut random)));
            // The normals have lengths from 0 to 1.5, because a mesh may contain normals of any length.
            let length = random.random_range(0.0..1.5) * ONE;
            scene
                .normals
                .push(direction(&mut random).map(|x| (x * length).round() as i16));
            scene.colours.push(random.random_range(0..=u16::MAX));
        }
        renderer.draw(&scene, &view, SMALL, false);
        for drawn in &renderer.drawn {
            let (normal, Rgb565(found)) = (scene.normals[drawn.index as usize], drawn.colour);
            let intensity = intensity(normal, drawn.facing, &view);
            let expected =
                channels(scene.colours[drawn.index as usize]).map(|channel| channel * intensity);
            for (expected, found) in expected.into_iter().zip(channels(found)) {
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
