//! Tests of the emulated board's gesture engine by its registers, with an image sensor at its port.

use emulated_board::virtual_image_sensor::{
    Fault as SensorFault, Hand, ImageSensor, Model, Scene, Source, Timing,
};
use emulated_board::{Device, GestureEngine, MainMemory};
use glint_core::colour::Rgb565;
use glint_core::gesture::{Region, Window};
use glint_model::gesture::{Channel as ModelChannel, Settings, Sums};
use litex_pac::gesture::{
    Camera, Channel, Control, EvEnable, Fault, RegionX, RegionY, Seen, Size, Snapshot,
    SnapshotState, Status, WindowA, WindowB, offset,
};
use litex_pac::register::Value;
use virtual_i2c_device::Device as _;

const SIZE: [usize; 2] = [64, 48];
const WINDOWS: [Window; 2] = [
    Window {
        lower: 140,
        upper: 200,
    },
    Window {
        lower: 70,
        upper: 120,
    },
];
const REGION: Region = Region {
    first: [4, 3],
    last: [60, 40],
};
/// Maximum number of clock cycles of a frame.
const FRAME: u64 = 40_000;

/// A moving hand.
fn scene() -> Scene {
    Scene::new(SIZE, |time| {
        vec![Hand {
            centre: [20.0 + 20_000.0 * (time % 0.001), 24.0],
            area: 300.0,
        }]
    })
}

fn settings() -> Settings {
    Settings {
        size: SIZE.map(|size| size as u16),
        windows: [
            (ModelChannel::Cr, WINDOWS[0]),
            (ModelChannel::Cb, WINDOWS[1]),
        ],
        region: REGION,
        least_run: 3,
    }
}

/// Expected sums of the frame that the scene has at `time`.
fn sums(time: f64) -> Sums {
    let settings = settings();
    let mut sums = Sums::NONE;
    let frame = scene().frame(time);
    for (y, line) in (0..).zip(frame.pixels.chunks(SIZE[0])) {
        let marks = line.iter().map(|&pixel| settings.marks(Rgb565(pixel)));
        sums.add_line(&settings, y, marks);
    }
    sums
}

struct Bench {
    engine: GestureEngine,
    ram: MainMemory,
    now: u64,
}

impl Bench {
    /// An engine with a sensor that has been set up and has a clock.
    fn new() -> Self {
        let mut bench = Self {
            engine: GestureEngine::new(),
            ram: MainMemory::new(),
            now: 1000,
        };
        bench
            .engine
            .plug(ImageSensor::new(Model::Ov7670, scene(), Timing::SHORT));
        let on = Camera::default()
            .with_clock(true)
            .with_scl(true)
            .with_sda(true);
        bench.set(offset::CAMERA, on.bits());
        for (register, value) in [(0x12, 0x04), (0x40, 0xd0)] {
            let sensor = bench.engine.sensor().unwrap();
            sensor.wires.chip.write(register, value);
        }
        bench.set(
            offset::EV_ENABLE,
            EvEnable::default().with_frame(true).bits(),
        );
        let [width, height] = SIZE.map(|size| size as u16);
        let size = Size::default().with_width(width).with_height(height);
        let [a, b] = WINDOWS;
        let window_a = WindowA::default().with_channel(Channel::Cr);
        let window_a = window_a.with_lower(a.lower).with_upper(a.upper);
        let window_b = WindowB::default().with_channel(Channel::Cb);
        let window_b = window_b.with_lower(b.lower).with_upper(b.upper);
        let Region { first, last } = REGION;
        let columns = RegionX::default().with_first(first[0]).with_last(last[0]);
        let rows = RegionY::default().with_first(first[1]).with_last(last[1]);
        for (register, value) in [
            (offset::SIZE, size.bits()),
            (offset::WINDOW_A, window_a.bits()),
            (offset::WINDOW_B, window_b.bits()),
            (offset::REGION_X, columns.bits()),
            (offset::REGION_Y, rows.bits()),
            (offset::LEAST_RUN, 3),
            (offset::CONTROL, Control::default().with_enable(true).bits()),
        ] {
            bench.set(register, value);
        }
        bench
    }

    fn read(&mut self, offset: u32) -> u32 {
        self.engine.read(offset, self.now)
    }

    fn set(&mut self, offset: u32, value: u32) {
        self.engine.write(offset, value, self.now, &mut self.ram);
    }

    fn status(&mut self) -> Status {
        Status::from_bits(self.read(offset::STATUS))
    }

    /// Advances time from event to event, for a number of cycles or up to an interrupt. Returns whether an interrupt occurred.
    fn run(&mut self, cycles: u64) -> bool {
        let end = self.now + cycles;
        while !self.engine.interrupt() {
            let next = self.engine.advance(self.now, &mut self.ram);
            assert!(next > self.now, "an event in the past");
            if self.engine.interrupt() || next > end {
                break;
            }
            self.now = next;
        }
        let comes = self.engine.interrupt();
        if comes {
            self.set(offset::EV_PENDING, 1);
        } else {
            self.now = end;
        }
        comes
    }
}

