//! The whole SoC draws with its raymarcher what glint-model draws: every field from three sides, for one eye and for two,
//! colours and depths, and what was counted.

use glint::board::{Board, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::picture::Frame;
use glint::render::{self, Counts, Rendered, Scene, Subject, on_model};
use glint::{convert, generate};
use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::Q32_32;
use glint_core::stereo::{Stereo, Tint};
use glint_core::wire::Manifest;
use glint_model::march::FieldOptions;

use crate::common::Camera;
use crate::{Told, read, send};

/// The board's time after which a silent firmware has failed.
const PATIENCE_MS: u64 = 4000;

/// Every kind of field.
const FIELDS: [&str; 13] = [
    "menger:4",
    "menger:6",
    "union:menger:2+spheres:0.75,0.75,0.75,0.5;-0.5,1,0,0.25",
    "menger:1",
    "cubes:2,0.8",
    "box:1,0.5,0.25",
    "lattice:2,0.8",
    "spheres:0,0,0,0.75;1,0.25,0.5,0.5;-0.75,-0.5,0.75,0.25",
    "planes:0.9",
    "union:box:1,0.5,0.25+moving:0.5,0.75,100",
    "smooth:0.3,menger:1+sphere:1.2",
    "moving:0.5,0.75,-60",
    "sphere:1",
];

fn looking(eye: [f64; 3], target: [f64; 3], half_width: f64, near: f64) -> View {
    Camera::looking(eye, target, half_width, near).rounded()
}

/// From outside, from near by and in the hole of the sponge. Downwards, where rays end soon: towards a horizon they take ten times
/// the evaluations, of which each is simulated.
fn views() -> [View; 3] {
    [
        looking([2.2, 1.7, 1.3], [0.0; 3], 0.9, 0.1),
        looking([0.3, 1.2, 0.4], [0.1, 0.0, -0.6], 0.6, 0.05),
        looking([0.05, 0.85, 0.03], [-0.1, 0.3, -0.8], 0.8, 0.02),
    ]
}

/// One eye, and two in either pair of colours.
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

fn board() -> SimulatedBoard {
    SimulatedBoard::fast(&built_firmware(None).unwrap()).unwrap()
}

/// Draws a field on the board, with or without its depths in memory, and compares it with the model's.
fn compare(
    console: &mut Console<SimulatedBoard>,
    field: Field,
    stereo: Option<Stereo>,
    view: &View,
    size: (u32, u32),
    with_depth: bool,
) {
    let name = format!("{field}, {stereo:?}, {view} at {size:?}");
    let options = FieldOptions {
        stereo,
        ..FieldOptions::of(&field)
    };
    let scene = Scene {
        subject: Subject::Field {
            field: &field,
            options: &options,
        },
        view: *view,
        size,
        backend: None,
    };
    let Rendered { frame, stats } = on_model(&scene).unwrap();
    // At once, so that nothing is drawn between them.
    let told = send(
        console,
        &[
            format!("size {} {}", size.0, size.1),
            render::view_command(view),
            stereo.map_or("stereo off".to_owned(), |stereo| format!("stereo {stereo}")),
            format!("field {field}"),
            format!("render{}", if with_depth { " depth" } else { "" }),
            "info".to_owned(),
        ],
    );
    assert_eq!(
        told.text("backend"),
        "gateware",
        "{name}: {:#?}",
        told.lines
    );
    let Counts::Rays(rays) = stats.counts else {
        panic!("{name}: rays were to be counted")
    };
    let counted = ["rays", "hits", "misses", "undecided"].map(|key| told.number(key));
    let expected = [rays.rays, rays.hits, rays.misses, rays.undecided];
    assert_eq!(counted, expected, "{name}: rays, hits, misses, undecided");
    let evaluations = u64::from(told.number("evaluations"));
    assert_eq!(evaluations, rays.evaluations, "{name}: evaluations");
    compare_picture(console, &told, &name, &frame, with_depth);
}

fn compare_picture(
    console: &mut Console<SimulatedBoard>,
    told: &Told,
    name: &str,
    frame: &Frame,
    with_depth: bool,
) {
    let place = |at: usize| (at as u32 % frame.width, at as u32 / frame.width);
    let bytes = read(console, told.address("frame"), 2 * frame.colour.len());
    for (at, (found, &wanted)) in bytes.chunks_exact(2).zip(&frame.colour).enumerate() {
        let found = u16::from_le_bytes([found[0], found[1]]);
        assert_eq!(found, wanted, "{name}: the colour at {:?}", place(at));
    }
    if with_depth {
        let bytes = read(console, told.address("depth"), 4 * frame.depth.len());
        for (at, (found, &wanted)) in bytes.chunks_exact(4).zip(&frame.depth).enumerate() {
            let found = u32::from_le_bytes([found[0], found[1], found[2], found[3]]);
            assert_eq!(found, wanted, "{name}: the depth at {:?}", place(at));
        }
    }
}

/// Every second one from one side for one eye or for two, in turns: all of them from all sides for both with
/// `GLINT_RTL_FIELDS=all`.
#[test]
fn the_soc_draws_every_field() {
    let all = std::env::var("GLINT_RTL_FIELDS").is_ok_and(|which| which == "all");
    let mut board = board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    for (number, text) in FIELDS.iter().enumerate() {
        let field = Field::parse(text).unwrap();
        for (side, view) in views().iter().enumerate() {
            // Both pairs of colours are seen in turns.
            for stereo in [None, eyes()[1 + (number + side) % 2]] {
                let in_turn = stereo.is_some() == ((number / 2 + side) % 2 == 0);
                if !all && (!in_turn || side != number / 2 % 3 || number % 2 != 0) {
                    continue;
                }
                let with_depth = side == number / 2 % 3;
                compare(&mut console, field, stereo, view, (320, 180), with_depth);
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
    let sponge = Field::Menger { depth: 4 };
    let [view, ..] = views();
    for size in [(1280, 720), (640, 360)] {
        compare(&mut console, sponge, None, &view, size, size.0 == 640);
        let scene = Scene {
            subject: Subject::mesh(&cube),
            view,
            size,
            backend: None,
        };
        let Rendered { frame, .. } = on_model(&scene).unwrap();
        let Manifest { length, crc32 } = Manifest::of(&cube);
        let staging = send(&mut console, &["info".to_owned()]).address("staging");
        let memory = console.board().memory().unwrap();
        memory.write_memory(staging, &cube).unwrap();
        let lines = [
            format!("load {length} {crc32:08x}"),
            "render".to_owned(),
            "info".to_owned(),
        ];
        let told = send(&mut console, &lines);
        assert_eq!(told.text("backend"), "gateware", "{:#?}", told.lines);
        let name = format!("the cube at {size:?}");
        compare_picture(&mut console, &told, &name, &frame, false);
    }
}
