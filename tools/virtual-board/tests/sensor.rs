//! The SoC's I2C master and a virtual MPU-6050 on its pins.

mod firmware;
mod program;

use firmware::{PROMPT, command, image};
use litex_pac::{i2c, leds};
use virtual_board::virtual_mpu6050::{Chip, Fault, Imperfections, Source, State, Wires};
use virtual_board::{Start, VirtualBoard};

/// Cycles of a transaction of five bytes, and a good deal more.
const ROUND: u64 = 20_000;

/// Cycles of a millisecond.
const MILLISECOND: u64 = 81_250;

fn sensor(motion: fn(f64) -> State) -> Wires {
    // Noise as of a specimen, and nothing that would have to be calibrated.
    let imperfections = Imperfections {
        noise: 0.005,
        accel_noise: 0.0004,
        ..Imperfections::NONE
    };
    Wires::new(Chip::new(
        Source::Motion(Box::new(motion)),
        imperfections,
        1,
    ))
}

#[test]
fn a_program_reads_the_sensor_through_the_pins() {
    // SAFETY: only addresses are asked for.
    let (i2c, leds) = unsafe { (i2c::I2c::steal(), leds::Leds::steal()) };
    let firmware = program::assemble(
        "i2c",
        &[
            ("COMMAND", i2c.command().address() as u32),
            ("ANSWER", i2c.answer().address() as u32),
            ("LEDS_OUT", leds.out().address() as u32),
        ],
    );
    let start = Start::Fast {
        firmware: &firmware,
    };
    let mut board = VirtualBoard::builder()
        .start(start)
        .build()
        .expect("a virtual board");
    let mut sensor = sensor(|_| State::default());
    sensor.log = Some(Vec::new());
    board.plug(sensor);
    board.run(ROUND);
    assert_eq!(board.leds(), 0x168);
    board
        .sensor()
        .expect("the sensor")
        .set_fault(Some(Fault::Identity(0x70)));
    board.run(2 * ROUND);
    assert_eq!(board.leds(), 0x170);
    let sensor = board.unplug().expect("the sensor");
    let log = sensor.log.unwrap_or_default().join(" ");
    assert!(log.starts_with("S d0+ 75+ S d1+ 68- P S"), "{log}");
    let violations = sensor.violations;
    assert!(violations.is_empty(), "{violations:#?}");
}

/// At rest but for a turn of 45° to the left, from 0.03 s on in 0.05 s.
fn turn(time: f64) -> State {
    let turns = (0.03..0.08).contains(&time);
    State {
        rate: [0.0, 0.0, if turns { 900.0 } else { 0.0 }],
        ..State::default()
    }
}

/// What the angle of that turn may be off by, in degrees: the times of samples are right within 0.15 ms (docs/imu.md), those at its
/// beginning and at its end.
const ANGLE: f64 = 900.0 * 2.0 * 0.15e-3;

/// The line of `key` in an answer.
fn line<'a>(answer: &'a str, key: &str) -> &'a str {
    let mut lines = answer.lines();
    lines
        .find_map(|line| line.strip_prefix(key)?.strip_prefix(' '))
        .unwrap_or_else(|| panic!("no {key} in {answer}"))
}

fn numbers(text: &str) -> Vec<f64> {
    let words = text.split(' ');
    words.map(|word| word.parse().expect("a number")).collect()
}

/// A board with a sensor that a program before this one has set up: a reset would take a tenth of a second.
fn board_with_sensor(motion: fn(f64) -> State) -> VirtualBoard {
    let image = image();
    let start = Start::Fast { firmware: &image };
    let mut board = VirtualBoard::builder()
        .start(start)
        .build()
        .expect("a virtual board");
    let mut sensor = sensor(motion);
    for (register, value) in [
        (0x6b, 0x01),
        (0x19, 0x01),
        (0x1a, 0x02),
        (0x1b, 0x18),
        (0x1c, 0x10),
        (0x38, 0x01),
    ] {
        sensor.chip.write(register, value);
    }
    board.plug(sensor);
    board.read_until(PROMPT, firmware::LIMIT).expect("a prompt");
    board
}

