//! `glint texture`, and textures of `glint convert`.

use crate::common::{
    SQUARE, all_refused, assert_has, drawn, files_refused, folder, glint, report, said, succeed,
};
use glint_texture::example::{repair_png, small_png};
use glint_texture::picture::Picture;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

/// A square with a material that has a texture.
const TEXTURED: &str = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

fn mtl(picture: &str) -> String {
    format!("newmtl a\nKd 1 0 0\nmap_Kd {picture}\n")
}

#[test]
fn a_picture_becomes_a_texture_and_a_picture_of_its_levels() {
    let folder = folder("texture");
    fs::write(folder.join("a.png"), small_png()).unwrap();
    let text = succeed(&folder, "texture a.png a.glt");
    assert_eq!(
        text,
        "8×8, rgb565, cut-out, 4 levels, 256 bytes, error 1.68 RMS and 4.0 at most (of 255)\n"
    );
    let report = report(&folder, "texture a.png b.png --palette 16 --texture-size 8");
    assert_eq!(report["format"], "palette 16");
    assert_eq!([&report["levels"], &report["bytes"]], [4, 192]);
    let sheet = Picture::decode(&fs::read(folder.join("b.png")).unwrap()).unwrap();
    assert_eq!(sheet.size, [15, 8]);
    assert_eq!(sheet.texels[0][3], 0);
    // Converting a texture keeps it, and options change only its wrap modes and filter.
    succeed(&folder, "texture a.glt b.glt");
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(read("a.glt") == read("b.glt"));
    let options = "--wrap clamp,mirror --filter nearest";
    succeed(&folder, &format!("texture a.glt b.glt {options}"));
    assert_eq!(read("b.glt")[16..19], [2, 1, 0]);
    let piped = glint(&folder, "texture a.png - --to glt");
    assert!(piped.status.success() && piped.stdout == read("a.glt"));
    let text = succeed(&folder, "texture a.png c.glt --cutoff 0");
    assert!(!text.contains("cut-out"), "{text}");
}

#[test]
fn bad_pictures_and_options() {
    let folder = folder("bad-pictures");
    let png = small_png();
    let with_size = |size: u32| {
        let mut file = png.clone();
        file[16..20].copy_from_slice(&size.to_be_bytes());
        file[20..24].copy_from_slice(&size.to_be_bytes());
        repair_png(&mut file);
        file
    };
    let damaged = "expected a PNG file without damage, found…";
    files_refused(
        &folder,
        [
            "texture FILE out.glt",
            "texture FILE out.png",
            "upload FILE",
            "render cube --texture FILE --out out.png",
        ],
        &[
            ("empty.png", vec![]),
            ("text.jpg", b"a text".to_vec()),
            ("cut.png", png[..60].to_vec()),
            ("none.png", with_size(0)),
            ("bomb.png", with_size(0x7fff_ffff)),
            ("magic.glt", b"GLT1".to_vec()),
            ("zeros.glt", [&b"GLT1"[..], &[0; 60]].concat()),
        ],
        &format!(
            "
            empty.png: expected a PNG or JPEG file, found an empty file
            text.jpg: expected a PNG or JPEG file, found 'a text'
            cut.png: {damaged}
            none.png: {damaged}
            bomb.png: expected a picture of at most 8192×8192, found a larger one
            magic.glt: expected a valid texture, found texture byte 0: expected 32 bytes, found 4
            zeros.glt: expected a valid texture, found texture byte 12: expected 3 to 10, the logarithm of a side, found 0
            "
        ),
    );
    fs::write(folder.join("a.png"), &png).unwrap();
    succeed(&folder, "texture a.png a.glt");
    let mut wrong = fs::read(folder.join("a.glt")).unwrap();
    wrong[40] ^= 1;
    fs::write(folder.join("wrong.glt"), &wrong).unwrap();
    all_refused(
        &folder,
        "
        texture a.png out.glt --cutoff 1.5
            --cutoff: expected an opacity of 0 to 1, found 1.5
        texture a.png out.glt --cutoff nan
            --cutoff: expected an opacity of 0 to 1, found NaN
        texture a.png out.glt --wrap clamp,clamp,clamp
            --wrap: expected one or two modes, found 3
        texture a.png out.jpg
            out.jpg: expected a name that ends in .glt, .png, found '.jpg'
        texture a.png -
            -: expected --to with a format, found none
        texture gone.png out.glt
            gone.png: expected a file to read, found…
        texture wrong.glt out.glt
            wrong.glt: expected the CRC-32…
        upload wrong.glt
            wrong.glt: expected the CRC-32…
        upload a.png --keep-scale
            --keep-scale: expected a mesh, found a texture
        upload a.png --no-textures
            --no-textures: expected a mesh, found a texture
        upload a.png --keep-scene
            --keep-scene: expected a mesh, found a texture
        ",
    );
    assert!(!folder.join("out.glt").exists());
}

