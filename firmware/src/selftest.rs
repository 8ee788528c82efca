//! Self-tests of the machine.

use core::fmt;
use core::time::Duration;

use embedded_hal::i2c::NoAcknowledgeSource;
use glint_core::block::Block;
use glint_core::digits::segments;
use glint_core::feature::{GESTURE, IMU, MESH};
use glint_core::flash::{DataLines, data_lines};
use glint_core::{image_sensor, mpu6050};
use glint_engines::gesture::SetUpError;
use glint_hal::i2c::BusError;
use glint_hal::timer::whole_millis;
use glint_model::selftest::{MESH_SHAPE, TestPicture};
use glint_program::gateware::Fallback;
use glint_program::gesture::Gesture;
use glint_program::sensor::{self, SensorError};
use litex_pac::cpu;

use crate::machine::Machine;

/// Number of bytes at the start of the memory test: four times the size of the data cache.
const TESTED: usize = 16 << 10;
/// Timeout for a vertical blanking.
const BLANKING: Duration = Duration::from_millis(100);
/// Timeout for a sample of the motion sensor, which may still be starting up.
const SAMPLE: Duration = Duration::from_millis(300);

/// The characters of the digits from left to right, and the time for which they are shown.
const PATTERN: [char; 8] = ['1', '2', '3', '4', '5', '6', '7', '8'];
const LOOK: Duration = Duration::from_secs(3);

/// Result of a test.
pub enum Verdict {
    /// The part is present and works.
    Passed,
    /// The part shows a text that a person must check.
    Shows(&'static str),
    /// The board, the gateware or the firmware lacks the part.
    Absent,
    /// The part is present and does not work.
    Failed(Failure),
}

/// Reason why a test failed.
pub enum Failure {
    /// The build ids of gateware and firmware differ.
    Identity,
    /// The counter of a clock does not advance.
    Stopped,
    /// A word of memory has another value than the value written.
    Memory {
        /// Address of the word in bytes.
        address: usize,
        /// The written value.
        expected: u32,
        /// The value read.
        found: u32,
    },
    /// The test of the flash's data lines failed.
    Flash(DataLines),
    /// No vertical blanking occurred within the timeout.
    Blanking,
    /// Number of screen lines since reset whose pixels came too late.
    Underflows(u32),
    /// A picture has a wrong checksum.
    Checksum {
        /// The stored checksum of the model's picture.
        expected: u32,
        /// The checksum of the gateware's picture.
        found: u32,
    },
    /// The gateware did not draw a picture.
    Engine(Fallback),
    /// The motion sensor reports an error.
    Sensor(SensorError),
    /// The motion sensor sends no sample, without reporting an error.
    NoSample,
    /// The set-up of the image sensor failed.
    ImageSensor(SetUpError),
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Passed => f.write_str("ok"),
            Self::Shows(text) => write!(f, "shows {text}"),
            Self::Absent => f.write_str("absent"),
            Self::Failed(failure) => write!(f, "FAILED: {failure}"),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Identity => f.write_str("build ids of firmware and gateware differ"),
            Self::Stopped => f.write_str("the counter does not advance"),
            Self::Memory {
                address,
                expected,
                found,
            } => write!(
                f,
                "{address:#010x} is {found:#010x}, expected {expected:#010x}"
            ),
            Self::Flash(lines) => lines.fmt(f),
            Self::Blanking => write!(
                f,
                "no vertical blanking for {} ms, expected one every 17 ms",
                whole_millis(BLANKING)
            ),
            Self::Underflows(count) => write!(f, "{count} underflows since reset, expected none"),
            Self::Checksum { expected, found } => {
                write!(f, "checksum {found:#010x}, expected {expected:#010x}")
            }
            Self::Engine(error) => error.fmt(f),
            Self::Sensor(error) if IMU.is_built => error.fmt(f),
            Self::NoSample => write!(f, "no sample for {} ms", whole_millis(SAMPLE)),
            Self::ImageSensor(error) if GESTURE.is_built => error.fmt(f),
            // The other failures are of parts that this build does not include, so they do not occur.
            Self::Sensor(_) | Self::ImageSensor(_) => Ok(()),
        }
    }
}

impl Verdict {
    fn check(passed: bool, failure: Failure) -> Self {
        if passed {
            Self::Passed
        } else {
            Self::Failed(failure)
        }
    }
}

/// Runs all tests, prints a line for each, and returns the number of tests that failed.
pub fn run(machine: &mut Machine) -> u32 {
    let mut failed = 0;
    let mut report = |machine: &mut Machine, name: &str, verdict: Verdict| {
        failed += u32::from(matches!(verdict, Verdict::Failed(_)));
        machine
            .terminal
            .print(format_args!("selftest {name} {verdict}\n"));
    };
    for (name, test) in TESTS {
        let verdict = test(machine);
        report(machine, name, verdict);
    }
    for picture in TestPicture::ALL {
        let verdict = draw(machine, picture);
        report(machine, picture.name(), verdict);
    }
    // Runs after the tests with pictures, which write to the memory that scan-out reads.
    let verdict = underflow(machine);
    report(machine, "underflow", verdict);
    failed
}

type Test = fn(&mut Machine) -> Verdict;

