//! `glint model` and `glint convert`.

use crate::common::{SQUARE, folder, refused, succeed};

#[test]
fn conversions_by_every_way_agree() {
    let folder = folder("conversions");
    // The model has no face colours, because not every format can store them.
    succeed(&folder, &["model", "icosphere:4", "straight.glm"]);
    for extension in ["obj", "ply"] {
        let between = format!("between.{extension}");
        succeed(&folder, &["model", "icosphere:4", &between]);
        succeed(&folder, &["convert", &between, "back.glm"]);
        let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
        assert_eq!(read("straight.glm"), read("back.glm"), "{extension}");
    }
    // STL has neither shared points nor point colours: each face has its own colour, and so its own vertices.
    succeed(
        &folder,
        &["convert", "straight.glm", "between.stl", "--keep-scale"],
    );
    let report = succeed(
        &folder,
        &[
            "convert",
            "between.stl",
            "back.glm",
            "--keep-scale",
            "--json",
        ],
    );
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(
        (&report["vertices"], &report["triangles"]),
        (&960.into(), &320.into())
    );
    assert_eq!(report["error_max"], 0.0);
}

#[test]
fn a_material_file_beside_the_mesh() {
    let folder = folder("materials");
    std::fs::write(
        folder.join("a.obj"),
        format!("mtllib sub/a.mtl\nusemtl red\n{SQUARE}"),
    )
    .unwrap();
    let text = succeed(&folder, &["convert", "a.obj", "a.glm"]);
    assert!(
        text.contains("note       no material file 'sub/a.mtl' beside the mesh"),
        "{text}"
    );
    std::fs::write(folder.join("a.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let text = succeed(&folder, &["convert", "a.obj", "a.glm"]);
    assert!(!text.contains("note"), "{text}");
    std::fs::write(folder.join("a.mtl"), "newmtl red\nKd 1 x 0\n").unwrap();
    let error = refused(&folder, &["convert", "a.obj", "b.glm"]);
    assert_eq!(
        error,
        "error: sub/a.mtl: line 2: expected a number within ±1e15, found 'x'"
    );
}
