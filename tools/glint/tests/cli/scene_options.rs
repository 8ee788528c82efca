//! Scenes with options, and scenes that cannot be drawn.

use crate::common::{
    assert_has, drawn, failed, files_refused, folder, glint_within, picture, refused, rows, said,
    succeed,
};

const LAMP: &str =
    "title = \"Lamp\"\nfield = \"union:box:2,2,0.1+sphere:0.6\"\ncamera = \"4 30 70\"\n";

/// A scene that no board can draw is bad input for every command; the error names the scene and the reason.
#[test]
fn scenes_that_cannot_be_shown() {
    let folder = folder("scenes-refused");
    let near = LAMP.replace("4 30 70", "1 30 70");
    let missing = "title = \"A\"\nmodel = \"missing.obj\"\ncamera = \"3 30 60\"\n";
    let commands = [
        "render --scene FILE --out a.png",
        "orbit --scene FILE --out a.png",
        "scene check FILE",
    ];
    files_refused(
        &folder,
        commands,
        &[("missing.toml", missing.into())],
        "missing.obj: expected a file to read, found No such file or directory (os error 2)",
    );
    std::fs::write(folder.join("near.toml"), near).unwrap();
    for command in commands {
        let error = failed(&folder, &command.replace("FILE", "near.toml"), 2);
        let expected = "error: near.toml: line 3: camera = `1 30 70`: radius 1: expected 2 to 5\n";
        assert_eq!(error, expected, "{command}");
    }
    assert!(!folder.join("a.png").exists());
}

/// The picture of a scene file without a camera equals the picture of `glint render` with the same
/// options: the mesh comes from the folder of the scene file, and up axis, lens and material apply.
#[test]
fn scenes_of_meshes_are_those_of_render() {
    let folder = folder("scene-of-meshes");
    let inner = folder.join("inner");
    std::fs::create_dir(&inner).unwrap();
    succeed(&folder, "model gear inner/a.obj");
    succeed(&folder, "model gear inner/a.stl");
    let table = r#"
        model = "a.obj" → inner/a.obj
        model = "a.stl"; up = "x"; shading = "smooth" → inner/a.stl --up x --shading smooth
        model = "a.obj"; fov = 40; zoom = 1.5 → inner/a.obj --fov 40 --zoom 1.5
        model = "a.obj"; fov = "40 30"; near = 0.5 → inner/a.obj --fov 40,30 --near 0.5
        model = "a.stl"; camera = "3 20 60"; projection = "orthographic -1 1.5 -1 1 2 3" → inner/a.stl --camera 3,20,60 --projection orthographic,-1,1.5,-1,1,2,3
        model = "a.stl"; orthographic = 2 → inner/a.stl --orthographic 2
        model = "a.stl"; material = "gold" → inner/a.stl --material gold
        model = "teapot"; material = "jade"; camera = "3 20 60" → teapot --material jade --camera 3,20,60 --shading flat
        object = ["a.obj move 1,0,0", "cube colour ff0000"]; material = "sky" → --object 'inner/a.obj move 1,0,0' --object 'cube colour ff0000' --material sky
        model = "a.obj"; field = "box:0.2,2,0.2" → inner/a.obj --field box:0.2,2,0.2
    "#;
    for (number, [keys, options]) in rows(table).enumerate() {
        let keys = keys.replace("; ", "\n");
        let name = format!("inner/{number}.toml");
        let text = format!("title = \"A\"\nquality = \"fast\"\n{keys}\n");
        std::fs::write(folder.join(&name), text).unwrap();
        let valid = succeed(&folder, &format!("scene check {name}"));
        assert_eq!(valid, format!("{name}: valid\n"));
        for board in ["model", "emulated"] {
            let render = |what: &str| {
                let options = format!("--board {board} --quality fast --force --out a.png");
                let output = glint_within(800, &folder, &format!("render {what} {options}"), &[]);
                let error = String::from_utf8_lossy(&output.stderr);
                assert!(output.status.success(), "{keys}: {error}");
                picture(&folder.join("a.png"))
            };
            let scene = render(&format!("--scene {name}"));
            assert!(scene == render(options), "{board}: {keys}");
        }
    }
    // The animation turns about the axis of the model.
    let orbit = |what: &str| {
        let orbit = format!("orbit {what} --quality fast --frames 3 --out a.png");
        succeed(&folder, &orbit);
        std::fs::read(folder.join("a.png")).unwrap()
    };
    assert!(orbit("--scene inner/2.toml") == orbit("inner/a.obj --fov 40 --zoom 1.5"));
    // The name of a generator is valid in any folder, unless the folder has a file with this name.
    let missing = "title = \"A\"\nmodel = \"b.obj\"\n";
    std::fs::write(inner.join("missing.toml"), missing).unwrap();
    assert_eq!(
        refused(&folder, "scene check inner/missing.toml"),
        "error: inner/b.obj: expected a file to read, found No such file or directory (os error 2)"
    );
    // The output is an input.
    failed(&folder, "render --scene inner/1.toml --out inner/a.stl", 2);
}

