//! Compares the whole SoC, including its raymarcher, with glint-model: colours, depths and statistics of every field, from three
//! cameras, for one eye and for two eyes.

use glint::board::{self, Board, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::picture::Image;
use glint::render::{self, FieldSubject, Frame, MeshSubject, Rendered, Stats, Subject, on_model};
use glint::{convert, generate};
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::field::{Field, Menger, Primitive};
use glint_core::fixed::{Q32_32, U4_28};
use glint_core::light::{Background, Light, Material};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};
use glint_core::wire::Manifest;

use crate::{Replies, compare_triangles, read, send};
use glint_vectors::Camera;

/// Longest accepted pause in the firmware's output, in the board's time.
const PATIENCE_MS: u64 = 4000;

/// Representative fields.
const FIELDS: [&str; 13] = [
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
];

/// Returns all tested fields: the fields in `FIELDS`, and an example of each kind of field that is not in `FIELDS`.
fn fields() -> Vec<&'static str> {
    let kind = |text: &&str| text.split(':').next().map(str::to_owned);
    let is_new = |text: &&str| !FIELDS.iter().any(|other| kind(other) == kind(text));
    let further = Primitive::EXAMPLES.into_iter().filter(is_new);
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

/// Returns the settings for one eye, and for two eyes with each tint (a pair of colours for the eyes).
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

pub fn board() -> SimulatedBoard {
    board::verilated(&built_firmware(None).unwrap()).unwrap()
}

/// Draws a field on the board, with or without depths, and compares the frame and its statistics with the model's.
fn compare(console: &mut Console<SimulatedBoard>, frame: &Frame, with_depth: bool) {
    let Frame {
        subject: Subject::Field(FieldSubject { field, prepass, .. }),
        view,
        size,
        stereo,
        ..
    } = frame
    else {
        panic!("expected a field");
    };
    let cones = if *prepass { ", after cones" } else { "" };
    let name = format!("{field}, {stereo:?}, {view} at {size}{cones}");
    let Rendered { image, stats } = on_model(frame).unwrap();
    let replies = send(console, &lines(frame, with_depth));
    compare_rays(&replies, &name, &stats);
    compare_picture(console, &replies, &name, &image, with_depth);
}

/// Returns the console commands that draw `frame`; a mesh of the frame must already be loaded. The commands must be sent in one
/// write, so that the firmware draws no frame between two commands.
fn lines(frame: &Frame, with_depth: bool) -> Vec<String> {
    let mut lines = render::commands(frame, "model", |_| String::new()).unwrap();
    lines.push(format!("render{}", if with_depth { " depth" } else { "" }));
    lines.push("info".to_owned());
    lines
}

fn compare_rays(replies: &Replies, name: &str, stats: &Stats) {
    assert_eq!(
        replies.text("backend"),
        "gateware",
        "{name}: {:#?}",
        replies.lines
    );
    let rays = stats.rays.as_ref().unwrap();
    let counted = ["rays", "hits", "misses", "undecided"].map(|key| replies.number(key));
    let expected = [rays.rays, rays.hits, rays.misses, rays.undecided];
    assert_eq!(counted, expected, "{name}: rays, hits, misses, undecided");
    let evaluations = u64::from(replies.number("evaluations"));
    assert_eq!(evaluations, rays.evaluations, "{name}: evaluations");
}

pub fn compare_picture(
    console: &mut Console<SimulatedBoard>,
    replies: &Replies,
    name: &str,
    image: &Image,
    with_depth: bool,
) {
    let place = |at: usize| (at as u32 % image.width, at as u32 / image.width);
    let bytes = read(console, replies.address("frame"), 2 * image.colour.len());
    for (at, (found, &wanted)) in bytes.chunks_exact(2).zip(&image.colour).enumerate() {
        let found = u16::from_le_bytes([found[0], found[1]]);
        assert_eq!(found, wanted, "{name}: the colour at {:?}", place(at));
    }
    if with_depth {
        let bytes = read(console, replies.address("depth"), 4 * image.depth.len());
        for (at, (found, &wanted)) in bytes.chunks_exact(4).zip(&image.depth).enumerate() {
            let found = u32::from_le_bytes([found[0], found[1], found[2], found[3]]);
            assert_eq!(found, wanted, "{name}: the depth at {:?}", place(at));
        }
    }
}

/// Whether the environment variable `GLINT_RTL_FIELDS` requests more combinations of fields, cameras and sizes, which take a long
/// time.
fn all() -> bool {
    std::env::var("GLINT_RTL_FIELDS").is_ok_and(|which| which == "all")
}

/// Draws every fourth field from one camera with one or two eyes, every second of these pictures with a prepass; also one field
/// of each kind that is not in `FIELDS`. With `GLINT_RTL_FIELDS=all`, draws all fields from all cameras, with one eye and with
/// two eyes, and from one camera also with a prepass.
#[test]
fn the_soc_draws_every_field() {
    let mut board = board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    for (number, text) in fields().into_iter().enumerate() {
        let field = Field::parse(text).unwrap();
        // Fields of kinds that are not in `FIELDS` are always drawn.
        let is_further = number >= FIELDS.len();
        for (side, view) in views().iter().enumerate() {
            // The tints alternate between the pictures for two eyes.
            for stereo in [None, eyes()[1 + (number + side) % 2]] {
                let once = side == number % 3;
                let in_turn = once && stereo.is_some() == ((number / 4 + side) % 2 == 0);
                for prepass in [false, true] {
                    let drawn = if all() {
                        !prepass || once
                    } else {
                        is_further && once && stereo.is_none() && !prepass
                            || in_turn && number % 4 == 0 && prepass == (number / 4 % 2 == 1)
                    };
                    if drawn {
                        let subject = FieldSubject {
                            field: &field,
                            appearance: &Appearance::default(),
                            quality: Quality::default(),
                            prepass,
                        };
                        let frame = Frame {
                            stereo,
                            ..Frame::new(Subject::Field(subject), *view, Size::W320)
                        };
                        compare(&mut console, &frame, once);
                    }
                }
            }
        }
    }
}

