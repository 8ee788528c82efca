//! Tests of the SoC's I2C master, and of the firmware's attitude, with a virtual MPU-6050 on the pins.

use crate::firmware::{Console, PROMPT, command, image, preloaded, value};
use crate::program;
use emulated_board::EmulatedBoard;
use litex_pac::{i2c, leds};
use virtual_board::virtual_mpu6050::{Chip, Fault, Imperfections, Source, State, Wires};
use virtual_board::{Simulation, Uart, VirtualBoard};

/// Interval between two checks for the end of a fault, in ms.
const STEP: u64 = 8;

/// Returns the number of cycles of the system clock in a millisecond.
fn millisecond(clock_hz: u32) -> u64 {
    u64::from(clock_hz) / 1000
}

pub fn sensor(motion: impl Fn(f64) -> State + Send + 'static) -> Wires {
    // The noise of a typical sensor, without errors that require calibration.
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
    // SAFETY: only computes addresses of registers, without an access.
    let (i2c, leds) = unsafe { (i2c::I2c::steal(), leds::Leds::steal()) };
    let mut board = program::started(
        "i2c",
        &[
            ("COMMAND", i2c.command().address() as u32),
            ("ANSWER", i2c.answer().address() as u32),
            ("LEDS_OUT", leds.out().address() as u32),
        ],
    );
    let mut sensor = sensor(|_| State::default());
    sensor.log = Some(Vec::new());
    board.plug(sensor);
    // A transaction of five bytes takes less than a quarter of a millisecond.
    let round = millisecond(board.clock_hz()) / 4;
    board.run(round);
    assert_eq!(board.leds(), 0x168);
    board
        .sensor()
        .expect("the sensor")
        .set_fault(Some(Fault::Identity(0x70)));
    board.run(2 * round);
    assert_eq!(board.leds(), 0x170);
    let sensor = board.unplug().expect("the sensor");
    let log = sensor.log.unwrap_or_default().join(" ");
    assert!(log.starts_with("S d0+ 75+ S d1+ 68- P S"), "{log}");
    let violations = sensor.violations;
    assert!(violations.is_empty(), "{violations:#?}");
}

/// Angle in degrees of [`turn`].
const TURNED: f64 = 22.5;

/// Motion at rest, except for a turn to the left that starts at 0.02 s and takes 0.025 s.
fn turn(time: f64) -> State {
    let turns = (0.02..0.045).contains(&time);
    State {
        rate: [0.0, 0.0, if turns { 900.0 } else { 0.0 }],
        ..State::default()
    }
}

/// Tolerance of measured angles, in degrees.
const ANGLE: f64 = 0.1;

fn numbers(text: &str) -> Vec<f64> {
    let words = text.split(' ');
    words.map(|word| word.parse().expect("a number")).collect()
}

/// Returns a sensor that is already set up, because a reset of the sensor would take a tenth of a second.
fn ready_sensor(motion: impl Fn(f64) -> State + Send + 'static) -> Wires {
    let mut sensor = sensor(motion);
    for (register, value) in [
        (0x6b, 0x01),
        (0x19, 0x00),
        (0x1a, 0x02),
        (0x1b, 0x18),
        (0x1c, 0x10),
        (0x38, 0x01),
    ] {
        sensor.chip.write(register, value);
    }
    sensor
}

/// Starts a virtual board with a sensor.
fn board_with_sensor(motion: impl Fn(f64) -> State + Send + 'static) -> VirtualBoard {
    let mut board = preloaded(&image());
    board.plug(ready_sensor(motion));
    board.expect(PROMPT, "start");
    board
}

/// Starts an emulated board with a sensor.
pub fn emulated_with_sensor(motion: impl Fn(f64) -> State + Send + 'static) -> EmulatedBoard {
    let mut board = EmulatedBoard::fast(&image()).expect("an image that fits");
    board.plug(ready_sensor(motion));
    board.expect(PROMPT, "start");
    board
}