const NET: &str = "eye 0 0 4\nplane 2\nwindow -2 -1.125 2 1.125\nsegment -1 0 1 1 0.5 1\nend\n";

/// The picture of a scene file with a wireframe program in its folder equals the picture of `glint wireframe render`, on the host and on a
/// board.
#[test]
fn scenes_of_programs_are_those_of_wireframe() {
    let folder = folder("scene-of-programs");
    let inner = folder.join("inner");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(inner.join("net.wft"), format!("{NET}ignored\n")).unwrap();
    std::fs::write(folder.join("a.wft"), NET).unwrap();
    succeed(&folder, "wireframe convert a.wft inner/net.wfb");
    for board in ["model", "emulated"] {
        let render = |command: &str| {
            let options = format!("--board {board} --aa 1 --force --out a.png");
            let output = glint_within(800, &folder, &format!("{command} {options}"), &[]);
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "{command}: {error}");
            (picture(&folder.join("a.png")), error)
        };
        let (expected, _) = render("wireframe render a.wft --size 320x180");
        let warning = "inner/net.wft: 1 line after the end is ignored";
        for program in ["net.wft", "net.wfb"] {
            let text = format!("title = \"A\"\nquality = \"fast\"\nprogram = \"{program}\"\n");
            std::fs::write(inner.join("a.toml"), text).unwrap();
            let (found, said) = render("render --scene inner/a.toml");
            assert!(found == expected, "{board}: {program}");
            assert_eq!(said.contains(warning), program == "net.wft", "{said}");
            assert_eq!(said.contains("ignored"), program == "net.wft", "{said}");
        }
    }
    // The output is an input.
    failed(
        &folder,
        "render --scene inner/a.toml --out inner/net.wfb",
        2,
    );
}

/// A scene file whose program cannot be used is refused with one line; no picture and no image is written.
#[test]
fn refused_programs_of_scenes() {
    let folder = folder("scene-programs-refused");
    std::fs::write(folder.join("firmware.bin"), [0x13; 400]).unwrap();
    std::fs::write(folder.join("endless.wft"), NET.replace("end\n", "")).unwrap();
    std::fs::write(folder.join("mesh.wfb"), b"GLM1 and more than a word").unwrap();
    std::fs::write(folder.join("empty.wfb"), b"").unwrap();
    std::fs::write(folder.join("short.wfb"), [0; 40]).unwrap();
    let long = NET.replace("end\n", &"segment 0 0 0 0 0 0\n".repeat(65_535));
    std::fs::write(folder.join("long.wft"), format!("{long}end\n")).unwrap();
    std::fs::create_dir(folder.join("folder.wft")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.join("device.wfb")).unwrap();
    for (program, expected) in [
        (
            "missing.wft",
            "missing.wft: expected a file to read, found No such file",
        ),
        (
            "endless.wft",
            "endless.wft: line 5: expected end, found the end of the input",
        ),
        (
            "mesh.wfb",
            "mesh.wfb: word 1: expected zeros in bits 127 to 99, found",
        ),
        (
            "empty.wfb",
            "empty.wfb: word 1: expected end, found the end of the input",
        ),
        (
            "short.wfb",
            "short.wfb: word 2: expected one eye in the program",
        ),
        (
            "long.wft",
            "long.wft: line 65539: expected at most 65535 segments",
        ),
        (
            "folder.wft",
            "folder.wft: expected a file to read, found Is a directory",
        ),
        ("device.wfb", "device.wfb: expected "),
    ] {
        let text = format!("title = \"A\"\nprogram = \"{program}\"\n");
        std::fs::write(folder.join("a.toml"), text).unwrap();
        for command in [
            "scene check a.toml",
            "render --scene a.toml --out a.png",
            "image make --firmware firmware.bin --scene a.toml --out a.bin",
        ] {
            let error = refused(&folder, command);
            assert!(error.contains(expected), "{command}: {program}: {error}");
            assert_eq!(error.trim_end().lines().count(), 1, "{error}");
        }
    }
    assert!(!folder.join("a.png").exists() && !folder.join("a.bin").exists());
}

