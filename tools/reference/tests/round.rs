//! The model's round fields against the exact hits of the same rays. `--nocapture` shows the measured figures.

use glint_core::field::Field as Scene;
use glint_core::fixed::Turns;
use glint_model::march::{
    FieldOptions, Light, Lights, Palette, ROUND_TUNING, Setup, State, Surface, paint,
};
use glint_reference::camera::{Camera, Size, Vector};
use glint_reference::field::metrics::{Outcome, accuracy, expected};
use glint_reference::field::{Face, Field, Sphere};

const SIZE: Size = Size {
    width: 320,
    height: 180,
};

/// How far the pictures go along n, in world units.
const FAR: f64 = 12.0;

fn ball(centre: Vector, radius: f64) -> Field {
    Field::Spheres(vec![Sphere { centre, radius }])
}

/// The spheres of a picture.
const SPHERES: [(Vector, f64); 8] = [
    ([0.0, 0.0, 0.0], 0.75),
    ([1.0, 0.25, 0.5], 0.5),
    ([-0.75, -0.5, 0.75], 0.25),
    ([0.5, -1.0, -0.25], 0.375),
    ([0.25, 1.0, -0.5], 0.5),
    ([0.0, -0.75, 0.5], 0.125),
    ([-1.25, 0.5, -0.25], 0.625),
    ([1.125, -0.5, -0.5], 0.0625),
];

/// A field as it is typed, and as the reference has it.
fn fields() -> Vec<(String, Turns, Field)> {
    let spheres = SPHERES.map(|(centre, radius)| Sphere { centre, radius });
    let typed = SPHERES.map(|([x, y, z], radius)| format!("{x},{y},{z},{radius}"));
    let angle = 1.0_f64;
    let turns = Turns((angle / std::f64::consts::TAU * 32f64.exp2()) as u32);
    let place = |orbit: f64| [orbit * angle.cos(), orbit * angle.sin(), 0.0];
    vec![
        ("sphere:1".into(), Turns(0), ball([0.0; 3], 1.0)),
        ("sphere:0.25".into(), Turns(0), ball([0.0; 3], 0.25)),
        (
            format!("spheres:{}", typed.join(";")),
            Turns(0),
            Field::Spheres(spheres.into()),
        ),
        (
            "lattice:1,0.3".into(),
            Turns(0),
            Field::Lattice {
                period: 1.0,
                radius: 0.3,
            },
        ),
        ("moving:0.375,0.75".into(), turns, ball(place(0.75), 0.375)),
        (
            "union:menger:3+moving:0.5,1".into(),
            turns,
            Field::Union(
                Box::new(Field::Menger { depth: 3 }),
                Box::new(ball(place(1.0), 0.5)),
            ),
        ),
        (
            "union:box:0.5,0.25,1+sphere:0.625".into(),
            turns,
            Field::Union(
                Box::new(Field::Box {
                    half: [0.5, 0.25, 1.0],
                }),
                Box::new(ball([0.0; 3], 0.625)),
            ),
        ),
    ]
}

/// The picture of the model: its depths along n in world units.
fn picture(setup: &Setup, scale: f64) -> (Vec<Outcome>, u32) {
    let mut most = 0;
    let rows = 0..setup.height;
    let outcomes = rows
        .flat_map(|y| (0..setup.width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let ray = setup.ray(0, x, y);
            let length: i64 = ray.direction.map(|d| i64::from(d).pow(2)).iter().sum();
            assert!(length <= 1 << 34, "{ray:?} is too long");
            let end = setup.march(&ray);
            most = most.max(end.steps);
            match end.state {
                State::Miss => Outcome::Miss,
                State::Undecided => Outcome::Undecided,
                State::Hit(surface) => {
                    let bits = setup.depth_of(&ray, end.t) as f64;
                    let t = bits * (-21.0 - f64::from(setup.exponent)).exp2() / scale;
                    let (face, normal) = match surface {
                        Surface::Face { axis, positive } => {
                            let axis = axis.into();
                            (Face::Axis { axis, positive }, [0.0; 3])
                        }
                        Surface::Round { .. } => {
                            let normal = setup.normal(&ray, &end).expect("it is round");
                            (Face::Round, normal.map(f64::from))
                        }
                    };
                    // As far as the reference looks.
                    if t > FAR {
                        Outcome::Miss
                    } else {
                        Outcome::Hit { t, face, normal }
                    }
                }
            }
        })
        .collect();
    (outcomes, most)
}

#[test]
fn round_fields_are_where_they_are() {
    let target = [0.015625, 0.0, 0.03125];
    for (text, phase, reference) in fields() {
        let scale = match reference {
            Field::Lattice { period, .. } => 64.0 / period,
            _ => 40.5,
        };
        for (name, eye, half_width) in [
            ("outside", [2.1875, 1.6875, 1.3125], 0.9),
            ("wide", [0.375, -1.3125, 0.53125], 1.5),
        ] {
            let camera = Camera::looking_at(eye, target, half_width, 0.01);
            let view = camera.view().expect("a camera");
            let camera = Camera::from(&view);
            let expected = expected(&reference, SIZE, (camera.near, FAR), |pixel| {
                camera.ray(pixel, SIZE)
            });
            let options = FieldOptions {
                tuning: ROUND_TUNING,
                phase,
                ..FieldOptions::default()
            };
            let scene = Scene::parse(&text).expect("a field");
            let setup = Setup::new(&scene, &view, (320, 180), &options).expect("a size");
            let (found, most) = picture(&setup, scale);
            let found = accuracy(&expected, &found);
            println!("{text}, {name}: {found:?}, at most {most} steps");
            let depth = found.depth.expect("it shows something");
            assert!(found.iou >= 0.999 && found.undecided == 0, "{name}");
            assert!(found.wrong_faces <= 0.01, "{name}");
            assert!(depth.median <= 3e-4 && depth.p99 <= 3e-3, "{name}");
            // There may be faces only.
            let normal = found.normal.map_or(0.0, |normal| normal.p99);
            assert!(normal <= 0.3, "{name}");
        }
    }
}

/// The channels of what is seen, against max(0, n·l) of the exact normals.
#[test]
fn spheres_are_lit_as_they_should_be() {
    let mut lights = Lights {
        count: 2,
        ..Lights::default()
    };
    lights.list[1] = Light {
        direction: [0, 65535, 0],
        colour: [90, 40, 10],
    };
    let palette = Palette {
        lights,
        ..Palette::default()
    };
    let camera = Camera::looking_at([2.1875, 1.6875, 1.3125], [0.0; 3], 0.9, 0.01);
    let view = camera.view().expect("a camera");
    let camera = Camera::from(&view);
    for radius in [0.25, 1.0] {
        let scene = Scene::parse(&format!("sphere:{radius}")).expect("a field");
        let options = FieldOptions {
            tuning: ROUND_TUNING,
            ..FieldOptions::default()
        };
        let setup = Setup::new(&scene, &view, (320, 180), &options).expect("a size");
        let mut most: f64 = 0.0;
        for (x, y) in (0..180).flat_map(|y| (0..320).map(move |x| (x, y))) {
            let exact = camera.ray([x, y].map(f64::from), SIZE);
            let field = ball([0.0; 3], radius);
            let Some(hit) = field.hit(exact.origin, exact.direction, 0.01, FAR) else {
                continue;
            };
            let ray = setup.ray(0, x, y);
            let end = setup.march(&ray);
            let found = paint(&setup, &palette, &ray, &end);
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
