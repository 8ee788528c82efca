//! The console: what is typed, what is shown, and what is understood.

use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::console::{Command, Event, HISTORY, ImuAction, LINE_MAX, LineEditor, write_help};
use glint_core::field::{Field, KINDS, Menger};
use glint_core::fixed::{Q2_23, Q32_32, Turns, U4_28};
use glint_core::follow::{Direction, Mounting};
use glint_core::imu::Follow;
use glint_core::light::{Background, Light, Material};
use glint_core::picture::{Backend, Size};
use glint_core::stereo::{Stereo, Tint};
use glint_core::wire::Manifest;
use proptest::prelude::*;

/// One line of a terminal.
#[derive(Default)]
struct Screen {
    line: Vec<char>,
    cursor: usize,
    sequence: String,
    lines: Vec<String>,
}

impl std::fmt::Write for Screen {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        for c in text.chars() {
            self.write(c);
        }
        Ok(())
    }
}

impl Screen {
    fn write(&mut self, c: char) {
        if !self.sequence.is_empty() {
            self.sequence.push(c);
            if c.is_ascii_alphabetic() {
                let sequence = std::mem::take(&mut self.sequence);
                let number = sequence[2..sequence.len() - 1].parse::<usize>();
                match c {
                    'D' => self.cursor -= number.expect("a number"),
                    'C' => self.cursor += number.expect("a number"),
                    'K' => self.line.truncate(self.cursor),
                    _ => panic!("unexpected sequence {sequence:?}"),
                }
                assert!(self.cursor <= self.line.len());
            }
            return;
        }
        match c {
            '\x1B' => self.sequence.push(c),
            '\r' => self.cursor = 0,
            '\n' => {
                self.lines.push(self.line.drain(..).collect());
                self.cursor = 0;
            }
            ' '..='~' => {
                if self.cursor == self.line.len() {
                    self.line.push(c);
                } else {
                    self.line[self.cursor] = c;
                }
                self.cursor += 1;
            }
            _ => panic!("unexpected character {c:?}"),
        }
    }
}

/// The lines that some bytes make, or what else comes of them, with what is shown.
fn type_in(bytes: &[u8]) -> (Vec<String>, Screen) {
    let (mut editor, mut screen, mut events) = (LineEditor::new(), Screen::default(), Vec::new());
    for &byte in bytes {
        match editor.on_byte(byte, &mut screen) {
            Event::None => {}
            Event::Line(line) => {
                assert!(
                    screen
                        .lines
                        .last()
                        .is_some_and(|shown| shown.ends_with(line)),
                    "{:?} {line:?}",
                    screen.lines
                );
                events.push(line.to_owned());
            }
            Event::Overlong => events.push("overlong".to_owned()),
            Event::Interrupt => events.push("interrupt".to_owned()),
        }
    }
    (events, screen)
}

#[track_caller]
fn assert_lines(bytes: &[u8], expected: &[&str]) {
    assert_eq!(type_in(bytes).0, expected);
}

#[test]
fn lines_end_with_cr_lf_or_both() {
    assert_lines(
        b"info\rstats\nhelp\r\n\n\r\rx\r",
        &["info", "stats", "help", "", "", "", "x"],
    );
}

#[test]
fn keys_edit_the_line() {
    assert_lines(b"infp\x08o\r", &["info"]);
    assert_lines(b"infp\x7Fo\r", &["info"]);
    assert_lines(b"\x08\x08a\r", &["a"]);
    assert_lines(b"ac\x1B[Db\r", &["abc"]);
    assert_lines(b"bc\x1B[Ha\x1B[Fd\r", &["abcd"]);
    assert_lines(b"bc\x1B[1~a\x1B[4~d\r", &["abcd"]);
    assert_lines(b"bc\x01a\x05d\r", &["abcd"]);
    assert_lines(b"bc\x1BOHa\x1BOFd\r", &["abcd"]);
    assert_lines(b"abc\x02\x02\x06\x0B\r", &["ab"]);
    assert_lines(b"abc\x1B[D\x1B[D\x1B[3~\r", &["ac"]);
    assert_lines(b"camera 3 4\x17\x175\r", &["camera 5"]);
    assert_lines(b"camera 3 4 \x17x\r", &["camera 3 x"]);
    assert_lines(b"some\x15info\r", &["info"]);
    assert_lines(b"an error\x1B[1;5D\x15\r", &["r"]);
    assert_lines(b"some\x03info\r", &["interrupt", "info"]);
    assert_lines(b"in\x0Cfo\r", &["info"]);
}

