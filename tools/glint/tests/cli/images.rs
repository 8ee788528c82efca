//! Makes, lists, checks and writes images for SPI flash.

use crate::common::{assert_has, folder, glint, refused, report, succeed};
use glint_core::flash::{CONTENTS, FIRMWARE, Image, Kind, Piece, encode};
use glint_core::texture::{self, Source};
use glint_core::wireframe::CUBE;
use glint_texture::example::small_png;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

/// Makes `board.bin` from a firmware and scenes.
fn make(folder: &Path, scenes: &str) -> String {
    fs::write(folder.join("firmware.bin"), [0x13; 400]).unwrap();
    let pieces = format!("--firmware firmware.bin --scene {scenes}");
    succeed(folder, &format!("image make {pieces} --out board.bin"))
}

#[test]
fn an_image_has_scenes_in_order_and_their_meshes() {
    let folder = folder("image");
    let gears =
        "title = \"A gear\"\nmodel = \"gear\"\ntexture = \"a.png\"\ncamera = \"2.5 40 65\"\n";
    fs::write(folder.join("a.png"), small_png()).unwrap();
    fs::write(folder.join("gears.toml"), gears).unwrap();
    succeed(&folder, "wireframe make cube --out net.wft");
    for name in ["net", "again"] {
        let net = "title = \"A net\"\nprogram = \"net.wft\"\n";
        fs::write(folder.join(format!("{name}.toml")), net).unwrap();
    }
    let scenes = "menger,gears.toml,net.toml,again.toml,demo";
    assert!(make(&folder, scenes).starts_with("board.bin: "));
    let valid = succeed(&folder, "image check board.bin");
    assert_eq!(valid, "board.bin: valid\n");
    let bytes = fs::read(folder.join("board.bin")).unwrap();
    let image = Image::new_checked(&bytes).unwrap();
    assert_eq!((image.bitstream, image.firmware), (None, &[0x13; 400][..]));
    let text = |kind, name| image.contents.find(kind, name).unwrap().text().unwrap();
    assert_eq!(
        text(Kind::List, "start"),
        "menger\ngears\nnet\nagain\nholoforge\nwireframe\nsimplegpu\npoor-mans-vr\nobjects\ncubes\n"
    );
    assert_eq!(
        text(Kind::Scene, "menger"),
        "quality balanced\ncamera 4 30 60\nfield menger:4\n"
    );
    let kinds: Vec<Kind> = image.contents.items().map(|item| item.kind).collect();
    for kind in [Kind::Mesh, Kind::Texture, Kind::Program] {
        assert_eq!(kinds.iter().filter(|known| **known == kind).count(), 1);
    }
    let list = succeed(&folder, "image list board.bin");
    assert!(list.starts_with("firmware "), "{list}");
    assert_has(&list, "mesh      gear  ");
    assert_has(&list, "texture   a.png  ");
    assert_has(&list, "program   net.wft  ");
    let checked = report(&folder, "image check board.bin");
    assert_eq!(checked, serde_json::json!(["board.bin"]));
    let parts = report(&folder, "image list board.bin");
    assert_eq!(parts[0]["offset"], FIRMWARE);
    assert_eq!(parts[1]["kind"], "mesh");
}

#[test]
fn two_different_files_of_one_name_are_refused() {
    let folder = folder("image-names");
    for (name, model) in [("a", "cube"), ("b", "gear")] {
        let folder = folder.join(name);
        fs::create_dir_all(&folder).unwrap();
        let scene = "title = \"A net\"\nprogram = \"net.wft\"\n";
        fs::write(folder.join(format!("{name}.toml")), scene).unwrap();
        succeed(&folder, &format!("wireframe make {model} --out net.wft"));
    }
    fs::write(folder.join("firmware.bin"), [0x13; 400]).unwrap();
    let make = "image make --firmware firmware.bin --scene a/a.toml,b/b.toml --out names.bin";
    let error = refused(&folder, make);
    assert_has(
        &error,
        "expected one file of each name; rename one of the files",
    );
    assert_has(&error, "two different files 'net.wft'");
    assert!(!folder.join("names.bin").exists());
    fs::copy(folder.join("a/net.wft"), folder.join("b/net.wft")).unwrap();
    succeed(&folder, make);
}

