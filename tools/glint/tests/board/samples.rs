//! Frames with four samples a pixel, which every renderer draws as the model does.

use crate::common::{counts, emulator, mesh, plain, renderer, running_board, sky, two_objects};
use glint::board::Board;
use glint::render::{
    BoardRenderer, FieldSubject, Frame, MeshSubject, Parts, Stats, Subject, on_model,
};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::colour::{Rounding, Shading};
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, U4_28};
use glint_core::light::Background;
use glint_core::picture::{Backend, Edges, Samples, Size};
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};
use std::fmt::Display;

/// Draws a frame with four samples a pixel, and checks that its colours are the model's. Returns its statistics.
fn check<B: Board>(
    renderer: &mut BoardRenderer<B>,
    backend: Backend,
    frame: &Frame,
    name: impl Display,
) -> Stats {
    let frame = Frame {
        samples: Samples::Four,
        ..*frame
    };
    renderer.set_backend(backend);
    let expected = on_model(&frame).unwrap();
    let found = renderer.render(&frame, Parts::COLOUR).unwrap();
    assert_eq!(
        found.stats.backend.as_deref(),
        Some(backend.name()),
        "{name}"
    );
    assert!(found.image.colour == expected.image.colour, "{name}");
    assert_eq!(counts(&found.stats), counts(&expected.stats), "{name}");
    found.stats
}

/// Draws all kinds of frames: a mesh with flat and smooth shading, clipped, with edges, before a sky and in fog; objects; fields, alone and
/// with a mesh; and two eyes. The gateware draws the frames in quarters and whole, and the soft core draws them too.
#[test]
fn averages_are_the_models() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let sphere = mesh("icosphere:3");
    let objects = two_objects(&sphere);
    let appearance = Appearance::default();
    let field = Field::parse("menger:2").unwrap();
    let field = FieldSubject {
        field: &field,
        appearance: &appearance,
        quality: Quality::default(),
    };
    let smooth = MeshSubject {
        shading: Shading::Smooth,
        ..plain(&sphere)
    };
    let near = view::look("0.3,-1.2,0.3,15,10").unwrap();
    let far = view::spherical("3,40,60").unwrap();
    let stereo = Stereo {
        half_separation: Q32_32::lit("0.03"),
        zero_parallax: Q32_32::lit("2"),
        tint: Tint::RedCyan,
    };
    let whole = |subject, view| Frame::new(subject, view, Size::W320);
    let divided = |subject, view| Frame::new(subject, view, Size::W1280);
    let over = Subject::edges(plain(&sphere), Edges::Over);
    let gateware = [
        divided(Subject::Mesh(plain(&sphere)), near),
        Frame {
            sky: Some(sky()),
            fog: U4_28::lit("0.2"),
            ..divided(Subject::Mesh(smooth), far)
        },
        Frame {
            sky: Background::Gradient.gradient(),
            ..divided(over, far)
        },
        divided(Subject::Objects(&objects), far),
        divided(Subject::Field(field), far),
        Frame {
            rounding: Rounding::Nearest,
            ..whole(Subject::MeshInField(plain(&sphere), field), far)
        },
        Frame {
            stereo: Some(stereo),
            ..whole(Subject::Field(field), far)
        },
        Frame {
            stereo: Some(stereo),
            ..divided(Subject::Mesh(plain(&sphere)), far)
        },
    ];
    for (number, frame) in gateware.iter().enumerate() {
        check(&mut renderer, Backend::Gateware, frame, number);
    }
    for (number, frame) in gateware[..3].iter().enumerate() {
        let size = Size::W320;
        let frame = Frame { size, ..*frame };
        check(&mut renderer, Backend::Cpu, &frame, number);
    }
    check(&mut renderer, Backend::Cpu, &gateware[0], "in quarters");
}

/// The verilated SoC draws a mesh in quarters before a sky, and a field. Each quarter starts directly after the previous
/// quarter, also if it has no geometry pass.
#[test]
fn the_soc_averages() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let sphere = mesh("icosphere:3");
    let appearance = Appearance::default();
    let field = Field::parse("menger:1").unwrap();
    let field = FieldSubject {
        field: &field,
        appearance: &appearance,
        quality: Quality::default(),
    };
    let view = view::spherical("2.5,30,60").unwrap();
    let before_sky = Frame {
        sky: Some(sky()),
        ..Frame::new(Subject::Mesh(plain(&sphere)), view, Size::W1280)
    };
    check(&mut renderer, Backend::Gateware, &before_sky, "mesh");
    let frame = Frame::new(Subject::Field(field), view, Size::W1280);
    let stats = check(&mut renderer, Backend::Gateware, &frame, "field");
    let busy = stats.engine.get("cycles_busy").unwrap();
    let cycles = stats.cycles.unwrap();
    assert!(busy > cycles / 10 * 9, "{busy} of {cycles} cycles");
}
