//! Tests of every command with its arguments.

use glint_core::camera::{Projection, View};
use glint_core::colour::{Rgb565, Shading, Winding};
use glint_core::console::{
    Command, GestureAction, ImuAction, LINE_MAX, ObjectAction, OptionName, Setting,
};
use glint_core::field::{Field, Menger};
use glint_core::fixed::{Q2_23, Q8_24, Q32_32, Turns, U4_28, U8_28};
use glint_core::follow::{Direction, Mounting};
use glint_core::imu::Follow;
use glint_core::light::{Background, Light, Material};
use glint_core::matrix::{Axis, Matrix};
use glint_core::object::Place;
use glint_core::picture::{Backend, Edges, Size};
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};
use glint_core::wire::Manifest;
use glint_core::wireframe::Key;
use glint_core::words::Words;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_line_upsets_the_parser(line in any::<String>()) {
        let _ = Command::parse(&line).map_err(|error| error.to_string());
    }

    #[test]
    fn no_arguments_upset_the_parser(
        name in proptest::sample::select(&["field", "stereo", "material", "light", "ambient", "fog", "camera", "view", "look", "lookat", "fov", "orthographic", "zoom", "fit", "orbit", "quality", "size", "load", "object", "leds", "help"][..]),
        words in proptest::collection::vec("(box:)?[-+]?[0-9a-fx_.,e]{0,12}", 0..16),
    ) {
        let line = format!("{name} {}", words.join(" "));
        let _ = Command::parse(&line).map_err(|error| error.to_string());
    }

    #[test]
    fn no_object_upsets_the_parser(
        action in proptest::sample::select(&["add", "move", "rotate", "scale", "matrix", "colour", "remove"][..]),
        words in proptest::collection::vec("(scale|rotate|move|matrix|colour|x|[-+]?[0-9a-f.,]{0,24})", 0..12),
    ) {
        let line = format!("object {action} {}", words.join(" "));
        let _ = Command::parse(&line).map_err(|error| error.to_string());
    }

    /// The printed form of a placement is parsed to the same placement.
    #[test]
    fn places_come_back_bit_for_bit(entries in any::<[[i32; 3]; 3]>(), by in any::<[i32; 3]>(), colour in any::<Option<u16>>()) {
        let number = |bits: i32, shift| Q8_24::from_bits(bits >> shift);
        let matrix = Matrix::new_checked(entries.map(|row| row.map(|x| number(x, 3))), by.map(|x| number(x, 2)));
        if let Ok(matrix) = matrix {
            let place = Place { matrix, colour: colour.map(Rgb565) };
            let text = place.to_string();
            prop_assert!(text.len() <= LINE_MAX / 2);
            prop_assert_eq!(Place::parse(&mut Words::new(&text)), Ok(place));
        }
    }

    /// The printed form of a view, given to the command `view`, sets the same view again.
    #[test]
    fn views_come_back_bit_for_bit(r in 2_i64 << 32..=5 << 32, theta in any::<u32>(), phi in 0..=1_u32 << 31) {
        let view = View::spherical(Q32_32::from_bits(r), Turns(theta), Turns(phi)).expect("in range");
        for projection in Projection::ALL {
            let view = view.with_projection(projection);
            let line = format!("view {view}");
            prop_assert!(line.len() <= LINE_MAX);
            prop_assert_eq!(Command::parse(&line).map_err(|error| error.to_string()), Ok(Some(Setting::View { view }.into())));
        }
    }
}

#[track_caller]
fn assert_parses<'a>(line: &'a str, expected: impl Into<Command<'a>>) {
    assert_eq!(
        Command::parse(line).map_err(|error| error.to_string()),
        Ok(Some(expected.into()))
    );
}

#[test]
fn a_blank_line_is_no_command() {
    for line in ["", " \t "] {
        assert_eq!(Command::parse(line).expect("nothing to refuse"), None);
    }
}

