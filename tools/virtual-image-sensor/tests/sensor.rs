//! Tests of the virtual image sensor's port against the data sheets' timing, with an independent receiver.

use virtual_i2c_device::{Device, Wires};
use virtual_image_sensor::{
    ChipFault, Fault, Frame, Hand, ImageSensor, Images, Levels, Model, Polarity, Scene, Source,
    Timing,
};

const SIZE: [usize; 2] = [40, 24];

/// Writes the registers for RGB565, as a set-up does.
fn select_rgb565(sensor: &mut ImageSensor) {
    let registers: &[(u16, u8)] = match sensor.wires.chip.model() {
        Model::Ov7670 => &[(0x12, 0x04), (0x40, 0xd0)],
        Model::Ov5640 => &[(0x4300, 0x61), (0x501f, 0x01)],
    };
    for &(register, value) in registers {
        sensor.wires.chip.write(register, value);
    }
}

fn still_hand() -> Scene {
    Scene::new(SIZE, |_| {
        vec![Hand {
            centre: [20.0, 12.0],
            area: 100.0,
        }]
    })
}

fn sensor(model: Model) -> ImageSensor {
    let mut sensor = ImageSensor::new(model, still_hand(), Timing::SHORT);
    select_rgb565(&mut sensor);
    sensor
}

/// The bytes of each line that a receiver samples while HREF is active and VSYNC is not.
fn received(levels: &[Levels], polarity: Polarity) -> Vec<Vec<u8>> {
    let mut lines = vec![Vec::new()];
    for levels in levels.iter().filter(|levels| levels.ticks()) {
        if levels.href() != polarity.href_low && levels.vsync() == polarity.vsync_low {
            lines.last_mut().expect("a line").push(levels.data());
        } else if lines.last().is_some_and(|line| !line.is_empty()) {
            lines.push(Vec::new());
        }
    }
    lines.pop_if(|line| line.is_empty());
    lines
}

fn lines_of(frame: &Frame) -> Vec<Vec<u8>> {
    let lines = frame.pixels.chunks(frame.width);
    lines
        .map(|line| line.iter().flat_map(|pixel| pixel.to_be_bytes()).collect())
        .collect()
}

#[test]
fn both_models_send_the_source_in_their_polarity() {
    let expected = lines_of(&still_hand().frame(0.0));
    for (model, vsync_low) in [(Model::Ov7670, false), (Model::Ov5640, true)] {
        let mut sensor = sensor(model);
        let polarity = Polarity {
            vsync_low,
            ..Polarity::default()
        };
        assert_eq!(sensor.wires.chip.polarity(), polarity, "{model:?}");
        let levels = sensor.frame(0.0);
        assert_eq!(received(&levels, polarity), expected, "{model:?}");
        let Timing { gap, blank, .. } = Timing::SHORT;
        let line = 2 * SIZE[0] + gap;
        assert_eq!(levels.len(), (SIZE[1] + blank.iter().sum::<usize>()) * line);
    }
}

#[test]
fn registers_invert_levels_and_gate_the_clock() {
    let mut sensor = sensor(Model::Ov7670);
    let expected = lines_of(&still_hand().frame(0.0));
    sensor.wires.chip.write(0x15, 0x02 | 0x08 | 0x10);
    let polarity = Polarity {
        vsync_low: true,
        href_low: true,
        swap: false,
        falling: true,
    };
    let levels = sensor.frame(0.0);
    assert_eq!(received(&levels, polarity), expected);
    assert!(levels.iter().all(|levels| levels.0 >> 11 & 1 != 0));
    sensor.wires.chip.write(0x15, 0x20);
    let ticks = sensor.frame(0.0).iter().filter(|l| l.ticks()).count();
    assert_eq!(ticks, 2 * SIZE[0] * SIZE[1]);
    sensor.wires.chip.write(0x15, 0x00);
    sensor.wires.chip.write(0x0c, 0x40);
    let swapped = received(&sensor.frame(0.0), Polarity::default());
    assert_eq!(swapped[0][..2], [expected[0][1], expected[0][0]]);
}

