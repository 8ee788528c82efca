//! Pictures of distance fields, alone and with a mesh, by the raymarcher and by the soft core.

use crate::common::{
    address, assert_has, drawn_alike, emulator, mesh, plain, read, renderer, timeless,
};
use glint::board::Board;
use glint::picture::Image;
use glint::render::{self, FieldSubject, Frame, Rendered, Subject};
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

/// Compares the first two lines of a frame with the model's while the soft core draws the rest. The
/// frame shows a cube that intersects a box.
#[test]
fn the_cpu_draws_a_mesh_in_a_field() {
    const PIXELS: usize = 2 * 320;
    // A fill value that is neither a colour nor a depth of this scene.
    const UNTOUCHED: [u8; 4] = 0xA5A5_A5A5_u32.to_le_bytes();
    let mesh = mesh("cube");
    // The camera looks down, so that the cube and the box both reach the top of the picture.
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
    let Image { colour, depth, .. } = render::on_model(&frame).unwrap().image;
    let mut seen = colour[..PIXELS].to_vec();
    seen.sort_unstable();
    seen.dedup();
    // The lines show mesh, field and background.
    assert!(seen.len() > 2, "{seen:?}");
    let colours: Vec<u8> = colour.iter().flat_map(|c| c.to_le_bytes()).collect();
    let depths: Vec<u8> = depth.iter().flat_map(|d| d.to_le_bytes()).collect();

    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    renderer.upload(&mesh, None).unwrap();
    // Frames alternate between two frame buffers. `colour` and `depth` are addresses in the current buffer; after one `render`,
    // the next frame is drawn into this buffer again.
    renderer.redraw().unwrap();
    let console = renderer.console();
    let [colour, depth] = ["frame", "depth"].map(|key| address(console, key));
    console.command("render").unwrap();
    let mut lines = vec!["backend cpu".to_owned()];
    lines.extend(render::commands(&frame, "model", |_| String::new()).unwrap());
    let memory = console.board().memory().unwrap();
    for place in [colour, depth] {
        memory
            .write_memory(place, &UNTOUCHED.repeat(PIXELS))
            .unwrap();
    }
    // The commands are sent in one write, so that no frame starts between two commands.
    let text: String = lines.iter().map(|line| format!("{line}\r")).collect();
    console.board().write(text.as_bytes()).unwrap();
    for line in &lines {
        console.reply(line).unwrap();
    }
    // The soft core clears the frame to black first, and no visible surface is black. The lines are complete when the last pixel
    // is neither black nor the fill value.
    let mut waited = 0;
    loop {
        let drawn = read(console, colour, 2 * PIXELS);
        let last: [u8; 2] = *drawn.last_chunk().unwrap();
        if last != [0; 2] && last != [UNTOUCHED[0], UNTOUCHED[1]] {
            break;
        }
        waited += 1;
        assert!(waited < 200, "the frame is not drawn");
        console.board().read(&mut Vec::new(), 1).unwrap();
    }
    // The last pixel is not compared, because its depth may not have been written yet.
    let before = PIXELS - 1;
    assert!(read(console, colour, 2 * before) == colours[..2 * before]);
    assert!(read(console, depth, 4 * before) == depths[..4 * before]);
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
