//! Tests of frames with directional light or light at the camera, in colours, and with ambient light.

use glint_core::camera::View;
use glint_core::fixed::Q32_32;
use glint_core::light::{Light, MeshLighting};
use glint_model::{MeshLight, Options, Shading};
use glint_vectors::scenes::scenes;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{CLEAR, Expected, SIZES, expected_with};
use super::generated;

/// Draws a frame with the model with this lighting and `shading`. Engine and model produce equal pictures if back faces are
/// culled, the shading is flat, or the ambient light is 0.
fn expected_lit(
    lighting: &MeshLighting,
    shading: Shading,
    mesh: &[u8],
    view: &View,
    size: (u32, u32),
    cull: bool,
) -> Expected {
    let options = Options {
        cull,
        clear: CLEAR,
        shading,
        light: Some(Box::leak(Box::new(MeshLight::new(lighting, view)))),
        ..Options::default()
    };
    expected_with(options, mesh, view, size)
}

/// Draws each scene with flat and with smooth shading, each time in another light.
#[test]
fn scenes_in_any_light() {
    let mut random = Pcg64Mcg::new(9);
    let mut bench = Bench::smooth(6, 0.0);
    for (name, mesh, view, cull) in scenes(generated) {
        // Skips large meshes, which take long and add no coverage.
        if mesh.len() > 1 << 20 {
            continue;
        }
        for shading in Shading::ALL {
            let mut colour = || [(); 3].map(|()| random.random());
            let ambient = if shading == Shading::Smooth && !cull {
                [0; 3]
            } else {
                colour()
            };
            let colour = colour();
            let towards =
                [(); 3].map(|()| Q32_32::from_bits(random.random_range(-1 << 32..1 << 32)));
            let light = if random.random_bool(0.3) {
                Light::at_camera(colour)
            } else {
                Light::new(towards, colour).expect("a direction")
            };
            let lighting = MeshLighting { ambient, light };
            let expected = expected_lit(&lighting, shading, &mesh, &view, SIZES[0], cull);
            bench.draw(&format!("{name} in {lighting:?}"), &mesh, &expected);
        }
    }
}
