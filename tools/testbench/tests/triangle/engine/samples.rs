//! Frames with four samples a pixel, whole and in quarters.

use glint_core::camera::View;
use glint_core::colour::{Rgb565, Rounding, Shading};
use glint_core::field::Field;
use glint_core::fixed::U4_28;
use glint_core::mesh::Mesh;
use glint_core::picture::{Quarter, Samples, Size};
use glint_core::quality::Quality;
use glint_core::texture::{Blend, Source, encode};
use glint_model::{FieldSubject, Frame, MeshSubject, Subject};
use glint_vectors::Camera;
use glint_vectors::meshes::textured_layers;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::gradient;
use super::fields::send_bands;
use super::textured::{Shown, texture};

/// A camera so close to the square of the test meshes that the square covers the middle of the picture.
fn view(random: &mut Pcg64Mcg) -> View {
    let eye = [
        random.random_range(-0.5..0.5),
        random.random_range(-4.0..-1.5),
        random.random_range(0.2..1.5),
    ];
    Camera::looking(eye, [0.1, 0.5, 0.0], 0.8, 0.02).rounded()
}

/// Frames of meshes with textures: before a sky, in a field, and in fog, in all sizes. Drawing a quarter must not change the other quarters
/// of the frame buffer.
#[test]
fn frames_are_averaged() {
    let mut drawn = [0; 3];
    let small = Size::W320;
    let frames: [(u64, f64, &[Size]); 3] = [
        (1, 0.0, &[small, Size::W1280, small]),
        (2, 0.3, &[Size::W640, small]),
        (3, 0.6, &[small, small, small]),
    ];
    for (seed, stalls, sizes) in frames {
        let mut random = Pcg64Mcg::new(seed.into());
        let mut bench = Bench::of("texture_fields", seed as u32, stalls);
        bench.with_depth = false;
        for (count, &size) in sizes.iter().enumerate() {
            // A blended texture takes a clock for each pixel.
            let is_small = size == Size::W320;
            let sources: Vec<_> = (0..2)
                .map(|_| match texture(&mut random) {
                    source if is_small => source,
                    source => Source {
                        blend: Blend::Opaque,
                        ..source
                    },
                })
                .collect();
            let is_blended = sources.iter().any(|source| source.blend != Blend::Opaque);
            let textures: Vec<_> = sources
                .iter()
                .map(|source| encode(source).unwrap())
                .collect();
            let mesh = textured_layers(&textures, 1.0, 0.3);
            let field = FieldSubject {
                field: &Field::parse("menger:2").unwrap(),
                appearance: &Default::default(),
                quality: Quality::default(),
            };
            let subject = MeshSubject {
                shading: Shading::Flat,
                ..MeshSubject::new(Mesh::new_checked(&mesh).unwrap())
            };
            let has_field = size == Size::W320 && count > 0;
            let frame = Frame {
                samples: Samples::Four,
                rounding: Rounding::new(random.random()),
                clear: Rgb565(random.random()),
                sky: random.random_bool(0.6).then(|| gradient(&mut random)),
                fog: U4_28::from_num([0.0, 0.3][random.random_range(0..2)]),
                ..Frame::new(
                    if has_field {
                        Subject::MeshInField(subject, field)
                    } else {
                        Subject::Mesh(subject)
                    },
                    view(&mut random),
                    size,
                )
            };
            bench.slot = random.random_range(0..2);
            bench.scribble();
            let mut picture = vec![0x9999; size.pixel_count()];
            for part in frame.parts() {
                let mut shown = Shown::of(&mesh, &part, picture);
                let name = format!("{size:?} {:?} {count} of seed {seed}", part.quarter);
                bench.set("raster_flags.sky_first", u64::from(is_blended));
                bench.set("field_source.enable", u64::from(has_field));
                bench.set("field_source.compose", 0);
                if has_field {
                    let triangles = [shown.whole, shown.clipped].concat();
                    bench.start_set(&shown.expected, &triangles, &textures);
                    send_bands(&mut bench, &mut random, false, &mut shown.bands);
                    bench.finish(&name, &shown.expected);
                } else {
                    bench.draw_textured(&name, &shown.expected, &shown.mesh, &shown.clipped);
                }
                picture = shown.expected.colour;
                drawn[size as usize] += 1;
            }
        }
    }
    assert_eq!(drawn, [6, 1, Quarter::ALL.len()]);
}
