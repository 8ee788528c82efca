//! Pictures of distance fields, alone and with a mesh, by the raymarcher and by the soft core.

use crate::common::{assert_has, drawn_alike, emulator, mesh, plain, renderer, timeless};
use glint::render::{FieldSubject, Frame, Rendered, Subject};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::field::Field;
use glint_core::light::Material;
use glint_core::picture::{Backend, Size};
use glint_core::quality::Quality;

#[test]
fn a_field_is_the_models() {
    a_field_by(Backend::Gateware, "gateware");
}

#[test]
fn a_field_by_the_cpu_is_the_models() {
    a_field_by(Backend::Cpu, "cpu");
}

/// Draws a cube that intersects a box.
#[test]
fn the_cpu_draws_a_mesh_in_a_field() {
    let mesh = mesh("cube");
    let mut board = emulator();
    let mut renderer = renderer(&mut board).with_backend(Backend::Cpu);
    renderer.upload(&mesh, None).unwrap();
    let eye = r#"{"eye":[0,-6,0],"u":[1,0,0],"v":[0,-0.6,-0.8],"n":[0,0.8,-0.6],"half_width":1.4,"near":0.1}"#;
    let field = FieldSubject {
        field: &Field::parse("box:3,0.2,0.4").unwrap(),
        appearance: &Appearance {
            material: Material::Jade,
            ..Appearance::default()
        },
        quality: Quality::default(),
    };
    let frame = Frame::new(
        Subject::MeshInField(plain(&mesh), field),
        view::parse(eye.as_bytes()).unwrap(),
        Size::W320,
    );
    let [Rendered { stats, .. }, expected] = drawn_alike(&mut renderer, &frame, "cpu");
    assert_eq!(stats.backend.as_deref(), Some("cpu"));
    assert_eq!(timeless(stats), expected.stats);
}

/// Draws a small, distant box with `backend`, and compares colours, depths and counts with the model's.
fn a_field_by(backend: Backend, name: &str) {
    let mut board = emulator();
    let mut renderer = renderer(&mut board).with_backend(backend);
    let eye =
        r#"{"eye":[0,-20,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.3,"near":0.1}"#;
    let subject = FieldSubject {
        field: &Field::parse("box:0.5,0.5,0.25").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let view = view::parse(eye.as_bytes()).unwrap();
    let frame = Frame::new(Subject::Field(subject), view, Size::W320);
    let [Rendered { stats, .. }, expected] = drawn_alike(&mut renderer, &frame, name);
    println!("{:?} cycles", stats.cycles);
    assert_eq!(stats.backend.as_deref(), Some(name));
    assert_eq!(timeless(stats), expected.stats);

    let shown = renderer.console().command("info scene").unwrap();
    assert_eq!(shown, ["scene box:0.5,0.5,0.25"]);
    // Without the field, the board draws the mesh again, and the eye is too far from the origin for a mesh.
    renderer.console().command("field off").unwrap();
    let error = renderer.redraw().unwrap_err().to_string();
    assert_has(&error, "expected within 8 of the origin for a mesh");
    renderer.console().command("camera 2 30 60").unwrap();
    assert_eq!(renderer.redraw().unwrap().triangles().triangles_in, 12);
}
