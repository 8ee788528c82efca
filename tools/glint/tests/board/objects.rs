//! Objects on the board: several named meshes in memory, drawn as the model draws them.

use crate::common::{address, drawn_alike, emulator, info, mesh, object, read, renderer, small};
use glint::board::{EmulatedBoard, SimulatedBoard};
use glint::console::Console;
use glint::render::{Frame, Subject};
use glint::{transfer, view};
use glint_core::picture::Size;

/// Four objects with three meshes, which overlap as seen by the camera.
#[test]
fn objects_are_the_models() {
    let meshes = ["cube", "icosphere:1", "sponge:1"].map(mesh);
    let [cube, sphere, sponge] = &meshes;
    let objects = [
        (cube, "scale 0.7 rotate x 20 rotate z 50 move -0.4,0.2,-0.1"),
        (sphere, "scale 0.5,0.5,-1 move 0.5,0.3,0.2"),
        (sponge, "scale 0.4 rotate y 30 move 0.2,-0.6,0.3"),
        (
            cube,
            "matrix 0.2,0.1,0,0,0.3,0,0,0,0.5,0,0.1,0.5 colour 30c0ff",
        ),
    ]
    .map(|(mesh, place)| object(mesh, place));
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let subject = Subject::Objects(&objects);
    let frame = Frame::new(subject, view::spherical("2.5,30,60").unwrap(), Size::W320);
    let drawn = drawn_alike(&mut renderer, &frame, "objects");
    let [found, expected] = drawn.map(|rendered| rendered.stats.triangles().triangles_drawn);
    assert_eq!(found, expected);
}

/// Uploads are stored one after another. A refused upload does not change the stored uploads, and `unload` moves the later
/// uploads into the gap.
#[test]
fn meshes_have_names_and_share_the_memory() {
    let [a, b, c] = ["cube", "icosphere:1", "icosphere:2"].map(mesh);
    let mut board = emulator();
    let mut console = small(&mut board);
    let start = address(&mut console, "staging");
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    for (number, (mesh, name)) in (1..).zip([(&a, "a"), (&b, "b"), (&c, "c")]) {
        transfer::stage(&mut console, mesh).unwrap();
        transfer::upload(&mut console, mesh, Some(name), number, quiet).unwrap();
    }
    assert_eq!(info::<String>(&mut console, "scene"), "c");
    let free = |bytes: usize| format!("free {} bytes", (64 << 20) - bytes);
    let list =
        |console: &mut Console<SimulatedBoard<EmulatedBoard>>| console.command("models").unwrap();
    let all = [
        "built-in cube sphere torus cylinder polygons crate atrium".to_owned(),
        format!("mesh a vertices 24 triangles 12 bytes {}", a.len()),
        format!("mesh b vertices 12 triangles 20 bytes {}", b.len()),
        format!("mesh c vertices 42 triangles 80 bytes {}", c.len()),
        "uploads 3 of 18".to_owned(),
        free(a.len() + b.len() + c.len()),
    ];
    assert_eq!(list(&mut console), all);

    let mut damaged = b.clone();
    let last = damaged.len() - 1;
    damaged[last] ^= 1;
    let refused = transfer::upload(&mut console, &damaged, Some("d"), 4, quiet).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("refused, previous uploads kept"),
        "{refused}"
    );
    assert_eq!(list(&mut console), all);

    console.command("object add c scale 0.5").unwrap();
    let refused = console.command("unload c").unwrap_err().to_string();
    assert!(refused.contains("object 1 shows this mesh"), "{refused}");
    console.command("unload a").unwrap();
    console.command("unload b").unwrap();
    assert!(read(&mut console, start, c.len()) == c);
    let end = start + c.len() as u32;
    assert_eq!(address(&mut console, "staging"), end);
    // The moved mesh is drawn from its new address.
    transfer::stage(&mut console, &b).unwrap();
    let lines = console.command("render").unwrap();
    assert!(
        lines.iter().any(|line| line == "triangles_in 80"),
        "{lines:?}"
    );
    // An object shows the new mesh after an upload replaces its mesh.
    transfer::upload(&mut console, &b, Some("c"), 5, quiet).unwrap();
    console.command("object show").unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    assert_eq!(list(&mut console).last(), Some(&free(b.len())));
}
