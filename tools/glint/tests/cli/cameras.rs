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

/// The sides of a volume, its matrix, and field of view, near and far plane give the same picture; each number of the volume has an effect.
#[test]
fn projections() {
    let folder = folder("projections");
    let picture = |options: &str| {
        let command =
            "render icosphere:8 --size 320x180 --aa 1 --background 000000 --camera 2,0,90";
        drawn(&folder, &format!("{command} {options}"))
    };
    let sides = "--projection perspective,-0.25,0.25,-0.140625,0.140625,0.25";
    let whole = picture("--fov 90 --near 0.25");
    assert_eq!(picture(sides), whole);
    let matrix = "--projection matrix,1,0,0,0,0,1.7777777778,0,0,0,0,-1,-0.5,0,0,-1,0";
    assert_eq!(picture(matrix), whole);
    let cut = picture("--fov 90 --near 0.25 --far 1.75");
    assert_eq!(picture(&format!("{sides},1.75")), cut);
    // The outline of the sphere is at the depth 1.875.
    let [high, cut_high] = [whole.as_slice(), &cut].map(|picture| {
        let [[top, bottom], _] = extent(picture);
        bottom + 1 - top
    });
    assert!(
        cut_high < high && cut_high > high / 2,
        "{cut_high} of {high}"
    );
    assert_ne!(picture("--fov 90 --near 1.75"), whole);

    // Equal fields of view in both directions give pixels with an aspect ratio of 16:9. The sides of the volume determine the middle of the
    // picture.
    let [[top, bottom], [left, right]] = extent(&picture("--fov 90,90"));
    let (high, wide) = (bottom + 1 - top, right + 1 - left);
    assert!((16 * high).abs_diff(9 * wide) <= 16, "{wide} x {high}");
    let aside = "--projection orthographic,-0.5,1.5,-1.25,0.75,0.25";
    let [[top, bottom], [left, right]] = extent(&picture(aside));
    // A unit has 160 pixels horizontally and 90 vertically. The centre of the sphere, of radius 1/2, is 0.5 units from the left side and
    // 0.75 units from the upper side.
    assert!(left <= 1 && right.abs_diff(159) <= 1, "{left} to {right}");
    assert!(
        top.abs_diff(22) <= 1 && bottom.abs_diff(112) <= 1,
        "{top} to {bottom}"
    );

    for (options, expected) in [
        (
            "--near 3",
            "error: --near: expected a distance of 0.01 to 2, found near 3: expected 0.01 to 2",
        ),
        (
            "--projection perspective,1,-1,0,1,0.1",
            "left 1, right -1: expected left below right",
        ),
        (
            "--projection matrix,1,2,3",
            "error: --projection: expected perspective or orthographic,LEFT",
        ),
        (
            "--scene holoforge --projection perspective,-1,1,-1,1,0.5,9",
            "expected no far plane with --scene",
        ),
        (
            "--field box:1,1,1 --projection orthographic,-1,1,-1,1,0.5",
            "expected perspective",
        ),
        (
            "--field box:1,1,1 --projection perspective,0,5,-1,1,1",
            "within 4 of the camera's axis",
        ),
    ] {
        let subject = if options.contains("--scene") {
            ""
        } else {
            "cube"
        };
        let command = format!("render {subject} {options} --out refused.png");
        let error = failed(&folder, &command, 2);
        assert_has(&error, expected);
    }
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
