//! Tests of lights in text form, and of the lit colours of faces.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::light::{
    Background, Highlight, Light, LightError, Lighting, MAX_LIGHTS, Material, MeshLighting, Rgb,
    highlight_share, parse_rgb,
};
use proptest::prelude::*;

/// Computes the lit colours of six faces in f64, as the expected values.
fn shone(ambient: Rgb, lights: &[([f64; 3], Rgb)], faces: &[Rgb; 6]) -> [[f64; 3]; 6] {
    core::array::from_fn(|face| {
        core::array::from_fn(|channel| {
            let sum: f64 = lights
                .iter()
                .map(|(direction, colour)| {
                    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let sign = if face % 2 == 1 { 1.0 } else { -1.0 };
                    let along = sign * direction[face / 2] / length;
                    along.max(0.0) * f64::from(colour[channel])
                })
                .sum();
            let light = (f64::from(ambient[channel]) + sum) / 255.0;
            f64::from(faces[face][channel]) * light.min(1.0)
        })
    })
}

fn lights() -> impl Strategy<Value = Vec<([i64; 3], Rgb)>> {
    // The random shift generates directions of all magnitudes.
    let number = (any::<i64>(), 0..63_u32).prop_map(|(x, shift)| x >> shift);
    let direction = [number.clone(), number.clone(), number]
        .prop_filter("a direction", |direction| *direction != [0; 3]);
    proptest::collection::vec((direction, any::<Rgb>()), 0..=MAX_LIGHTS)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn faces_are_lit_as_in_f64(
        ambient in any::<Rgb>(),
        lights in lights(),
        material in proptest::sample::select(&Material::ALL[..]),
    ) {
        let lighting = Lighting {
            ambient,
            lights: lights
                .iter()
                .map(|(direction, colour)| {
                    Light::new(direction.map(Q32_32::from_bits), *colour).expect("a direction")
                })
                .collect(),
            ..Lighting::PLAIN
        };
        let exact: Vec<_> = lights
            .iter()
            .map(|(direction, colour)| (direction.map(|x| x as f64), *colour))
            .collect();
        let exact = shone(ambient, &exact, &material.faces());
        for (found, exact) in lighting.shine_on(&material.faces()).iter().zip(exact) {
            for (found, exact) in found.iter().zip(exact) {
                // The tolerance is half a step for the rounding of the result, plus 2^-15 of 255 for the rounding
                // of each light's direction.
                prop_assert!((f64::from(*found) - exact).abs() < 0.54, "{found} {exact}");
            }
        }
    }

    /// The printed text of a light reads back as the same light.
    #[test]
    fn lights_come_back_bit_for_bit(
        direction in [any::<i64>(), any::<i64>(), any::<i64>()],
        shift in 0..63_u32,
        colour in any::<Rgb>(),
    ) {
        if let Ok(light) = Light::new(direction.map(|x| Q32_32::from_bits(x >> shift)), colour) {
            let text = light.to_string();
            prop_assert_eq!(Light::parse(&text), Ok(light));
        }
    }

    #[test]
    fn no_text_upsets_the_parser(text in "[-+0-9.,a-f]{0,40}") {
        let _ = Light::parse(&text).map_err(|error| error.to_string());
    }
}

#[test]
fn plain_light_leaves_colours_as_they_are() {
    for material in Material::ALL {
        assert_eq!(
            Lighting::PLAIN.shine_on(&material.faces()),
            material.faces()
        );
    }
}

/// All faces of a material must have different lit colours, except faces in ambient light only, because no edge is visible
/// between faces of equal colour.
#[test]
fn every_face_of_a_material_looks_different() {
    for material in Material::ALL {
        let faces = material.light().shine_on(&material.faces());
        for (i, face) in faces.iter().enumerate() {
            let other = faces.iter().skip(i + 1).position(|other| other == face);
            // Faces turned away from all lights show only the ambient light.
            assert!(
                other.is_none_or(|_| *face == faces[4]),
                "{}",
                material.name()
            );
        }
    }
}