#[test]
fn every_command_is_understood() {
    let degrees = |x: i32| Turns::from_degrees(x.into());
    assert_parses("help", Command::Help { command: None });
    assert_parses(
        "help view",
        Command::Help {
            command: Some("view"),
        },
    );
    assert_parses("info", Command::Info { key: None });
    assert_parses("info frame", Command::Info { key: Some("frame") });
    assert_parses("scene", Command::Scene { name: None });
    assert_parses(
        "  scene   menger ",
        Command::Scene {
            name: Some("menger"),
        },
    );
    assert_parses("object", Command::Show(OptionName::Object));
    let object = |line, action| assert_parses(line, Setting::Object { action });
    let place = |text| Place::parse(&mut Words::new(text)).expect("a place");
    object("object list", ObjectAction::List);
    object(
        "object add teapot scale 0.5 rotate z 30 move 1,0,-2 colour ff8000",
        ObjectAction::Add {
            mesh: "teapot",
            place: place("scale 0.5 rotate z 30 move 1,0,-2 colour ff8000"),
        },
    );
    for (line, next) in [
        ("object scale 3 2", "scale 2"),
        ("object scale 3 1,2,-3", "scale 1,2,-3"),
        ("object rotate 3 x -90", "rotate x -90"),
        ("object move 3 1,0.5,0", "move 1,0.5,0"),
        ("object matrix 3 1,0,0,0,1,0,0,0,2", "scale 1,1,2"),
        ("object matrix 3 1,0,0,0,1,0,0,0,1,3,2,1", "move 3,2,1"),
        ("object colour 3 00ff7f", "colour 00ff7f"),
    ] {
        let (number, next) = (3, place(next));
        object(line, ObjectAction::Change { number, next });
    }
    object("object remove 16", ObjectAction::Remove(Some(16)));
    object("object remove all", ObjectAction::Remove(None));
    assert_parses("field", Command::Show(OptionName::Field));
    assert_parses("field off", Setting::Field { field: None });
    assert_parses(
        "field menger:4",
        Setting::Field {
            field: Some(Field::from(Menger { depth: 4 })),
        },
    );
    assert_parses("stereo", Command::Show(OptionName::Stereo));
    assert_parses("stereo off", Setting::Stereo { eyes: None });
    let stereo = Stereo {
        half_separation: Q32_32::lit("0.05"),
        zero_parallax: Q32_32::lit("3"),
        tint: Tint::RedCyan,
    };
    assert_parses(
        "stereo 0.05,3,red-cyan",
        Setting::Stereo { eyes: Some(stereo) },
    );
    assert_parses("mesh", Command::Show(OptionName::Mesh));
    assert_parses("mesh on", Setting::Mesh { on: true });
    assert_parses("material", Command::Show(OptionName::Material));
    for (name, material) in Material::NAMES.into_iter().zip(Material::ALL) {
        assert_parses(&format!("material {name}"), Setting::Material { material });
    }
    assert_parses("light", Command::Show(OptionName::Light));
    assert_parses("light default", Setting::Light { light: None });
    let light = Light::new([1, -2, 3].map(Into::into), [0xFF, 0x80, 0x0A]).expect("a direction");
    assert_parses("light 1,-2,3,ff800a", Setting::Light { light: Some(light) });
    assert_parses("ambient", Command::Show(OptionName::Ambient));
    assert_parses("ambient default", Setting::Ambient { colour: None });
    assert_parses(
        "ambient 00ff7f",
        Setting::Ambient {
            colour: Some([0, 0xFF, 0x7F]),
        },
    );
    assert_parses("background", Command::Show(OptionName::Background));
    for (name, background) in [
        ("default", None),
        ("white", Some(Background::White)),
        ("sky", Some(Background::Sky)),
        ("102030", Some(Background::Colour([0x10, 0x20, 0x30]))),
    ] {
        assert_parses(
            &format!("background {name}"),
            Setting::Background { background },
        );
    }
    assert_parses("fog", Command::Show(OptionName::Fog));
    assert_parses("fog off", Setting::Fog { density: None });
    assert_parses(
        "fog 0.25",
        Setting::Fog {
            density: Some(U4_28::lit("0.25")),
        },
    );
    assert_parses("occlusion", Command::Show(OptionName::Occlusion));
    assert_parses("occlusion off", Setting::Occlusion { on: false });
    assert_parses("undecided on", Setting::Undecided { on: true });
    assert_parses("echo x-1", Command::Echo { word: "x-1" });
    let camera = Setting::Camera {
        r: Q32_32::lit("3.5"),
        theta: degrees(-90),
        phi: degrees(60),
    };
    assert_parses("camera 3.5 -90 60", camera);
    assert_parses("camera 3.5 270 60.0", camera);
    let numbers = "0 0 3 1 0 0 0 -1 0 0 0 -1 0.9 0.1";
    let view = View::new_checked(
        [0, 0, 3].map(Into::into),
        [1, 0, 0].map(Q2_23::from_num),
        [0, -1, 0].map(Q2_23::from_num),
        [0, 0, -1].map(Q2_23::from_num),
        "0.9".parse().expect("a number"),
        "0.1".parse().expect("a number"),
    );
    assert_parses("view", Command::Show(OptionName::View));
    assert_parses(
        &format!("view {numbers}"),
        Setting::View {
            view: view.expect("a camera"),
        },
    );
    let look = Setting::Look {
        yaw: degrees(10),
        pitch: degrees(-20),
        roll: degrees(30),
    };
    assert_parses("look 10 -20 30", look);
    let towards = |up: [i32; 3]| {
        let [eye, gaze, up] = [[3, 0, 1], [-3, 0, -1], up].map(|v| v.map(Q32_32::from_num));
        View::towards(eye, gaze, up).expect("in range")
    };
    let view = towards([0, 0, 1]);
    assert_parses("lookat 3 0 1 -3 0 -1", Setting::LookAt { view });
    let view = towards([0, 1, 0]);
    assert_parses("lookat 3 0 1 -3 0 -1 0 1 0", Setting::LookAt { view });
    let far = Some(U8_28::lit("2.5"));
    assert_parses("clip 2.5", Setting::Clip { far });
    assert_parses("clip off", Setting::Clip { far: None });
    let rule = Winding::Screen;
    assert_parses("winding screen", Setting::Winding { rule });
    let edges = Some(Edges::Hidden);
    assert_parses("edges hidden", Setting::Edges { edges });
    assert_parses("edges off", Setting::Edges { edges: None });
    assert_parses("edges", Command::Show(OptionName::Edges));
    let angle = degrees(150);
    assert_parses("fov 150", Setting::FieldOfView { angle });
    let factor = U8_28::from_num(1.5);
    assert_parses("zoom 1.5", Setting::Zoom { factor });
    assert_parses("fit", Setting::Fit { lens: None });
    let lens = Some((Axis::Y, None));
    assert_parses("fit y", Setting::Fit { lens });
    let lens = Some((Axis::Y, Some(degrees(60))));
    assert_parses("fit y 60", Setting::Fit { lens });
    let width = U8_28::from_num(3.5);
    assert_parses("orthographic 3.5", Setting::Orthographic { width });
    assert_parses("imu", Command::Imu { action: None });
    let imu = |line, action| {
        assert_parses(
            line,
            Command::Imu {
                action: Some(action),
            },
        )
    };
    imu("imu calibrate", ImuAction::Calibrate(8_192));
    imu("imu calibrate 100", ImuAction::Calibrate(100));
    imu("imu stream", ImuAction::Stream(None));
    imu("imu stream 5", ImuAction::Stream(Some(5)));
    imu("imu look", ImuAction::Follow(Some(Follow::Look)));
    imu("imu orbit", ImuAction::Follow(Some(Follow::Orbit)));
    imu("imu off", ImuAction::Follow(None));
    imu("imu recentre", ImuAction::Recentre);
    assert_parses("gesture", Command::Gesture { action: None });
    for action in GestureAction::ALL {
        assert_parses(
            &format!("gesture {action}"),
            Command::Gesture {
                action: Some(action),
            },
        );
    }
    assert_parses("mounting", Command::Mounting { mounting: None });
    assert_parses(
        "mounting -x z",
        Command::Mounting {
            mounting: Mounting::new(Direction::MinusX, Direction::Z),
        },
    );
    assert_parses("sensitivity", Command::Sensitivity { gain: None });
    assert_parses("sensitivity 0.125", Command::Sensitivity { gain: Some(32) });
    assert_parses("sensitivity 2.5", Command::Sensitivity { gain: Some(640) });
    assert_parses("orbit", Command::Orbit { frames: None });
    assert_parses("orbit 48", Command::Orbit { frames: Some(48) });
    assert_parses("quality", Command::Show(OptionName::Quality));
    for quality in Quality::ALL {
        assert_parses(&format!("quality {quality}"), Setting::Quality { quality });
    }
    assert_parses("size 320 180", Setting::Size { size: Size::W320 });
    assert_parses("size 640 360", Setting::Size { size: Size::W640 });
    assert_parses("size 1280 720", Setting::Size { size: Size::W1280 });
    assert_parses("frame", Command::Frame { depth: false });
    assert_parses("frame depth", Command::Frame { depth: true });
    assert_parses(
        "load 33554432 DEADbeef",
        Command::Load {
            upload: Manifest {
                length: 32 << 20,
                crc32: 0xDEAD_BEEF,
            },
            name: None,
        },
    );
    assert_parses(
        "load 16 0 icosphere:4",
        Command::Load {
            upload: Manifest {
                length: 16,
                crc32: 0,
            },
            name: Some("icosphere:4"),
        },
    );
    assert_parses("models", Command::Models {});
    assert_parses("unload teapot", Command::Unload { name: "teapot" });
    assert_parses(
        "program 256 0123abcd",
        Command::Program {
            upload: Some(Manifest {
                length: 256,
                crc32: 0x0123_ABCD,
            }),
        },
    );
    assert_parses("program", Command::Program { upload: None });
    assert_parses(
        "press up",
        Command::Press {
            key: Key::Up,
            rotate: false,
        },
    );
    assert_parses(
        "press left rotate",
        Command::Press {
            key: Key::Left,
            rotate: true,
        },
    );
    assert_parses(
        "load 0x10 0",
        Command::Load {
            upload: Manifest {
                length: 16,
                crc32: 0,
            },
            name: None,
        },
    );
    assert_parses("replay", Command::Replay { upload: None });
    assert_parses(
        "replay 64 1f",
        Command::Replay {
            upload: Some(Manifest {
                length: 64,
                crc32: 0x1F,
            }),
        },
    );
    assert_parses("render", Command::Render { depth: false });
    assert_parses("render depth", Command::Render { depth: true });
    assert_parses("cull on", Setting::Cull { on: true });
    assert_parses("overlay", Command::Show(OptionName::Overlay));
    assert_parses("overlay on", Setting::Overlay { on: true });
    assert_parses("prepass on", Setting::Prepass { on: true });
    assert_parses("prepass off", Setting::Prepass { on: false });
    assert_parses("cull off", Setting::Cull { on: false });
    assert_parses("stats", Command::Stats { json: false });
    assert_parses("stats json", Command::Stats { json: true });
    assert_parses("shading", Command::Show(OptionName::Shading));
    assert_parses(
        "shading flat",
        Setting::Shading {
            shading: Shading::Flat,
        },
    );
    assert_parses(
        "shading smooth",
        Setting::Shading {
            shading: Shading::Smooth,
        },
    );
    assert_parses("backend", Command::Show(OptionName::Backend));
    assert_parses(
        "backend cpu",
        Setting::Backend {
            backend: Backend::Cpu,
        },
    );
    assert_parses(
        "backend gateware",
        Setting::Backend {
            backend: Backend::Gateware,
        },
    );
    assert_parses("bench", Command::Bench { benchmark: None });
    assert_parses(
        "bench sine",
        Command::Bench {
            benchmark: Some(("sine", None)),
        },
    );
    assert_parses(
        "bench field 2",
        Command::Bench {
            benchmark: Some(("field", Some(2))),
        },
    );
    assert_parses("selftest", Command::SelfTest {});
    assert_parses("leds 65535", Command::Leds { value: 0xFFFF });
    assert_parses("leds 0x00ff", Command::Leds { value: 0xFF });
    assert_parses("buttons", Command::Buttons {});
    assert_parses("reboot", Command::Reboot {});
}
