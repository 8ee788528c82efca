//! Tests of the line editor: keys, history, completion and echo.

use glint_core::console::{Command, Event, HISTORY, LINE_MAX, LineEditor, NameList, Names};
use proptest::prelude::*;

/// The names of a machine with four uploads.
struct Known;

impl Names for Known {
    fn visit(&self, list: NameList, visit: &mut dyn FnMut(&str)) {
        let [meshes, textures, programs, built_in, scenes] = [
            &["hull", "hull-2"][..],
            &["wood"],
            &["ball.wfb"],
            &["cube", "torus"],
            &["cubes", "menger"],
        ];
        let names = match list {
            NameList::Scenes => [built_in, meshes, scenes].concat(),
            NameList::Meshes => [built_in, meshes].concat(),
            NameList::Textures => textures.to_vec(),
            NameList::Programs => programs.to_vec(),
            NameList::Uploads => [meshes, textures, programs].concat(),
        };
        names.into_iter().for_each(visit);
    }
}

/// A terminal that interprets the echo and keeps the text that it shows.
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

/// Sends bytes to the editor. Returns the reported lines and other events, and the screen.
fn type_in(bytes: &[u8]) -> (Vec<String>, Screen) {
    let (mut editor, mut screen, mut events) = (LineEditor::new(), Screen::default(), Vec::new());
    for &byte in bytes {
        match editor.on_byte(byte, &Known, &mut screen) {
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
    // The history keeps neither blank lines nor repeated lines.
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
fn a_deletion_in_an_overlong_line_does_not_make_it_a_line() {
    let longest = "x".repeat(LINE_MAX);
    assert_lines(format!("{longest}x\x7F\r").as_bytes(), &[&longest[1..]]);
}

#[test]
fn leftovers_of_sequences_do_no_harm() {
    assert_lines(b"\x80\xFF\xC3\xA9info\x1B\x1B[99;99z\x1Bx\x07\r", &["info"]);
}

#[test]
fn tab_completes_commands_and_the_words_of_their_arguments() {
    assert_lines(b"mat\t\r", &["material "]);
    assert_lines(b"mat\tgo\t\r", &["material gold "]);
    assert_lines(b"he\tcam\t\r", &["help camera "]);
    assert_lines(b"stats \t\r", &["stats json "]);
    assert_lines(b"imu c\t\r", &["imu calibrate "]);
    assert_lines(b"mounting -x -\tz\r", &["mounting -x -z"]);
    assert_lines(b"stereo \t\r", &["stereo off "]);
    assert_lines(b"background s\t\r", &["background sky "]);
    // Completion at the cursor keeps the text after the cursor.
    assert_lines(b" on\x01cul\t\r", &["cull  on"]);
    // Only the text that all candidates have in common is inserted.
    assert_lines(b"b\ten\t\r", &["bench "]);
    assert_lines(b"re\t\r", &["re"]);
    // Numbers, unknown commands and surplus arguments have no candidates.
    for line in ["leds 1", "cube x", "reboot x", "cull on o"] {
        assert_lines(format!("{line}\t\r").as_bytes(), &[line]);
    }
    let longest = "x".repeat(LINE_MAX - 6);
    assert_lines(
        format!("{longest} \x01mater\t\r").as_bytes(),
        &[&format!("mater{longest} ")],
    );
}

/// Names of scenes, meshes and fields, and the words after a keyword such as `off`.
#[test]
fn tab_completes_names() {
    assert_lines(b"scene me\t\r", &["scene menger "]);
    assert_lines(b"scene cu\ts\r", &["scene cubes"]);
    assert_lines(b"scene cubes\t\r", &["scene cubes "]);
    assert_lines(b"object a\tto\t\r", &["object add torus "]);
    assert_lines(b"unload h\t\t\r", &["unload hull"]);
    assert_lines(b"unload w\t\r", &["unload wood "]);
    assert_lines(b"program b\t\r", &["program ball.wfb "]);
    assert_lines(b"program 1 0 h\t\r", &["program 1 0 hull"]);
    assert_lines(b"load 1 0 w\t\r", &["load 1 0 wood "]);
    assert_lines(b"field men\t4\r", &["field menger:4"]);
    assert_lines(b"field of\t\r", &["field off "]);
    assert_lines(b"edges h\t\r", &["edges hidden "]);
    assert_lines(b"edges o\tv\t\r", &["edges over "]);
    let listed = |line: &[u8]| type_in(line).1.lines[1].clone();
    assert_eq!(listed(b"edges \t\r"), "off hidden over ");
    assert_eq!(listed(b"texture \t\r"), "own wood ");
    assert_eq!(listed(b"unload \t\r"), "hull hull-2 wood ball.wfb ");
    assert_eq!(
        listed(b"scene \t\r"),
        "cube torus hull hull-2 cubes menger "
    );
    let fields = listed(b"field \t\r");
    assert!(fields.starts_with("off menger: box: "), "{fields}");
}

/// A line that is printed above the prompt keeps a line that is being typed, but does not repeat a line that has ended.
#[test]
fn a_redrawn_line_is_the_one_being_typed() {
    let mut editor = LineEditor::new();
    let mut typed = |text: &str| {
        for byte in text.bytes() {
            editor.on_byte(byte, &Known, &mut String::new());
        }
        let mut screen = Screen::default();
        editor.redraw(&mut screen).unwrap();
        screen.line.into_iter().collect::<String>()
    };
    assert_eq!(typed("inf"), "glint> inf");
    assert_eq!(typed("o\x1B[D"), "glint> info");
    assert_eq!(typed("\r"), "glint> ");
    assert_eq!(typed("l"), "glint> l");
}

#[test]
fn tab_lists_candidates_that_have_nothing_more_in_common() {
    let (_, screen) = type_in(b"help re\t\r");
    assert_eq!(
        screen.lines,
        ["help re", "reboot replay render ", "glint> help re"]
    );
    let (_, screen) = type_in(b"shading \t\r");
    assert_eq!(screen.lines[1], "flat smooth ");
}

fn keys() -> impl Strategy<Value = Vec<u8>> {
    let key = prop_oneof![
        8 => "[a-z ]{1,4}".prop_map(String::into_bytes),
        1 => Just(b"\r".to_vec()),
        8 => proptest::sample::select(&[
            "\x08", "\x1B[3~", "\x1B[D", "\x1B[C", "\x1B[A", "\x1B[B", "\x01", "\x05", "\x0B", "\x15", "\x17", "\x0C", "\t", "\x1B[1;2C",
        ][..]).prop_map(|key| key.as_bytes().to_vec()),
    ];
    proptest::collection::vec(key, 0..60).prop_map(|keys| keys.concat())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// The function `type_in` compares every line with the line on the screen.
    #[test]
    fn what_is_shown_is_the_line(keys in keys()) {
        let (lines, screen) = type_in(&[&keys[..], b"\r"].concat());
        // The screen has additional lines, because Tab lists candidates on lines of their own.
        prop_assert!(lines.len() <= screen.lines.len());
    }

    #[test]
    fn noise_is_harmless(noise in proptest::collection::vec(any::<u8>(), 0..2_000)) {
        let (mut editor, mut echo) = (LineEditor::new(), String::new());
        for byte in noise {
            if let Event::Line(line) = editor.on_byte(byte, &Known, &mut echo) {
                let _ = Command::parse(line).map_err(|error| error.to_string());
            }
        }
        editor.on_byte(3, &Known, &mut echo);
        for byte in *b"info" {
            editor.on_byte(byte, &Known, &mut echo);
        }
        prop_assert_eq!(editor.on_byte(b'\r', &Known, &mut echo), Event::Line("info"));
    }
}
