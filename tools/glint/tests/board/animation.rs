//! Animations: a board moves the scene by its own time, and its picture equals the model's picture
//! of the scene in the same state.

use crate::common::{emulator, info, renderer};
use glint::render::{self, Parts, Rendered};
use glint::scene::{self, Changes};
use glint_scene_file::SceneFile;
use virtual_board::Uart;

/// Keys that all scenes contain.
const START: &str = "title = \"a\"\nsize = \"320 180\"\n";

/// Duration of a motion in seconds.
const TIME: f64 = 0.5;
/// Rate of a motion in degrees per second.
const RATE: f64 = 40.0;
/// Tolerance of the duration in seconds. It covers the commands before and after the motion, and a
/// frame, because a picture shows the state at the start of its drawing.
const LATE: f64 = 0.2;
/// Duration of a frame in seconds.
const FRAME: f64 = 1.0 / 60.0;

/// The picture of a scene file on the model.
fn on_model(text: &str) -> Vec<u16> {
    let scene = SceneFile::parse("a", "a.toml", text).unwrap_or_else(|error| panic!("{error}"));
    let drawn = scene::draw(&scene, &Changes::default(), render::on_model);
    drawn.unwrap().unwrap().image.colour
}

#[test]
fn the_board_draws_the_state_at_its_time() {
    // The kind of motion, the key that the motion changes with its value, the console command that
    // prints the new state, and the other keys of the scene.
    let cases = [
        (
            "azimuth",
            "camera",
            "4 10 60",
            "view",
            "field = \"menger:2\"\n",
        ),
        (
            "orbit",
            "field",
            "moving:0.4,1,10",
            "field",
            "camera = \"4 30 60\"\n",
        ),
        (
            "turn z",
            "object",
            "torus scale 0.7,0.5,0.6 rotate x 30 move 0.2,0,0.1",
            "object",
            "camera = \"4 30 60\"\n",
        ),
    ];
    for (part, key, value, option, others) in cases {
        let mut board = emulator();
        let mut renderer = renderer(&mut board);
        let start = format!("{START}{key} = \"{value}\"\n{others}");
        let file = format!("{start}animate = \"{part} {RATE}\"\n");
        let file = SceneFile::parse("a", "a.toml", &file).unwrap();
        let size = file.size();
        let lines: Vec<String> = file.settings().to_vec();
        renderer.render_after(&lines, size, Parts::COLOUR).unwrap();
        let hertz = f64::from(renderer.board().inner().clock_hz());
        renderer.board().inner().run((TIME * hertz) as u64);
        // While the scene moves, the console answers and a picture can be downloaded.
        let console = renderer.console();
        assert_eq!(info::<u32>(console, "size"), 320);
        console.command("render").unwrap();
        console.command("animate off").unwrap();
        let shown = console.command(option).unwrap().remove(0);
        let shown = shown.strip_prefix(option).unwrap().trim();
        let shown = shown
            .strip_prefix("1 torus")
            .map_or(shown.to_owned(), |place| format!("torus{place}"));
        if option == "field" {
            let angle: f64 = shown.rsplit(',').next().unwrap().parse().unwrap();
            let range = 10.0 + RATE * (TIME - FRAME)..10.0 + RATE * (TIME + LATE);
            assert!(range.contains(&angle), "{angle} degrees");
        }
        let Rendered { image, stats } = renderer.render_after(&[], size, Parts::COLOUR).unwrap();
        let moved = on_model(&format!("{START}{option} = \"{shown}\"\n{others}"));
        assert!(image.colour == moved, "{part} at {shown}");
        assert!(image.colour != on_model(&start), "{part} moves");
        assert_eq!(stats.backend.as_deref(), Some("gateware"), "{part}");
        // The picture does not change any more.
        renderer.board().inner().run(hertz as u64 / 10);
        assert!(
            renderer.colour(size).unwrap() == moved,
            "{part} has stopped"
        );
    }
}

/// A host draws a scene in the state at the start of its motion.
#[test]
fn a_host_draws_the_start() {
    let file = format!(
        "{START}field = \"moving:0.4,1\"\ncamera = \"4 30 60\"\nanimate = \"orbit 90 azimuth 30\"\n"
    );
    let scene = SceneFile::parse("a", "a.toml", &file).unwrap();
    let mut board = emulator();
    let mut renderer = renderer(&mut board).with_scene(Some(scene.clone()));
    let drawn = scene::draw(&scene, &Changes::default(), |frame| {
        renderer.render(frame, Parts::COLOUR).unwrap()
    });
    assert!(drawn.unwrap().image.colour == on_model(&file));
}