#[test]
fn the_soc_draws_large_fields_and_goes_back_to_meshes() {
    let mut board = board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let (cube, _) = convert::convert(
        &generate::named("cube").unwrap(),
        convert::Options::default(),
    )
    .unwrap();
    let sponge = FieldSubject {
        field: &Field::from(Menger { depth: 4 }),
        appearance: &Appearance::default(),
        quality: Quality::default(),
        prepass: true,
    };
    let [view, ..] = views();
    let sizes = [Size::W640, Size::W1280];
    for &size in if all() { &sizes[..] } else { &sizes[..1] } {
        let frame = Frame::new(Subject::Field(sponge), view, size);
        compare(&mut console, &frame, size == Size::W640);
        let mesh = Mesh::new_checked(&cube).unwrap();
        let frame = Frame::new(Subject::mesh(mesh), view, size);
        let Rendered { image, .. } = on_model(&frame).unwrap();
        let load = load(&mut console, &cube);
        let replies = send(
            &mut console,
            &[load, "render".to_owned(), "info".to_owned()],
        );
        assert_eq!(replies.text("backend"), "gateware", "{:#?}", replies.lines);
        let name = format!("the cube at {size}");
        compare_picture(&mut console, &replies, &name, &image, false);
    }
}

/// Copies a mesh to the board's staging memory; returns the `load` command for the mesh.
pub fn load(console: &mut Console<SimulatedBoard>, mesh: &[u8]) -> String {
    let Manifest { length, crc32 } = Manifest::of(mesh);
    let staging = send(console, &["info".to_owned()]).address("staging");
    let memory = console.board().memory().unwrap();
    memory.write_memory(staging, mesh).unwrap();
    format!("load {length} {crc32:08x}")
}

/// Draws a mesh that intersects a field, with clipped triangles, light, fog, sky and prepass, and compares the pictures with
/// the model's. With `GLINT_RTL_FIELDS=all`, also draws from more cameras, at a second size, and in consecutive frames.
#[test]
fn the_soc_draws_a_mesh_in_a_field() {
    let mut board = board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let (mesh, _) = convert::convert(
        &generate::named("icosphere:3").unwrap(),
        convert::Options::default(),
    )
    .unwrap();
    let appearance = Appearance {
        material: Material::Gold,
        lights: ["1,-2,3", "-1,0.5,0.25,4080ff"]
            .map(|light| Light::parse(light).unwrap())
            .into_iter()
            .collect(),
        ambient: Some([0x30, 0x20, 0x28]),
        background: Some(Background::Sky),
        fog: U4_28::lit("0.2"),
        occlusion: true,
        undecided: true,
    };
    let field = FieldSubject {
        field: &Field::parse("box:0.75,0.75,0.75").unwrap(),
        appearance: &appearance,
        quality: Quality::default(),
        prepass: true,
    };
    let both = |view, size, cull| {
        let mesh = MeshSubject {
            cull,
            ..MeshSubject::new(Mesh::new_checked(&mesh).unwrap())
        };
        Frame::new(Subject::MeshInField(mesh, field), view, size)
    };
    let [outside, near_by, inside] = views();
    let load = load(&mut console, &mesh);
    send(&mut console, &[load]);
    let mut frames = vec![both(inside, Size::W320, false)];
    if all() {
        frames.push(both(outside, Size::W320, true));
        frames.push(both(near_by, Size::W640, true));
    }
    for (number, frame) in frames.iter().enumerate() {
        let name = format!("scene {number}");
        let Rendered { image, stats } = on_model(frame).unwrap();
        let cull = frame.subject.mesh_part().is_some_and(|mesh| mesh.cull);
        let cull = format!("cull {}", if cull { "on" } else { "off" });
        let lines = [vec![cull], lines(frame, true)].concat();
        let replies = send(&mut console, &lines);
        compare_rays(&replies, &name, &stats);
        let triangles = stats.triangles();
        assert!(
            number > 0 || triangles.triangles_clipped > 0,
            "nothing was clipped"
        );
        compare_triangles(&replies, &name, &stats);
        assert_eq!(
            u64::from(replies.number("pixels_covered")),
            triangles.pixels_covered,
            "{name}"
        );
        compare_picture(&mut console, &replies, &name, &image, true);
    }
    if !all() {
        return;
    }
    // The command `bench` draws eight frames without waiting for the monitor between them.
    let replies = send(
        &mut console,
        &["bench field".to_owned(), "info scene".to_owned()],
    );
    assert!(replies.text("bench").starts_with("field frames 8 cycles "));
    assert_eq!(replies.text("scene"), "box:0.75,0.75,0.75 with model");
}
