//! Tests of coloured directional light and ambient light on meshes.

use glint_core::colour::{Rgb565, Shading, Winding};
use glint_core::fixed::Q32_32;
use glint_core::light::{Light, MeshLighting};
use glint_core::mesh::{IndexedTriangle, Vertex, encode};
use glint_model::triangle::shade::Lit;
use glint_model::{DrawnTriangle, MeshLight, Options, SIZES};
use glint_vectors::{Camera, Picture, Random};

fn any_light(random: &mut Random) -> MeshLighting {
    let mut colour = || {
        [(); 3].map(|()| {
            [0, 255, random.bits() as u8, random.bits() as u8][random.integer(0, 3) as usize]
        })
    };
    let (ambient, colour) = (colour(), colour());
    let light = if random.coin() {
        Light::at_camera(colour)
    } else {
        Light::new(random.direction().map(Q32_32::from_num), colour).unwrap()
    };
    MeshLighting { ambient, light }
}

#[test]
fn white_light_at_the_camera_is_the_default() {
    let mut random = Random(1);
    for _ in 0..100 {
        let view = Camera::inside(&mut random).rounded();
        let light = MeshLight::new(&MeshLighting::CAMERA, &view);
        assert_eq!(light.row, light.forward);
        assert_eq!((light.colour, light.ambient), MeshLight::PLAIN);
        for intensity in 0..=256 {
            assert_eq!(light.shares(intensity), [intensity; 3]);
        }
    }
}

#[test]
fn shares_are_within_two_units_of_the_exact_sum() {
    let mut random = Random(2);
    let view = Camera::inside(&mut random).rounded();
    let mut worst = 0.0_f64;
    for colour in 0..=255_u8 {
        for ambient in (0..=255_u8).step_by(5) {
            let lighting = MeshLighting {
                ambient: [ambient; 3],
                light: Light::at_camera([colour; 3]),
            };
            let light = MeshLight::new(&lighting, &view);
            for intensity in 0..=256 {
                let [share, ..] = light.shares(intensity);
                let [colour, ambient] = [colour, ambient].map(|part| f64::from(part) / 255.0);
                let exact = (ambient + colour * f64::from(intensity) / 256.0).min(1.0);
                worst = worst.max((f64::from(share) - 256.0 * exact).abs());
            }
        }
    }
    println!("largest error of a share: {worst:.3}/256");
    assert!(worst <= 1.5);
}

/// Smooth triangles whose vertices have the normal and the colour of the triangle are lit like flat triangles, for both winding rules, on
/// both sides, and after clipping.
#[test]
fn equal_vertices_are_lit_as_flat_triangles() {
    let mut random = Random(3);
    let (mut compared, mut clipped, mut lit) = (0, 0, 0);
    for round in 0..40 {
        let mut vertices = Vec::new();
        let triangles: Vec<_> = (0..60)
            .map(|i| {
                let normal = random.direction().map(|x| (x * 16_384.0) as i16);
                let colour = Rgb565(random.bits() as u16);
                vertices.extend([(); 3].map(|()| Vertex {
                    position: [0; 3].map(|_| random.integer(-30_000, 30_000) as i16),
                    normal,
                    colour,
                    fine: 0,
                }));
                IndexedTriangle {
                    indices: [3 * i, 3 * i + 1, 3 * i + 2],
                    colour,
                    normal,
                    texture: 0,
                }
            })
            .collect();
        let bytes = encode(&vertices, &triangles).unwrap();
        let view = Camera::inside(&mut random).rounded();
        let light = MeshLight::new(&any_light(&mut random), &view);
        let options = Options {
            cull: round % 4 == 0,
            winding: Winding::ALL[round / 2 % 2],
            light: Some(&light),
            ..Options::default()
        };
        let drawn = |shading: Shading| -> Vec<DrawnTriangle> {
            let options = Options { shading, ..options };
            Picture::with_options(&bytes, &view, SIZES[0], &options).drawn
        };
        let (flat, smooth) = (drawn(Shading::Flat), drawn(Shading::Smooth));
        assert_eq!(flat.len(), smooth.len());
        for (flat, smooth) in flat.iter().zip(&smooth) {
            for Lit([red, green, blue]) in smooth.lit.unwrap() {
                let rounded = [(red, 11), (green, 10), (blue, 11)]
                    .map(|(x, cut)| (u32::from(x) + (1 << (cut - 1))) >> cut);
                assert_eq!(rounded, flat.colour.channels().map(u32::from), "{light:?}");
                compared += 1;
            }
            clipped += u32::from(flat.clipped);
            lit += u32::from(flat.colour != Rgb565(0));
        }
    }
    println!("{compared} vertices compared, {clipped} triangles clipped, {lit} triangles lit");
    assert!(compared > 1500 && clipped > 200 && lit > 500);
}