#[test]
fn the_history_brings_lines_back() {
    assert_lines(b"one\rtwo\r\x1B[A\r", &["one", "two", "two"]);
    assert_lines(b"one\rtwo\r\x1B[A\x1B[A\r", &["one", "two", "one"]);
    assert_lines(
        b"one\rtwo\r\x1B[A\x1B[A\x1B[A\x1B[B!\r",
        &["one", "two", "two!"],
    );
    assert_lines(b"one\rtyp\x10\x0Eed\r", &["one", "typed"]);
    assert_lines(b"\x1B[A\x1B[Bx\r", &["x"]);
    // Empty lines and repetitions are not remembered.
    assert_lines(
        b"one\r\r  \rtwo\rtwo\r\x1B[A\x1B[A\r",
        &["one", "", "  ", "two", "two", "one"],
    );
    let many: Vec<String> = (0..=HISTORY).map(|i| format!("line {i}\r")).collect();
    let (lines, _) =
        type_in(format!("{}{}\r", many.concat(), "\x1B[A".repeat(HISTORY + 5)).as_bytes());
    assert_eq!(lines.last().map(String::as_str), Some("line 1"));
}

#[test]
fn an_overlong_line_is_an_error_and_nothing_else_is_lost() {
    let longest = "x".repeat(LINE_MAX);
    assert_lines(format!("{longest}\rinfo\r").as_bytes(), &[&longest, "info"]);
    assert_lines(
        format!("{longest}x\rinfo\r").as_bytes(),
        &["overlong", "info"],
    );
    assert_lines(
        format!("{}\rinfo\r", longest.repeat(100)).as_bytes(),
        &["overlong", "info"],
    );
    assert_lines(format!("{longest}x\x7F\r").as_bytes(), &[&longest[1..]]);
}

#[test]
fn leftovers_of_a_transfer_and_noise_do_no_harm() {
    assert_lines(b"\0\x02\x13E\xF0\0info\r", &["info"]);
    assert_lines(
        b"\x80\xFF\xC3\xA9info\x1B\x1B[99;99z\x1Bx\t\x07\r",
        &["info"],
    );
    assert_lines(b"some\x1B[\rinfo\r", &["some", "info"]);
}

fn keys() -> impl Strategy<Value = Vec<u8>> {
    let key = prop_oneof![
        8 => "[a-z ]{1,4}".prop_map(String::into_bytes),
        1 => Just(b"\r".to_vec()),
        8 => proptest::sample::select(&[
            "\x08", "\x1B[3~", "\x1B[D", "\x1B[C", "\x1B[A", "\x1B[B", "\x01", "\x05", "\x0B", "\x15", "\x17", "\x0C", "\x1B[1;2C",
        ][..]).prop_map(|key| key.as_bytes().to_vec()),
    ];
    proptest::collection::vec(key, 0..60).prop_map(|keys| keys.concat())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// `type_in` compares every line with the screen.
    #[test]
    fn what_is_shown_is_the_line(keys in keys()) {
        let (lines, screen) = type_in(&[&keys[..], b"\r"].concat());
        prop_assert_eq!(lines.len(), screen.lines.len());
    }

    #[test]
    fn noise_is_harmless(noise in proptest::collection::vec(any::<u8>(), 0..2_000)) {
        let (mut editor, mut echo) = (LineEditor::new(), String::new());
        for byte in noise {
            if let Event::Line(line) = editor.on_byte(byte, &mut echo) {
                let _ = Command::parse(line).map_err(|error| error.to_string());
            }
        }
        editor.on_byte(3, &mut echo);
        for byte in *b"info" {
            editor.on_byte(byte, &mut echo);
        }
        prop_assert_eq!(editor.on_byte(b'\r', &mut echo), Event::Line("info"));
    }

    #[test]
    fn no_line_upsets_the_parser(line in any::<String>()) {
        let _ = Command::parse(&line).map_err(|error| error.to_string());
    }

    #[test]
    fn no_arguments_upset_the_parser(
        name in proptest::sample::select(&["field", "stereo", "material", "light", "ambient", "fog", "camera", "view", "look", "orbit", "size", "load", "leds", "help"][..]),
        words in proptest::collection::vec("(box:)?[-+]?[0-9a-fx_.,e]{0,12}", 0..16),
    ) {
        let line = format!("{name} {}", words.join(" "));
        let _ = Command::parse(&line).map_err(|error| error.to_string());
    }

    /// What the console prints for `view` sets the same view again.
    #[test]
    fn views_come_back_bit_for_bit(r in 2_i64 << 32..=5 << 32, theta in any::<u32>(), phi in 0..=1_u32 << 31) {
        let view = View::spherical(Q32_32::from_bits(r), Turns(theta), Turns(phi)).expect("in range");
        let line = format!("view {view}");
        prop_assert!(line.len() <= LINE_MAX);
        prop_assert_eq!(Command::parse(&line).map_err(|error| error.to_string()), Ok(Command::View(Some(view))));
    }
}

