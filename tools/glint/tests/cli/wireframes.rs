//! `glint wireframe`.

use crate::common::{
    SQUARE, all_refused, files_refused, folder, glint_within, picture, report, succeed,
};

const PROGRAM: &str = "\
# a cross
eye 0 0 4
plane 2
window -2 -1.125 2 1.125
segment -1 0 1  1 0 1
segment 0 -1 1  0 1 1
end
";

#[test]
fn both_forms_of_a_program() {
    let folder = folder("wireframe_forms");
    std::fs::write(folder.join("a.wft"), PROGRAM).unwrap();
    succeed(&folder, "wireframe convert a.wft a.wfb");
    succeed(&folder, "wireframe convert a.wfb b.wft");
    succeed(&folder, "wireframe convert b.wft b.wfb");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    assert_eq!(read("a.wfb"), read("b.wfb"));
    assert_eq!(read("a.wfb").len(), 6 * 16);
    let text = String::from_utf8(read("b.wft")).unwrap();
    assert_eq!(
        text,
        "eye 0 0 4\nplane 2\nwindow -2 -1.125 2 1.125\nsegment -1 0 1 1 0 1\nsegment 0 -1 1 0 1 1\nend\n"
    );
    // Data after the end of the program are ignored.
    std::fs::write(folder.join("c.wft"), format!("{PROGRAM}no instruction\n")).unwrap();
    std::fs::write(folder.join("d.wfb"), [&read("a.wfb")[..], b"more"].concat()).unwrap();
    for (longer, to) in [("c.wft", "c.wfb"), ("d.wfb", "e.wfb")] {
        succeed(&folder, &format!("wireframe convert {longer} {to}"));
        assert_eq!(read(to), read("a.wfb"), "{longer}");
    }
    let shown = "eye        0 0 4\nplane      2\nwindow     -2 -1.125 2 1.125\nprogram    2 segments, 96 bytes in binary form\n";
    for name in ["a.wft", "a.wfb"] {
        assert_eq!(succeed(&folder, &format!("wireframe check {name}")), shown);
    }
    let json = report(&folder, "wireframe check a.wfb");
    assert_eq!(json["segments"], 2);
    assert_eq!([&json["window"][1], &json["plane"]], [-1.125, 2.0]);
}

#[test]
fn programs_of_meshes() {
    let folder = folder("wireframe_meshes");
    std::fs::write(folder.join("square.obj"), SQUARE).unwrap();
    for (model, segments) in [("cube", 12), ("square.obj", 4), ("icosphere:8", 1920)] {
        let text = succeed(&folder, &format!("wireframe make {model} --out a.wfb"));
        let dropped = "dropped    0 edges of length 0 after rounding to 2^-11";
        assert_eq!(text, format!("written    {segments} segments\n{dropped}\n"));
    }
    // The triangles of an STL do not share points. All 12 triangles of a cube count, so the 6
    // diagonals are edges, too.
    succeed(&folder, "model cube cube.stl");
    let json = report(&folder, "wireframe make cube.stl --out a.wft");
    assert_eq!(json["segments"], 18);
    let placed = "--keep-scale --eye=1,2,3 --plane=-1 --window=-1,-1,1,1 --out a.wft";
    succeed(&folder, &format!("wireframe make square.obj {placed}"));
    let text = std::fs::read_to_string(folder.join("a.wft")).unwrap();
    assert_eq!(
        text,
        "eye 1 2 3\nplane -1\nwindow -1 -1 1 1\nsegment 0 0 -1 0 0 0\nsegment 0 0 -1 1 0 -1\nsegment 0 0 0 1 0 0\nsegment 1 0 -1 1 0 0\nend\n"
    );
}

