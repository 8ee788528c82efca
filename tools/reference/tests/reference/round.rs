//! Compares the model's pictures of round fields with the exact hits of the same rays. `--nocapture` shows the measured figures.

use glint_core::field::Primitive;
use glint_core::light::{Highlight, Light, Lighting, Material};
use glint_model::raymarch::{FieldOptions, Lights, Palette, paint};
use glint_reference::camera::Camera;
use glint_reference::raymarch::Face;
use glint_reference::raymarch::raymarched::Subject;
use glint_vectors::math::{dot, normalised};

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
        let found = subject.measure();
        println!("{scene}: {found:?}");
        let found = found.accuracy;
        let depth = found.depth.expect("a hit");
        assert!(found.iou >= 0.999 && found.undecided == 0, "{scene}");
        assert!(found.wrong_faces <= 0.01, "{scene}");
        assert!(depth.median <= 3e-4 && depth.p99 <= 3e-3, "{scene}");
        let normal = found.normal.map_or(0.0, |normal| normal.p99);
        assert!(normal <= 0.3, "{scene}");
    }
}

/// Compares the colours of a lit sphere or cone with the material times the light, plus the highlight. The light is the sum of the ambient
/// light and, for each light, its colour times max(0, n·l); the highlight is the first light's colour times STRENGTH·max(0, n·h)^EXPONENT.
/// n is the exact normal, l the direction to a light, and h the direction halfway to the first light and to the camera.
#[test]
fn round_surfaces_are_lit_as_they_should_be() {
    let light = |text| Light::parse(text).expect("a light");
    let camera = Camera::looking([2.1875, 1.6875, 1.3125], [0.0; 3], 0.9, 0.01);
    let lighting = Lighting {
        ambient: [55; 3],
        lights: [light("-28,-28,51,c8c8c8"), light("0,1,0,5a280a")]
            .into_iter()
            .collect(),
        ..Lighting::PLAIN
    };
    let (ivory, slate, normal) = (Material::Ivory, Material::Slate, Material::Normal);
    // A case has a field, a material, whether it has the lights above, strength and exponent of a highlight, and the largest difference.
    for (scene, material, has_lights, highlight, limit) in [
        ("sphere:0.25", ivory, true, None, 4.0),
        ("sphere:1", ivory, true, None, 4.0),
        ("sphere:1", normal, false, None, 2.5),
        ("sphere:0.25", normal, true, None, 4.5),
        // The power of the cosine differs by up to 0.033 of the strength.
        ("sphere:1", slate, true, Some((0.8, 4)), 5.0),
        ("sphere:1", normal, true, Some((0.5, 20)), 8.0),
        ("sphere:0.25", slate, true, Some((1.0, 128)), 11.0),
        ("cone:0.8,1.6", ivory, true, None, 4.0),
        ("cone:0.8,1.6", normal, true, None, 4.5),
        ("cone:0.1,2", ivory, true, None, 4.0),
        ("cone:1,0.1", normal, true, None, 4.5),
        ("cone:1,1", slate, true, Some((0.8, 4)), 5.0),
    ] {
        let lighting = match (has_lights, highlight) {
            (false, _) => Lighting::PLAIN,
            (true, None) => lighting.clone(),
            (true, Some((strength, exponent))) => Lighting {
                highlight: Highlight::parse(&format!("{strength},{exponent}")),
                ..lighting.clone()
            },
        };
        let lighting = lighting.seen_from(&camera.view().expect("a camera"));
        let half = camera.n.map(|part| -part);
        let half = lighting.lights.first().map(|light| {
            let towards = light.direction().map(|part| f64::from(part) / 16384.0);
            normalised(core::array::from_fn(|i| towards[i] + half[i]))
        });
        let lights = Lights::new(material, &lighting);
        let palette = Palette {
            lights,
            ..Palette::default()
        };
        let subject = Subject::new("above", scene, &camera, (320, 180));
        let setup = subject.setup(&FieldOptions::of(&subject.parsed));
        let tracer = setup.tracer();
        let pixels = (0..180).flat_map(|y| (0..320).map(move |x| (x, y)));
        let mut most: f64 = 0.0;
        for ((x, y), expected) in pixels.zip(&subject.expected) {
            // The base of a cone is a face.
            let Some(hit) = expected.hit.filter(|hit| hit.face == Face::Round) else {
                continue;
            };
            let found = paint(&setup, &palette, &tracer.trace(0, x, y));
            for (i, found) in found.into_iter().enumerate() {
                let mut light = f64::from(lights.ambient[i]);
                for one in &lights.list[..lights.count] {
                    let towards = one.direction.map(|part| f64::from(part) / 65536.0);
                    light += dot(hit.normal, towards).max(0.0) * f64::from(one.colour[i]);
                }
                let colour = match material {
                    Material::Normal => 130.0 + 95.0 * hit.normal[i],
                    _ => f64::from(lights.materials[0][i]),
                };
                let mut seen = light.min(255.0) * colour / 255.0;
                if let (Some((strength, exponent)), Some(half)) = (highlight, half) {
                    let cosine = dot(hit.normal, half).max(0.0);
                    seen += strength * cosine.powi(exponent) * f64::from(lights.list[0].colour[i]);
                }
                most = most.max((seen.min(255.0) - f64::from(found)).abs());
            }
        }
        println!("{material:?}, {scene}: channels differ by at most {most:.2}");
        assert!(most <= limit, "{material:?}, {scene}: {most}");
    }
}
