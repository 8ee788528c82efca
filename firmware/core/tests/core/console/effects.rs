//! What commands do to the picture.

use glint_core::block::Block;
use glint_core::console::{Command, Effect};
use glint_core::scene::{Reason, blocks, commands};

fn parse(line: &str) -> Command<'_> {
    Command::parse(line).unwrap().unwrap()
}

#[test]
fn commands_that_show_something_leave_the_picture() {
    let shown = "help info selftest buttons scene models field mesh stereo object material light \
        ambient background fog occlusion undecided view imu mounting sensitivity replay gesture \
        quality backend shading edges overlay render frame stats bench demo";
    for line in shown.split(' ') {
        assert_eq!(parse(line).effect(), Effect::None, "{line}");
    }
    for line in [
        "object list",
        "imu calibrate",
        "imu stream",
        "gesture calibrate",
        "gesture mask",
        "overlay on",
        "demo on",
        "reboot",
        "leds 1",
        "echo a",
    ] {
        assert_eq!(parse(line).effect(), Effect::None, "{line}");
    }
}

#[test]
fn uploads_are_apart_from_settings() {
    for line in ["load 16 0", "unload a", "program 16 0", "replay 16 0"] {
        assert_eq!(parse(line).effect(), Effect::Uploads, "{line}");
    }
    for line in [
        "scene a",
        "program",
        "field off",
        "object add a",
        "object remove all",
        "orbit",
        "imu look",
        "imu off",
        "gesture on",
        "fov 60",
        "zoom 2",
        "fit",
        "quality fast",
        "size 320 180",
        "backend cpu",
    ] {
        assert_eq!(parse(line).effect(), Effect::Picture, "{line}");
    }
}

#[test]
fn scenes_need_the_blocks_of_their_commands() {
    let needed = |text: &'static str| blocks(commands(text).map(|command| command.unwrap().1));
    let bits = |blocks: &[Block]| blocks.iter().fold(1, |bits, block| bits | block.bit());
    assert_eq!(needed("size 640 360"), bits(&[Block::Scanout]));
    assert_eq!(
        needed("scene a\nmesh on\nfield menger:2"),
        bits(&[Block::Triangle, Block::Raymarch])
    );
    assert_eq!(needed("program"), bits(&[Block::Triangle, Block::Line]));
    assert_eq!(
        needed("object add a\ngesture on"),
        bits(&[Block::Triangle, Block::Gesture])
    );
    assert_eq!(
        needed("backend cpu\nscene a\ngesture on"),
        bits(&[Block::Gesture])
    );
}

#[test]
fn other_lines_are_no_scene() {
    let error = |text: &'static str| {
        let error = commands(text).find_map(Result::err).unwrap();
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