#[test]
fn the_camera_follows_the_sensor_and_a_lost_one_is_found_again() {
    let mut board = board_with_sensor(turn);
    command(&mut board, "imu look");
    board.run((90 * MILLISECOND).saturating_sub(board.cycles()));
    let status = command(&mut board, "imu");
    assert_eq!(line(&status, "sensor"), "MPU-6050");
    assert_eq!(line(&status, "failure"), "none");
    assert_eq!(line(&status, "failures"), "0");
    let samples: u32 = line(&status, "samples").parse().expect("a number");
    assert!((40..45).contains(&samples), "{status}");
    let angles = numbers(line(&status, "angles"));
    assert!((angles[0] - 45.0).abs() < ANGLE, "{status}");
    // The picture's camera is the attitude, as soon as there is a frame for it.
    board.run(35 * MILLISECOND);
    let view = command(&mut board, "view");
    let view = numbers(line(&view, "view"));
    let (sine, cosine) = 45_f64.to_radians().sin_cos();
    for (found, expected) in view[9..12].iter().zip([-sine, cosine, 0.0]) {
        assert!((found - expected).abs() < ANGLE.to_radians(), "{view:?}");
    }
    // Pulled out and put back; the attitude is held.
    let sensor = board.unplug().expect("the sensor");
    board.run(15 * MILLISECOND);
    let status = command(&mut board, "imu");
    assert_eq!(
        line(&status, "failure"),
        "i2c: no device acknowledged the address"
    );
    let refused = command(&mut board, "imu calibrate");
    assert!(
        refused.contains("error: imu calibrate: i2c: no device acknowledged the address"),
        "{refused}"
    );
    board.plug(sensor);
    board.run(40 * MILLISECOND);
    let status = command(&mut board, "imu");
    assert_eq!(line(&status, "failure"), "none");
    let angles = numbers(line(&status, "angles"));
    assert!((angles[0] - 45.0).abs() < ANGLE, "{status}");
    let answer = command(&mut board, "info video_underflows");
    assert_eq!(line(&answer, "video_underflows"), "0");
    let cycles = |key| line(&status, key).parse::<u32>().expect("a number");
    let [read, tracked] = ["cycles_read", "cycles_tracked"].map(cycles);
    println!("cycles a sample: {read} to read it, {tracked} to make an attitude of it");
    assert!(read < 10_000, "6 % of 2 ms: {status}");
    assert!(tracked < 6_000, "4 % of 2 ms: {status}");
    let violations = board.unplug().expect("the sensor").violations;
    assert!(violations.is_empty(), "{violations:#?}");
}

/// Each fault on the board: told on the console, and over within its time. Some 1.5 s of the board's time: with `GLINT_IMU_FAULTS` only.
#[test]
fn every_fault_is_told_and_survived() {
    if std::env::var_os("GLINT_IMU_FAULTS").is_none() {
        return;
    }
    let mut board = board_with_sensor(|_| State::default());
    command(&mut board, "imu orbit");
    board.run(20 * MILLISECOND);
    let failures = |board: &mut VirtualBoard| {
        let status = command(board, "imu");
        let number = |key| line(&status, key).parse::<u32>().expect("a number");
        let failure = line(&status, "failure").to_owned();
        (failure, number("failures"), number("samples"))
    };
    let gone = "i2c: no device acknowledged the address";
    // What is wrong, the ms until it is told, the ms until it is over, and what is told.
    let faults: [(Option<Fault>, u64, u64, &str); 8] = [
        (Some(Fault::Absent), 10, 100, gone),
        (
            Some(Fault::NoAcknowledge),
            10,
            100,
            "i2c: the device did not acknowledge a byte",
        ),
        (
            Some(Fault::StuckData(0)),
            10,
            100,
            "i2c: SDA is held low and nine clocks did not free it",
        ),
        (
            Some(Fault::Stretched(u64::MAX)),
            40,
            100,
            "i2c: SCL is held low longer than a device may stretch it",
        ),
        (
            Some(Fault::Stalled),
            25,
            250,
            "no sample comes: expected 500 a second",
        ),
        (
            Some(Fault::Frozen),
            110,
            250,
            "all samples are the same: expected some noise",
        ),
        (
            Some(Fault::Identity(0x12)),
            110,
            250,
            "WHO_AM_I is 0x12: expected 0x68",
        ),
        // Its supply fails for a moment.
        (None, 25, 250, gone),
    ];
    for (fault, until_told, until_over, text) in faults {
        let (before, count, _) = failures(&mut board);
        assert_eq!(before, "none", "{fault:?}");
        let sensor = board.sensor().expect("the sensor");
        if matches!(fault, None | Some(Fault::Identity(_))) {
            sensor.chip.reset();
        }
        sensor.set_fault(fault);
        board.run(until_told * MILLISECOND);
        let (failure, told, _) = failures(&mut board);
        assert!(failure.starts_with(text), "{fault:?}: {failure}");
        assert!(told > count, "{fault:?}");
        let sensor = board.sensor().expect("the sensor");
        sensor.set_fault(None);
        board.run(until_over * MILLISECOND);
        let (after, _, samples) = failures(&mut board);
        assert_eq!(after, "none", "{fault:?}");
        board.run(10 * MILLISECOND);
        let (_, _, more) = failures(&mut board);
        assert!(
            more >= samples + 4,
            "{fault:?}: {samples} samples, then {more}"
        );
    }
    let answer = command(&mut board, "info video_underflows");
    assert_eq!(line(&answer, "video_underflows"), "0");
}