#[test]
fn textures_of_a_mesh() {
    let folder = folder("textures");
    fs::create_dir(folder.join("sub")).unwrap();
    fs::write(folder.join("a.obj"), TEXTURED).unwrap();
    fs::write(folder.join("a.mtl"), mtl("sub/a b.png")).unwrap();
    fs::write(folder.join("sub/a b.png"), small_png()).unwrap();
    let text = succeed(&folder, "convert a.obj a.glm");
    let line = "texture    'sub/a b.png': 8×8, rgb565, cut-out, 4 levels, 256 bytes, error";
    assert_has(&text, line);
    // A mesh in a board's memory layout keeps its texture.
    let report = report(&folder, "convert a.glm b.glm --keep-scale --keep-order");
    assert_eq!(report["textures"][0]["size"], serde_json::json!([8, 8]));
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(read("a.glm") == read("b.glm"));
    let options = "--palette 256 --filter nearest";
    let text = succeed(&folder, &format!("convert a.glm b.glm {options}"));
    assert_has(&text, "texture    1: 8×8, palette 256, cut-out");
    // Without the texture the mesh equals a mesh in the material's colour.
    succeed(&folder, "convert a.obj plain.glm --no-textures");
    fs::write(folder.join("a.mtl"), "newmtl a\nKd 1 0 0\n").unwrap();
    succeed(&folder, "convert a.obj b.glm");
    assert!(read("plain.glm") == read("b.glm"));
    for out in ["b.obj", "b.stl", "b.ply"] {
        let text = succeed(&folder, &format!("convert a.glm {out}"));
        assert_has(
            &text,
            "note: textures are left out: only .glm files have them",
        );
    }
    fs::write(folder.join("a.obj"), SQUARE).unwrap();
    let text = succeed(&folder, "convert a.obj b.stl");
    assert!(!text.contains("textures"), "{text}");
}

/// All commands that take a model have the texture options of `glint convert`, and print the same
/// line.
#[test]
fn textures_where_a_model_is_taken() {
    let folder = folder("textures-taken");
    fs::write(folder.join("a.obj"), TEXTURED).unwrap();
    fs::write(folder.join("a.mtl"), mtl("a.png")).unwrap();
    let picture = Picture::drawn([64, 32], |x, y| [4 * x as u8, 8 * y as u8, 99, 255]);
    fs::write(folder.join("a.png"), picture.png().unwrap()).unwrap();
    let options = "--palette 16 --texture-size 16 --filter nearest";
    let line_of = |text: &str| {
        let line = text.lines().find(|line| line.starts_with("texture "));
        line.map(str::to_owned)
    };
    let text = succeed(&folder, &format!("convert a.obj a.glm {options}"));
    let line = line_of(&text).unwrap();
    assert_has(&line, "'a.png': 16×16, palette 16, 5 levels");
    for command in [
        "render a.obj --out p.png --force",
        "render cube --object a.obj --out p.png --force",
        "orbit a.obj --frames 2 --out a.gif --force",
        "upload a.obj --board emulated",
    ] {
        let run = |options: &str| said(&folder, &format!("{command} {options}"))[0].clone();
        assert_eq!(line_of(&run(options)).as_ref(), Some(&line), "{command}");
        let json = run(&format!("{options} --json"));
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["textures"][0]["colours"], 16, "{command}");
        assert_eq!(line_of(&run("--no-textures")), None, "{command}");
    }
    // The picture equals the picture of the converted mesh. A mesh in a board's memory layout keeps its
    // texture unless an option is given.
    let picture = |arguments: &str| {
        let command = format!("render {arguments} --up y --out p.png");
        succeed(&folder, &command);
        fs::read(folder.join("p.png")).unwrap()
    };
    let small = picture("a.glm");
    assert!(small == picture(&format!("a.obj {options}")));
    let full = picture("a.obj");
    succeed(&folder, "convert a.obj full.glm");
    assert!(small != full && full == picture("full.glm"));
    let again = format!("convert full.glm again.glm --keep-scale --keep-order {options}");
    succeed(&folder, &again);
    let again = picture("again.glm");
    assert!(again != full && again == picture(&format!("full.glm {options}")));
    let plain = picture("a.obj --no-textures");
    assert!(plain != full && plain == picture("full.glm --no-textures"));
    all_refused(
        &folder,
        "
        render a.obj --out q.png --no-textures --palette 16
            --palette: expected textures, found --no-textures
        render --field menger:2 --out q.png --texture-size 16
            --texture-size: expected a model, found none
        orbit --scene menger --out q.gif --filter nearest
            --filter: expected a model, found --scene
        ",
    );
}

