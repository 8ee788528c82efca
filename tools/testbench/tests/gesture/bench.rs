//! Test bench of the gesture engine: two clocks, an image sensor on its pins, and the model for comparison.

use glint_core::gesture::{Region, Window};
use glint_model::gesture::{Channel, Engine, Pins, Polarity, Settings};
use glint_testbench::{Counters, Module, Port};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::camera::{Camera, End, Picture};

/// Periods of both clocks in a common unit of time; the sensor's period is even.
#[derive(Clone, Copy, Debug)]
pub struct Clocks {
    pub sys: u64,
    pub camera: u64,
}

impl Clocks {
    /// Periods, in ps, of the Urbana's system clock and of an image sensor that sends 640x480
    /// pixels at 60 frames per second.
    pub const URBANA: Self = Self {
        sys: 12_308,
        camera: 20_400,
    };

    /// An image sensor with twice the engine's clock frequency: one pixel in each clock of the
    /// engine.
    pub const TWICE: Self = Self {
        sys: 10_000,
        camera: 5_000,
    };
}

/// The build with a short time-out for the sensor's clock, and with sums of products.
pub const HASTY: &str = "gesture_engine_hasty";

/// Settings that mark every pixel of a frame of this size as part of a hand.
pub const fn settings(size: [u16; 2]) -> Settings {
    const ALL: Window = window(0, 255);
    Settings {
        size,
        windows: [(Channel::Cr, ALL), (Channel::Cb, ALL)],
        region: Region {
            first: [0; 2],
            last: [2047; 2],
        },
        least_run: 1,
    }
}

/// A window of channel values from `lower` to `upper`.
pub const fn window(lower: u8, upper: u8) -> Window {
    Window { lower, upper }
}

pub struct Bench {
    pub module: Module,
    pub twin: Engine,
    pub random: Pcg64Mcg,
    pub camera: Camera,
    clocks: Clocks,
    /// Whether the engine samples at the falling edge.
    falling: bool,
    clk: Port,
    pclk: Port,
    pins: [Port; 3],
    latched: Port,
    counters: Counters,
    now: u64,
    next_sys: u64,
    /// Number of clocks with `latched` high.
    pub latches: u32,
}

impl Bench {
    /// Makes a bench of the build [`HASTY`] with the default polarity of the pins. The engine is
    /// enabled and has seen a VSYNC, so a frame can follow.
    pub fn usual(clocks: Clocks, settings: Settings, seed: u64) -> Self {
        let mut bench = Self::new(HASTY, clocks, Polarity::default(), false, settings, seed);
        bench.begin();
        bench
    }

    /// Makes a bench of the build `name`. The engine is enabled in the middle of a frame, and waits for a VSYNC.
    pub fn new(
        name: &str,
        clocks: Clocks,
        polarity: Polarity,
        falling: bool,
        settings: Settings,
        seed: u64,
    ) -> Self {
        let mut bench = Self::stopped(name, clocks, polarity, settings, seed);
        bench.falling = falling;
        bench.module.drive("pins.falling", falling);
        // Registers without a reset start with random values, so the FIFO may contain random data.
        // A VSYNC discards them.
        bench.idle(3000);
        bench.begin();
        bench.twin = Engine::new(polarity, settings, bench.camera.pins(false, false, 0));
        bench.counters = Counters::new(&bench.module, "events");
        bench.latches = 0;
        bench.module.drive("enable", true);
        bench.idle(100);
        bench
    }

