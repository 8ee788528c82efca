//! Tests of every command with its arguments.

use glint_core::camera::{Lens, Projection, Sides, View, ViewVolume};
use glint_core::colour::Rgb565;
use glint_core::console::{Command, GestureAction, LINE_MAX, ObjectAction, Setting, write_help};
use glint_core::field::{Field, Menger};
use glint_core::fixed::{Q2_23, Q4_28, Q8_24, Q32_32, Turns, U4_28, U8_28};
use glint_core::light::{Light, Material};
use glint_core::matrix::{Axis, Matrix};
use glint_core::object::Place;
use glint_core::quality::Quality;
use glint_core::steering::{Direction, Mounting};
use glint_core::stereo::{Stereo, Tint};
use glint_core::words::Words;
use proptest::prelude::*;

/// The names of all commands, as the help lists them.
fn names() -> Vec<String> {
    let mut help = String::new();
    write_help(&mut help, None).expect("strings take all text");
    let names = help.lines().filter_map(|line| line.split(' ').next());
    names.map(str::to_owned).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_line_upsets_the_parser(line in any::<String>()) {
        let _ = Command::parse(&line).map_err(|error| error.to_string());
    }

    #[test]
    fn no_arguments_upset_the_parser(
        name in proptest::sample::select(names()),
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
    fn views_come_back_bit_for_bit(
        r in 2_i64 << 32..=5 << 32, theta in any::<u32>(), phi in 0..=1_u32 << 31,
        half in [1_u64 << 24..1 << 34, 1 << 24..1 << 34], middle in [-6_i32 << 28..=6 << 28, -6 << 28..=6 << 28], is_centred in any::<bool>(),
    ) {
        let view = View::spherical(Q32_32::from_bits(r), Turns(theta), Turns(phi)).expect("in range");
        let middle = middle.map(|x| Q4_28::from_bits(if is_centred { 0 } else { x }));
        for projection in Projection::ALL {
            let view = view.with_projection(projection);
            let lens = Lens::window(projection, half.map(U8_28::from_bits), middle.map(Into::into), view.near()).expect("in range");
            let wide = view.with_lens(lens);
            let line = format!("view {wide}");
            prop_assert!(line.len() <= LINE_MAX);
            prop_assert_eq!(Command::parse(&line).map_err(|error| error.to_string()), Ok(Some(Setting::View { view: wide }.into())));
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

/// Lines, and the Debug forms of their commands.
const SIMPLE: &str = r#"
help => Help { command: None }
help view => Help { command: Some("view") }
info => Info { key: None }
info frame => Info { key: Some("frame") }
scene => Scene { name: None }
  scene   menger  => Scene { name: Some("menger") }
object => Show(Object)
object list => Set(Object { action: List })
object remove 16 => Set(Object { action: Remove(Some(16)) })
object remove all => Set(Object { action: Remove(None) })
field => Show(Field)
field off => Set(Field { field: None })
stereo => Show(Stereo)
stereo off => Set(Stereo { eyes: None })
aa => Show(Antialiasing)
aa 4 => Set(Antialiasing { samples: Some(Four) })
aa default => Set(Antialiasing { samples: None })
mesh => Show(Mesh)
mesh on => Set(Mesh { on: true })
material => Show(Material)
light => Show(Light)
light default => Set(Light { light: None })
ambient => Show(Ambient)
ambient default => Set(Ambient { colour: None })
ambient 00ff7f => Set(Ambient { colour: Some([0, 255, 127]) })
highlight => Show(Highlight)
highlight off => Set(Highlight { highlight: None })
highlight 0.25,9 => Set(Highlight { highlight: Some(Highlight { strength: 250, exponent: 9 }) })
shadow => Show(Shadow)
shadow on => Set(Shadow { on: true })
background => Show(Background)
background default => Set(Background { background: None })
background white => Set(Background { background: Some(White) })
background sky => Set(Background { background: Some(Sky) })
background gradient => Set(Background { background: Some(Gradient) })
background 102030 => Set(Background { background: Some(Colour([16, 32, 48])) })
fog => Show(Fog)
fog off => Set(Fog { density: None })
occlusion => Show(Occlusion)
occlusion off => Set(Occlusion { on: false })
undecided on => Set(Undecided { on: true })
echo x-1 => Echo { word: "x-1" }
view => Show(View)
clip off => Set(Clip { far: None })
winding screen => Set(Winding { rule: Screen })
textures off => Set(Textures { on: false })
texture => Show(Texture)
texture own => Set(Texture { texture: None })
texture wood.png => Set(Texture { texture: Some("wood.png") })
edges => Show(Edges)
edges hidden => Set(Edges { edges: Some(Hidden) })
edges off => Set(Edges { edges: None })
fit => Set(Fit { lens: None })
fit y => Set(Fit { lens: Some((Y, None)) })
imu => Imu { action: None }
imu calibrate => Imu { action: Some(Calibrate(8192)) }
imu calibrate 100 => Imu { action: Some(Calibrate(100)) }
imu stream => Imu { action: Some(Stream(None)) }
imu stream 5 => Imu { action: Some(Stream(Some(5))) }
imu look => Imu { action: Some(Follow(Some(Look))) }
imu orbit => Imu { action: Some(Follow(Some(Orbit))) }
imu off => Imu { action: Some(Follow(None)) }
imu recentre => Imu { action: Some(Recentre) }
gesture => Gesture { action: None }
mounting => Mounting { mounting: None }
sensitivity => Sensitivity { gain: None }
sensitivity 0.125 => Sensitivity { gain: Some(32) }
sensitivity 2.5 => Sensitivity { gain: Some(640) }
orbit => Orbit { frames: None }
orbit 48 => Orbit { frames: Some(48) }
animate => Show(Animate)
animate off => Set(Animate { animation: Animation { azimuth: Rate(0), orbit: Rate(0), turn: None } })
animate azimuth 30 orbit -7.5 => Set(Animate { animation: Animation { azimuth: Rate(30), orbit: Rate(-7.5), turn: None } })
animate turn z 45 => Set(Animate { animation: Animation { azimuth: Rate(0), orbit: Rate(0), turn: Some(ObjectTurn { object: None, axis: Z, rate: Rate(45) }) } })
animate turn 16 y -360 => Set(Animate { animation: Animation { azimuth: Rate(0), orbit: Rate(0), turn: Some(ObjectTurn { object: Some(16), axis: Y, rate: Rate(-360) }) } })
animate turn x 0 => Set(Animate { animation: Animation { azimuth: Rate(0), orbit: Rate(0), turn: None } })
quality => Show(Quality)
size 320 180 => Set(Size { size: W320 })
size 640 360 => Set(Size { size: W640 })
size 1280 720 => Set(Size { size: W1280 })
frame => Frame { depth: false }
frame depth => Frame { depth: true }
load 33554432 DEADbeef => Load { upload: Manifest { length: 33554432, crc32: 3735928559 }, name: None }
load 16 0 icosphere:4 => Load { upload: Manifest { length: 16, crc32: 0 }, name: Some("icosphere:4") }
load 0x10 0 => Load { upload: Manifest { length: 16, crc32: 0 }, name: None }
models => Models
unload teapot => Unload { name: "teapot" }
program => Program { action: None }
program cube.wfb => Program { action: Some(Show("cube.wfb")) }
program 256 0123abcd => Program { action: Some(Upload { manifest: Manifest { length: 256, crc32: 19114957 }, name: None }) }
program 256 0123abcd ball => Program { action: Some(Upload { manifest: Manifest { length: 256, crc32: 19114957 }, name: Some("ball") }) }
press up => Press { key: Up, rotate: false }
press left rotate => Press { key: Left, rotate: true }
replay => Replay { upload: None }
replay 64 1f => Replay { upload: Some(Manifest { length: 64, crc32: 31 }) }
render => Render { depth: false }
render depth => Render { depth: true }
cull on => Set(Cull { on: true })
cull off => Set(Cull { on: false })
dither => Show(Dither)
dither off => Set(Dither { on: false })
overlay => Show(Overlay)
overlay on => Set(Overlay { on: true })
prepass on => Set(Prepass { on: true })
prepass off => Set(Prepass { on: false })
stats => Stats { json: false }
stats json => Stats { json: true }
shading => Show(Shading)
shading flat => Set(Shading { shading: Flat })
shading smooth => Set(Shading { shading: Smooth })
backend => Show(Backend)
backend cpu => Set(Backend { backend: Cpu })
backend gateware => Set(Backend { backend: Gateware })
bench => Bench { benchmark: None }
bench sine => Bench { benchmark: Some(("sine", None)) }
bench field 2 => Bench { benchmark: Some(("field", Some(2))) }
selftest => SelfTest
leds 65535 => Leds { value: 65535 }
leds 0x00ff => Leds { value: 255 }
buttons => Buttons
reboot => Reboot
"#;

#[test]
fn simple_commands_are_understood() {
    for (line, form) in SIMPLE.lines().filter_map(|line| line.split_once(" => ")) {
        let command = Command::parse(line).map_err(|error| error.to_string());
        assert_eq!(
            format!("{command:?}"),
            format!("Ok(Some({form}))"),
            "{line}"
        );
    }
}

#[test]
fn names_of_variants_are_understood() {
    for (name, material) in Material::NAMES.into_iter().zip(Material::ALL) {
        assert_parses(&format!("material {name}"), Setting::Material { material });
    }
    for action in GestureAction::ALL {
        let line = format!("gesture {action}");
        let action = Some(action);
        assert_parses(&line, Command::Gesture { action });
    }
    for quality in Quality::ALL {
        assert_parses(&format!("quality {quality}"), Setting::Quality { quality });
    }
}

#[test]
fn commands_of_objects_are_understood() {
    let object = |line, action| assert_parses(line, Setting::Object { action });
    let place = |text| Place::parse(&mut Words::new(text)).expect("a place");
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
}

#[test]
fn numbers_and_angles_are_understood() {
    let degrees = |x: i32| Turns::from_degrees(x.into());
    let field = Some(Field::from(Menger { depth: 4 }));
    assert_parses("field menger:4", Setting::Field { field });
    let eyes = Some(Stereo {
        half_separation: Q32_32::lit("0.05"),
        zero_parallax: Q32_32::lit("3"),
        tint: Tint::RedCyan,
    });
    assert_parses("stereo 0.05,3,red-cyan", Setting::Stereo { eyes });
    let light = Light::new([1, -2, 3].map(Into::into), [0xFF, 0x80, 0x0A]).expect("a direction");
    assert_parses("light 1,-2,3,ff800a", Setting::Light { light: Some(light) });
    let density = Some(U4_28::lit("0.25"));
    assert_parses("fog 0.25", Setting::Fog { density });
    let camera = Setting::Camera {
        r: Q32_32::lit("3.5"),
        theta: degrees(-90),
        phi: degrees(60),
    };
    assert_parses("camera 3.5 -90 60", camera);
    assert_parses("camera 3.5 270 60.0", camera);
    let view = View::new_checked(
        [0, 0, 3].map(Into::into),
        [1, 0, 0].map(Q2_23::from_num),
        [0, -1, 0].map(Q2_23::from_num),
        [0, 0, -1].map(Q2_23::from_num),
        "0.9".parse().expect("a number"),
        "0.1".parse().expect("a number"),
    )
    .expect("a camera");
    let line = "view 0 0 3 1 0 0 0 -1 0 0 0 -1 0.9 0.1";
    assert_parses(line, Setting::View { view });
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
    let angle = degrees(150);
    assert_parses(
        "fov 150",
        Setting::FieldOfView {
            angles: (angle, None),
        },
    );
    let angles = (angle, Some(Turns::from_degrees(Q32_32::lit("112.5"))));
    assert_parses("fov 150 112.5", Setting::FieldOfView { angles });
    let [left, right, bottom, top] = ["-0.2", "0.1", "-0.1", "0.15"].map(Q32_32::lit);
    let sides = Sides {
        left,
        right,
        bottom,
        top,
    };
    for (kind, projection) in [
        ("perspective", Projection::Perspective),
        ("orthographic", Projection::Orthographic),
    ] {
        for (word, far) in [("", None), (" 7", Some(U8_28::lit("7")))] {
            let volume =
                ViewVolume::of_sides(projection, sides, U4_28::lit("0.1"), far).expect("a volume");
            let line = format!("projection {kind} -0.2 0.1 -0.1 0.15 0.1{word}");
            assert_parses(&line, Setting::Projection { volume });
        }
    }
    let matrix = [[2, 0, 0, 0], [0, 3, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        .map(|row| row.map(Q32_32::from_num));
    let volume = ViewVolume::of_matrix(&matrix).expect("a projection");
    assert_parses(
        "projection matrix 2 0 0 0 0 3 0 0 0 0 -1 -1 0 0 -1 0",
        Setting::Projection { volume },
    );
    assert_parses(
        "near 0.5",
        Setting::Near {
            distance: U4_28::lit("0.5"),
        },
    );
    let factor = U8_28::from_num(1.5);
    assert_parses("zoom 1.5", Setting::Zoom { factor });
    let lens = Some((Axis::Y, Some(degrees(60))));
    assert_parses("fit y 60", Setting::Fit { lens });
    let width = U8_28::from_num(3.5);
    assert_parses("orthographic 3.5", Setting::Orthographic { width });
    let mounting = Mounting::new(Direction::MinusX, Direction::Z);
    assert_parses("mounting -x z", Command::Mounting { mounting });
}
