//! Tests of the effects of commands on the picture.

use glint_core::console::{Command, Effect};

fn parse(line: &str) -> Command<'_> {
    Command::parse(line).unwrap().unwrap()
}

#[test]
fn commands_that_show_something_leave_the_picture() {
    let shown = "help, info, selftest, buttons, scene, models, field, mesh, stereo, object, material, light, ambient, highlight, shadow, background, \
        fog, occlusion, undecided, view, imu, mounting, sensitivity, replay, gesture, animate, quality, backend, shading, texture, edges, dither, overlay, \
        render, frame, stats, bench, demo, object list, imu calibrate, imu stream, gesture calibrate, gesture mask, overlay on, \
        demo on, reboot, leds 1, echo a";
    for line in shown.split(", ") {
        assert_eq!(parse(line).effect(), Effect::None, "{line}");
    }
}

#[test]
fn uploads_are_apart_from_settings() {
    for line in [
        "load 16 0",
        "unload a",
        "program 16 0",
        "program 16 0 a",
        "replay 16 0",
    ] {
        assert_eq!(parse(line).effect(), Effect::Uploads, "{line}");
    }
    let settings = "field off, object add a, object remove all, fov 60, zoom 2, fit, quality fast, size 320 180, backend cpu";
    for line in settings.split(", ") {
        let Command::Set(setting) = parse(line) else {
            panic!("{line} sets no option");
        };
        assert_eq!(parse(line).effect(), Effect::Option(&setting), "{line}");
    }
    assert_eq!(parse("scene a").effect(), Effect::Subject("a"));
    assert_eq!(parse("program").effect(), Effect::Wireframe(None));
    assert_eq!(parse("program a").effect(), Effect::Wireframe(Some("a")));
    for line in ["orbit", "imu look", "imu off", "gesture on"] {
        assert_eq!(parse(line).effect(), Effect::Motion, "{line}");
    }
}