#[test]
fn the_header_of_a_bit_file_is_left_out() {
    let folder = folder("image-bitstream");
    let data = [[0xff; 32].as_slice(), &[0xaa, 0x99, 0x55, 0x66], &[5; 20]].concat();
    let mut file = vec![
        0, 9, 0x0f, 0xf0, 0x0f, 0xf0, 0x0f, 0xf0, 0x0f, 0xf0, 0, 0, 1,
    ];
    for (key, text) in (b'a'..).zip(["glint", "7s50", "date", "time"]) {
        file.extend([key, 0, text.len() as u8]);
        file.extend(text.as_bytes());
    }
    file.extend([b'e', 0, 0, 0, data.len() as u8]);
    file.extend(&data);
    fs::write(folder.join("top.bit"), &file).unwrap();
    fs::write(folder.join("top.bin"), &data).unwrap();
    fs::write(folder.join("cut.bit"), &file[..file.len() - 1]).unwrap();
    fs::write(folder.join("firmware.bin"), [0x13; 400]).unwrap();
    let make = |bitstream: &str| {
        let pieces = format!("--firmware firmware.bin --bitstream {bitstream}");
        format!("image make {pieces} --out board.bin")
    };
    for bitstream in ["top.bit", "top.bin"] {
        succeed(&folder, &make(bitstream));
        let bytes = fs::read(folder.join("board.bin")).unwrap();
        assert!(bytes.starts_with(&data), "{bitstream}");
        let found = Image::new_checked(&bytes).unwrap().bitstream;
        assert_eq!(found, Some(&data[..]));
    }
    let error = refused(&folder, &(make("cut.bit") + " --force"));
    assert_has(
        &error,
        "cut.bit: byte 42: expected the field e with all bytes",
    );
    fs::write(folder.join("text.bin"), "no bitstream").unwrap();
    let error = refused(&folder, &(make("text.bin") + " --force"));
    assert_has(&error, "expected an erased slot, or a bitstream");
}

#[test]
fn damaged_images_are_refused_with_the_place() {
    let folder = folder("image-damaged");
    make(&folder, "cubes");
    let good = fs::read(folder.join("board.bin")).unwrap();
    let check = |bytes: &[u8], expected: &str| {
        fs::write(folder.join("bad.bin"), bytes).unwrap();
        assert_has(&refused(&folder, "image check bad.bin"), expected);
    };
    let short = "bad.bin: byte 4194308: expected at most 100 bytes of contents (to the end of the image), found";
    check(&good[..CONTENTS + 100], short);
    let mut damaged = good.clone();
    damaged[FIRMWARE + 20] ^= 1;
    check(&damaged, "byte 3145732: expected the CRC-32 0x");
    let mut damaged = good;
    *damaged.last_mut().unwrap() ^= 1;
    check(&damaged, "expected the CRC-32 0x");
    assert!(refused(&folder, "image list bad.bin").contains("expected the CRC-32"));
    // A damaged image is not written, with or without openFPGALoader.
    assert!(refused(&folder, "flash --spi bad.bin").contains("expected the CRC-32"));
}

