//! Scenes with options, and scenes that cannot be drawn.

use crate::common::{drawn, files_refused, folder, glint, refused, succeed};

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
        let output = glint(&folder, &command.replace("FILE", "near.toml"));
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{command}: {error}");
        let expected = "error: near.toml: line 3: camera = `1 30 70`: radius 1: expected 2 to 5\n";
        assert_eq!(error, expected, "{command}");
    }
    assert!(!folder.join("a.png").exists());
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

/// An option that a scene also sets is rejected, not ignored.
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
            let output = glint(&folder, &scene);
            let error = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{option:?}: {error}");
            assert!(error.contains("cannot be used with"), "{error}");
        }
    }
    assert_eq!(
        refused(&folder, "render --scene menger --up y --out a.png"),
        "error: --up: expected a model, found a --scene"
    );
    assert!(!folder.join("a.png").exists());
}

/// The key `stereo` of a scene has the effect of the option, for meshes, objects, and a mesh in a field; the depths are those of
/// the left eye.
#[test]
fn two_eyes() {
    let folder = folder("scene-two-eyes");
    let camera = "title = \"Two\"\ncamera = \"3 30 60\"\n";
    for (number, (keys, options)) in [
        ("model = \"cube\"\n", "cube"),
        (
            "model = \"cube\"\nfield = \"box:0.2,1,0.2\"\n",
            "cube --field box:0.2,1,0.2",
        ),
        ("object = \"cube scale 0.5\"\n", "--object 'cube scale 0.5'"),
    ]
    .into_iter()
    .enumerate()
    {
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
    const SPONGE: &str = "title = \"A\"\nfield = \"menger:3\"\ncamera = \"3 25 70\"\n";
    for (name, keys) in [
        ("balanced.toml", ""),
        ("fast.toml", "quality = \"fast\"\n"),
        ("large.toml", "quality = \"fast\"\nsize = \"640 360\"\n"),
    ] {
        std::fs::write(folder.join(name), format!("{SPONGE}{keys}")).unwrap();
    }
    let of_scene = |scene: &str| drawn(&folder, &format!("render --scene {scene}"));
    let of_field = |more: &str| {
        let field = "--field menger:3 --camera 3,25,70";
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
    let output = glint(&folder, best);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("fast, balanced, exact"), "{error}");
}
