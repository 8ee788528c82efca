//! The scenes in the firmware equal the files of the folder `scenes`, and are drawn as the model draws them.

use crate::common::{console, drawn_alike, emulator, info, renderer};
use glint::render::{self, Parts, Rendered, size_command, view_command};
use glint::scene::{self, Changes};
use glint_core::picture::Size;
use glint_scene_file::{NAMES, SceneFile, built_in};

/// The gateware's picture of every scene in the firmware equals the model's picture of the host's
/// scene. The commands that move the camera are left out.
#[test]
fn scenes_are_the_models() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let changes = Changes {
        size: Some(Size::W320),
        ..Changes::default()
    };
    // The list `demo` starts with the scene `holoforge`, which is drawn anyway.
    for name in NAMES.into_iter().filter(|name| *name != "demo") {
        let scene = built_in(name).unwrap();
        let (view, expected) = scene::draw(&scene, &changes, |frame| {
            (frame.view, render::on_model(frame).unwrap())
        })
        .unwrap();
        let show = format!("scene {name}");
        let (size, view) = (size_command(Size::W320), view_command(&view));
        let mut commands = vec![show, "imu off".into(), size, view];
        if name.starts_with("holoforge") {
            let error = renderer.console().command(&commands.remove(0)).unwrap_err();
            let error = error.to_string();
            assert!(error.contains("no image sensor answers"), "{error}");
        }
        let drawn = renderer.render_after(&commands, Size::W320, Parts::COLOUR);
        let Rendered { image, stats } = drawn.unwrap();
        println!("{name}: {:?} cycles", stats.cycles);
        assert_eq!(stats.backend.as_deref(), Some("gateware"), "{name}");
        assert!(image.colour == expected.image.colour, "{name}");
    }
    // The default scene contains no settings of the other scenes.
    let console = renderer.console();
    console.command("scene default").unwrap();
    assert_eq!(info::<String>(console, "scene"), "cube");
    assert!(console.command("object list").unwrap().is_empty());
    assert_eq!(info::<u32>(console, "size"), 1280);
}

/// A scene file with a mesh that is not built into the firmware.
#[test]
fn a_scene_file_is_the_models() {
    const FILE: &str = "title = \"a\"\nmodel = \"icosphere:2\"\ncamera = \"2 30 60\"\nfov = 60\nlight = \"1,2,3,ff8040\"\ndepth = true\n";
    let scene = SceneFile::parse("a", "a.toml", FILE).unwrap();
    let mut board = emulator();
    let mut renderer = renderer(&mut board).with_scene(Some(scene.clone()));
    scene::draw(&scene, &Changes::default(), |frame| {
        drawn_alike(&mut renderer, frame, "a scene file");
    })
    .unwrap();
}

#[test]
fn refused_scenes() {
    let mut board = emulator();
    let mut console = console(&mut board);
    for (command, expected) in [
        ("scene gear", "or objects or poor-mans-vr"),
        (
            "load 16 0 menger",
            "the name of a scene, expected another name",
        ),
        (
            "object show",
            "no objects, expected `object add MESH` first",
        ),
    ] {
        let error = console.command(command).unwrap_err().to_string();
        assert!(error.contains(expected), "{command}: {error}");
    }
}
