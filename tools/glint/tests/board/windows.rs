//! Pictures through windows that are off the camera's axis, or whose pixels are not square, are bit-identical to the model's.

use crate::common::{drawn_alike, emulator, mesh, object, plain, renderer, running_board};
use glint::board::Simulation;
use glint::render::{BoardRenderer, FieldSubject, Frame, Subject};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::camera::{Lens, Projection, View};
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, U8_28};
use glint_core::picture::{Backend, Edges, Size};
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;

/// A camera whose window has these half sizes and this middle.
fn through(projection: Projection, half: [&str; 2], middle: [&str; 2]) -> View {
    let view = view::spherical("2.5,30,60").unwrap();
    let lens = Lens::window(
        projection,
        half.map(U8_28::lit),
        middle.map(Q32_32::lit),
        view.near(),
    );
    view.with_lens(lens.unwrap())
}

fn compare<S: Simulation>(
    renderer: &mut BoardRenderer<glint::board::SimulatedBoard<S>>,
    frame: &Frame,
    by: &str,
) {
    let [found, expected] = drawn_alike(renderer, frame, by);
    assert_eq!(found.stats.backend.as_deref(), Some(by));
    let first = expected.image.colour.first();
    assert!(
        expected.image.colour.iter().any(|x| Some(x) != first),
        "empty"
    );
}

/// Draws meshes, edges, objects, fields, a mesh in a field, and two eyes, by the gateware and by the soft core.
#[test]
fn windows_are_the_models() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let (sphere, cube) = (mesh("icosphere:2"), mesh("cube"));
    let objects = [
        object(&cube, "scale 0.5 rotate z 30 move 0.3,0.2,0.1"),
        object(&sphere, "scale 0.6,0.4,0.5 move -0.2,0.1,0"),
    ];
    let field = FieldSubject {
        field: &Field::parse("box:0.5,0.3,0.2").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let windows = [
        through(Projection::Perspective, ["0.3", "0.3"], ["0.1", "-0.05"]),
        through(Projection::Perspective, ["0.2", "0.1125"], ["-0.05", "0.1"]),
        through(Projection::Orthographic, ["0.6", "0.5"], ["0.1", "-0.2"]),
    ];
    for backend in [Backend::Gateware, Backend::Cpu] {
        renderer.set_backend(Some(backend));
        for view in windows {
            let mut subjects = vec![
                Subject::Mesh(plain(&sphere)),
                Subject::edges(plain(&cube), Edges::Over),
                Subject::Objects(&objects),
            ];
            let is_perspective = view.projection() == Projection::Perspective;
            if is_perspective {
                subjects.push(Subject::Field(field));
                subjects.push(Subject::MeshInField(plain(&sphere), field));
            }
            for subject in subjects {
                let frame = Frame::new(subject, view, Size::W320);
                compare(&mut renderer, &frame, backend.name());
            }
            if is_perspective && backend == Backend::Gateware {
                for subject in [Subject::Mesh(plain(&sphere)), Subject::Field(field)] {
                    let frame = Frame {
                        stereo: Some(Stereo::parse("0.03,2").unwrap()),
                        ..Frame::new(subject, view, Size::W320)
                    };
                    compare(&mut renderer, &frame, "gateware");
                }
            }
        }
    }
}

/// Draws a mesh and a field on the verilated SoC.
#[test]
fn the_soc_draws_windows() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let view = through(Projection::Perspective, ["0.3", "0.3"], ["0.1", "-0.05"]);
    let cube = mesh("cube");
    let frame = Frame::new(Subject::Mesh(plain(&cube)), view, Size::W320);
    compare(&mut renderer, &frame, "gateware");
    let parallel = through(Projection::Orthographic, ["0.8", "0.6"], ["0.1", "-0.2"]);
    let frame = Frame::new(Subject::Mesh(plain(&cube)), parallel, Size::W320);
    compare(&mut renderer, &frame, "gateware");
    let field = FieldSubject {
        field: &Field::parse("box:0.5,0.3,0.2").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let frame = Frame::new(Subject::Field(field), view, Size::W320);
    compare(&mut renderer, &frame, "gateware");
}