/// `--texture`, and the key of a scene file, draw what a material with this texture draws.
#[test]
fn a_texture_in_place_of_those_of_a_mesh() {
    let folder = folder("textures-replaced");
    // The material is red.
    let picture = |name: &str, red: u8| {
        let picture = Picture::drawn([32, 64], |x, y| [red + (x * y / 16) as u8, 0, 0, 255]);
        fs::write(folder.join(name), picture.png().unwrap()).unwrap();
    };
    picture("a.png", 0);
    picture("b.png", 99);
    fs::write(folder.join("a.obj"), TEXTURED).unwrap();
    let draw = |material: &str, arguments: &str| {
        fs::write(folder.join("a.mtl"), mtl(material)).unwrap();
        drawn(&folder, &format!("render {arguments}"))
    };
    let own = draw("a.png", "a.obj --up y");
    let other = draw("b.png", "a.obj --up y");
    assert!(own != other);
    for board in ["", "--board emulated"] {
        let replaced = format!("a.obj --up y --texture b.png {board}");
        assert!(draw("a.png", &replaced) == other, "{board}");
    }
    succeed(&folder, "texture b.png b.glt");
    assert!(draw("a.png", "a.obj --up y --texture b.glt") == other);
    let scene = "title = \"A square\"\nmodel = \"a.obj\"\ntextures = true\nsize = \"640 360\"\n";
    let own = draw("b.png", &scene_of(&folder, scene));
    let scene = format!("{scene}texture = \"b.png\"\n");
    for board in ["", " --board emulated"] {
        let replaced = scene_of(&folder, &scene) + board;
        assert!(draw("a.png", &replaced) == own, "{board}");
    }
    let [text, _] = said(
        &folder,
        "render a.obj --texture b.png --palette 16 --out p.png",
    );
    assert_has(&text, "texture    'b.png': 32×64, palette 16");
    let [_, warning] = said(&folder, "render cube --texture b.png --out q.png");
    assert_has(&warning, "no face has a texture");
    fs::write(
        folder.join("off.toml"),
        scene.replace("textures = true", "textures = false"),
    )
    .unwrap();
    let [_, warning] = said(&folder, "render --scene off.toml --out s.png");
    assert_has(&warning, "textures are off");
    all_refused(
        &folder,
        "
        render --field menger:2 --texture b.png --out r.png
            --texture: expected a model, found none
        render a.obj --up y --texture b.png --out b.png --force
            b.png: expected another file to write, found the input b.png
        ",
    );
}

/// Writes a scene file, and returns the argument for it.
fn scene_of(folder: &Path, text: &str) -> String {
    fs::write(folder.join("a.toml"), text).unwrap();
    "--scene a.toml".to_owned()
}

#[test]
fn pictures_that_cannot_be_used_are_named() {
    let folder = folder("unusable-pictures");
    let outside = folder.join("outside.png");
    fs::write(&outside, small_png()).unwrap();
    let folder = folder.join("model");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("a.obj"), TEXTURED).unwrap();
    fs::write(folder.join("damaged.png"), &small_png()[..50]).unwrap();
    symlink(&outside, folder.join("link.png")).unwrap();
    symlink("/dev/zero", folder.join("device.png")).unwrap();
    fs::create_dir(folder.join("folder.png")).unwrap();
    for name in [
        "gone.png",
        "../outside.png",
        outside.to_str().unwrap(),
        "link.png",
        "device.png",
        "folder.png",
        "/dev/zero",
    ] {
        fs::write(folder.join("a.mtl"), mtl(name)).unwrap();
        let text = succeed(&folder, "convert a.obj a.glm");
        assert_has(&text, "note       no image file '");
        assert_has(&text, "beside the mesh: its faces keep their own colours");
        assert!(!text.contains("texture  "), "{name}: {text}");
    }
    fs::write(folder.join("a.mtl"), mtl("damaged.png")).unwrap();
    let text = succeed(&folder, "convert a.obj a.glm");
    let note = "note       texture 'damaged.png': expected a PNG file without damage, found";
    assert_has(&text, note);
}
