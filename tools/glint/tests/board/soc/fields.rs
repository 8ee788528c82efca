//! Compares the whole SoC, including its raymarcher, with glint-model: colours, depths and statistics of every field, from three
//! cameras, for one eye and for two eyes.

use glint::render::{FieldSubject, Frame, MeshSubject, Subject};
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::field::{Field, Menger, Primitive};
use glint_core::fixed::{Q32_32, U4_28};
use glint_core::light::{Background, Highlight, Light, Material};
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};

use super::compare;
use crate::common::{mesh, plain, renderer, running_board};
use glint_vectors::Camera;

/// Representative fields, as arguments of the command `field`.
const FIELDS: [&str; 17] = [
    "menger:4",
    "menger:6",
    "menger:1",
    "box:1,0.5,0.25",
    "cubes:2,0.8",
    "union:menger:2+spheres:0.75,0.75,0.75,0.5;-0.5,1,0,0.25",
    "union:box:1,0.5,0.25+moving:0.5,0.75,100",
    "planes:0.9",
    "spheres:0,0,0,0.75;1,0.25,0.5,0.5;-0.75,-0.5,0.75,0.25",
    "lattice:2,0.8",
    "moving:0.5,0.75,-60",
    "sphere:1",
    "smooth:0.3,menger:1+sphere:1.2",
    "union:cubes:2,0.4+sphere:0.9",
    "union:boxes:1,0.5,0.5,0.05+spheres:0.75,0.5,0.25,0.5;-0.5,1,0,0.25",
    "union:planes:0.9+moving:0.5,0.75,100",
    "union:lattice:1,0.3+moving:0.45,0.75,-60",
];

/// Returns all tested fields: the fields in `FIELDS`, and an example of each kind of field that is not in `FIELDS`.
fn fields() -> Vec<&'static str> {
    let kind = |text: &&str| text.split(':').next().map(str::to_owned);
    let is_new = |text: &&str| !FIELDS.iter().any(|other| kind(other) == kind(text));
    let is_drawn = |text: &&str| !Field::parse(text).unwrap().is_left_to_soft_core();
    let further = Primitive::EXAMPLES
        .into_iter()
        .filter(is_drawn)
        .filter(is_new);
    FIELDS.into_iter().chain(further).collect()
}

fn looking(eye: [f64; 3], target: [f64; 3], half_width: f64, near: f64) -> View {
    Camera::looking(eye, target, half_width, near).rounded()
}

/// Returns cameras outside the sponge, close to it, and in its hole. The cameras look down, because rays near the horizon would
/// take ten times as many evaluations, which are slow to simulate.
fn views() -> [View; 3] {
    [
        looking([2.2, 1.7, 1.3], [0.0; 3], 0.9, 0.1),
        looking([0.3, 1.2, 0.4], [0.1, 0.0, -0.6], 0.6, 0.05),
        looking([0.05, 0.85, 0.03], [-0.1, 0.3, -0.8], 0.8, 0.02),
    ]
}

/// Returns the settings for one eye, and for two eyes with each tint, which is a pair of colours
/// for the eyes.
fn eyes() -> [Option<Stereo>; 3] {
    let stereo = |tint| Stereo {
        half_separation: Q32_32::lit("0.03"),
        zero_parallax: Q32_32::lit("1.5"),
        tint,
    };
    [
        None,
        Some(stereo(Tint::RedBlue)),
        Some(stereo(Tint::RedCyan)),
    ]
}

/// Whether the environment variable `GLINT_RTL_FIELDS` requests all combinations of fields, cameras
/// and sizes, which take a long time.
fn all() -> bool {
    std::env::var("GLINT_RTL_FIELDS").is_ok_and(|which| which == "all")
}