#[test]
fn the_lights_of_the_day_have_length_1() {
    let Lighting { lights, .. } = Lighting::day();
    let numbers = |x, y, z| [x, y, z].map(Q32_32::from_num);
    assert_eq!(
        lights,
        [
            Light::new(numbers(3, -5, 8), [0xFF, 0xF4, 0xE0]).expect("a direction"),
            Light::new(numbers(-2, 1, 2), [0x30, 0x38, 0x48]).expect("a direction"),
        ]
    );
}

#[test]
fn lights_and_colours_are_read() {
    let along_z = |z| [Q32_32::ZERO, Q32_32::ZERO, z];
    let white = Light::new(along_z(Q32_32::lit("2.5")), [0xFF; 3]);
    assert_eq!(Light::parse("0,0,2.5"), white);
    let little = Light::new(along_z(Q32_32::lit("1e-5")), [255, 192, 128]);
    assert_eq!(Light::parse("0,0,1e-5,ffC080"), little);
    let at_camera = Light::at_camera([255, 128, 10]);
    assert_eq!(Light::parse("camera,ff800a"), Ok(at_camera));
    assert_eq!(at_camera.to_string(), "camera,ff800a");
    assert_eq!(Light::parse("camera"), Ok(Light::at_camera([0xFF; 3])));
    for text in [
        "",
        "1,2",
        "1,2,x",
        "1,2,3,",
        "1,2,3,+fffff",
        "1,2,3,ffffff,",
        "camera,",
        "cameras",
    ] {
        let error = Light::parse(text).expect_err(text);
        assert_eq!(error, LightError::Form(text));
        assert_eq!(
            error.to_string(),
            format!("{text}: expected X,Y,Z[,RRGGBB] or camera[,RRGGBB]")
        );
    }
    assert_eq!(parse_rgb("0102ff"), Some([1, 2, 255]));
    assert_eq!(parse_rgb("\u{e9}\u{e9}\u{e9}"), None);
}

#[test]
fn what_is_not_said_of_light_follows_from_what_is() {
    let gold = Appearance {
        material: Material::Gold,
        ..Appearance::default()
    };
    assert_eq!(Appearance::default().lighting(), Lighting::PLAIN);
    assert_eq!(gold.lighting(), Lighting::day());
    let dim = Appearance {
        ambient: Some([1, 2, 3]),
        ..gold.clone()
    };
    let Lighting {
        ambient, lights, ..
    } = dim.lighting();
    assert_eq!((ambient, lights), ([1, 2, 3], Lighting::day().lights));
    let light = Light::parse("0,0,1").expect("a light");
    let lit = Appearance {
        lights: [light].into_iter().collect(),
        ..gold
    };
    let Lighting {
        ambient, lights, ..
    } = lit.lighting();
    assert_eq!((ambient, &lights[..]), (Lighting::AMBIENT, &[light][..]));
}

#[test]
fn meshes_have_the_first_light() {
    assert_eq!(Appearance::default().mesh_lighting(), MeshLighting::CAMERA);
    let [first, second] = ["0,0,1", "0,1,0"].map(|text| Light::parse(text).expect("a light"));
    let mut appearance = Appearance {
        material: Material::Gold,
        ambient: Some([1, 2, 3]),
        ..Appearance::default()
    };
    let dim = MeshLighting {
        ambient: [1, 2, 3],
        ..MeshLighting::CAMERA
    };
    assert_eq!(appearance.mesh_lighting(), dim);
    appearance.ambient = None;
    appearance.lights = [first, second].into_iter().collect();
    let lit = MeshLighting {
        ambient: Lighting::AMBIENT,
        light: first,
    };
    assert_eq!(appearance.mesh_lighting(), lit);
}

