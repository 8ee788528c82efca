//! Tests of scenes: options, needed blocks, and the text form.

use glint_core::block::Block;
use glint_core::console::{Command, ObjectAction, OptionName, Setting};
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::picture::{Samples, Size};
use glint_core::quality::Quality;
use glint_core::words::Words;
use glint_scene::{AnyBoard, Board, Defaults, Kind, Reason, Scene};
use proptest::prelude::*;

/// A board that supports pictures up to 640×360, and has no engine, and no mesh, texture or program named `none`.
struct SmallBoard;

impl Board for SmallBoard {
    fn has_size(&self, size: Size) -> bool {
        size != Size::W1280
    }

    fn has_engine(&self) -> bool {
        false
    }

    fn has_mesh(&mut self, name: &str) -> bool {
        name != "none"
    }

    fn mesh(&self, _: &str) -> Option<Mesh<'_>> {
        None
    }

    fn has_texture(&self, name: &str) -> bool {
        name != "none"
    }

    fn has_program(&self, name: &str) -> bool {
        name != "none"
    }
}

fn start() -> Scene {
    Scene::new(Defaults::GATEWARE).expect("a camera in range")
}

/// Executes the lines of a scene. Returns the error of the first line that fails.
fn execute(scene: &mut Scene, lines: &str, board: &mut dyn Board) -> Result<(), String> {
    for line in glint_scene::lines(lines) {
        let (_, line) = line.map_err(|error| error.to_string())?;
        line.apply(scene, board)
            .map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn scene(lines: &str) -> Scene {
    let mut scene = start();
    execute(&mut scene, lines, &mut AnyBoard).expect("lines of a scene");
    scene
}

fn lines(scene: &Scene) -> String {
    let mut text = String::new();
    scene
        .write_lines(&start(), &mut text)
        .expect("a string takes all text");
    text
}

/// Generates a line of a scene, with random values. Some lines are errors in some scenes.
fn line() -> impl Strategy<Value = String> {
    let number = |low: i32, high: i32| (low..high).prop_map(|x| format!("{}", f64::from(x) / 64.0));
    let word = |words: &'static [&'static str]| proptest::sample::select(words);
    prop_oneof![
        word(&[
            "off",
            "menger:3",
            "box:1,1,0.5",
            "union:menger:2+sphere:1",
            "moving:0.3,1,30",
            "cubes:2,0.4"
        ])
        .prop_map(|field| format!("field {field}")),
        word(&["cube", "torus", "a"]).prop_map(|mesh| format!("scene {mesh}")),
        word(&[
            "program",
            "program a.wfb",
            "object show",
            "object remove all",
            "object remove 1"
        ])
        .prop_map(str::to_owned),
        (word(&["cube", "a"]), number(-640, 640), number(1, 128)).prop_map(|(mesh, x, s)| format!(
            "object add {mesh} scale {s} rotate x {x} move {x},1,2"
        )),
        number(-640, 640).prop_map(|x| format!("object move 1 {x},0,1")),
        (
            word(&[
                "mesh",
                "occlusion",
                "undecided",
                "cull",
                "dither",
                "overlay"
            ]),
            word(&["on", "off"])
        )
            .prop_map(|(option, on)| format!("{option} {on}")),
        (number(0, 64), number(64, 640))
            .prop_map(|(e, zero)| format!("stereo {e},{zero},red-cyan")),
        word(&[
            "stereo off",
            "aa 1",
            "aa 4",
            "aa default",
            "edges over",
            "edges hidden",
            "edges off",
            "light default",
            "ambient default",
            "ambient 102030",
            "background sky",
            "background gradient",
            "background default",
            "background 405060",
            "shadow on",
            "shadow off",
            "highlight off",
            "highlight 0.6,32",
            "fog off",
            "clip off",
            "near 0.5",
            "fov 66",
            "fov 150 112.5",
            "orthographic 2",
            "zoom 1.5",
            "projection perspective -0.2 0.1 -0.1 0.15 0.1 7",
            "projection orthographic -2 1 -1 1.5 0.1",
            "projection matrix 2 0 0.5 0 0 3 0 0 0 0 -1 -1 0 0 -1 0",
            "winding screen",
            "winding mesh",
            "shading smooth",
            "shading flat",
            "texture own",
            "texture wood.png",
            "backend cpu",
            "backend gateware",
            "size 320 180",
            "size 1280 720",
            "quality fast",
            "quality exact"
        ])
        .prop_map(str::to_owned),
        word(&["normal", "mixed", "jade", "clay"])
            .prop_map(|material| format!("material {material}")),
        (number(-640, 640), number(1, 640)).prop_map(|(x, y)| format!("light {x},{y},1,ff8040")),
        number(1, 1024).prop_map(|fog| format!("fog {fog}")),
        number(1, 1024).prop_map(|far| format!("clip {far}")),
        (number(128, 320), number(-23040, 23040), number(0, 11520))
            .prop_map(|(r, theta, phi)| format!("camera {r} {theta} {phi}")),
        (number(-640, 640), number(-640, 640))
            .prop_map(|(yaw, pitch)| format!("look {yaw} {pitch} 3")),
        (number(-640, 640), number(-640, 640))
            .prop_map(|(x, y)| format!("lookat {x} {y} 1 1 2 -1")),
        number(64, 11000).prop_map(|angle| format!("fov {angle}")),
        number(64, 6400).prop_map(|width| format!("orthographic {width}")),
        number(32, 128).prop_map(|factor| format!("zoom {factor}")),
        (number(-640, 640), number(-640, 640))
            .prop_map(|(x, y)| format!("animate azimuth {x} orbit {y}")),
        (1..4, number(-640, 640))
            .prop_map(|(object, y)| format!("animate orbit 1 turn {object} x {y}")),
        word(&["animate off", "animate turn z 30"]).prop_map(str::to_owned),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// The text of a scene converts the start scene to this scene. A line with an error changes nothing.
    #[test]
    fn a_scene_comes_back_from_its_text(made in proptest::collection::vec(line(), 0..24)) {
        let mut scene = start();
        for line in made {
            let before = scene.clone();
            let is_overlay = line.starts_with("overlay");
            if let Some(Command::Set(setting)) = Command::parse(&line).expect("a command").filter(|_| is_overlay) {
                scene.apply(&setting, &mut AnyBoard).expect("the overlay is set");
            } else if execute(&mut scene, &line, &mut AnyBoard).is_err() {
                prop_assert_eq!(&scene, &before);
            }
        }
        // The text over the picture belongs to no scene.
        scene.overlay = false;
        let text = lines(&scene);
        let mut again = start();
        prop_assert_eq!(execute(&mut again, &text, &mut AnyBoard), Ok(()), "{}", text);
        prop_assert_eq!(again, scene, "{}", text);
    }
}

#[test]
fn the_text_has_what_differs_from_the_scene_at_start() {
    assert_eq!(lines(&start()), "");
    assert_eq!(
        lines(&scene(
            "quality exact\nlight camera\nscene torus\nmesh on\nfield box:1,1,1"
        )),
        "mesh on\nlight camera,ffffff\nquality exact\nsize 1280 720\naa 4\nscene torus\nfield box:1,1,1\n"
    );
    assert_eq!(
        lines(&scene("object add a\nscene b\nedges over"))
            .lines()
            .last(),
        Some("edges over")
    );
}

#[test]
fn scenes_need_the_blocks_of_what_they_show() {
    let bits = |blocks: &[Block]| blocks.iter().fold(1, |bits, block| bits | block.bit());
    for (lines, blocks) in [
        ("size 640 360", &[Block::Triangle][..]),
        (
            "scene a\nmesh on\nfield menger:2",
            &[Block::Triangle, Block::Raymarch],
        ),
        ("field menger:2", &[Block::Raymarch]),
        ("program", &[Block::Line]),
        ("edges over", &[Block::Triangle, Block::Line]),
        ("object add a", &[Block::Triangle]),
        ("backend cpu\nscene a", &[]),
    ] {
        assert_eq!(scene(lines).blocks(), bits(blocks), "{lines}");
    }
}

/// A quality sets the largest size that the board supports, up to its own size; an unsupported size is an error.
#[test]
fn a_board_limits_the_scene() {
    let mut scene = start();
    let mut apply = |lines| execute(&mut scene, lines, &mut SmallBoard);
    assert_eq!(apply("quality exact"), Ok(()));
    for (line, expected) in [
        (
            "size 1280 720",
            "size: 1280x720 not available on this board",
        ),
        (
            "backend gateware",
            "gateware: no triangle engine in this SoC",
        ),
        ("object add none", "object add `none`: expected a mesh"),
        (
            "texture none",
            "texture `none`: expected own or an uploaded texture",
        ),
        (
            "program none",
            "program `none`: expected cube or an uploaded program",
        ),
        ("object show", "object: no objects"),
        ("object move 2 1,1,1", "object 2: no objects"),
        (
            "program\nstereo 0.1,3",
            "stereo: not available for the wireframe",
        ),
        ("edges over", "edges: not available"),
        (
            "field menger:2\nfit",
            "fit: expected a mesh alone or objects",
        ),
        (
            "light camera\nlight camera\nlight camera\nlight camera\nlight camera",
            "light: expected at most 4",
        ),
        ("zoom 0", "half_width"),
        ("camera 6 0 0", ""),
    ] {
        let error = apply(line).expect_err(line);
        assert!(error.starts_with(expected), "{line}: {error}");
    }
    assert_eq!((scene.quality, scene.size), (Quality::Exact, Size::W640));
}

#[test]
fn an_option_is_shown_as_it_is_set() {
    let scene = scene("light 1,-2,3\nfog 0.25\nobject add a\nscene b");
    let shown = |option: OptionName| {
        let mut text = String::new();
        scene
            .show(option, &mut text)
            .expect("a string takes all text");
        text
    };
    assert_eq!(shown(OptionName::Fog), "fog 0.25\n");
    assert_eq!(shown(OptionName::Ambient), "ambient 404040\n");
    assert_eq!(shown(OptionName::Light), "light 1,-2,3,ffffff\n");
    assert!(shown(OptionName::Object).starts_with("object 1 a matrix 1,0,0,"));
    assert_eq!(scene.subject().to_string(), "b");
}

/// A mesh replaces the objects, and `object show` shows them again; without objects the mesh is shown.
#[test]
fn objects_come_and_go() {
    let mut scene = scene("object add a\nobject add b\nscene c");
    assert_eq!((scene.kind, scene.objects.len()), (Kind::Solid, 2));
    let mut object = |action| {
        let set = scene.apply(&Setting::Object { action }, &mut AnyBoard);
        set.expect("there are objects");
        (scene.kind, scene.first_object_of("b"))
    };
    assert_eq!(object(ObjectAction::Show), (Kind::Objects, Some(2)));
    assert_eq!(
        object(ObjectAction::Remove(Some(1))),
        (Kind::Objects, Some(1))
    );
    assert_eq!(object(ObjectAction::Remove(None)), (Kind::Solid, None));
}

/// An object that turns by many small steps keeps its size, even while it moves. A later change of its
/// scale has an effect.
#[test]
fn a_turning_object_keeps_its_size() {
    let mut scene = scene("object add a scale 0.5");
    let mut change = |text: &str, times: usize| {
        let next = Place::parse(&mut Words::new(text)).expect("operations");
        for _ in 0..times {
            let action = ObjectAction::Change { number: 1, next };
            let set = scene.apply(&Setting::Object { action }, &mut AnyBoard);
            set.expect("in range");
        }
        let rows = scene.objects[0].place.matrix.linear();
        [0, 1, 2].map(|j| {
            let squares = rows.map(|row| row[j].to_num::<f64>().powi(2));
            squares.iter().sum::<f64>().sqrt()
        })
    };
    let near = |found: [f64; 3], expected: f64| {
        assert!(
            found.iter().all(|x| (x - expected).abs() < 1e-6),
            "{found:?}"
        );
    };
    near(change("rotate z 0.1", 36_000), 0.5);
    near(
        change("rotate x 0.1 rotate y 0.1 move 0,0,0.00001", 10_000),
        0.5,
    );
    near(change("scale 3", 1), 1.5);
    near(change("rotate y 0.1", 36_000), 1.5);
}

/// Steps there and back leave no error: moves are exact sums, and so are scales by powers of two that lose no
/// bits. Other scales are rounded once a step.
#[test]
fn an_object_comes_back_from_many_moves_and_scales() {
    let start = scene("object add a scale 0.3 rotate x 20 rotate y 40 move 0.1,0.2,0.3");
    let steps = |texts: [&str; 2], times: usize| {
        let mut scene = start.clone();
        for text in texts {
            for _ in 0..times {
                execute(&mut scene, &format!("object {text}"), &mut AnyBoard).expect("in range");
            }
        }
        scene.objects[0].place.matrix
    };
    let before = start.objects[0].place.matrix;
    for (texts, times) in [
        (
            ["move 1 0.001,-0.002,0.003", "move 1 -0.001,0.002,-0.003"],
            5_000,
        ),
        (["scale 1 4", "scale 1 0.25"], 2),
        (["scale 1 2,4,1", "scale 1 0.5,0.25,1"], 2),
    ] {
        assert_eq!(steps(texts, times), before, "{texts:?}");
    }
    let after = steps(["scale 1 1.01", "scale 1 0.9900990099"], 200);
    let rows = [before, after].map(|matrix| matrix.linear().map(|row| row.map(f64::from)));
    let pairs = rows[0].as_flattened().iter().zip(rows[1].as_flattened());
    let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!(
        "error of {:.1} units of 2^-24 after 400 scales",
        worst * 2f64.powi(24)
    );
    // Each step rounds by half a unit, and the factors are rounded to 2^−24 themselves.
    assert!(worst < 400.0 * 0.5f64.powi(24));
}

#[test]
fn other_lines_are_no_scene() {
    let error = |text: &'static str| {
        let error = glint_scene::lines(text).find_map(Result::err).unwrap();
        (
            error.line,
            matches!(error.reason, Reason::Effect),
            error.to_string(),
        )
    };
    assert_eq!(
        error("fov 60\nload 16 0"),
        (
            2,
            true,
            "line 2: expected a command that sets the picture".into()
        )
    );
    assert_eq!(error("reboot").0, 1);
    assert!(error("fov 60\n\nfov 70").1, "a blank line");
    let (line, is_effect, text) = error("fov 60\nfov 700");
    assert!(
        (line, is_effect) == (2, false) && text.starts_with("line 2: fov: "),
        "{text}"
    );
}

/// A pixel has four samples where the gateware draws about 60 frames per second, unless a number is set. A quality sets its number,
/// and `aa default` restores the number of the board.
#[test]
fn the_samples_follow_from_the_scene() {
    for (text, samples, has_depths) in [
        ("", Samples::Four, false),
        ("aa 1", Samples::One, true),
        ("aa 1\naa default", Samples::Four, false),
        ("backend cpu", Samples::One, true),
        ("backend cpu\naa 4", Samples::Four, false),
        ("stereo 0.1,3", Samples::One, true),
        ("field menger:2", Samples::One, true),
        ("field menger:2\nsize 640 360", Samples::Four, false),
        ("field menger:2\nquality exact", Samples::Four, false),
        ("quality fast", Samples::One, true),
        ("quality exact\nquality balanced", Samples::Four, false),
    ] {
        let scene = scene(text);
        assert_eq!(scene.samples(), samples, "{text}");
        assert_eq!(scene.has_depths(), has_depths, "{text}");
    }
    let board = Defaults {
        samples: Samples::One,
        ..Defaults::GATEWARE
    };
    assert_eq!(Scene::new(board).expect("a camera").samples(), Samples::One);
}

/// A reset keeps the backend, and gives the soft core its smaller size.
#[test]
fn a_reset_restores_the_size_of_the_backend() {
    for (text, size) in [
        ("size 640 360", Size::W1280),
        ("size 640 360\nbackend cpu", Size::W320),
    ] {
        let mut scene = scene(text);
        let backend = scene.backend;
        scene.reset().expect("a camera in range");
        assert_eq!((scene.size, scene.backend), (size, backend), "{text}");
    }
}
