//! Tests of frames with directional light or light at the camera, in colours, and with ambient light.

use glint_core::fixed::Q32_32;
use glint_core::light::{Light, MeshLighting};
use glint_model::{MeshLight, Options, Shading};
use glint_vectors::scenes::scenes;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{CLEAR, SIZES, expected_with};
use super::generated;

/// Draws each scene with flat and smooth shading in turn, in changing light, with stalls of the memory and without. Engine and model
/// produce equal pictures if back faces are culled, the shading is flat, or the ambient light is 0.
#[test]
fn scenes_in_any_light() {
    let mut random = Pcg64Mcg::new(9);
    for stalls in [0.0, 0.4] {
        let mut bench = Bench::of("smooth", 6, stalls);
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
                let options = Options {
                    cull,
                    clear: CLEAR,
                    shading,
                    light: Some(Box::leak(Box::new(MeshLight::new(&lighting, &view)))),
                    ..Options::default()
                };
                let expected = expected_with(options, &mesh, &view, SIZES[0]);
                bench.with_depth = shading == Shading::Smooth;
                bench.slot ^= 1;
                bench.draw(&format!("{name} in {lighting:?}"), &mesh, &expected);
            }
        }
    }
}