#[test]
fn a_light_at_the_camera_follows_the_camera() {
    let view = View::spherical(Q32_32::from_num(3), Turns(0), Turns::QUARTER).expect("a camera");
    let lighting = Lighting {
        ambient: [0; 3],
        lights: [Light::at_camera([255; 3])].into_iter().collect(),
        ..Lighting::PLAIN
    };
    // The camera is on the x axis, so the face towards the camera is in full light and all other faces are dark.
    let lit = lighting.clone().seen_from(&view);
    let [_, face, dark @ ..] = lit.shine_on(&[[200; 3]; 6]);
    assert_eq!(face, [200; 3]);
    assert_eq!(dark, [[0; 3]; 4]);
    assert_eq!(lighting.shine_on(&[[200; 3]; 6]), [[0; 3]; 6]);
    let sun = Lighting::day();
    assert_eq!(sun.clone().seen_from(&view), sun);
}

#[test]
fn names_are_different() {
    for (i, name) in Material::NAMES.iter().enumerate() {
        assert!(!Material::NAMES[..i].contains(name), "{name}");
    }
}

#[test]
fn backgrounds() {
    let background = |text| Appearance {
        background: Background::parse(text),
        ..Appearance::default()
    };
    let default = Appearance::default();
    assert_eq!(default.field_background(), Background::White);
    for (text, horizon, is_fixed) in [
        ("white", [0xFF; 3], None),
        ("sky", [214, 228, 242], Some(false)),
        ("gradient", [92, 98, 108], Some(true)),
        ("0080ff", [0, 0x80, 0xFF], None),
    ] {
        let appearance = background(text);
        let background = appearance.field_background();
        assert_eq!(background.to_string(), text);
        assert_eq!(background.colours()[1], horizon);
        let gradient = background.gradient().map(|shown| shown.is_fixed);
        assert_eq!(gradient, is_fixed, "{text}");
    }
    for text in ["", "black", "12345", "1234567", "White", "+12345"] {
        assert_eq!(Background::parse(text), None, "{text}");
    }
}

#[test]
fn highlights_are_read_and_come_back() {
    for (text, shown) in [
        ("0.6,32", "0.6,32"),
        ("1,4", "1,4"),
        ("0,128", "0,128"),
        ("0.0625,5", "0.063,5"),
        ("0.05,100", "0.05,100"),
    ] {
        let highlight = Highlight::parse(text).expect(text);
        assert_eq!(highlight.to_string(), shown);
        assert_eq!(Highlight::parse(shown), Some(highlight));
    }
    for text in [
        "", "0.5", "0.5,3", "0.5,129", "1.001,9", "-0.1,9", "0.5,9,", "x,9", "0.5,+9",
    ] {
        assert_eq!(Highlight::parse(text), None, "{text}");
    }
}

/// The approximated power of the cosine in the highlight against the exact power, for all exponents.
#[test]
fn the_highlight_is_near_the_power_of_the_cosine() {
    let mut most: [f64; 2] = [0.0; 2];
    for exponent in 4..=128 {
        let highlight = Highlight::parse(&format!("1,{exponent}")).expect("a highlight");
        let steepness = f64::from(highlight.steepness()) / 256.0;
        for cosine in (0..=1 << 16).step_by(7).chain([1 << 16]) {
            let found = f64::from(highlight_share(highlight.steepness(), cosine)) / 255.0;
            let cosine = f64::from(cosine) / 65536.0;
            let exact = (1.0 - steepness * (1.0 - cosine)).max(0.0).powi(4);
            most[0] = most[0].max((found - exact).abs());
            most[1] = most[1].max((found - cosine.powi(exponent)).abs());
        }
    }
    println!(
        "error against the fourth power {:.4}, against the power of the cosine {:.4}",
        most[0], most[1]
    );
    assert!(most[0] <= 1.4 / 255.0 && most[1] <= 0.037, "{most:?}");
}
