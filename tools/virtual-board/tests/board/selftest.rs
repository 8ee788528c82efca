//! Tests of the command `selftest`: it finds plugged sensors, and reports faults. For the virtual board, a test of `glint` runs the
//! command, on a board that starts from its flash.

use crate::firmware::{Console, PROMPT, address, command, emulated, image, patch, value};
use crate::sensor::{emulated_with_sensor, sensor};
use emulated_board::EmulatedBoard;
use glint_core::block::Block;
use glint_core::digits::segments;
use glint_core::flash::{CONTENTS, MAGIC};
use virtual_board::virtual_flash::Flash;
use virtual_board::virtual_image_sensor::{ImageSensor, Model, Scene, Timing};
use virtual_board::virtual_mpu6050::{Fault, State};
use virtual_board::{Simulation, Uart};

/// The parts that the self-test of the emulated board tests.
const PARTS: [&str; 21] = [
    "identity",
    "clock",
    "cycle counter",
    "memory",
    "flash",
    "digits",
    "imu",
    "camera",
    "scan-out",
    "triangle flat",
    "triangle smooth",
    "triangle average",
    "triangle texture",
    "line",
    "raymarch sponge",
    "raymarch cubes",
    "raymarch spheres",
    "raymarch stereo",
    "line texture",
    "raymarch texture",
    "underflow",
];

/// The result for the part `name`.
fn verdict<'a>(answer: &'a str, name: &str) -> &'a str {
    value(answer, &format!("selftest {name}"))
}

/// Checks that every part passes, except that the results of sensors are `sensors`.
fn check(answer: &str, sensors: &str) {
    for part in PARTS {
        let expected = match part {
            "imu" | "camera" => sensors,
            "digits" => "shows 1234 5678",
            // The flash is erased.
            "flash" => "absent",
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
    assert_eq!(
        board.digits(),
        ['1', '2', '3', '4', '5', '6', '7', '8'].map(segments)
    );
    // The digits show the state of the board again.
    board.run(4 * 81_250_000);
    assert_eq!(board.digits()[4..], [0; 4]);
}

#[test]
fn sensors_that_are_not_plugged_are_absent() {
    let (mut board, _) = emulated(&image());
    check(&command(&mut board, "selftest"), "absent");
}

/// The bytes of a flash as a CPU reads them if the lines 0 and 1 are exchanged.
fn exchanged(bytes: &[u8]) -> Vec<u8> {
    let bytes = bytes.iter();
    bytes
        .map(|byte| byte & 0xcc | (byte & 0x11) << 1 | (byte & 0x22) >> 1)
        .collect()
}

#[test]
fn exchanged_lines_of_the_flash_fail() {
    let mut flash = vec![0xff; CONTENTS];
    flash.extend(MAGIC);
    let (mut board, _) = emulated(&image());
    for (flash, expected) in [
        (
            exchanged(&flash),
            "FAILED: data of the lines 0 1 2 3 on the lines 1 0 2 3, expected the same order",
        ),
        (flash, "ok"),
    ] {
        board.plug_flash(Flash::new(flash));
        let answer = command(&mut board, "selftest");
        assert_eq!(verdict(&answer, "flash"), expected);
    }
}

/// A build for a scene may lack the I2C master and the digits.
#[test]
fn blocks_that_the_gateware_lacks_are_absent() {
    let lacks = [Block::I2C, Block::Digits, Block::Flash];
    let has = Block::ALL.iter().filter(|block| !lacks.contains(block));
    let mut board = EmulatedBoard::fast(&image()).unwrap();
    board.state_blocks(has.map(|block| block.bit()).sum());
    board.plug(sensor(|_| State::default()));
    board.expect(PROMPT, "start");
    let answer = command(&mut board, "selftest");
    for part in ["imu", "digits", "flash"] {
        assert_eq!(verdict(&answer, part), "absent", "{part}: {answer}");
    }
    assert!(answer.ends_with("ok\r\nglint> "), "{answer}");
    let error = "i2c: this gateware has no master";
    for line in ["imu", "imu calibrate", "imu stream 1"] {
        let answer = command(&mut board, line);
        assert!(answer.contains(error), "{answer}");
    }
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
