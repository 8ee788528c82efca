//! Compares the model's pictures of round fields with the exact hits of the same rays. `--nocapture` shows the measured figures.

use glint_core::field::{CentredSphere, Field as Scene, Primitive};
use glint_core::fixed::Q32_32;
use glint_core::light::{Light, Lighting, Material};
use glint_model::raymarch::{FieldOptions, Lights, Palette, paint};
use glint_reference::camera::Camera;
use glint_reference::raymarch::raymarched::{Measured, Subject};

/// Checks each kind of bounded field. Unbounded fields are skipped, because their faces and
/// spheres at the horizon are small, and because rays towards the horizon run along faces.
#[test]
fn every_kind_of_field_is_where_it_is() {
    for scene in Primitive::EXAMPLES {
        let camera = Camera::looking(
            [2.1875, 1.6875, 1.3125],
            [0.015625, 0.0, 0.03125],
            0.9,
            0.01,
        );
        let subject = Subject::new("aside", scene, &camera, (320, 180));
        if subject.parsed.is_endless() {
            continue;
        }
        let picture = subject.picture(&FieldOptions::of(&subject.parsed));
        let found = Measured::new(&subject.expected, &picture);
        println!("{scene}: {found:?}");
        let found = found.accuracy;
        let depth = found.depth.expect("a hit");
        assert!(found.iou >= 0.999 && found.undecided == 0, "{scene}");
        assert!(found.wrong_faces <= 0.01, "{scene}");
        assert!(depth.median <= 3e-4 && depth.p99 <= 3e-3, "{scene}");
        assert!(
            found.normal.is_none_or(|normal| normal.p99 <= 0.3),
            "{scene}"
        );
    }
}

/// Compares the colours of a lit sphere with the material times the light: the sum of the ambient light and, for each light, its
/// colour times max(0, n·l). n is the exact normal, and l the direction to the light.
#[test]
fn spheres_are_lit_as_they_should_be() {
    let light = |text| Light::parse(text).expect("a light");
    let lighting = Lighting {
        ambient: [55; 3],
        lights: [light("-28,-28,51,c8c8c8"), light("0,1,0,5a280a")]
            .into_iter()
            .collect(),
    };
    let lights = Lights::new(Material::Ivory, &lighting);
    let palette = Palette {
        lights,
        ..Palette::default()
    };
    let camera = Camera::looking([2.1875, 1.6875, 1.3125], [0.0; 3], 0.9, 0.01);
    for radius in ["0.25", "1"] {
        let scene = Scene::from(CentredSphere {
            radius: radius.parse::<Q32_32>().expect("a number"),
        });
        let subject = Subject::new("above", &scene.to_string(), &camera, (320, 180));
        let setup = subject.setup(&FieldOptions::of(&scene));
        let tracer = setup.tracer();
        let pixels = (0..180).flat_map(|y| (0..320).map(move |x| (x, y)));
        let mut most: f64 = 0.0;
        for ((x, y), expected) in pixels.zip(&subject.expected) {
            let Some(hit) = expected.hit else { continue };
            let found = paint(&setup, &palette, &tracer.trace(0, x, y));
            for (i, found) in found.into_iter().enumerate() {
                let mut light = f64::from(lights.ambient[i]);
                for one in &lights.list[..2] {
                    let cosine: f64 = core::iter::zip(hit.normal, one.direction)
                        .map(|(n, l)| n * f64::from(l) / 65536.0)
                        .sum();
                    light += cosine.max(0.0) * f64::from(one.colour[i]);
                }
                let seen = light.min(255.0) * f64::from(lights.materials[0][i]) / 255.0;
                most = most.max((seen - f64::from(found)).abs());
            }
        }
        println!("radius {radius}: channels differ by at most {most:.2}");
        assert!(most <= 4.0, "radius {radius}: {most}");
    }
}