#[test]
fn each_frame_has_the_sums_of_the_model() {
    let mut bench = Bench::new();
    let mut all = vec![];
    for number in 0..6 {
        // An incomplete frame before the first VSYNC does not count.
        assert!(bench.run(2 * FRAME), "frame {number}");
        assert_eq!(bench.read(offset::SEQUENCE), number + 1);
        let found = [offset::COUNT, offset::SUM_X, offset::SUM_Y].map(|at| bench.read(at));
        all.push(found);
    }
    let status = bench.status();
    assert!(status.running() && !status.waiting());
    assert_eq!(status.fault(), Some(Fault::None));
    let seen = Seen::from_bits(bench.read(offset::SEEN));
    assert_eq!([seen.pixels(), seen.lines()], SIZE.map(|size| size as u16));
    assert_eq!(bench.read(offset::FRAMES), 6);
    assert_eq!(bench.read(offset::FRAMES_DROPPED), 0);
    // The hand moves, and the frames show its path at constant time steps.
    let period = {
        let line = 2 * SIZE[0] + Timing::SHORT.gap;
        let lines = SIZE[1] + Timing::SHORT.blank.iter().sum::<usize>();
        (line * lines) as f64 / f64::from(Timing::SHORT.clock)
    };
    let expected: Vec<[u32; 3]> = (0..12)
        .map(|number| {
            let clock = f64::from(litex_pac::constants::CONFIG_CLOCK_FREQUENCY);
            let halves = (1000.0 * 2.0 * f64::from(Timing::SHORT.clock) / clock).floor();
            let begin = halves / (2.0 * f64::from(Timing::SHORT.clock));
            let sums = sums(begin + f64::from(number) * period);
            [sums.count, sums.sums[0], sums.sums[1]]
        })
        .collect();
    let first = expected.windows(6).position(|frames| frames == all);
    assert!(first.is_some(), "{all:?} are not in {expected:?}");
}

#[test]
fn faults_are_those_of_the_frames() {
    let mut bench = Bench::new();
    assert!(bench.run(2 * FRAME));
    for (fault, expected) in [
        (SensorFault::Slip { line: 10, bytes: 2 }, Fault::Pixels),
        (SensorFault::Slip { line: 10, bytes: 1 }, Fault::Byte),
        (SensorFault::Lines(3), Fault::Lines),
        (SensorFault::Cut(20), Fault::Cut),
        (SensorFault::Stopped(20), Fault::Stopped),
    ] {
        let dropped = bench.read(offset::FRAMES_DROPPED);
        bench.engine.sensor().unwrap().fault = Some(fault);
        while bench.run(2 * FRAME) {}
        assert!(bench.read(offset::FRAMES_DROPPED) > dropped, "{fault:?}");
        // The clock stops in some of these frames, and runs in the other frames.
        while matches!(fault, SensorFault::Stopped(_)) && bench.status().running() {
            bench.run(500);
        }
        assert_eq!(bench.status().fault(), Some(expected), "{fault:?}");
        bench.engine.sensor().unwrap().fault = None;
        assert!(bench.run(4 * FRAME), "no complete frame after {fault:?}");
        assert_eq!(bench.status().fault(), Some(Fault::None), "{fault:?}");
    }
}

#[test]
fn without_a_clock_nothing_runs() {
    let mut bench = Bench::new();
    assert!(bench.run(2 * FRAME));
    bench.set(
        offset::CAMERA,
        Camera::default().with_scl(true).with_sda(true).bits(),
    );
    while bench.run(2 * FRAME) {}
    let status = bench.status();
    assert!(!status.running() && status.waiting());
    assert_eq!(status.fault(), Some(Fault::Stopped));
    let mut empty = GestureEngine::new();
    assert_eq!(empty.advance(0, &mut bench.ram), u64::MAX);
    let status = Status::from_bits(empty.read(offset::STATUS, 0));
    assert!(status.scl() && status.sda() && !status.running() && !status.waiting());
}

#[test]
fn a_small_picture_is_that_of_a_whole_frame() {
    let mut bench = Bench::new();
    assert!(bench.run(2 * FRAME));
    let request = Snapshot::default().with_step(2).with_start(true);
    for is_colour in [false, true] {
        let request = request.with_colour(is_colour).bits();
        bench.set(offset::SNAPSHOT, request);
        assert_eq!(bench.read(offset::SNAPSHOT), request);
        let state = SnapshotState::from_bits(bench.read(offset::SNAPSHOT_STATE));
        assert!(!state.ready());
        for _ in 0..3 {
            assert!(bench.run(2 * FRAME));
        }
        let state = SnapshotState::from_bits(bench.read(offset::SNAPSHOT_STATE));
        let pixels = SIZE[0] / 4 * SIZE[1] / 4;
        let words = if is_colour { pixels } else { pixels / 16 };
        assert_eq!((state.ready(), usize::from(state.words())), (true, words));
        assert!(state.sequence() > 1);
        bench.set(offset::SNAPSHOT_PLACE, 0);
        let words: Vec<u32> = (0..words)
            .map(|_| bench.read(offset::SNAPSHOT_WORD))
            .collect();
        let marked = words.iter().map(|word| word.count_ones()).sum::<u32>();
        assert!(marked > 0 && words.iter().any(|&word| word != words[0]));
    }
}
