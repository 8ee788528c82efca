//! Tests of the pictures on the monitor while scenes change.

use emulated_board::{EmulatedBoard, Frame};
use virtual_board::Uart;

use crate::firmware::{LIMIT, PROMPT, command, emulated, image};

/// Scenes of different sizes, engines and cameras, without motion.
const SCENES: [&str; 3] = ["default", "menger", "spheres"];

/// Maximum number of video frames until the last scene is shown.
const FRAMES: usize = 40;

fn is_black(frame: &Frame) -> bool {
    frame.pixels.iter().all(|colour| *colour == 0)
}

/// Checks that each video frame is one of the `whole` pictures, or black, which is allowed while the size changes. Ends when the picture
/// `last` follows another picture.
fn check(board: &mut EmulatedBoard, whole: &[Frame], last: usize) {
    let mut seen = Vec::new();
    for number in 0..FRAMES {
        let shown = board.capture();
        let found = whole.iter().position(|picture| *picture == shown);
        assert!(
            found.is_some() || is_black(&shown),
            "frame {number} is torn, after {seen:?}"
        );
        seen.extend(found);
        seen.dedup();
        if seen.len() > 1 && found == Some(last) {
            return;
        }
    }
    panic!("expected the scene {last} within {FRAMES} frames, found {seen:?}");
}

#[test]
fn no_torn_picture_is_shown_while_scenes_change() {
    let (mut board, _) = emulated(&image());
    let whole = SCENES.map(|scene| {
        command(&mut board, &format!("scene {scene}"));
        command(&mut board, "render");
        // The next video frame may still be the previous picture.
        board.capture();
        board.capture()
    });
    for (number, picture) in whole.iter().enumerate() {
        assert!(!whole[..number].contains(picture), "{}", SCENES[number]);
        assert!(!is_black(picture), "{}", SCENES[number]);
    }
    for round in 0..6 {
        command(&mut board, &format!("scene {}", SCENES[(round + 2) % 3]));
        board.capture();
        board.capture();
        // The commands are sent together: each waits until the previous picture is drawn, not until it is shown.
        let steps = 3 + round % 5;
        let scenes = (0..steps).chain([0]).map(|step| SCENES[(round + step) % 3]);
        for scene in scenes {
            board.uart_write(format!("scene {scene}\rrender\r").as_bytes());
        }
        check(&mut board, &whole, round % 3);
        for _ in 0..2 * (steps + 1) {
            board.read_until(PROMPT, LIMIT).expect("an answer");
        }
    }
}