#[test]
fn each_fault_shows_on_the_pins() {
    let normal = Polarity::default();
    let mut sensor = sensor(Model::Ov7670);
    let whole = sensor.frame(0.0);
    let mut with = |fault| {
        sensor.fault = Some(fault);
        let levels = sensor.frame(0.0);
        let lines: Vec<usize> = received(&levels, normal).iter().map(Vec::len).collect();
        (levels, lines)
    };
    let line = 2 * SIZE[0];
    let (unplugged, _) = with(Fault::Unplugged);
    assert!(unplugged.iter().all(|l| !l.ticks() && l.0 & 0x3ff == 0));
    let (no_sync, lines) = with(Fault::NoSync);
    assert!(no_sync.iter().all(|l| !l.vsync()));
    assert_eq!(lines, [line; SIZE[1]]);
    for (bytes, expected) in [(1, line - 1), (6, line - 6), (-4, line + 4)] {
        let (_, lines) = with(Fault::Slip { line: 3, bytes });
        assert_eq!((lines[2], lines[3], lines[4]), (line, expected, line));
    }
    assert_eq!(with(Fault::Lines(2)).1, [line; SIZE[1] - 2]);
    assert_eq!(with(Fault::Lines(-3)).1, [line; SIZE[1] + 3]);
    let (cut, lines) = with(Fault::Cut(5));
    assert_eq!((lines.len(), lines[5]), (6, line / 2));
    assert!(cut.last().is_some_and(|last| last.href()));
    let (stopped, lines) = with(Fault::Stopped(5));
    assert_eq!((lines.len(), lines[5]), (6, line / 2));
    assert!(stopped.iter().any(|l| !l.ticks()));
    let (inverted, _) = with(Fault::Inverted(Polarity {
        vsync_low: true,
        ..normal
    }));
    assert!(
        inverted
            .iter()
            .zip(&whole)
            .all(|(a, b)| a.0 ^ b.0 == 1 << 9)
    );
}

#[test]
fn a_camera_without_clock_or_in_standby_is_still_and_a_reset_clears_its_registers() {
    let mut sensor = sensor(Model::Ov5640);
    assert!(sensor.set_inputs(true, false) && !sensor.set_inputs(true, false));
    assert!(sensor.frame(0.0).iter().all(|l| !l.ticks()));
    assert!(sensor.set_inputs(true, true));
    assert!(sensor.set_inputs(false, true) && sensor.set_inputs(true, true));
    // After a reset the format is not RGB565, so the bytes differ from the source's.
    let polarity = sensor.wires.chip.polarity();
    let lines = received(&sensor.frame(0.0), polarity);
    assert_ne!(lines, lines_of(&still_hand().frame(0.0)));
    sensor.wires.chip.write(0x3008, 0x42);
    assert!(sensor.frame(0.0).iter().all(|l| !l.ticks()));
}

/// Time of half a period of SCL, in ns.
const HALF: u64 = 1_500;

/// A bit-banging SCCB master: no repeated start, no wait for SCL.
struct Master {
    wires: Wires<virtual_image_sensor::Chip>,
    now: u64,
}

impl Master {
    fn set(&mut self, scl: bool, sda: bool) -> bool {
        self.now += HALF;
        self.wires.update(self.now, scl, sda).1
    }

    fn start(&mut self) {
        self.set(true, true);
        self.set(true, false);
        self.set(false, false);
    }

    fn stop(&mut self) {
        self.set(false, false);
        self.set(true, false);
        self.set(true, true);
    }

    /// Sends a bit, or releases SDA to receive one; returns the level of SDA while SCL is high.
    fn bit(&mut self, bit: bool) -> bool {
        self.set(false, bit);
        let level = self.set(true, bit);
        self.set(false, bit);
        level
    }

    /// Sends a byte; returns whether the chip acknowledged it.
    fn send(&mut self, byte: u8) -> bool {
        for place in (0..8).rev() {
            self.bit(byte >> place & 1 != 0);
        }
        !self.bit(true)
    }

    fn write(&mut self, bytes: &[u8]) -> bool {
        self.start();
        let acknowledged = bytes.iter().all(|&byte| self.send(byte));
        self.stop();
        acknowledged
    }

    fn read(&mut self, address: u8, number: &[u8]) -> Option<u8> {
        let whole: Vec<u8> = [&[address << 1], number].concat();
        if !self.write(&whole) {
            return None;
        }
        self.start();
        let answers = self.send(address << 1 | 1);
        let byte = (0..8).fold(0, |byte, _| byte << 1 | u8::from(self.bit(true)));
        self.bit(true);
        self.stop();
        answers.then_some(byte)
    }
}

