//! The edges of meshes on the emulated board: the soft core computes segments, the line engine
//! draws lines, and the results equal the model's.

use crate::common::{console, counts, drawn_alike, emulator, mesh, plain, renderer};
use glint::render::{Frame, MeshSubject, Subject};
use glint::view;
use glint_core::colour::Winding;
use glint_core::fixed::U8_28;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Edges, Size};
use glint_model::Clip;

/// A mesh of one chunk with its triangles in reverse order.
fn reversed(mesh: &[u8]) -> Vec<u8> {
    let triangles = Mesh::new_checked(mesh).unwrap().triangle_count() as usize;
    let (before, triangles) = mesh.split_at(mesh.len() - 16 * triangles);
    let records = triangles.chunks_exact(16).rev();
    before.iter().chain(records.flatten()).copied().collect()
}

/// Hidden edges and edges over the faces, with unclipped triangles, clipped triangles (which the soft core appends to the band
/// lists), and triangles set up by the soft core.
#[test]
fn edges_are_the_models() {
    let [sphere, sponge] = ["icosphere:2", "sponge:1"].map(mesh);
    let other = reversed(&sphere);
    let outside = view::spherical("2,30,60").unwrap();
    let inside = view::look("0,-0.3,0.1,20,10").unwrap();
    let far = Clip::View {
        far: U8_28::lit("2.1"),
    };
    let clipped = MeshSubject {
        clip: far,
        winding: Winding::Screen,
        ..plain(&sponge)
    };
    let both_sides = MeshSubject {
        cull: false,
        ..plain(&sphere)
    };
    let (hidden, over) = (Some(Edges::Hidden), Some(Edges::Over));
    let (gateware, cpu) = (Backend::Gateware, Backend::Cpu);
    let cases = [
        (plain(&sphere), outside, hidden, gateware),
        // Without edges the board keeps the list of the previous mesh. The next mesh is loaded at the same address as the
        // previous mesh.
        (plain(&sphere), outside, None, gateware),
        (plain(&other), outside, hidden, gateware),
        (plain(&sponge), inside, over, gateware),
        (clipped, outside, hidden, gateware),
        (both_sides, outside, over, cpu),
    ];
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    for (number, (subject, view, edges, backend)) in cases.into_iter().enumerate() {
        let subject = match edges {
            Some(edges) => Subject::edges(subject, edges),
            None => Subject::Mesh(subject),
        };
        let frame = Frame::new(subject, view, Size::W320);
        renderer.set_backend(backend);
        let [found, expected] = drawn_alike(&mut renderer, &frame, &format!("case {number}"));
        let by = found.stats.backend.as_deref();
        assert_eq!(by, Some(backend.name()), "case {number}");
        let [found, expected] = [found.stats, expected.stats];
        assert_eq!(counts(&found), counts(&expected), "case {number}");
        let is_clipped = number == 3 || number == 4;
        let clipped = expected.triangles().triangles_clipped;
        assert_eq!(clipped > 0, is_clipped, "case {number}");
    }
}

/// Only a mesh that is drawn alone has edges. Other subjects refuse edges, and turn them off.
#[test]
fn a_mesh_alone_has_edges() {
    let mut board = emulator();
    let mut console = console(&mut board);
    for other in ["scene menger", "scene wireframe", "object add cube"] {
        for command in ["scene cube", "edges over"] {
            console.command(command).unwrap();
        }
        assert_eq!(console.command("edges").unwrap(), ["edges over"]);
        console.command(other).unwrap();
        assert_eq!(console.command("edges").unwrap(), ["edges off"], "{other}");
        let refused = console.command("edges hidden").unwrap_err().to_string();
        let expected = "not available for objects, fields and wireframes, expected `scene NAME`";
        assert!(refused.contains(expected), "{other}: {refused}");
        console.command("edges off").unwrap();
    }
}