#[test]
fn the_camera_follows_the_sensor_and_a_replugged_one_is_found() {
    let mut board = board_with_sensor(turn);
    let millisecond = millisecond(board.clock_hz());
    command(&mut board, "imu look");
    board.run((55 * millisecond).saturating_sub(board.cycles()));
    let status = command(&mut board, "imu");
    assert_eq!(value(&status, "sensor"), "MPU-6050");
    assert_eq!(value(&status, "failure"), "none");
    assert_eq!(value(&status, "failures"), "0");
    let samples: u32 = value(&status, "samples").parse().expect("a number");
    assert!((45..57).contains(&samples), "{status}");
    let angles = numbers(value(&status, "angles"));
    assert!((angles[0] - TURNED).abs() < ANGLE, "{status}");
    // The camera follows the attitude in the next frame.
    board.run(35 * millisecond);
    let view = command(&mut board, "view");
    let view = numbers(value(&view, "view"));
    let (sine, cosine) = TURNED.to_radians().sin_cos();
    for (found, expected) in view[9..12].iter().zip([-sine, cosine, 0.0]) {
        assert!((found - expected).abs() < ANGLE.to_radians(), "{view:?}");
    }
    // While the sensor is unplugged, the attitude is held. The first error depends on the state of the transfer; the search for the
    // sensor, 30 ms later, finds no device.
    let sensor = board.unplug().expect("the sensor");
    board.run(40 * millisecond);
    let status = command(&mut board, "imu");
    assert_eq!(
        value(&status, "failure"),
        "i2c: no device acknowledged the address"
    );
    let refused = command(&mut board, "imu calibrate");
    assert!(
        refused.contains("error: imu calibrate: i2c: no device acknowledged the address"),
        "{refused}"
    );
    board.plug(sensor);
    board.run(40 * millisecond);
    let status = command(&mut board, "imu");
    assert_eq!(value(&status, "failure"), "none");
    let angles = numbers(value(&status, "angles"));
    assert!((angles[0] - TURNED).abs() < ANGLE, "{status}");
    let answer = command(&mut board, "info video_underflows");
    assert_eq!(value(&answer, "video_underflows"), "0");
    let cycles = |key| value(&status, key).parse::<u32>().expect("a number");
    let [read, tracked] = ["cycles_read", "cycles_tracked"].map(cycles);
    println!("cycles per sample: {read} to read it, {tracked} to compute the attitude");
    assert!(u64::from(read) < millisecond / 20, "5 % of 1 ms: {status}");
    assert!(tracked < 4_500, "{status}");
    let violations = board.unplug().expect("the sensor").violations;
    assert!(violations.is_empty(), "{violations:#?}");
}

/// A rotation matrix from body to world.
type Rotation = [[f64; 3]; 3];

/// A part of the scripted motion; a rest follows it. `time` is its duration in s. Without oscillations (`swings` is 0), `rate`
/// is the mean rate about each axis in °/s; with them, `rate` is the peak rate, and `swings` the number of oscillations.
/// `shake` is the amplitude of an acceleration along all axes, in g.
struct Part {
    name: &'static str,
    time: f64,
    rate: [f64; 3],
    swings: f64,
    shake: f64,
}

impl Part {
    const fn turn(name: &'static str, time: f64, rate: [f64; 3]) -> Self {
        Self {
            name,
            time,
            rate,
            swings: 0.0,
            shake: 0.0,
        }
    }

    /// Returns the state at `time` in a part of duration `length`, both in s. The three numbers
    /// are: the rotation so far, as the time in s that it takes at the rate `rate`; the current
    /// rate as a multiple of `rate`; and the current acceleration as a multiple of `shake`. The
    /// rate starts and ends smoothly, as sampling requires.
    fn at(&self, time: f64, length: f64) -> (f64, f64, f64) {
        if self.swings > 0.0 {
            let turns = std::f64::consts::TAU * self.swings / length;
            let (sin, cos) = (turns * time).sin_cos();
            ((1.0 - cos) / turns, sin, sin)
        } else {
            let turns = std::f64::consts::TAU / length;
            let (sin, cos) = (turns * time).sin_cos();
            (time - sin / turns, 1.0 - cos, 0.0)
        }
    }
}