/// Each error of a scene file is reported on its own line.
#[test]
fn all_errors_of_a_scene_file() {
    let folder = folder("scene-errors");
    let text = "title = \"A\"\nfeild = \"menger:3\"\ncamera = [4, 30, 70]\nsize = \"640 480\"\n";
    std::fs::write(folder.join("a.toml"), text).unwrap();
    for command in ["scene check a.toml", "render --scene a.toml --out a.png"] {
        assert_eq!(
            failed(&folder, command, 2),
            "error: a.toml: line 2: `feild`: expected a key, did you mean `field`?\n\
             error: a.toml: line 3: camera: `[4, 30, 70]`: expected a text, a number, true or false, such as camera = \"4 30 70\"\n\
             error: a.toml: line 4: size = `640 480`: size: 640 x 480: expected 320 180, 640 360 or 1280 720, such as size = \"640 360\"\n"
        );
    }
    assert_eq!(
        failed(&folder, "render --scene mengr --out a.png", 2),
        "error: mengr: expected a scene file FILE.toml or a built-in scene, did you mean `menger`?\n"
    );
}

/// The lens options apply to the camera of a scene.
#[test]
fn the_lens_of_a_scene() {
    let folder = folder("scene-lens");
    std::fs::write(folder.join("wide.toml"), LAMP).unwrap();
    std::fs::write(folder.join("narrow.toml"), format!("{LAMP}fov = 30\n")).unwrap();
    let render = |scene: &str| drawn(&folder, &format!("render --scene {scene}"));
    let narrow = render("narrow.toml");
    assert!(narrow != render("wide.toml"));
    assert!(narrow == render("wide.toml --fov 30"));
    assert!(narrow != render("narrow.toml --zoom 2"));
    assert!(narrow == render("narrow.toml --camera 4,30,70 --fov 30"));
}

/// An option that sets a property of the scene is rejected, not ignored.
#[test]
fn options_that_a_scene_states() {
    let folder = folder("scene-options");
    for option in [
        "cube",
        "--field box:1,1,1",
        "--stereo 0.05,3",
        "--material jade",
        "--light 0,0,1",
        "--ambient 404040",
        "--background sky",
        "--fog 1",
        "--occlusion",
        "--undecided",
        "--prepass",
    ] {
        for command in ["render", "orbit"] {
            let scene = format!("{command} --scene menger --out a.png {option}");
            assert_has(&failed(&folder, &scene, 2), "cannot be used with");
        }
    }
    assert_eq!(
        refused(&folder, "render --scene menger --up y --out a.png"),
        "error: --up: expected a model, found a --scene"
    );
    assert!(!folder.join("a.png").exists());
}

