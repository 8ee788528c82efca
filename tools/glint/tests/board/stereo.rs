//! Stereo pictures of meshes, edges, objects, and meshes in fields on the emulated board equal the
//! combination of the model's two pictures for one eye.

use crate::common::{
    assert_has, console, counts, drawn_alike, emulator, mesh, plain, renderer, small, two_objects,
};
use glint::board::Board;
use glint::board::Uart;
use glint::render::{self, FieldSubject, Frame, MeshSubject, Subject};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::colour::{Rgb565, Shading, luminance};
use glint_core::field::Field;
use glint_core::picture::{Backend, Edges, Size};
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};

/// Combines the pictures of both eyes to a stereo picture.
fn composed(eyes: &[Frame; 2], tint: Tint) -> Vec<u16> {
    let [left, right] = eyes.map(|frame| render::on_model(&frame).unwrap().image.colour);
    let grey = |pixel| u16::from(luminance(Rgb565(pixel).to_rgb888()));
    let pixels = left.into_iter().zip(right);
    let pixels = pixels.map(|(left, right)| (grey(left), grey(right)));
    pixels
        .map(|(left, right)| {
            let green = match tint {
                Tint::RedBlue => left.min(right),
                Tint::RedCyan => right,
            };
            left >> 3 << 11 | green >> 2 << 5 | right >> 3
        })
        .collect()
}

#[test]
fn two_eyes_are_the_models() {
    let [sphere, sponge] = ["icosphere:2", "sponge:1"].map(mesh);
    let objects = two_objects(&sphere);
    let appearance = Appearance::default();
    let field = Field::parse("box:0.3,1,0.3").unwrap();
    let field = FieldSubject {
        field: &field,
        appearance: &appearance,
        quality: Quality::default(),
    };
    let smooth = MeshSubject {
        shading: Shading::Smooth,
        ..plain(&sphere)
    };
    let both_sides = MeshSubject {
        cull: false,
        ..plain(&sponge)
    };
    let outside = view::spherical("2.5,30,60").unwrap();
    // The camera is in a hole of the sponge. With a half separation of 1, each eye is in a solid part or beyond the sponge.
    let inside = view::look("0,-0.3,0.1,20,10").unwrap();
    let (gateware, cpu) = (Backend::Gateware, Backend::Cpu);
    let mesh = |mesh| Subject::Mesh(plain(mesh));
    let over = Subject::edges(plain(&sponge), Edges::Over);
    let hidden = Subject::edges(plain(&sphere), Edges::Hidden);
    let in_field = Subject::MeshInField(plain(&sphere), field);
    let cases = [
        (mesh(&sphere), outside, "0.1,2.5", gateware),
        (mesh(&sphere), outside, "0,0.1", gateware),
        (mesh(&sphere), outside, "1,1", gateware),
        (mesh(&sphere), outside, "0.1,2,red-cyan", cpu),
        (Subject::Mesh(smooth), outside, "0.1,2.5", gateware),
        (mesh(&sponge), inside, "0.05,0.5", gateware),
        (Subject::Mesh(both_sides), inside, "1,1,red-cyan", gateware),
        (over, inside, "0.05,0.5", gateware),
        (hidden, outside, "0.1,2,red-cyan", cpu),
        (Subject::Objects(&objects), outside, "0.1,2", gateware),
        (in_field, outside, "0.1,2,red-cyan", gateware),
        (in_field, outside, "0.3,1", cpu),
        // The last cases return to one eye, and to a field without a mesh.
        (mesh(&sphere), outside, "", gateware),
        (Subject::Field(field), outside, "0.1,2", gateware),
    ];
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    for (number, (subject, view, stereo, backend)) in cases.into_iter().enumerate() {
        let frame = Frame {
            stereo: (!stereo.is_empty()).then(|| Stereo::parse(stereo).unwrap()),
            ..Frame::new(subject, view, Size::W320)
        };
        renderer.set_backend(backend);
        let [found, expected] = drawn_alike(&mut renderer, &frame, &format!("case {number}"));
        if let Some(eyes) = frame.eyes().unwrap() {
            let expected = &expected.image;
            assert!(expected.colour == composed(&[eyes.left, eyes.right], eyes.tint));
            let left = render::on_model(&eyes.left).unwrap().image;
            assert!(expected.depth == left.depth, "case {number}");
        }
        let [found, expected] = [found.stats, expected.stats];
        assert_eq!(counts(&found), counts(&expected), "case {number}");
        let by = found.backend.as_deref();
        assert_eq!(by, Some(backend.name()), "case {number}");
    }
}

/// While a picture for two eyes is drawn, and while the mode changes, the screen shows either the complete old or the complete
/// new picture.
#[test]
fn no_picture_is_half_composed() {
    let mut board = emulator();
    let mut console = small(&mut board);
    console.command("scene sphere").unwrap();
    let mut wholes = Vec::new();
    let settings = ["stereo off", "stereo 0.2,2", "stereo 0.2,2,red-cyan"];
    for setting in settings {
        for command in [setting, "render"] {
            console.command(command).unwrap();
        }
        wholes.push(console.board().inner().capture());
    }
    assert!(wholes[0] != wholes[1] && wholes[1] != wholes[2]);
    let (mut seen, mut frames) = ([0; 3], 0);
    for setting in settings.iter().cycle().take(9) {
        let text = format!("{setting}\r");
        console.board().write(text.as_bytes()).unwrap();
        // A picture takes about a million cycles.
        for _ in 0..60 {
            let board = console.board().inner();
            board.run(50_000);
            let shown = board.shown();
            let which = wholes.iter().position(|whole| *whole == shown);
            seen[which.expect("a whole picture")] += 1;
            frames += 1;
        }
        console.reply(setting).unwrap();
    }
    println!("{frames} pictures: {seen:?}");
    assert!(seen.iter().all(|&count| count > 60));
}

/// Subjects that cannot be drawn for two eyes are refused by the console.
#[test]
fn a_wireframe_has_one_eye() {
    let mut board = emulator();
    let mut console = console(&mut board);
    for command in ["stereo 0.1,2", "scene wireframe"] {
        console.command(command).unwrap();
    }
    assert_eq!(console.command("stereo").unwrap(), ["stereo off"]);
    let refused = console.command("stereo 0.1,2").unwrap_err().to_string();
    assert_has(&refused, "expected `scene NAME` or `field FIELD` first");
    console.command("stereo off").unwrap();
    for command in ["scene cube", "stereo 0.1,2", "orthographic 2"] {
        console.command(command).unwrap();
    }
    let refused = console.command("render").unwrap_err().to_string();
    assert_has(&refused, "expected perspective with a field or two eyes");
    console.command("fov 60").unwrap();
    console.command("render").unwrap();
}