/// Start of the first part, in seconds.
const BEGIN: f64 = 0.03;
/// Length of the rest after each part, in seconds.
const RESTING: f64 = 0.035;

const SCRIPT: [Part; 6] = [
    Part::turn("yaw", 0.05, [0.0, 0.0, 900.0]),
    // Pitches up from level through the vertical, to 9° beyond it.
    Part::turn("pitch through 90°", 0.104, [950.0, 0.0, 0.0]),
    Part::turn("roll", 0.05, [0.0, -900.0, 0.0]),
    Part::turn("tumble", 0.06, [600.0, -800.0, 500.0]),
    Part {
        name: "shake",
        time: 0.06,
        rate: [900.0, 600.0, -800.0],
        swings: 2.0,
        shake: 1.5,
    },
    Part::turn("rest", 0.01, [0.0; 3]),
];

/// The product of two rotations.
fn times(a: &Rotation, b: &Rotation) -> Rotation {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The rotation about `axis` by `degrees` times the length of `axis` (Rodrigues' formula).
fn rotation(axis: [f64; 3], degrees: f64) -> Rotation {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let axis = axis.map(|x| x / length);
    let [x, y, z] = axis;
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let (sin, cos) = (length * degrees).to_radians().sin_cos();
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let diagonal = if i == j { cos } else { 0.0 };
            diagonal + (1.0 - cos) * axis[i] * axis[j] + sin * cross[i][j]
        })
    })
}

/// Returns the total rotation of `SCRIPT` until `time`, and the sensor's motion at that time. `stretch`
/// multiplies the duration of each part and divides its rate.
fn script(time: f64, stretch: f64) -> (Rotation, State) {
    let mut turned = rotation([0.0; 3], 0.0);
    let (mut rate, mut shake) = ([0.0; 3], 0.0);
    let mut begin = BEGIN;
    for part in &SCRIPT {
        let length = part.time * stretch;
        let inside = (time - begin).clamp(0.0, length);
        let (turning, speed, shaking) = part.at(inside, length);
        turned = times(&turned, &rotation(part.rate, turning / stretch));
        if inside > 0.0 && inside < length {
            rate = part.rate.map(|x| x * speed / stretch);
            shake = part.shake * shaking;
        }
        begin += length + RESTING;
    }
    // At rest the sensor measures 1 g along the world's z axis, here in body axes.
    let state = State {
        rate,
        force: turned[2].map(|up| up + shake),
        ..State::default()
    };
    (turned, state)
}

/// The camera follows the sensor's motion as computed in f64, even where the pitch passes 90°. The motion takes 0.6 s of
/// board time; with `GLINT_IMU_MOTION` in the environment it is seven times slower and takes 2.6 s.
#[test]
fn the_camera_follows_a_script() {
    let is_slow = std::env::var_os("GLINT_IMU_MOTION").is_some();
    let stretch = if is_slow { 7.0 } else { 1.0 };
    let mut board = emulated_with_sensor(move |time| script(time, stretch).1);
    let millisecond = millisecond(board.clock_hz());
    command(&mut board, "imu look");
    let camera = |board: &mut EmulatedBoard| -> [[f64; 3]; 3] {
        let view = command(board, "view");
        let view = numbers(value(&view, "view"));
        [3, 6, 9].map(|at| [0, 1, 2].map(|i| view[at + i]))
    };
    let mut end = BEGIN;
    for part in &SCRIPT {
        end += part.time * stretch + RESTING;
        // Runs until just before the next part. This leaves time for the delay of the sensor's filter and for a frame.
        let until = ((end - 0.005) * 1e3 * millisecond as f64) as u64;
        board.run(until.saturating_sub(board.cycles()));
        let (turned, _) = script(end, stretch);
        // The camera's u, v, n before any rotation: it looks along y.
        let expected = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
            .map(|axis| [0, 1, 2].map(|i| (0..3).map(|k| turned[i][k] * axis[k]).sum::<f64>()));
        let found = camera(&mut board);
        for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!(
                (found - expected).abs() < ANGLE.to_radians(),
                "{}: {found:?}, expected {expected:?}",
                part.name
            );
        }
    }
    let status = command(&mut board, "imu");
    assert_eq!(value(&status, "failures"), "0", "{status}");
    let answer = command(&mut board, "info video_underflows");
    assert_eq!(value(&answer, "video_underflows"), "0");
}

