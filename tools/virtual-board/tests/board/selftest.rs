//! Tests of the command `selftest`: it finds plugged sensors, and reports faults. For the virtual board, a test of `glint` runs the
//! command, on a board that starts from its flash.

use crate::firmware::{address, command, emulated, image, patch};
use crate::sensor::{emulated_with_sensor, sensor};
use virtual_board::virtual_image_sensor::{ImageSensor, Model, Scene, Timing};
use virtual_board::virtual_mpu6050::{Fault, State};
use virtual_board::{Simulation, Uart};

/// All parts.
const PARTS: [&str; 15] = [
    "identity",
    "clock",
    "cycle counter",
    "memory",
    "imu",
    "camera",
    "scan-out",
    "triangle flat",
    "triangle smooth",
    "line",
    "raymarch sponge",
    "raymarch cubes",
    "raymarch spheres",
    "raymarch stereo",
    "underflow",
];

/// The result for the part `name`.
fn verdict<'a>(answer: &'a str, name: &str) -> &'a str {
    let key = format!("selftest {name} ");
    let mut lines = answer.lines();
    lines
        .find_map(|line| line.strip_prefix(&key))
        .unwrap_or_else(|| panic!("no {name} in {answer}"))
}

/// Checks that every part passes, except that the results of sensors are `sensors`, and that the standard gateware has no smooth shading.
fn check(answer: &str, sensors: &str) {
    for part in PARTS {
        let expected = match part {
            "imu" | "camera" => sensors,
            "triangle smooth" => "absent",
            _ => "ok",
        };
        assert_eq!(verdict(answer, part), expected, "{part}: {answer}");
    }
    let parts = answer.lines().filter(|line| line.starts_with("selftest "));
    assert_eq!(parts.count(), PARTS.len(), "{answer}");
    assert!(answer.ends_with("ok\r\nglint> "), "{answer}");
}

#[test]
fn plugged_sensors_pass() {
    let mut board = emulated_with_sensor(|_| State::default());
    let nothing = Scene::new([320, 240], |_| Vec::new());
    let timing = Timing::SHORT;
    board.plug_image_sensor(ImageSensor::new(Model::Ov7670, nothing, timing));
    let answer = command(&mut board, "selftest");
    check(&answer, "ok");
}

#[test]
fn sensors_that_are_not_plugged_are_absent() {
    let (mut board, _) = emulated(&image());
    check(&command(&mut board, "selftest"), "absent");
}

#[test]
fn an_unknown_sensor_and_a_picture_with_another_checksum_fail() {
    let mut image = image();
    // Moves an end of the last segment of the built-in wireframe program.
    let program = address(&["wireframe", "cube", "CUBE"]);
    patch(&mut image, program + 14 * 16, &[0x0800_0800]);
    let (mut board, _) = emulated(&image);
    let mut unknown = sensor(|_| State::default());
    unknown.chip.fault = Some(Fault::Identity(0x00));
    board.plug(unknown);
    // The search for a sensor is repeated every 30 ms.
    board.run(3_000_000);
    let answer = command(&mut board, "selftest");
    assert!(
        verdict(&answer, "imu").starts_with("FAILED: WHO_AM_I is 0x00: expected 0x68"),
        "{answer}"
    );
    let line = verdict(&answer, "line");
    assert!(
        line.starts_with("FAILED: checksum 0x") && line.contains(", expected 0x"),
        "{answer}"
    );
    assert_eq!(verdict(&answer, "triangle flat"), "ok", "{answer}");
    assert!(
        answer.ends_with("error: selftest: 2 failed, expected none\r\nglint> "),
        "{answer}"
    );
}