/// Draws every fourth field, and one field of each kind that is not in `FIELDS`, from one camera
/// with one or two eyes. With `GLINT_RTL_FIELDS=all`, draws all fields from all cameras, with one
/// eye and with two eyes.
#[test]
fn the_soc_draws_every_field() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    for (number, text) in fields().into_iter().enumerate() {
        let field = Field::parse(text).unwrap();
        // Fields of kinds that are not in `FIELDS` are always drawn.
        let is_further = number >= FIELDS.len();
        for (side, view) in views().iter().enumerate() {
            // The tints alternate between the pictures for two eyes.
            for stereo in [None, eyes()[1 + (number + side) % 2]] {
                let once = side == number % 3;
                let in_turn = once && stereo.is_some() == ((number / 4 + side) % 2 == 0);
                let is_drawn =
                    all() || is_further && once && stereo.is_none() || in_turn && number % 4 == 0;
                if is_drawn {
                    let subject = FieldSubject {
                        field: &field,
                        appearance: &Appearance::default(),
                        quality: Quality::default(),
                    };
                    let frame = Frame {
                        stereo,
                        ..Frame::new(Subject::Field(subject), *view, Size::W320)
                    };
                    compare(&mut renderer, &frame, once);
                }
            }
        }
    }
}

#[test]
fn the_soc_draws_large_fields_and_goes_back_to_meshes() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let cube = mesh("cube");
    let sponge = FieldSubject {
        field: &Field::from(Menger { depth: 4 }),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let [view, ..] = views();
    let sizes = [Size::W640, Size::W1280];
    for &size in if all() { &sizes[..] } else { &sizes[..1] } {
        let frame = Frame::new(Subject::Field(sponge), view, size);
        compare(&mut renderer, &frame, size == Size::W640);
        renderer.upload(&cube, Some("model")).unwrap();
        let frame = Frame::new(Subject::Mesh(plain(&cube)), view, size);
        compare(&mut renderer, &frame, false);
    }
}

/// Draws a mesh that intersects a field, with clipped triangles, light and sky, and compares the pictures with
/// the model's. With `GLINT_RTL_FIELDS=all`, also draws from more cameras, at a second size, and in consecutive frames.
#[test]
fn the_soc_draws_a_mesh_in_a_field() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let mesh = mesh("icosphere:3");
    let appearance = Appearance {
        material: Material::Gold,
        lights: ["1,-2,3", "-1,0.5,0.25,4080ff"]
            .map(|light| Light::parse(light).unwrap())
            .into_iter()
            .collect(),
        ambient: Some([0x30, 0x20, 0x28]),
        highlight: Highlight::parse("0.7,20"),
        shadow: true,
        background: Some(Background::Sky),
        // The standard gateware has fog on fields alone.
        fog: U4_28::ZERO,
        occlusion: true,
        undecided: true,
    };
    let field = FieldSubject {
        field: &Field::parse("box:0.75,0.75,0.75").unwrap(),
        appearance: &appearance,
        quality: Quality::default(),
    };
    let both = |view, size, cull| {
        let mesh = MeshSubject {
            cull,
            ..plain(&mesh)
        };
        Frame::new(Subject::MeshInField(mesh, field), view, size)
    };
    let [outside, near_by, inside] = views();
    renderer.upload(&mesh, Some("model")).unwrap();
    let mut frames = vec![both(inside, Size::W320, false)];
    if all() {
        frames.push(both(outside, Size::W320, true));
        frames.push(both(near_by, Size::W640, true));
    }
    for (number, frame) in frames.iter().enumerate() {
        let stats = compare(&mut renderer, frame, true);
        let clipped = stats.triangles().triangles_clipped;
        assert!(number > 0 || clipped > 0, "nothing was clipped");
    }
    if !all() {
        return;
    }
    // The command `bench` draws eight frames without waiting for the monitor between them.
    let console = renderer.console();
    let bench = console.command("bench field").unwrap();
    assert!(bench[0].starts_with("bench field frames 8 cycles "));
    let scene = console.command("info scene").unwrap();
    assert_eq!(scene, ["scene box:0.75,0.75,0.75 with model"]);
}