#[test]
fn registers_are_reached_over_the_wires() {
    let master = |model| Master {
        wires: sensor(model).wires,
        now: 0,
    };
    let mut ov7670 = master(Model::Ov7670);
    let identity = [0x0a, 0x0b].map(|number| ov7670.read(0x21, &[number]));
    assert_eq!(identity, [Some(0x76), Some(0x73)]);
    assert!(ov7670.write(&[0x42, 0x15, 0x02]));
    assert!(ov7670.wires.chip.polarity().vsync_low);
    assert_eq!(ov7670.read(0x3c, &[0x0a]), None);
    // A reset takes a millisecond, in which the chip does not answer.
    assert!(ov7670.write(&[0x42, 0x12, 0x80]));
    assert_eq!(ov7670.read(0x21, &[0x12]), None);
    ov7670.now += 1_000_000;
    assert_eq!(ov7670.read(0x21, &[0x12]), Some(0));
    ov7670.wires.set_fault(Some(ChipFault::Identity(0x2640)));
    let identity = [0x0a, 0x0b].map(|number| ov7670.read(0x21, &[number]));
    assert_eq!(identity, [Some(0x26), Some(0x40)]);

    let mut ov5640 = master(Model::Ov5640);
    let identity = [0x0a, 0x0b].map(|low| ov5640.read(0x3c, &[0x30, low]));
    assert_eq!(identity, [Some(0x56), Some(0x40)]);
    assert!(ov5640.write(&[0x78, 0x43, 0x00, 0x6f, 0x00]));
    assert_eq!(ov5640.read(0x3c, &[0x43, 0x00]), Some(0x6f));
    ov5640.wires.set_fault(Some(ChipFault::Identity(0x2640)));
    assert_eq!(ov5640.read(0x3c, &[0x30, 0x0a]), Some(0x26));
    ov5640.wires.set_fault(Some(ChipFault::NoAcknowledge));
    assert_eq!(ov5640.read(0x3c, &[0x30, 0x0a]), None);
    assert_eq!(ov7670.wires.violations, [""; 0]);
    assert_eq!(ov5640.wires.violations, [""; 0]);
}

/// Whether a pixel has the colour of the hand: much more red than blue.
fn is_skin(pixel: u16) -> bool {
    i32::from(pixel >> 11) - i32::from(pixel & 0x1f) > 3
}

#[test]
fn the_hand_has_the_stated_centre_and_area() {
    for (centre, area) in [([160.0, 120.0], 500.0), ([57.3, 88.9], 6_000.0)] {
        let mut scene = Scene::new([320, 240], move |_| vec![Hand { centre, area }]);
        scene.noise = 2.0;
        let frame = scene.frame(0.0);
        let (mut count, mut sums) = (0.0, [0.0; 2]);
        for (at, _) in frame
            .pixels
            .iter()
            .enumerate()
            .filter(|(_, p)| is_skin(**p))
        {
            count += 1.0;
            sums = [
                sums[0] + (at % frame.width) as f64,
                sums[1] + (at / frame.width) as f64,
            ];
        }
        let found = sums.map(|sum| sum / count);
        for axis in [0, 1] {
            assert!((found[axis] - centre[axis]).abs() < 0.1, "{found:?}");
        }
        assert!((count / area - 1.0).abs() < 0.1, "{count} of {area}");
    }
}

#[test]
fn light_salt_discs_and_time_change_the_picture() {
    let mut scene = Scene::new(SIZE, |time| {
        vec![Hand {
            centre: [10.0 + time, 12.0],
            area: 60.0,
        }]
    });
    scene.light = Box::new(|time| if time < 5.0 { 1.0 } else { 0.5 });
    let first = scene.frame(0.0);
    let skin = |frame: &Frame| frame.pixels.iter().filter(|p| is_skin(**p)).count();
    let hand = skin(&first);
    assert!(first.pixels[12 * SIZE[0] + 10] >> 11 == 28);
    assert!(scene.frame(6.0).pixels[12 * SIZE[0] + 16] >> 11 == 14);
    scene.discs.push(Hand {
        centre: [34.0, 5.0],
        area: 40.0,
    });
    let more = skin(&scene.frame(0.0)) - hand;
    assert!((35..45).contains(&more), "{more}");
    scene.salt = 0.05;
    let salted = scene.frame(0.0);
    let again = scene.frame(0.0);
    let pairs = again.pixels.iter().zip(&salted.pixels);
    assert!(pairs.filter(|(a, b)| a != b).count() > 10);
}

#[test]
fn a_folder_of_pictures_is_played_in_order() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("sensor-pictures");
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, colour) in [("b", [0, 255, 0]), ("a", [255, 0, 0])] {
        let file = std::fs::File::create(folder.join(name).with_extension("png"));
        let mut encoder = png::Encoder::new(file.expect("a file"), 2, 1);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        let data = [colour, colour].concat();
        writer.write_image_data(&data).expect("a picture");
    }
    let mut images = Images::read(&folder).expect("two pictures");
    let colours = [0, 1, 2].map(|_| images.frame(0.0).pixels);
    assert_eq!(colours, [[0xf800; 2], [0x07e0; 2], [0xf800; 2]]);
    let empty = folder.join("empty");
    std::fs::create_dir_all(&empty).expect("a folder");
    let error = Images::read(&empty).err().expect("no pictures");
    assert!(error.to_string().contains("expected a folder with PNG"));
}