/// The key `stereo` of a scene has the effect of the option for meshes, objects, and a mesh in a
/// field. The depths are those of the left eye.
#[test]
fn two_eyes() {
    let folder = folder("scene-two-eyes");
    let camera = "title = \"Two\"\ncamera = \"3 30 60\"\n";
    let table = r#"
        model = "cube" → cube
        model = "cube"; field = "box:0.2,1,0.2" → cube --field box:0.2,1,0.2
        object = "cube scale 0.5" → --object 'cube scale 0.5'
    "#;
    for (number, [keys, options]) in rows(table).enumerate() {
        let keys = keys.replace("; ", "\n") + "\n";
        let name = format!("{number}.toml");
        let of_one = format!("{camera}{keys}");
        let text = format!("{of_one}stereo = \"0.2,2.5,red-cyan\"\n");
        std::fs::write(folder.join(&name), text).unwrap();
        std::fs::write(folder.join("one.toml"), of_one).unwrap();
        let valid = succeed(&folder, &format!("scene check {name}"));
        assert_eq!(valid, format!("{name}: valid\n"));
        let render = |what: &str| {
            let picture = drawn(&folder, &format!("render --depth a.f32 {what}"));
            (picture, std::fs::read(folder.join("a.f32")).unwrap())
        };
        let scene = render(&format!("--scene {name}"));
        let eyes = "--camera 3,30,60 --stereo 0.2,2.5,red-cyan --quality balanced";
        assert!(scene == render(&format!("{options} {eyes}")), "{keys}");
        let one = render("--scene one.toml");
        assert!(scene.0 != one.0 && scene.1 != one.1, "{keys}");
    }
}

/// The quality of a scene comes from its key or the option; a size overrides the size of the quality.
#[test]
fn quality_of_a_scene() {
    let folder = folder("scene-quality");
    // The rays of this field march, so a quality also sets a threshold, and pictures of the same
    // size differ between two qualities.
    const FIELD: &str =
        "title = \"A\"\nfield = \"smooth:0.3,box:1,1,0.2+sphere:0.7\"\ncamera = \"3 25 70\"\n";
    for (name, keys) in [
        ("balanced.toml", ""),
        ("fast.toml", "quality = \"fast\"\n"),
        ("large.toml", "quality = \"fast\"\nsize = \"640 360\"\n"),
    ] {
        std::fs::write(folder.join(name), format!("{FIELD}{keys}")).unwrap();
    }
    let of_scene = |scene: &str| drawn(&folder, &format!("render --scene {scene}"));
    let of_field = |more: &str| {
        let field = "--field smooth:0.3,box:1,1,0.2+sphere:0.7 --camera 3,25,70";
        drawn(&folder, &format!("render {field} {more}"))
    };
    let balanced = of_scene("balanced.toml");
    assert_eq!(balanced.len(), 3 * 640 * 360);
    assert!(balanced == of_scene("fast.toml --quality balanced"));
    assert!(balanced == of_field("--quality balanced"));
    assert!(balanced == of_field("--size 640x360"));
    let fast = of_scene("fast.toml");
    assert_eq!(fast.len(), 3 * 320 * 180);
    assert!(fast == of_scene("balanced.toml --quality fast"));
    assert!(fast == of_field("--quality fast"));
    assert!(fast != of_field(""));
    let large = of_scene("large.toml");
    assert!(large.len() == balanced.len() && large != balanced);
    assert!(large == of_scene("balanced.toml --quality fast --size 640x360"));
    assert!(large == of_field("--size 640x360 --quality fast"));
    let best = "render --field menger:3 --quality best --out b.png";
    assert_has(&failed(&folder, best, 2), "fast, balanced, exact");
}

/// The key and the option `prepass` are accepted, but have no effect, as a note says.
#[test]
fn a_prepass_has_no_effect() {
    const NOTE: &str =
        "prepass has no effect: rays need no prepass any more, and the next release rejects it\n";
    let folder = folder("prepass");
    let scene = "title = \"a box\"\nfield = \"box:1,1,1\"\nsize = \"320 180\"\n";
    for (name, scene) in [
        ("without.toml", scene.to_owned()),
        ("with.toml", format!("{scene}prepass = true\n")),
    ] {
        std::fs::write(folder.join(name), scene).unwrap();
    }
    for (without, with, file) in [
        ("--scene without.toml", "--scene with.toml", "with.toml: "),
        ("--field box:1,1,1", "--field box:1,1,1 --prepass", ""),
    ] {
        let note = format!("note: {file}{NOTE}");
        let render = |options: &str| {
            let [_, notes] = said(&folder, &format!("render --force --out a.png {options}"));
            (picture(&folder.join("a.png")), notes)
        };
        let (expected, silence) = render(without);
        assert_eq!(silence, "");
        assert!(render(with) == (expected, note), "{with}");
    }
    let [_, note] = said(&folder, "scene check with.toml");
    assert_eq!(note, format!("note: with.toml: {NOTE}"));
}