    /// Makes a bench after the reset, before the camera starts.
    fn stopped(
        name: &str,
        clocks: Clocks,
        polarity: Polarity,
        settings: Settings,
        seed: u64,
    ) -> Self {
        let module = Module::load(name, seed as u32);
        // The engine is busy for 16 clocks at the end of a line or frame, and latches settings about 40 clocks after VSYNC.
        let clocks_of = |count: u64| (count * clocks.sys).div_ceil(clocks.camera) as usize;
        let camera = Camera {
            polarity,
            blank: clocks_of(20) + 4,
            between: clocks_of(60) + 8,
            is_noisy: true,
        };
        let mut bench = Self {
            twin: Engine::new(polarity, settings, camera.pins(false, false, 0)),
            random: Pcg64Mcg::seed_from_u64(seed),
            camera,
            clocks,
            falling: false,
            clk: module.port("clk"),
            pclk: module.port("camera_pclk"),
            pins: ["vsync", "href", "data"].map(|pin| module.port(&format!("camera_{pin}"))),
            latched: module.port("latched"),
            counters: Counters::new(&module, "events"),
            module,
            now: 0,
            next_sys: 1,
            latches: 0,
        };
        for (pin, value) in [
            ("vsync_low", polarity.vsync_low),
            ("href_low", polarity.href_low),
            ("swap", polarity.swap),
        ] {
            bench.module.drive(&format!("pins.{pin}"), value);
        }
        bench.set(settings);
        bench.module.drive("rst", true);
        bench.pass(100 * clocks.sys);
        bench.module.drive("rst", false);
        bench
    }

    /// Makes a bench whose camera sends neither frames nor a clock, and enables the engine.
    pub fn silent(name: &str) -> Self {
        let mut bench = Self::stopped(
            name,
            Clocks::URBANA,
            Polarity::default(),
            settings([1; 2]),
            1,
        );
        bench.module.drive("enable", true);
        bench.pass(3000 * bench.clocks.sys);
        bench
    }

    /// Requests new settings, which are latched at the next frame.
    pub fn set(&mut self, settings: Settings) {
        self.twin.settings = settings;
        let Region { first, last } = settings.region;
        let [(a, window_a), (b, window_b)] = settings.windows;
        for (name, value) in [
            ("width", settings.size[0]),
            ("height", settings.size[1]),
            ("window_a.channel", a as u16),
            ("window_a.lower", window_a.lower.into()),
            ("window_a.upper", window_a.upper.into()),
            ("window_b.channel", b as u16),
            ("window_b.lower", window_b.lower.into()),
            ("window_b.upper", window_b.upper.into()),
            ("region_x.first", first[0]),
            ("region_x.last", last[0]),
            ("region_y.first", first[1]),
            ("region_y.last", last[1]),
            ("least_run", settings.least_run.into()),
        ] {
            self.module.drive(&format!("settings.{name}"), value);
        }
    }

    /// Sends a frame, and compares the engine with the model after it.
    pub fn frame(&mut self, picture: &Picture, end: End) {
        let pins = self.camera.send(&mut self.random, picture, end);
        self.send(&pins);
        self.compare();
    }

    /// Sends a VSYNC, after which the engine accepts frames.
    pub fn begin(&mut self) {
        let picture = Picture::default();
        let pins = self.camera.send(&mut self.random, &picture, End::Vsync);
        self.send(&pins);
    }

    /// Drives a sequence of pin states, one per period of the sensor's clock.
    pub fn send(&mut self, sent: &[Pins]) {
        for &pins in sent {
            self.twin.clock(pins);
            let values = [pins.vsync.into(), pins.href.into(), pins.data.into()];
            for (port, value) in self.pins.into_iter().zip(values) {
                self.module.set_value(port, value);
            }
            for level in [self.falling, !self.falling] {
                self.module.set_value(self.pclk, level.into());
                self.module.settle();
                self.pass(self.clocks.camera / 2);
            }
        }
    }

    /// Keeps the image sensor's pins idle for `count` clocks of the engine.
    pub fn idle(&mut self, count: u64) {
        let count = (count * self.clocks.sys).div_ceil(self.clocks.camera);
        let pins = self.camera.pins(false, false, 0);
        self.send(&vec![pins; count as usize]);
    }