/// The tests that run before the tests of the engines, because the engines depend on memory and scan-out.
const TESTS: [(&str, Test); 9] = [
    ("identity", |machine| {
        Verdict::check(machine.identity.matches(), Failure::Identity)
    }),
    ("clock", |machine| {
        let passed = machine.clock.cycles() < machine.clock.cycles();
        Verdict::check(passed, Failure::Stopped)
    }),
    ("cycle counter", |_| {
        let passed = cpu::cycles_low() != cpu::cycles_low();
        Verdict::check(passed, Failure::Stopped)
    }),
    ("memory", |machine| memory(machine.models.staging())),
    ("flash", |machine| flash(machine.flash)),
    ("digits", digits),
    ("imu", imu),
    ("camera", camera),
    ("scan-out", scan_out),
];

/// Tests `window`, a part of main memory: writes different words to all addresses at the start of the window and to one address per
/// address line, flushes the cache, and reads all words back. A window shorter than a word counts as absent.
fn memory(window: &mut [u8]) -> Verdict {
    let (words, _) = window.as_chunks_mut::<4>();
    let count = words.len();
    if count == 0 {
        return Verdict::Absent;
    }
    let start = TESTED / 4;
    let lines = (start.ilog2()..usize::BITS).map(|line| 1 << line);
    let places = (0..start).chain(lines).take_while(|place| *place < count);
    let pattern = |place: usize| (place as u32).wrapping_mul(0x9e37_79b9);
    for place in places.clone() {
        words[place] = pattern(place).to_le_bytes();
    }
    cpu::flush_data_cache();
    for place in places {
        let (expected, word) = (pattern(place), &words[place]);
        let found = u32::from_le_bytes(*word);
        if found != expected {
            return Verdict::Failed(Failure::Memory {
                address: word.as_ptr().addr(),
                expected,
                found,
            });
        }
    }
    Verdict::Passed
}

/// Checks the data lines of the flash with the bytes at the beginning of an image or a bitstream.
fn flash(bytes: Option<&[u8]>) -> Verdict {
    match bytes.map(data_lines) {
        None | Some(DataLines::Erased) => Verdict::Absent,
        Some(lines) => Verdict::check(lines == DataLines::Right, Failure::Flash(lines)),
    }
}

/// Shows a different digit at each position. A person compares them with the printed text.
fn digits(machine: &mut Machine) -> Verdict {
    let Some(devices) = &mut machine.devices else {
        return Verdict::Absent;
    };
    if !machine.identity.has(Block::Digits) {
        return Verdict::Absent;
    }
    devices.digits.show(PATTERN.map(segments));
    devices.tests_digits = Some(machine.clock.after(LOOK));
    Verdict::Shows("1234 5678")
}

fn imu(machine: &mut Machine) -> Verdict {
    if !IMU.is_built || machine.devices.is_none() {
        return Verdict::Absent;
    }
    let before = machine.imu.samples();
    let end = machine.clock.after(SAMPLE);
    loop {
        sensor::deliver(&mut machine.imu);
        match machine.imu.error() {
            Some(mpu6050::Error::Bus(
                BusError::NoAcknowledge(NoAcknowledgeSource::Address) | BusError::Absent,
            )) => return Verdict::Absent,
            Some(error) => return Verdict::Failed(Failure::Sensor(error)),
            None if machine.imu.samples() != before => return Verdict::Passed,
            None if end.passed() => return Verdict::Failed(Failure::NoSample),
            None => {}
        }
    }
}

fn camera(machine: &mut Machine) -> Verdict {
    if !GESTURE.is_built {
        return Verdict::Absent;
    }
    match machine.gesture.as_mut().map(Gesture::check) {
        None | Some(Err(image_sensor::Error::Absent)) => Verdict::Absent,
        Some(Err(error)) => Verdict::Failed(Failure::ImageSensor(error)),
        Some(Ok(_)) => Verdict::Passed,
    }
}

/// Waits until a frame buffer is free, at the latest after the next vertical blanking.
fn scan_out(machine: &mut Machine) -> Verdict {
    let display = &mut machine.renderer.display;
    if !display.is_visible() {
        return Verdict::Absent;
    }
    let end = machine.clock.after(BLANKING);
    while display.back().is_none() {
        if end.passed() {
            return Verdict::Failed(Failure::Blanking);
        }
    }
    Verdict::Passed
}

fn underflow(machine: &mut Machine) -> Verdict {
    let display = &machine.renderer.display;
    match display.counters().underflow_count {
        _ if !display.is_visible() => Verdict::Absent,
        count => Verdict::check(count == 0, Failure::Underflows(count)),
    }
}

/// Draws a picture by the gateware, and compares its checksum with the model's.
fn draw(machine: &mut Machine, picture: TestPicture) -> Verdict {
    if !picture.is_built() {
        return Verdict::Absent;
    }
    let Machine {
        models, renderer, ..
    } = machine;
    let mesh = if MESH.is_built {
        models.shape(MESH_SHAPE)
    } else {
        None
    };
    let mut verdict = Verdict::Absent;
    let mut draw = |frame: &glint_model::Frame| {
        verdict = match renderer.checksum(frame) {
            None => Verdict::Absent,
            Some(Ok(found)) => {
                let expected = picture.stored();
                Verdict::check(found == expected, Failure::Checksum { expected, found })
            }
            Some(Err(error)) if error.is_left_out() => Verdict::Absent,
            Some(Err(error)) => Verdict::Failed(Failure::Engine(error)),
        };
    };
    // The camera of every picture is valid.
    let _ = picture.describe(mesh, &mut draw);
    verdict
}