/// The firmware reports every fault of the sensor on the console, and recovers in time; the pictures are not affected. This
/// takes a second of board time.
#[test]
fn every_fault_is_reported_and_recovered() {
    let mut board = emulated_with_sensor(|_| State::default());
    let millisecond = millisecond(board.clock_hz());
    command(&mut board, "imu orbit");
    board.run(20 * millisecond);
    let failures = |board: &mut EmulatedBoard| {
        let status = command(board, "imu");
        let number = |key| value(&status, key).parse::<u32>().expect("a number");
        let failure = value(&status, "failure").to_owned();
        (failure, number("failures"), number("samples"))
    };
    let gone = "i2c: no device acknowledged the address";
    // A read in progress ends without its last bytes, any other transfer without an acknowledgement.
    let vanished = "the sensor vanished within a sample";
    // For each case: the fault, the time-outs of its report and of the recovery in ms, and the texts that may report it.
    let faults: [(Option<Fault>, u64, u64, &[&str]); 8] = [
        (Some(Fault::Absent), 10, 100, &[gone, vanished]),
        (
            Some(Fault::NoAcknowledge),
            10,
            100,
            &["i2c: the device did not acknowledge a byte"],
        ),
        (
            Some(Fault::StuckData(0)),
            10,
            100,
            &["i2c: SDA is held low: nine clocks did not release it"],
        ),
        (
            Some(Fault::Stretched(u64::MAX)),
            80,
            100,
            &["i2c: SCL is held low longer than a device may stretch it"],
        ),
        (
            Some(Fault::Stalled),
            25,
            250,
            &["no samples: expected 1000 per second"],
        ),
        (
            Some(Fault::Frozen),
            110,
            250,
            &["all samples are equal: expected noise"],
        ),
        (
            Some(Fault::Identity(0x00)),
            110,
            250,
            &["WHO_AM_I is 0x00: expected 0x68"],
        ),
        // A short loss of the sensor's supply voltage.
        (None, 25, 250, &[gone]),
    ];
    for (fault, until_told, until_over, texts) in faults {
        let (before, count, _) = failures(&mut board);
        assert_eq!(before, "none", "{fault:?}");
        let sensor = board.sensor().expect("the sensor");
        if matches!(fault, None | Some(Fault::Identity(_))) {
            sensor.chip.reset();
        }
        sensor.set_fault(fault);
        board.run(until_told * millisecond);
        let (failure, told, _) = failures(&mut board);
        assert!(
            texts.iter().any(|text| failure.starts_with(text)),
            "{fault:?}: {failure}"
        );
        assert!(told > count, "{fault:?}");
        let sensor = board.sensor().expect("the sensor");
        sensor.set_fault(None);
        let end = board.cycles() + until_over * millisecond;
        let samples = loop {
            board.run(STEP * millisecond);
            let (failure, _, samples) = failures(&mut board);
            if failure == "none" {
                break samples;
            }
            assert!(board.cycles() < end, "{fault:?}: still {failure}");
        };
        board.run(STEP * millisecond);
        let (_, _, more) = failures(&mut board);
        assert!(
            more >= samples + 4,
            "{fault:?}: {samples} samples, then {more}"
        );
    }
    let answer = command(&mut board, "info video_underflows");
    assert_eq!(value(&answer, "video_underflows"), "0");
}
