//! Compares the gateware on the virtual board with the engines of the emulated board: pictures,
//! depths, the position of a hand and the exact counts are equal.

use crate::common::{
    emulator, emulator_with, mesh, plain, renderer, running_board, small, two_objects,
};
use glint::board::{SimulatedBoard, Simulation};
use glint::console::value;
use glint::gesture::image_sensor;
use glint::render::{FieldSubject, Frame, Parts, Rendered, Subject};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::colour::Shading;
use glint_core::field::Field;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use virtual_board::virtual_image_sensor::{Hand, Scene};

/// Renders the named frames on a board.
fn drawn<S: Simulation>(mut board: SimulatedBoard<S>, frames: &[(&str, Frame)]) -> Vec<Rendered> {
    let mut renderer = renderer(&mut board);
    let render = |(name, frame): &(&str, Frame)| {
        let rendered = renderer.render(frame, Parts::ALL).unwrap();
        println!("{name}: {:?} cycles", rendered.stats.cycles);
        rendered
    };
    frames.iter().map(render).collect()
}

#[test]
fn both_boards_draw_the_same() {
    let [sphere, sponge] = ["icosphere:2", "sponge:1"].map(mesh);
    let outside = view::spherical("2.5,30,60").unwrap();
    let inside = view::look("0,-0.3,0.1,20,10").unwrap();
    let objects = two_objects(&sphere);
    let field = FieldSubject {
        field: &Field::parse("box:0.3,1,0.3").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let both = Subject::MeshInField(plain(&sphere), field);
    let frames = [
        ("a mesh", Subject::Mesh(plain(&sphere)), outside, None),
        (
            "clipped triangles",
            Subject::Mesh(plain(&sponge)),
            inside,
            None,
        ),
        ("objects", Subject::Objects(&objects), outside, None),
        ("two eyes", both, outside, Some("0.1,2.5")),
    ]
    .map(|(name, subject, view, stereo)| {
        let frame = Frame {
            stereo: stereo.map(|stereo| Stereo::parse(stereo).unwrap()),
            ..Frame::new(subject, view, Size::W320)
        };
        (name, frame)
    });
    let by_gateware = drawn(running_board(), &frames);
    // The number of words of a descriptor depends on the shading of the gateware.
    let by_emulation = drawn(emulator_with(Shading::Flat), &frames);
    for ((name, frame), (expected, found)) in
        frames.iter().zip(by_gateware.iter().zip(&by_emulation))
    {
        assert!(found.image == expected.image, "{name}");
        let counts = |rendered: &Rendered| {
            let stats = &rendered.stats;
            // The engine writes the words that can differ from the previous frames, and the number of frames drawn while objects
            // are added depends on the speed of the board.
            let exact = if matches!(frame.subject, Subject::Objects(_)) {
                &["vertices", "groups"][..]
            } else {
                &["vertices", "groups", "words_written"]
            };
            let engine: Vec<_> = exact
                .iter()
                .map(|name| stats.engine.get(name).unwrap())
                .collect();
            assert_eq!(stats.triangles().pixels_tested, None);
            let others = (stats.rays.clone(), stats.edges.clone());
            (stats.backend.clone(), stats.mesh.clone(), others, engine)
        };
        assert_eq!(counts(found), counts(expected), "{name}");
        // The cycles of the emulated board are an estimate.
        let [found, expected] = [found, expected].map(|rendered| rendered.stats.cycles.unwrap());
        assert!(
            (expected / 5..2 * expected).contains(&found),
            "{name}: {found}, {expected}"
        );
    }
}

/// Statistics of a resting hand in front of an image sensor without noise.
fn found<S: Simulation>(mut board: SimulatedBoard<S>) -> [String; 3] {
    let hand = Hand {
        centre: [150.0, 110.0],
        area: 6_000.0,
    };
    let scene = Scene::new([320, 240], move |_| vec![hand]);
    board.inner().plug_image_sensor(image_sensor(scene));
    let mut console = small(&mut board);
    console.command("gesture on").unwrap();
    let cycles = u64::from(console.board().inner().clock_hz()) / 50;
    console.board().inner().run(cycles);
    let lines = console.command("gesture").unwrap();
    println!("{lines:#?}");
    ["hand", "centre", "fault"].map(|key| value("gesture", &lines, key).unwrap())
}

#[test]
fn both_boards_find_the_hand() {
    let expected = found(running_board());
    assert_eq!(expected[0], "tracked");
    assert_eq!(found(emulator()), expected);
}
