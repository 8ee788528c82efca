//! Follows the tutorial in docs/scenes.md, which writes a scene from scratch: each command of the page works on the scene file of
//! the page.

use crate::common::{folder, json, picture, report, said, succeed};
use std::path::Path;

/// The first code block of the page in the given language.
fn block<'p>(page: &'p str, language: &str) -> &'p str {
    let (_, rest) = page.split_once(&format!("```{language}\n")).unwrap();
    rest.split_once("```").unwrap().0
}

#[test]
fn a_scene_from_nothing() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/scenes.md")).unwrap();
    let folder = folder("scene-from-nothing");
    std::fs::write(folder.join("lamp.toml"), block(&page, "toml")).unwrap();
    // The commands in the first column of the table; its other column describes them.
    let commands: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `glint "))
        .map(|line| line.split_once('`').unwrap().0)
        .collect();
    assert_eq!(commands.len(), 4, "{commands:?}");
    let command = |start: &str| {
        let mut commands = commands.iter();
        *commands.find(|command| command.starts_with(start)).unwrap()
    };
    let run = |start: &str| said(&folder, command(start))[0].clone();
    assert_eq!(run("scene check"), "lamp.toml: valid\n");
    let shown = run("scene show");
    for expected in [
        "field union:box:2,2,0.1+sphere:0.6",
        "material jade",
        "--blocks scanout raymarch i2c --no-depths --fields box,spheres --lanes 2",
    ] {
        assert!(shown.contains(expected), "{expected}: {shown}");
    }
    assert!(run("scene list").contains("menger"));
    succeed(&folder, &format!("{} --stats lamp.json", command("render")));
    // The sphere above the floor is in the middle of the picture, the sky in the upper corners.
    let pixels = picture(&folder.join("lamp.png"));
    let pixel = |x: usize, y: usize| &pixels[3 * (640 * y + x)..][..3];
    assert_eq!(pixels.len(), 3 * 640 * 360);
    let [red, green, blue] = pixel(320, 150) else {
        unreachable!()
    };
    assert!(green > red && green > blue, "jade {:?}", pixel(320, 150));
    let [red, _, blue] = pixel(2, 2) else {
        unreachable!()
    };
    assert!(blue > red, "sky {:?}", pixel(2, 2));
    assert!(json(&folder.join("lamp.json")).is_object());
}

#[test]
fn scenes_as_json() {
    let folder = folder("scenes-json");
    let list = report(&folder, "scene list");
    assert!(
        list.as_array()
            .unwrap()
            .iter()
            .any(|scene| scene["name"] == "objects")
    );
    let shown = report(&folder, "scene show objects");
    let options = shown["gateware"].as_array().unwrap();
    assert!(options.contains(&"--smooth".into()), "{options:?}");
    assert!(
        shown["settings"]
            .as_array()
            .unwrap()
            .iter()
            .any(|line| line == "shading smooth")
    );
    let shown = report(&folder, "scene show demo");
    assert_eq!(shown["scenes"][0], "holoforge");
    assert_eq!(shown["settings"], serde_json::json!([]));
    let checked = report(&folder, "scene check cubes menger");
    assert_eq!(checked, serde_json::json!(["cubes", "menger"]));
}