/// Images with correct checksums are refused if no board can show their scenes.
#[test]
fn what_boards_cannot_show_is_refused() {
    let folder = folder("image-scenes");
    let scene = |name: &str, text: String| Piece {
        kind: Kind::Scene,
        name: name.to_owned(),
        bytes: text.into_bytes(),
    };
    let objects = |count: usize| "object add cube\n".repeat(count);
    let check = |pieces: &[Piece]| {
        let image = encode(&[], &[0x13; 400], pieces).unwrap();
        fs::write(folder.join("scenes.bin"), image).unwrap();
        glint(&folder, "image check scenes.bin")
    };
    let fine = [
        scene("objects", objects(16)),
        scene("fit", "object add torus\nobject add cube\nfit\n".into()),
        scene("alone", "scene torus\nfit\n".into()),
        scene("long", "fov 60\n".repeat(1_000)),
    ];
    let checked = check(&fine);
    let said = String::from_utf8(checked.stderr).unwrap();
    assert!(checked.status.success(), "{said}");
    let moved = "object add cube move 20,0,0\nobject move 1 20,0,0\n".to_owned();
    let edges = "field menger:4\nedges over\n".to_owned();
    let executed = "a command that boards execute";
    let cases = [
        (
            "many",
            objects(40),
            format!("line 17: {executed} (object: expected at most 16 objects"),
        ),
        (
            "long",
            "fov 60\n".repeat(50_000),
            "at most 1000 commands, found 50000".into(),
        ),
        (
            "none",
            "object show\n".into(),
            format!("line 1: {executed} (object: no objects"),
        ),
        (
            "far",
            moved,
            format!("line 2: {executed} (object 1: matrix row 1: translation 40"),
        ),
        (
            "edges",
            edges,
            format!("line 2: {executed} (edges: not available"),
        ),
    ];
    let is_refused = |pieces: &[Piece], expected: &str| {
        let checked = check(pieces);
        assert!(!checked.status.success());
        assert_has(&String::from_utf8(checked.stderr).unwrap(), expected);
    };
    for (name, text, expected) in cases {
        is_refused(
            &[scene(name, text)],
            &format!("expected scene {name}: {expected}"),
        );
    }
    let same = vec![scene("same", "fov 60\n".into()); 63];
    let expected = "expected scene same: names that differ, found two items of this kind and name";
    is_refused(&same, expected);
    let item = |kind, bytes| Piece {
        kind,
        name: "same".to_owned(),
        bytes,
    };
    let texture = texture::encode(&Source {
        size_log2: [3, 3],
        levels: vec![vec![0; 64]],
        ..Source::default()
    });
    let upload = [
        item(Kind::Texture, texture.unwrap()),
        item(Kind::Mesh, Vec::new()),
    ];
    let expected = "expected mesh same: names that differ, found two meshes, textures or programs of this name";
    is_refused(&upload, expected);
    let endless = CUBE[..3].as_flattened();
    let expected = "expected program same: word 4: end, found the end of the input";
    is_refused(&[item(Kind::Program, endless.to_vec())], expected);
    let missing = scene("a", "program same\n".to_owned());
    let expected =
        "expected scene a: line 1: a command that boards execute (program `same`: expected cube or";
    is_refused(&[missing], expected);
}

/// Runs `glint flash --spi board.bin` with `folder` as the program search path.
fn flash(folder: &Path) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["flash", "--spi", "board.bin"])
        .current_dir(folder)
        .env("PATH", folder)
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8(text).unwrap())
}

/// Without openFPGALoader, the error states how to install it. The test replaces openFPGALoader,
/// which requires a board, by a script that records its arguments.
#[test]
fn an_image_without_a_bitstream_is_written_behind_its_slot() {
    let folder = folder("image-flash");
    make(&folder, "cubes");
    let (success, said) = flash(&folder);
    assert!(!success);
    assert_eq!(
        said,
        "error: openFPGALoader: expected the program in PATH, found none; `apt-get install openfpgaloader` installs it\n"
    );
    let loader = folder.join("openFPGALoader");
    fs::write(
        &loader,
        "#!/bin/sh\nPATH=/bin:/usr/bin\necho \"$@\" > arguments\nfor file; do :; done\ncp \"$file\" written\n",
    )
    .unwrap();
    fs::set_permissions(&loader, fs::Permissions::from_mode(0o755)).unwrap();
    let (success, said) = flash(&folder);
    assert!(success, "{said}");
    let arguments = fs::read_to_string(folder.join("arguments")).unwrap();
    assert!(
        arguments.starts_with("--board arty_s7_50 --write-flash --offset 3145728 /")
            && arguments.ends_with(".bin\n"),
        "{arguments}"
    );
    let image = fs::read(folder.join("board.bin")).unwrap();
    assert_eq!(fs::read(folder.join("written")).unwrap(), image[FIRMWARE..]);
    fs::write(&loader, "#!/bin/sh\nexit 3\n").unwrap();
    let (success, said) = flash(&folder);
    assert!(!success && said.contains("found exit status: 3"), "{said}");
}

#[test]
fn the_firmware_must_be_one_that_the_bios_boots() {
    let folder = folder("image-firmware");
    fs::write(folder.join("short.bin"), [0x13; 31]).unwrap();
    fs::write(folder.join("long.bin"), vec![0x13; 1 << 20]).unwrap();
    let make = |firmware: &str| {
        let command = format!("image make --firmware {firmware} --out board.bin");
        refused(&folder, &command)
    };
    assert!(make("short.bin").contains("expected at least 32 bytes of firmware, found 31"));
    assert!(make("long.bin").contains("expected at most 1048568 bytes of firmware, found 1048576"));
    let checked = glint(&folder, "image check board.bin");
    assert!(!checked.status.success());
}