#[test]
fn refused_programs() {
    let folder = folder("wireframe_refused");
    let program = |from: &str, to: &str| PROGRAM.replace(from, to).into_bytes();
    files_refused(
        &folder,
        ["wireframe check FILE", "wireframe convert FILE out.wfb"],
        &[
            ("a.txt", vec![]),
            ("a.wft", program("end\n", "")),
            ("b.wft", program("eye 0 0 4", "eye 0 0 -4")),
            ("a.wfb", vec![0; 40]),
            ("b.wfb", vec![0xFF; 16]),
        ],
        "
        a.txt: expected a name that ends in .wft (text) or .wfb (binary), found '.txt'
        a.wft: line 7: expected end, found the end of the input
        b.wft: line 2: expected a z of the eye of at least 0, found -4
        a.wfb: word 2: expected one eye in the program, found a second one
        b.wfb: word 1: expected zeros in bits 127 to 99, found 0x1fffffff
        ",
    );
    all_refused(
        &folder,
        "
        wireframe make cube --out out.wfb --extent=32
            --extent: expected a side above 0 and below 32, found 32
        wireframe make cube --out out.wfb --plane=8
            cube: expected a z of the eye above that of the view plane, 8, found 8
        wireframe make cube --out out.wfb --eye=0,0
            --eye: expected a position X,Y,Z, each from -16 to 15.9995, found '0,0'
        wireframe make cube --out out.wfb --window=0,0,0,1
            cube: expected x of the window's lower corner below 0, found 0
        ",
    );
    assert!(!folder.join("out.wfb").exists());
}

/// `glint upload` takes both forms of a program, under the name of the file.
#[test]
fn uploads_of_programs() {
    let folder = folder("wireframe_uploads");
    std::fs::write(folder.join("a.wft"), format!("{PROGRAM}more\n")).unwrap();
    succeed(&folder, "wireframe convert a.wft a.wfb");
    for name in ["a.wft", "a.wfb"] {
        let upload = format!("upload {name} --board emulated --json");
        let output = glint_within(800, &folder, &upload, &[]);
        let [text, error] =
            [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        assert!(output.status.success(), "{error}");
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["bytes"], 6 * 16);
        let is_warned = error.contains("a.wft: 1 line after the end is ignored");
        assert_eq!(is_warned, name == "a.wft", "{error}");
    }
    std::fs::write(folder.join("b.wft"), PROGRAM.replace("end\n", "")).unwrap();
    all_refused(
        &folder,
        "
        upload b.wft
            b.wft: line 7: expected end, found the end of the input
        upload gone.wfb
            gone.wfb: expected a file to read, found…
        upload a.wft --keep-scale
            --keep-scale: expected a mesh, found a wireframe program
        upload a.wft --keep-scene
            --keep-scene: expected a mesh, found a wireframe program
        upload a.wft --palette 16
            --palette: expected a mesh or a texture, found a wireframe program
        ",
    );
}

#[test]
fn pictures_after_keys() {
    let folder = folder("wireframe_pictures");
    std::fs::write(folder.join("a.wft"), PROGRAM).unwrap();
    let render = |more: &str| {
        let render = format!("wireframe render a.wft --aa 1 --out a.png {more}");
        let text = succeed(&folder, &render);
        (text, picture(&folder.join("a.png")))
    };
    let (text, still) = render("--size 640x360");
    // At z = 1 the scale is 2/3 of the scale in the view plane, which is 160 pixels per unit.
    assert_eq!(text, "segments   2 in, 2 drawn as lines, 428 pixels\n");
    assert_eq!(still.len(), 3 * 640 * 360);
    let count = |colour: [u8; 3]| still.chunks(3).filter(|pixel| *pixel == colour).count();
    let (green, black) = (count([0, 255, 0]), count([0; 3]));
    assert_eq!((green, green + black), (427, 640 * 360));
    let (_, moved) = render("--press up:2,rotate,left,pan,down:2 --size 640x360");
    assert!(moved != still);
    let (_, back) =
        render("--press up:2,rotate,left,right,pan,down:2,zoom-in,zoom-out --size 640x360");
    assert!(back == still);
    let (text, small) = render("--press=up:300 --motion=accumulated --size=320x180");
    assert_eq!(small.len(), 3 * 320 * 180);
    let note =
        "note       61 steps were skipped, because coordinates would have left their range\n";
    assert!(text.ends_with(note), "{text}");
    let (json, _) = render("--json");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!([&json["segments"], &json["lines"]], [2, 2]);
    all_refused(
        &folder,
        "
        wireframe render a.wft --out b.png --press=up,jump
            --press: expected up, down, left, right, zoom-in, zoom-out (or KEY:COUNT), rotate or pan, found 'jump'
        wireframe render a.wft --out b.png --size=512x384
            --size: expected 320x180, 640x360 or 1280x720, found '512x384'
        ",
    );
    assert!(!folder.join("b.png").exists());
}
