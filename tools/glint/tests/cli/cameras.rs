//! The camera that shows the whole model, and the lens options.

use crate::common::{assert_has, drawn, failed, folder, picture, refused, said};

/// The first and the last drawn row and column of a picture with a black background.
fn extent(pixels: &[u8]) -> [[usize; 2]; 2] {
    let is_drawn = |i: &usize| pixels[3 * i..3 * i + 3] != [0; 3];
    let drawn: Vec<_> = (0..320 * 180).filter(is_drawn).collect();
    let range = |of: fn(usize) -> usize| {
        let values = drawn.iter().map(|&i| of(i));
        [values.clone().min().unwrap(), values.max().unwrap()]
    };
    [range(|i| i / 320), range(|i| i % 320)]
}

#[test]
fn the_whole_model_fills_the_picture() {
    let folder = folder("framing");
    // The camera fits a sphere exactly, so the picture does not depend on the sphere's position and
    // size.
    let picture = |subject: &str| {
        let options = "--size 320x180 --aa 1 --background 000000";
        drawn(&folder, &format!("render {subject} {options}"))
    };
    for model in [
        "icosphere:20",
        "--object 'icosphere:20 scale 0.3 move 1,-1,0.5'",
        "--object 'icosphere:20 scale 2'",
        "icosphere:20 --fov 20",
        "icosphere:20 --fov 100",
    ] {
        let [[top, bottom], [left, right]] = extent(&picture(model));
        // A given field of view determines the distance of the camera from a sphere around the model, which fills 80 % of the height.
        let filled = if model.contains("--fov") { 144 } else { 162 };
        for (low, high, all) in [(top, bottom, 180), (left, right, 320)] {
            let is_fitted = (high + 1 - low).abs_diff(filled) <= 2;
            let is_centred = (low + high + 1).abs_diff(all) <= 2;
            assert!(is_fitted && is_centred, "{model:?} {low} {high}");
        }
    }
    // The picture shows every model completely.
    for model in ["cube", "gear", "teapot", "torus-knot", "sponge:2"] {
        let [[top, bottom], [left, right]] = extent(&picture(model));
        let is_inside = top > 7 && bottom < 172 && left > 14 && right < 305;
        let is_filled = top < 11 || bottom > 168 || left < 18 || right > 301;
        assert!(is_inside && is_filled, "{model}");
    }
    let [[top, bottom], _] = extent(&picture("icosphere:20 --zoom 0.5"));
    assert!((bottom + 1 - top).abs_diff(81) <= 2);
    let error = refused(&folder, "render icosphere:20 --out b.png --zoom 0");
    assert_has(&error, "error: --zoom: expected a factor");
}

#[test]
fn the_axis_that_is_up() {
    let folder = folder("up");
    // One column along y, and one along z.
    let column = |to: [usize; 3]| {
        let line = |[x, y, z]: [f64; 3]| {
            let v = [x, y, z];
            format!("v {} {} {}\n", v[to[0]], v[to[1]], v[to[2]])
        };
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 4.0]];
        let faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
        points.map(line).concat() + faces
    };
    std::fs::write(folder.join("z.obj"), column([0, 1, 2])).unwrap();
    std::fs::write(folder.join("y.obj"), column([1, 2, 0])).unwrap();
    let drawn = |arguments: &str| {
        let [_, note] = said(&folder, &format!("render --force --out a.png {arguments}"));
        (picture(&folder.join("a.png")), note)
    };
    let (upright, note) = drawn("z.obj --up z");
    assert_eq!(note, "");
    let guessed = "note: y is up, as usual in .obj; --up z changes it\n";
    assert!(drawn("y.obj") == (upright.clone(), guessed.to_owned()));
    assert!(drawn("y.obj --up y") == (upright.clone(), String::new()));
    assert!(drawn("y.obj --up z").0 != upright);
    let orthographic = "--field box:1,1,1 --orthographic 2 --out b.png";
    for command in ["render", "orbit"] {
        let error = failed(&folder, &format!("{command} {orthographic}"), 2);
        assert_has(&error, "cannot be used with");
    }
    assert!(!folder.join("b.png").exists());
}
