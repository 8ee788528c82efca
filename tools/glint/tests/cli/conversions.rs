//! `glint model` and `glint convert`.

use crate::common::{
    SQUARE, all_refused, assert_has, drawn, folder, glint_within, refused, report, succeed,
};
use glint::formats::gltf::example::{TWO_MESHES, as_binary};

#[test]
fn conversions_by_every_way_agree() {
    let folder = folder("conversions");
    // The model has no face colours, because not every format can store them.
    succeed(&folder, "model icosphere:4 straight.glm");
    for extension in ["obj", "ply"] {
        let between = format!("between.{extension}");
        succeed(&folder, &format!("model icosphere:4 {between}"));
        succeed(&folder, &format!("convert {between} back.glm"));
        let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
        assert_eq!(read("straight.glm"), read("back.glm"), "{extension}");
    }
    // STL has neither shared points nor point colours: each face has its own colour, and therefore its own vertices.
    succeed(&folder, "convert straight.glm between.stl --keep-scale");
    let report = report(&folder, "convert between.stl back.glm --keep-scale");
    assert_eq!([&report["vertices"], &report["triangles"]], [960, 320]);
    assert_eq!(report["error_max"], 0.0);
}

#[test]
fn gltf_in_both_forms() {
    let folder = folder("gltf");
    let (binary, buffer) = as_binary(TWO_MESHES).unwrap();
    std::fs::write(folder.join("binary.glb"), binary).unwrap();
    let (start, rest) = TWO_MESHES.split_once("data:").unwrap();
    let (_, end) = rest.split_once('"').unwrap();
    let text = [start, "with%20space.bin\"", end].concat();
    std::fs::write(folder.join("text.gltf"), text).unwrap();
    std::fs::write(folder.join("with space.bin"), buffer).unwrap();
    for name in ["binary.glb", "text.gltf"] {
        let report = report(&folder, &format!("convert {name} out.glm"));
        assert_eq!([&report["points"], &report["triangles"]], [8, 4]);
        assert_eq!(report["remarks"][0], "points and lines are ignored");
        drawn(&folder, &format!("render {name}"));
    }
    std::fs::remove_file(folder.join("with space.bin")).unwrap();
    all_refused(
        &folder,
        "
        convert text.gltf out.glm
            text.gltf: expected the file of a buffer in the folder of the glTF, found 'with%20space.bin'
        convert binary.glb out.glb
            out.glb: expected a name that ends in .obj, .stl, .ply, .glm, found '.glb'
        ",
    );
}

#[test]
fn the_order_saves_fetches_and_keeps_the_picture() {
    let folder = folder("orders");
    succeed(&folder, "model scan:40 scan.ply");
    let fetches = |out: &str, more: &str| {
        let report = report(&folder, &format!("convert scan.ply {out} {more}"));
        assert_eq!(report["triangles"], 32_000);
        let a_vertex =
            |key: &str| report[key].as_f64().unwrap() / report["vertices"].as_f64().unwrap();
        (a_vertex("fetches_before"), a_vertex("fetches"))
    };
    let (before, after) = fetches("ordered.glm", "");
    assert!(before > 3.0 && after <= 1.15, "{before} {after}");
    assert_eq!(fetches("kept.glm", "--keep-order"), (before, before));
    let drawn = |mesh: &str| drawn(&folder, &format!("render {mesh}"));
    assert!(drawn("ordered.glm") == drawn("kept.glm"));
    assert!(drawn("ordered.glm") == drawn("scan.ply"));
}

#[test]
fn wrong_winding_is_repaired_in_every_format() {
    let folder = folder("winding");
    succeed(&folder, "model icosphere:4 whole.obj");
    let whole = std::fs::read_to_string(folder.join("whole.obj")).unwrap();
    let turn = |(number, line): (usize, &str)| match line.split(' ').collect::<Vec<_>>()[..] {
        ["f", a, b, c] if number % 3 == 0 => format!("f {a} {c} {b}\n"),
        _ => format!("{line}\n"),
    };
    let broken: String = whole.lines().enumerate().map(turn).collect();
    std::fs::write(folder.join("broken.obj"), broken).unwrap();
    for extension in ["glm", "obj", "ply", "stl"] {
        let [whole, repaired] =
            [("whole", ""), ("broken", "--fix-winding")].map(|(input, more)| {
                let out = format!("out.{extension}");
                let command = format!("convert {input}.obj {out} --keep-scale {more}");
                let text = succeed(&folder, &command);
                let is_repaired = text.contains("winding: 107 of 320 faces");
                assert_eq!(is_repaired, !more.is_empty(), "{text}");
                std::fs::read(folder.join(out)).unwrap()
            });
        assert!(whole == repaired, "{extension}");
    }
}

#[test]
fn a_material_file_beside_the_mesh() {
    let folder = folder("materials");
    let obj = format!("mtllib sub/a.mtl\nusemtl red\n{SQUARE}");
    std::fs::write(folder.join("a.obj"), obj).unwrap();
    let text = succeed(&folder, "convert a.obj a.glm");
    assert_has(
        &text,
        "note       no material file 'sub/a.mtl' beside the mesh",
    );
    std::fs::write(folder.join("a.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let text = succeed(&folder, "convert a.obj a.glm");
    assert!(!text.contains("note"), "{text}");
    std::fs::write(folder.join("a.mtl"), "newmtl red\nKd 1 x 0\n").unwrap();
    let error = refused(&folder, "convert a.obj b.glm");
    assert_eq!(
        error,
        "error: sub/a.mtl: line 2: expected a number, found 'x'"
    );
}

/// 260 concave polygons with 8,000 corners have nearly the maximum number of triangles of a mesh. Their conversion takes at most
/// 512 MiB.
#[test]
fn concave_polygons_of_8000_corners_load_in_bounded_memory() {
    let folder = folder("large-polygons");
    let (polygons, corners) = (260, 8000);
    let mut obj = String::new();
    for i in 0..corners {
        let radius = if i % 2 == 0 { 1.0 } else { 100.0 };
        let (sin, cos) = (f64::from(i) / f64::from(corners) * std::f64::consts::TAU).sin_cos();
        obj += &format!("v {:.6} {:.6} 0\n", radius * cos, radius * sin);
    }
    let face = (1..=corners).map(|corner| format!(" {corner}"));
    let face = format!("f{}\n", face.collect::<String>());
    obj += &face.repeat(polygons as usize);
    std::fs::write(folder.join("large.obj"), obj).unwrap();
    let convert = "convert large.obj a.glm --json";
    let output = glint_within(512, &folder, convert, &[]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let number = |key: &str| report[key].as_i64().unwrap();
    let expected = [corners, polygons].map(i64::from);
    assert_eq!([number("points"), number("faces")], expected);
    let triangles = number("triangles") + number("degenerate");
    assert_eq!(triangles, i64::from(polygons * (corners - 2)));
}
