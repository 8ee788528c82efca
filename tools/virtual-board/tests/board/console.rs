//! Tests of the firmware's console: its output, word for word, and its behaviour with noise and long input.

use std::path::{Path, PathBuf};

use emulated_board::EmulatedBoard;
use glint_core::colour::Shading;
use virtual_board::{Simulation, Uart};

use crate::firmware::{Console, LIMIT, PROMPT, command, emulated, image, started};
use litex_pac::triangle::Counters;

/// Keys of output lines whose values depend on time.
const TIMES: [&str; 4] = [
    "cycles ",
    "cycles_soft_core ",
    "video_frames ",
    "uptime_ms ",
];

/// Console names of counters of the triangle engine whose values do not depend on time.
const COUNTS: [&str; 4] = ["vertices", "cycles_walking", "cycles_empty", "groups"];

/// Returns the console names of the triangle engine's counters, except counters of pixels, which are in all statistics.
fn counters() -> Vec<&'static str> {
    let all = Counters::default();
    let names = all.iter().map(|(name, _)| match name {
        "items_in" => "words_read",
        "items_out" => "words_written",
        name => name,
    });
    names.filter(|name| !name.starts_with("pixels_")).collect()
}

/// Returns `text` without the values that change between builds, and without the counters that depend on time. `clock_hz` is the
/// frequency of the board's clock.
fn lasting(text: &str, clock_hz: u32) -> String {
    let text = text
        .replace(&format!("{:#010x}", litex_pac::BUILD_ID), "BUILD_ID")
        .replace(&format!(", {} kHz", clock_hz / 1000), ", CLOCK kHz")
        .replace(&format!("clock {clock_hz}"), "clock CLOCK")
        .replace(&format!("\"clock\":{clock_hz}"), "\"clock\":CLOCK")
        .replace("\r\n", "\n");
    let line = |line: &str| match TIMES.iter().find(|key| line.starts_with(*key)) {
        Some(key) => format!("{key}…"),
        None => match line.split_once("\"cycles\":") {
            Some((before, rest)) => format!(
                "{before}\"cycles\":…{}",
                &rest[rest.find(',').unwrap_or(0)..]
            ),
            None => line.to_owned(),
        },
    };
    let counters = counters();
    let depends_on_time = |line: &&str| {
        let key = line.split(' ').next().unwrap_or_default();
        counters.contains(&key) && !COUNTS.contains(&key)
    };
    let lines = text.split('\n').filter(|line| !depends_on_time(line));
    lines.map(line).collect::<Vec<_>>().join("\n")
}

/// The committed transcript, and its path.
pub fn committed() -> (PathBuf, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/board/console.txt");
    let text = std::fs::read_to_string(&path).expect("the transcript");
    (path, text)
}

/// Sends the text after each prompt of `script` to a board that has printed `said`, and returns all output without time-dependent values.
fn replayed((mut board, said): (impl Console, String), script: &str) -> String {
    let mut transcript = said;
    for line in script.lines().filter_map(|line| line.strip_prefix(PROMPT)) {
        transcript += &command(&mut board, line);
    }
    for name in counters() {
        let key = format!("\r\n{name} ");
        assert!(transcript.contains(&key), "no counter {name}");
    }
    let end = transcript
        .strip_suffix(PROMPT)
        .expect("a prompt at the end");
    lasting(end, board.clock_hz())
}

/// Compares a transcript with the committed transcript, line by line.
fn check(found: &str, path: &Path, expected: &str) {
    for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "line {} of {}", number + 1, path.display());
    }
    let [found, expected] = [found, expected].map(|text| text.lines().count());
    assert_eq!(found, expected, "lines of {}", path.display());
}

/// Replays the committed transcript. With `GLINT_UPDATE` in the environment, rewrites the transcript.
#[test]
fn console_output_matches_the_transcript() {
    let (path, expected) = committed();
    let found = replayed(started(&image()), &expected);
    if std::env::var_os("GLINT_UPDATE").is_some() {
        std::fs::write(&path, &found).expect("the transcript can be written");
        return;
    }
    check(&found, &path, &expected);
}

/// Keys of lines that differ on the emulated board: it has its own name, and does not count groups
/// without covered pixels that the engine visits.
const GATEWARE: [&str; 3] = ["board ", "cycles_walking ", "cycles_empty "];

