//! Compares frames of several objects on the whole SoC with glint-model: colours, depths and counts of triangles. The triangle
//! engine makes a geometry pass for each object, and the firmware clips the exceptions of each object. Every other frame has a sky. Shading is flat, the
//! shading of the standard gateware build.

use glint::console::value;
use glint::render::{self, Frame, Subject};
use glint_core::colour::Winding;
use glint_core::fixed::U8_28;
use glint_core::picture::Size;
use glint_model::Clip;
use glint_vectors::Camera;

use super::compare;
use crate::common::{mesh, object, renderer, running_board, sky};

/// Placements of the objects that the gateware draws. The first object encloses the eye of the last
/// camera, and other objects cross the near plane of this camera, so that triangles of several
/// objects are clipped.
const OBJECTS: [&str; 5] = [
    "scale 1.7 rotate x 20",
    "scale 0.3 rotate z 30 move 0.4,0.3,0.1",
    "scale -0.25 rotate y 50 move -0.35,0.2,0.3 colour 40c0ff",
    "scale 0.5 rotate x 45 rotate z 45 move -0.5,-0.6,0 colour ff8020",
    "matrix 0.2,0,0,0,0.2,0,0,0,-0.2,0.3,-0.5,-0.2",
];

/// An object with a matrix that requires transformed normals, so that the engine draws a copy of its mesh.
const STRETCHED: &str = "scale 0.2,0.4,0.1";

#[test]
fn the_soc_draws_objects() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let views = [
        Camera::looking([1.5, -1.9, 1.0], [0.0; 3], 0.6, 0.1),
        Camera::looking([0.3, -0.2, 0.2], [-0.3, 0.4, 0.0], 1.4, 0.02),
    ];
    let all = OBJECTS.len();
    let usual = |view| (view, Clip::Guard, Winding::Mesh);
    let far = U8_28::lit("2.5");
    // One object, all objects that the gateware draws, and one object more in two sizes. Geometry passes do not support the options of
    // the last two frames, so the CPU computes all descriptors, which takes it long: these frames have a quarter of the triangles.
    let frames: [(&str, &[_]); 2] = [
        (
            "icosphere:2",
            &[
                (1, Size::W320, usual(0)),
                (all, Size::W320, usual(1)),
                (all + 1, Size::W320, usual(0)),
                (all + 1, Size::W640, usual(1)),
            ],
        ),
        (
            "icosphere:1",
            &[
                (all + 1, Size::W320, (0, Clip::View { far }, Winding::Mesh)),
                (all + 1, Size::W320, (1, Clip::Guard, Winding::Screen)),
            ],
        ),
    ];
    for (name, frames) in frames {
        let mesh = mesh(name);
        renderer.upload(&mesh, Some("model")).unwrap();
        let places = OBJECTS.into_iter().chain([STRETCHED]);
        let mut objects: Vec<_> = places.map(|place| object(&mesh, place)).collect();
        for &(count, size, (view, clip, winding)) in frames {
            for object in &mut objects {
                object.subject.winding = winding;
                object.subject.clip = clip;
            }
            let subject = Subject::Objects(&objects[..count]);
            let frame = Frame {
                sky: (view == 1).then(sky),
                ..Frame::new(subject, views[view].rounded(), size)
            };
            let stats = compare(&mut renderer, &frame, true);
            let is_by_cpu = stats.engine.get("cycles_geometry").unwrap() == 0;
            let has_options = (clip, winding) != (Clip::Guard, Winding::Mesh);
            assert_eq!(is_by_cpu, has_options, "{count} objects at {size}");
        }
    }
}

/// Measures back-to-back frames of one and of five objects with 4,900 triangles in total, and the soft core's cycles per object.
/// Requires gateware with smooth shading: `cargo xtask gateware --board virtual --smooth`.
#[test]
#[ignore = "needs gateware with smooth shading"]
fn five_objects_take_a_sixtieth_of_a_second() {
    const CYCLES: u64 = 81_250_000 / 60;
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    renderer.upload(&mesh("icosphere:7"), None).unwrap();
    let console = renderer.console();
    let view = Camera::looking([1.5, -1.9, 1.0], [0.0; 3], 0.5, 0.1);
    console.command("shading smooth").unwrap();
    let view = render::view_command(&view.rounded());
    console.command(&view).unwrap();
    let mut soft_core = vec![];
    for (count, place) in [
        (1, "move 0,0,0"),
        (2, "scale 0.5 move 0.6,0.4,0.1"),
        (3, "scale 0.5 rotate x 50 move -0.6,0.4,0.1"),
        (4, "scale 0.4 rotate y 50 move 0,-0.7,0.4 colour ff8020"),
        (5, "scale 0.4 rotate z 50 move 0.3,-0.7,-0.4 colour 40c0ff"),
    ] {
        let object = format!("object add model {place}");
        console.command(&object).unwrap();
        if count > 1 && count < 5 {
            continue;
        }
        for size in [Size::W640, Size::W1280] {
            console.command(&render::size_command(size)).unwrap();
            let lines = console.command("bench triangle").unwrap();
            let text: String = value("bench triangle", &lines, "bench").unwrap();
            let value = |key: &str| -> u64 {
                let mut words = text.split(' ').skip_while(|word| *word != key);
                words.nth(1).unwrap().parse().unwrap()
            };
            let (frames, cycles) = (value("frames"), value("cycles"));
            let busy = value("soft_core") / frames;
            println!(
                "{count} objects at {size}: {} cycles a frame, {busy} of the soft core",
                cycles / frames
            );
            soft_core.push(busy);
            assert!(size != Size::W640 || cycles <= CYCLES * frames);
        }
    }
    println!(
        "an object: {} cycles of the soft core",
        (soft_core[2] - soft_core[0]) / 4
    );
}