    /// Stops the sensor's clock for `count` clocks of the engine, which must exceed the engine's time-out.
    pub fn stop(&mut self, count: u64) {
        self.twin.stop();
        self.pass(count * self.clocks.sys);
        assert_eq!(self.module.read("status.running"), 0);
    }

    /// Advances the engine's clock by `time`.
    fn pass(&mut self, time: u64) {
        self.now += time;
        while self.next_sys <= self.now {
            self.counters.sample(&self.module);
            self.latches += u32::from(self.module.is_high(self.latched));
            for level in [1, 0] {
                self.module.set_value(self.clk, level);
                self.module.settle();
            }
            self.next_sys += self.clocks.sys;
        }
    }

    /// Compares all values that software can read with the model's.
    pub fn compare(&mut self) {
        self.idle(60);
        let twin = &self.twin;
        let read = |name: &str| self.module.read(name);
        let counts =
            ["frames", "frames_dropped", "lines_malformed"].map(|name| self.counters.get(name));
        let expected = [
            twin.counts.frames,
            twin.counts.frames_dropped,
            twin.counts.lines_malformed,
        ];
        assert_eq!(
            counts,
            expected.map(u64::from),
            "frames, dropped frames, malformed lines"
        );
        assert_eq!(
            read("status.fault"),
            twin.fault.map_or(0, |fault| fault as u64),
            "{:?}",
            twin.fault
        );
        let seen = [read("status.pixels"), read("status.lines")];
        assert_eq!(
            seen,
            [twin.seen.pixels, twin.seen.lines].map(u64::from),
            "pixels and lines seen"
        );
        assert_eq!(self.latches, twin.counts.frames, "pulses of `latched`");
        assert_eq!(read("sequence_number"), u64::from(twin.counts.frames));
        if twin.counts.frames == 0 {
            return;
        }
        let Region { first, last } = twin.results.bounds;
        for (name, value) in [
            ("count", twin.results.count.into()),
            ("sum_x", twin.results.sums[0].into()),
            ("sum_y", twin.results.sums[1].into()),
            ("box_x.first", first[0].into()),
            ("box_x.last", last[0].into()),
            ("box_y.first", first[1].into()),
            ("box_y.last", last[1].into()),
            ("sum_xx", twin.results.products[0]),
            ("sum_xy", twin.results.products[1]),
            ("sum_yy", twin.results.products[2]),
        ] {
            assert_eq!(read(&format!("results.{name}")), value, "{name}");
        }
    }

    /// Requests a small picture (snapshot).
    pub fn request_snapshot(&mut self, step: u8, is_colour: bool) {
        self.twin.request_snapshot(step, is_colour);
        self.module.drive("snapshot_request.step", step);
        self.module.drive("snapshot_request.colour", is_colour);
        self.pulse("snapshot_request.start");
    }

    /// Compares the small picture, or its absence, with the model's.
    pub fn compare_snapshot(&mut self) {
        let is_ready = self.module.read("snapshot_state.ready") != 0;
        let expected = self.twin.snapshot().cloned();
        assert_eq!(is_ready, expected.is_some(), "ready");
        let Some(expected) = expected else { return };
        let found = ["words", "sequence_number"]
            .map(|name| self.module.read(&format!("snapshot_state.{name}")));
        let expected_state = [expected.words().len() as u64, expected.frame().into()];
        assert_eq!(found, expected_state, "words and frame");
        self.module.drive("snapshot_request.place", 0);
        self.pulse("snapshot_request.set");
        for (place, word) in expected.words().iter().enumerate() {
            // Keeps the sensor's clock running: without edges, the engine would take the sensor as stopped.
            self.idle(2);
            assert_eq!(
                self.module.read("snapshot_state.word"),
                u64::from(*word),
                "word {place}"
            );
            self.pulse("snapshot_request.move");
        }
    }

    fn pulse(&mut self, name: &str) {
        self.module.drive(name, 1);
        self.pass(self.clocks.sys);
        self.module.drive(name, 0);
    }
}
