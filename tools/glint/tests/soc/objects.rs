//! Compares frames of several objects on the whole SoC with glint-model: colours, depths and counts of triangles. The triangle
//! engine makes a geometry pass for each object, and the firmware clips the exceptions of each object. Shading is flat, the
//! shading of the standard gateware build.

use glint::console::Console;
use glint::render::{self, Frame, MeshSubject, Rendered, Subject, on_model};
use glint_core::colour::Winding;
use glint_core::fixed::U8_28;
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::picture::Size;
use glint_core::words::Words;
use glint_model::{Clip, Object, Placement};
use glint_vectors::Camera;

use crate::fields::{board, compare_picture, load};
use crate::{compare_triangles, generated, send};

/// Longest accepted pause in the firmware's output, in the board's time.
const PATIENCE_MS: u64 = 4000;

/// Placements of the objects that the gateware draws. The first object is around the eye of the last camera, and others cross its
/// near plane, so that triangles of several objects are clipped.
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
    let mut board = board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let mesh = generated("icosphere:2");
    let load = load(&mut console, &mesh);
    send(&mut console, &[load]);
    let views = [
        Camera::looking([1.5, -1.9, 1.0], [0.0; 3], 0.6, 0.1),
        Camera::looking([0.3, -0.2, 0.2], [-0.3, 0.4, 0.0], 1.4, 0.02),
    ];
    let mut objects = vec![];
    for (number, text) in OBJECTS.into_iter().chain([STRETCHED]).enumerate() {
        let place = Place::parse(&mut Words::new(text)).unwrap();
        objects.push(Object {
            subject: MeshSubject::new(Mesh::new_checked(&mesh).unwrap()),
            placement: Placement::new(place.matrix),
            colour: place.colour,
        });
        send(&mut console, &[format!("object add model {text}")]);
        // One object, all objects that the gateware draws, and one more object.
        if (1..OBJECTS.len() - 1).contains(&number) {
            continue;
        }
        let mut frames: Vec<_> = views
            .iter()
            .map(|view| (view, Clip::Guard, Winding::Mesh))
            .collect();
        if number == OBJECTS.len() {
            // The geometry pass does not support the options of these frames, so the CPU makes all descriptors.
            let far = U8_28::lit("2.5");
            frames.extend([
                (&views[0], Clip::View { far }, Winding::Mesh),
                (&views[1], Clip::Guard, Winding::Screen),
            ]);
        }
        for (place, (view, clip, winding)) in frames.into_iter().enumerate() {
            // The larger size is used only with all objects, and not if the CPU makes all descriptors, which takes a long time.
            let is_larger = number == OBJECTS.len() && place < views.len();
            let sizes = [Size::W320, Size::W640];
            for size in sizes.into_iter().take(1 + usize::from(is_larger)) {
                for object in &mut objects {
                    object.subject.winding = winding;
                    object.subject.clip = clip;
                }
                let name = format!("{} objects at {size}, frame {place}", number + 1);
                let frame = Frame::new(Subject::Objects(&objects), view.rounded(), size);
                let Rendered { image, stats } = on_model(&frame).unwrap();
                let clip = match clip {
                    Clip::Guard => "off".to_owned(),
                    Clip::View { far } => far.to_string(),
                };
                let lines = [
                    format!("clip {clip}"),
                    format!("winding {winding}"),
                    render::size_command(size),
                    render::view_command(&frame.view),
                    "render depth".to_owned(),
                    "info".to_owned(),
                ];
                let replies = send(&mut console, &lines);
                assert_eq!(
                    replies.text("backend"),
                    "gateware",
                    "{name}: {:#?}",
                    replies.lines
                );
                let is_by_cpu = replies.number("cycles_geometry") == 0;
                assert_eq!(is_by_cpu, place >= views.len(), "{name}");
                println!(
                    "{name}: {} triangles clipped",
                    stats.triangles().triangles_clipped
                );
                compare_triangles(&replies, &name, &stats);
                compare_picture(&mut console, &replies, &name, &image, true);
            }
        }
    }
}

/// Measures back-to-back frames of one and of five objects with 4,900 triangles in total, and the soft core's cycles per object.
/// Requires gateware with smooth shading: `cargo xtask gateware --board virtual --smooth`.
#[test]
#[ignore = "needs gateware with smooth shading"]
fn five_objects_take_a_sixtieth_of_a_second() {
    const CYCLES: u64 = 81_250_000 / 60;
    let mut board = board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let load = load(&mut console, &generated("icosphere:7"));
    let view = Camera::looking([1.5, -1.9, 1.0], [0.0; 3], 0.5, 0.1);
    let lines = [
        load,
        "shading smooth".to_owned(),
        render::view_command(&view.rounded()),
    ];
    send(&mut console, &lines);
    let mut soft_core = vec![];
    for (count, place) in [
        (1, "move 0,0,0"),
        (2, "scale 0.5 move 0.6,0.4,0.1"),
        (3, "scale 0.5 rotate x 50 move -0.6,0.4,0.1"),
        (4, "scale 0.4 rotate y 50 move 0,-0.7,0.4 colour ff8020"),
        (5, "scale 0.4 rotate z 50 move 0.3,-0.7,-0.4 colour 40c0ff"),
    ] {
        send(&mut console, &[format!("object add model {place}")]);
        if count > 1 && count < 5 {
            continue;
        }
        for size in [Size::W640, Size::W1280] {
            let lines = [render::size_command(size), "bench triangle".to_owned()];
            let replies = send(&mut console, &lines);
            let text = replies.text("bench");
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