/// Replays the transcript on the emulated board, which is set to the shading and textures of the
/// virtual board's gateware, because the size of a descriptor depends on them.
#[test]
fn the_emulated_board_prints_the_transcript_too() {
    let (path, expected) = committed();
    let mut board = EmulatedBoard::fast(&image()).expect("an image that fits");
    board.state_shading(Shading::Flat);
    board.state_textures(false);
    let said = board.expect(PROMPT, "start");
    let common = |text: &str| {
        let lines = text.lines();
        let lines = lines.filter(|line| !GATEWARE.iter().any(|key| line.starts_with(key)));
        lines.collect::<Vec<_>>().join("\n")
    };
    let found = replayed((board, said), &expected);
    check(&common(&found), &path, &common(&expected));
}

#[test]
fn noise_and_overlong_lines_are_rejected_and_nothing_is_lost() {
    let (mut board, _) = emulated(&image());
    // Noise of all bytes except line ends and Ctrl-C: editing keys, partial characters and escape sequences.
    let noise = (0..500_u32).map(|index| (index.wrapping_mul(0x9e37_79b9) >> 24) as u8);
    board.uart_write(
        &noise
            .filter(|byte| !b"\r\n\x03".contains(byte))
            .collect::<Vec<_>>(),
    );
    // The zero byte clears the noise from the input line.
    board.uart_write(b"\0leds 7\r");
    board
        .read_until("leds 7\r\nok\r\nglint> ", LIMIT)
        .expect("an answer");
    assert_eq!(board.leds(), 7);
    board.uart_write(&[b'x'; 720]);
    let answer = command(&mut board, "");
    assert!(
        answer.ends_with("\r\nerror: line: expected at most 640 bytes\r\nglint> "),
        "{answer:?}"
    );
    // Twenty commands in one write all get a reply.
    board.uart_write(b"buttons\r".repeat(20).as_slice());
    for _ in 0..20 {
        let answer = board.read_until(PROMPT, LIMIT).expect("an answer");
        assert!(
            answer.ends_with("buttons 0x0\r\nswitches 0x0000\r\nok\r\nglint> "),
            "{answer}"
        );
    }
    assert!(command(&mut board, "info").contains("\r\nuart_lost 0\r\n"));
}

#[test]
fn pins_are_read_and_driven() {
    let (mut board, _) = emulated(&image());
    board.set_buttons(0b0101);
    board.set_switches(0xbeef);
    assert!(command(&mut board, "buttons").contains("buttons 0x5\r\nswitches 0xbeef\r\nok"));
    assert_eq!(board.leds(), 1, "only the heartbeat LED is lit");
    command(&mut board, "leds 42405");
    assert_eq!(board.leds(), 42405);
}

#[test]
fn a_still_scene_renders_nothing_and_a_change_is_rendered_once() {
    let (mut board, _) = started(&image());
    command(&mut board, "camera 3 10 80");
    command(&mut board, "render");
    // Fills both frame buffers and the depth buffer with a pattern, to detect later which of them were not drawn to.
    let windows = [0x4100_0000, 0x4120_0000, 0x4140_0000];
    for window in windows {
        board
            .ddr_write(window, &[0xa5; 320 * 180 * 2])
            .expect("main RAM");
    }
    let untouched = |board: &mut virtual_board::VirtualBoard, window| {
        let mut bytes = vec![0; 320 * 180 * 2];
        board.ddr_read(window, &mut bytes).expect("main RAM");
        bytes.iter().all(|byte| *byte == 0xa5)
    };
    // An unchanged camera must not start a frame; the wait is longer than the drawing of a frame.
    command(&mut board, "camera 3 10 80");
    board.run(1_500_000);
    assert!(
        windows
            .map(|window| untouched(&mut board, window))
            .iter()
            .all(|untouched| *untouched)
    );
    // A new camera starts a frame in the frame buffer that is not shown. Depths are not written, because they were not requested.
    command(&mut board, "camera 3 11 80");
    board.run(2_500_000);
    let [a, b, depth] = windows.map(|window| untouched(&mut board, window));
    assert!(a != b && depth);
}