#[track_caller]
fn assert_parses(line: &str, expected: Command) {
    assert_eq!(
        Command::parse(line).map_err(|error| error.to_string()),
        Ok(expected)
    );
}

#[test]
fn every_command_is_understood() {
    let degrees = |x: i32| Turns::from_degrees(x.into());
    assert_parses("", Command::Empty);
    assert_parses(" \t ", Command::Empty);
    assert_parses("help", Command::Help(None));
    assert_parses("help view", Command::Help(Some("view")));
    assert_parses("info", Command::Info(None));
    assert_parses("info frame", Command::Info(Some("frame")));
    assert_parses("scene", Command::Scene(None));
    assert_parses("  scene   menger ", Command::Scene(Some("menger")));
    assert_parses("field", Command::Field(None));
    assert_parses("field off", Command::Field(Some(None)));
    assert_parses(
        "field menger:4",
        Command::Field(Some(Some(Field::from(Menger { depth: 4 })))),
    );
    assert_parses("stereo", Command::Stereo(None));
    assert_parses("stereo off", Command::Stereo(Some(None)));
    let stereo = Stereo {
        half_separation: Q32_32::lit("0.05"),
        zero_parallax: Q32_32::lit("3"),
        tint: Tint::RedCyan,
    };
    assert_parses(
        "stereo 0.05,3,red-cyan",
        Command::Stereo(Some(Some(stereo))),
    );
    assert_parses("mesh", Command::Mesh(None));
    assert_parses("mesh on", Command::Mesh(Some(true)));
    assert_parses("material", Command::Material(None));
    for (name, material) in Material::NAMES.into_iter().zip(Material::ALL) {
        assert_parses(
            &format!("material {name}"),
            Command::Material(Some(material)),
        );
    }
    assert_parses("light", Command::Light(None));
    assert_parses("light default", Command::Light(Some(None)));
    let light = Light::new([1, -2, 3].map(Into::into), [0xFF, 0x80, 0x0A]).expect("a direction");
    assert_parses("light 1,-2,3,ff800a", Command::Light(Some(Some(light))));
    assert_parses("ambient", Command::Ambient(None));
    assert_parses("ambient default", Command::Ambient(Some(None)));
    assert_parses(
        "ambient 00ff7f",
        Command::Ambient(Some(Some([0, 0xFF, 0x7F]))),
    );
    assert_parses("background", Command::Background(None));
    for (name, background) in Background::NAMES.into_iter().zip(Background::ALL) {
        assert_parses(
            &format!("background {name}"),
            Command::Background(Some(background)),
        );
    }
    assert_parses("fog", Command::Fog(None));
    assert_parses("fog off", Command::Fog(Some(U4_28::ZERO)));
    assert_parses("fog 0.25", Command::Fog(Some(U4_28::lit("0.25"))));
    assert_parses("occlusion", Command::Occlusion(None));
    assert_parses("occlusion off", Command::Occlusion(Some(false)));
    let camera = Command::Camera {
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
    assert_parses("view", Command::View(None));
    assert_parses(
        &format!("view {numbers}"),
        Command::View(Some(view.expect("a camera"))),
    );
    let look = Command::Look {
        yaw: degrees(10),
        pitch: degrees(-20),
        roll: degrees(30),
    };
    assert_parses("look 10 -20 30", look);
    assert_parses("imu", Command::Imu(None));
    let imu = |line, action| assert_parses(line, Command::Imu(Some(action)));
    imu("imu calibrate", ImuAction::Calibrate(8_192));
    imu("imu calibrate 100", ImuAction::Calibrate(100));
    imu("imu stream", ImuAction::Stream(None));
    imu("imu stream 5", ImuAction::Stream(Some(5)));
    imu("imu look", ImuAction::Follow(Some(Follow::Look)));
    imu("imu orbit", ImuAction::Follow(Some(Follow::Orbit)));
    imu("imu off", ImuAction::Follow(None));
    imu("imu recentre", ImuAction::Recentre);
    assert_parses("mounting", Command::Mounting(None));
    let mounting = |forward, up| Mounting::new(Direction::parse(forward)?, Direction::parse(up)?);
    assert_parses("mounting -x z", Command::Mounting(mounting("-x", "z")));
    assert_parses("sensitivity", Command::Sensitivity(None));
    assert_parses("sensitivity 0.125", Command::Sensitivity(Some(32)));
    assert_parses("sensitivity 2.5", Command::Sensitivity(Some(640)));
    assert_parses("orbit", Command::Orbit { frames: None });
    assert_parses("orbit 48", Command::Orbit { frames: Some(48) });
    assert_parses("size 320 180", Command::Size(Size::W320));
    assert_parses("size 640 360", Command::Size(Size::W640));
    assert_parses("size 1280 720", Command::Size(Size::W1280));
    assert_parses("frame", Command::Frame { depth: false });
    assert_parses("frame depth", Command::Frame { depth: true });
    assert_parses(
        "load 33554432 DEADbeef",
        Command::Load(Manifest {
            length: 32 << 20,
            crc32: 0xDEAD_BEEF,
        }),
    );
    assert_parses(
        "load 0x10 0",
        Command::Load(Manifest {
            length: 16,
            crc32: 0,
        }),
    );
    assert_parses("replay", Command::Replay(None));
    assert_parses(
        "replay 64 1f",
        Command::Replay(Some(Manifest {
            length: 64,
            crc32: 0x1F,
        })),
    );
    assert_parses("render", Command::Render { depth: false });
    assert_parses("render depth", Command::Render { depth: true });
    assert_parses("cull on", Command::Cull(true));
    assert_parses("prepass on", Command::Prepass(true));
    assert_parses("prepass off", Command::Prepass(false));
    assert_parses("cull off", Command::Cull(false));
    assert_parses("stats", Command::Stats { json: false });
    assert_parses("stats json", Command::Stats { json: true });
    assert_parses("shading", Command::Shading(None));
    assert_parses("shading flat", Command::Shading(Some(Shading::Flat)));
    assert_parses("shading smooth", Command::Shading(Some(Shading::Smooth)));
    assert_parses("backend", Command::Backend(None));
    assert_parses("backend cpu", Command::Backend(Some(Backend::Cpu)));
    assert_parses(
        "backend gateware",
        Command::Backend(Some(Backend::Gateware)),
    );
    assert_parses("bench", Command::Bench(None));
    assert_parses("bench sine", Command::Bench(Some("sine")));
    assert_parses("selftest", Command::SelfTest);
    assert_parses("leds 65535", Command::Leds(0xFFFF));
    assert_parses("leds 0x00ff", Command::Leds(0xFF));
    assert_parses("buttons", Command::Buttons);
    assert_parses("reboot", Command::Reboot);
}

#[track_caller]
fn assert_refused(line: &str, expected: &str) {
    assert_eq!(
        Command::parse(line).expect_err("a mistake").to_string(),
        expected
    );
}

#[test]
fn mistakes_are_named_with_their_place() {
    assert_refused(
        "  cube",
        "\"cube\" (column 3): expected a command, `help` lists them",
    );
    assert_refused(
        "help cube",
        "help: COMMAND is \"cube\" (column 6): expected a command, `help` lists them",
    );
    assert_refused(
        "buttons now",
        "buttons: \"now\" (column 9): expected the end of the line, as in `buttons`",
    );
    assert_refused(
        "camera 3 4",
        "camera: PHI is missing: expected a number of degrees from 0 to 180, as in `camera R THETA PHI`",
    );
    assert_refused(
        "camera 3 4 181",
        "camera: PHI is \"181\" (column 12): expected a number of degrees from 0 to 180",
    );
    assert_refused(
        "camera 3 x 5",
        "camera: THETA is \"x\" (column 10): expected a number of degrees",
    );
    assert_refused(
        "camera 1e300 0 0",
        "camera: R is \"1e300\" (column 8): expected a number",
    );
    assert_refused(
        "camera nan 0 0",
        "camera: R is \"nan\" (column 8): expected a number",
    );
    assert_refused(
        "size 1 2",
        "size: 1 x 2: expected 320 180, 640 360 or 1280 720",
    );
    assert_refused(
        "load -1 0",
        "load: BYTES is \"-1\" (column 6): expected a whole number from 0 to 33554432",
    );
    assert_refused(
        "load 5 123456789",
        "load: CRC32 is \"123456789\" (column 8): expected up to 8 hexadecimal digits",
    );
    assert_refused(
        "leds 65536",
        "leds: VALUE is \"65536\" (column 6): expected a whole number from 0 to 65535",
    );
    assert_refused(
        "cull",
        "cull: on|off is missing: expected on or off, as in `cull on|off`",
    );
    assert_refused(
        "stats xml",
        "stats: json is \"xml\" (column 7): expected json",
    );
    assert_refused(
        "frame depth 2",
        "frame: \"2\" (column 13): expected the end of the line, as in `frame [depth]`",
    );
    assert_refused(
        "view 0 0 3 1 0 0 0 2",
        "view: VY is \"2\" (column 20): expected a number from -2 to 2",
    );
    assert_refused(
        "view 0 0 3 1 0 0 0 1 0 0 0 -1 0.9 0.1",
        "view: u × v = −n: expected u × v = n (u right, v down, n forward)",
    );
    let error = Command::parse("field ball:1")
        .expect_err("a mistake")
        .to_string();
    assert!(error.starts_with("field: no field is named ball: expected menger:DEPTH, "));
    assert_refused("field menger:7", "field: depth: expected 1 to 6");
    assert_refused(
        "field box:1,1,1 on",
        "field: \"on\" (column 17): expected the end of the line, as in `field [off|FIELD]`",
    );
    assert_refused(
        "stereo 0.05",
        "stereo: 0.05: expected E,ZERO[,red-blue|red-cyan]",
    );
    assert_refused(
        "stereo 0.5,0.25",
        "stereo: ZERO 0.25: expected at least 0.5",
    );
    assert_refused(
        "material wood",
        "material: MATERIAL is \"wood\" (column 10): expected normal or clay or jade or sky or gold or ivory or slate",
    );
    assert_refused("light 1,2", "light: 1,2: expected X,Y,Z[,RRGGBB]");
    assert_refused(
        "light 0,0,0",
        "light: direction 0,0,0: expected one that is not 0",
    );
    assert_refused(
        "ambient fff",
        "ambient: default|RRGGBB is \"fff\" (column 9): expected default or a colour RRGGBB",
    );
    assert_refused(
        "mounting y -y",
        "mounting: FORWARD and UP are on the same axis: expected two that are perpendicular",
    );
    assert_refused(
        "sensitivity 8.5",
        "sensitivity: expected a number from 0.125 to 8",
    );
    assert_refused(
        "fog 16",
        "fog: off|DENSITY is \"16\" (column 5): expected off or a number from 0 to below 16",
    );
    assert_refused(
        &"\u{1}é".repeat(50),
        &format!(
            "\"{}...\" (column 1): expected a command, `help` lists them",
            "\\u{1}é".repeat(12)
        ),
    );
}

#[test]
fn the_help_lists_every_command_and_how_it_is_used() {
    let help = |command| {
        let mut text = String::new();
        write_help(&mut text, command).expect("a string takes everything");
        text
    };
    let list = help(None);
    for line in list.lines() {
        assert!(line.len() <= 120, "{line}");
    }
    for name in list
        .lines()
        .filter_map(|line| line.split_once("  "))
        .map(|(name, _)| name.trim())
    {
        let usage = help(Some(name));
        assert!(usage.starts_with(name), "{usage}");
        // The syntax is taken up to its first argument, and an error shows the same usage.
        let first = usage.lines().next().unwrap_or_default();
        if let Some(required) = first
            .split_once(' ')
            .filter(|(_, arguments)| !arguments.starts_with('['))
        {
            assert!(
                Command::parse(required.0)
                    .expect_err("incomplete")
                    .to_string()
                    .contains(first)
            );
        } else {
            assert!(Command::parse(name).is_ok(), "{name}");
        }
    }
    assert_eq!(list.lines().count(), 35);
    let field = help(Some("field"));
    assert!(
        KINDS.iter().all(|(form, _)| field.contains(form)),
        "{field}"
    );
    assert_eq!(
        help(Some("camera")),
        "camera R THETA PHI\n  looks at the origin from a distance of 2 to 5, by azimuth and angle from the z axis\n  \
         R: a number\n  THETA: a number of degrees\n  PHI: a number of degrees from 0 to 180\n"
    );
}
