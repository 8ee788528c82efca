//! Tests of whole frames of the raymarcher: every pixel is output once, equal to the model's, while `band_open` is high for its band.

use glint_model::SIZES;
use glint_model::raymarch::{FieldSetup, FieldStats, Palette, Rays, State};
use glint_model::triangle::descriptor::band_rows;
use glint_testbench::{Bits, Counters, Module, Sink, Stalls};

use crate::scenes::{
    FIELDS, ROUND, SPONGES, UNIONS, further_kinds, lights, setup, setup_with, tunnel,
};
use glint_testbench::raymarch::{
    Pixel, RayPlace, pixel, set_blocks, set_lane, set_lights, set_paint, set_rays,
};
use glint_vectors::Random;

const COUNTERS: [&str; 8] = [
    "cycles_busy",
    "cycles_idle",
    "items_out",
    "evaluations",
    "items_in",
    "hits",
    "misses",
    "undecided",
];

struct Bench {
    module: Module,
    lanes: u64,
    counters: Counters,
    counted: [u64; 8],
}

/// Cost of a frame: the module's counters and the model's statistics.
struct Taken {
    counters: [u64; 8],
    stats: FieldStats,
}

impl Taken {
    fn busy(&self, bench: &Bench) -> String {
        let [busy, idle, ..] = self.counters;
        let evaluations = self.stats.evaluations as f64;
        format!(
            "{:.2} evaluations a ray, {:.4} a clock and lane, {busy} clocks, {idle} of lanes idle",
            evaluations / f64::from(self.stats.rays),
            evaluations / (busy * bench.lanes) as f64
        )
    }
}

impl Bench {
    fn new(name: &str, lanes: u64, seed: u32) -> Self {
        let module = Module::new(name, seed);
        Self {
            counters: Counters::new(&module, "events"),
            module,
            lanes,
            counted: [0; 8],
        }
    }

    fn clock(&mut self) {
        self.module.settle();
        self.counters.sample(&self.module);
        self.module.clock();
    }

    fn clocks(&mut self, clocks: u32) {
        (0..clocks).for_each(|_| self.clock());
    }

    fn counted(&self) -> [u64; 8] {
        COUNTERS.map(|name| self.counters.get(name))
    }

    fn port(&mut self, name: &str, value: u64) {
        let port = self.module.port(name);
        self.module.set(port, value);
    }

    fn pulse(&mut self, name: &str) {
        self.port(name, 1);
        self.clock();
        self.port(name, 0);
    }

    fn set(&mut self, setup: &FieldSetup, palette: &Palette) {
        set_lane(&mut self.module, setup);
        set_rays(&mut self.module, setup);
        set_paint(&mut self.module, setup, palette);
        set_lights(&mut self.module, setup, &palette.lights);
        set_blocks(&mut self.module, setup, "cone_offset", "cone_spread");
        self.port("prepass", setup.cones.is_some().into());
        self.port("size", u64::from(setup.width / 640));
    }

    /// Draws a frame and compares its pixels with the model's. With `hurry`, `band_open` rises immediately for each band, and the
    /// output never stalls; otherwise both are delayed at random.
    fn draw(
        &mut self,
        random: &mut Random,
        setup: &FieldSetup,
        palette: &Palette,
        hurry: bool,
    ) -> Taken {
        self.set(setup, palette);
        let lines = band_rows(setup.width);
        let eyes: u32 = if setup.stereo.is_some() { 2 } else { 1 };
        let share = if hurry { 0.0 } else { 0.3 };
        let mut sink = Sink::new(
            &self.module,
            "group",
            &Pixel::PAYLOAD,
            Stalls::new(random.bits(), share),
        );
        let done = self.module.port("band_done");
        let mut stats = FieldStats::default();
        let mut rays = Rays::new(setup);
        self.pulse("start");
        for band in 0..setup.height / lines {
            let mut expected = std::collections::HashMap::new();
            for y in 0..lines {
                for (x, eye) in (0..setup.width).flat_map(|x| (0..eyes).map(move |eye| (x, eye))) {
                    let place = RayPlace {
                        odd: band % 2 == 1,
                        line: y,
                        column: x,
                        eye: eye as usize,
                    };
                    let ray = rays.ray(place.eye, x, band * lines + y);
                    let outcome = setup.march(&ray);
                    stats.count(setup, &outcome);
                    expected.insert((eye.into(), y.into(), x.into()), {
                        pixel(setup, palette, place, &ray, &outcome)
                    });
                }
            }
            if !hurry {
                // On the board, the triangles of a band are drawn first; the delay simulates their drawing time.
                self.clocks(random.integer(0, 3000) as u32);
            }
            self.port("band_open", 1);
            let begun = self.module.cycles();
            loop {
                assert!(
                    self.module.cycles() - begun < 40_000_000,
                    "the raymarcher stalls in {setup:?}"
                );
                sink.drive(&mut self.module);
                self.module.settle();
                sink.sample(&self.module);
                if self.module.is_high(done) {
                    break;
                }
                self.clock();
            }
            for item in sink.take() {
                let found = Pixel::from(std::array::from_fn(|i| item[i].number()));
                let column = 8 * found.column + u64::from(found.mask.trailing_zeros());
                let place = (found.eye, found.line, column);
                let wanted = expected.remove(&place).unwrap_or_else(|| {
                    panic!("{found:?} was output twice, or belongs to another band")
                });
                assert_eq!(found, wanted, "in band {band} of {setup:?}");
            }
            assert!(expected.is_empty(), "band {band} ended early");
            self.port("band_open", 0);
            self.pulse("band_next");
        }
        stats.evaluations += rays.evaluations();
        let busy = self.module.port("busy");
        assert!(!self.module.is_high(busy), "busy after the last band");
        // Counters count up to four clocks after the last pixel, and then stop.
        self.clocks(4);
        let events = self.module.port("events");
        assert_eq!(
            self.module.get(events),
            Bits::default(),
            "events of no frame"
        );
        let counted = self.counted();
        let counters = std::array::from_fn(|i| counted[i] - self.counted[i]);
        self.counted = counted;
        assert_eq!(
            counters[2..],
            [
                stats.rays.into(),
                stats.evaluations,
                stats.rays.into(),
                stats.hits.into(),
                stats.misses.into(),
                stats.undecided.into()
            ],
            "{:?} of {setup:?}",
            &COUNTERS[2..]
        );
        Taken { counters, stats }
    }
}

#[test]
fn frames_of_all_fields_with_stalls() {
    let mut random = Random(9);
    let mut bench = Bench::new("raymarcher", 2, 1);
    for _ in 0..4 {
        draw_in_short(&mut bench, &mut random, &FIELDS);
    }
    for text in further_kinds() {
        draw_in_short(&mut bench, &mut random, &[text]);
    }
    // Back-pressure of pixels blocks the ends of rays, which in turn block the rays.
    assert!(bench.counters.get("cycles_stalled") > 0);
}

/// Draws a frame of a random field of `fields` with a low step limit, because an undecided ray, which takes all steps, costs as
/// much as 20 decided rays.
fn draw_in_short(bench: &mut Bench, random: &mut Random, fields: &[&str]) {
    let mut setup = setup(random, fields);
    setup.tuning.cap = setup.tuning.cap.min(40);
    bench.draw(random, &setup, &Palette::default(), false);
}

#[test]
fn frames_of_sponges_with_cones_and_stalls() {
    let mut random = Random(12);
    let mut bench = Bench::new("raymarcher_sponge", 4, 2);
    for _ in 0..3 {
        let mut setup = setup_with(&mut random, &SPONGES, true);
        setup.tuning.cap = setup.tuning.cap.min(20);
        bench.draw(&mut random, &setup, &Palette::default(), false);
    }
}

#[test]
fn frames_of_round_fields_in_all_lights() {
    let mut random = Random(12);
    let mut bench = Bench::new("raymarcher", 2, 1);
    for frame in 0..5 {
        let fields = [&ROUND[..], &UNIONS, &SPONGES][frame % 3];
        let prepass = frame % 2 == 1;
        let mut setup = setup_with(&mut random, fields, prepass);
        setup.tuning.cap = setup.tuning.cap.min(20);
        let palette = Palette {
            lights: lights(&mut random),
            ..Palette::default()
        };
        bench.draw(&mut random, &setup, &palette, frame % 2 == 0);
    }
}

/// Draws a sphere with one light and with four lights: each further light may take one more clock for each pixel of the sphere.
#[test]
fn round_pixels_take_a_clock_a_light() {
    let mut random = Random(13);
    let mut bench = Bench::new("raymarcher", 2, 1);
    let setup = loop {
        let setup = setup(&mut random, &["sphere:1"]);
        let middle = setup.ray(0, setup.width / 2, setup.height / 2);
        let end = setup.march(&middle);
        if setup.width == 320 && end.steps > 2 && matches!(end.state, State::Hit(_)) {
            break setup;
        }
    };
    let [one, four] = [1, 4].map(|count| {
        let mut palette = Palette::default();
        palette.lights.count = count;
        let taken = bench.draw(&mut random, &setup, &palette, true);
        println!("{count} lights: {} clocks", taken.counters[0]);
        (taken.counters[0], u64::from(taken.stats.hits))
    });
    assert!(four.0 <= one.0 + 3 * four.1 + 100, "{one:?}, {four:?}");
}

#[test]
fn sponges_keep_the_lanes_busy() {
    let mut random = Random(10);
    let mut bench = Bench::new("raymarcher_sponge", 4, 1);
    for frame in 0..2 {
        let setup = setup(&mut random, &SPONGES);
        let taken = bench.draw(&mut random, &setup, &Palette::default(), true);
        println!("frame {frame}: {}", taken.busy(&bench));
        // Below 8 evaluations per ray, the ray generator limits the speed, not the lanes.
        let share = taken.stats.evaluations as f64 / (taken.counters[0] * bench.lanes) as f64;
        assert!(share >= 0.98 || taken.stats.evaluations < 8 * u64::from(taken.stats.rays));
    }
}

/// Measures the cost of a frame in the sponge's largest tunnel, where rays take the most evaluations, without and with a
/// prepass of cones: at 320 × 180, or at 1280 × 720 with `GLINT_RTL_FIELDS=all`.
#[test]
fn cones_take_evaluations_off_the_rays_of_a_tunnel() {
    let all = std::env::var("GLINT_RTL_FIELDS").is_ok_and(|fields| fields == "all");
    let size = SIZES[if all { 2 } else { 0 }];
    let mut random = Random(13);
    let mut bench = Bench::new("raymarcher_sponge", 4, 1);
    let clocks = [false, true].map(|prepass| {
        let setup = tunnel(size, prepass);
        let taken = bench.draw(&mut random, &setup, &Palette::default(), true);
        println!("{size:?}, prepass {prepass}: {}", taken.busy(&bench));
        taken.counters[0]
    });
    assert!(clocks[1] * 3 < clocks[0] * 2, "{clocks:?} clocks");
}

#[test]
fn a_frame_given_up_leaves_nothing() {
    let mut random = Random(11);
    let mut bench = Bench::new("raymarcher", 2, 3);
    for clocks in [1, 20, 500, 20_000] {
        let setup = setup(&mut random, &["cubes:2,0.5"]);
        bench.set(&setup, &Palette::default());
        bench.port("band_open", 1);
        bench.port("group_ready", 1);
        bench.pulse("start");
        bench.clocks(clocks);
        bench.port("band_open", 0);
        bench.pulse("restart");
        bench.clocks(4);
        bench.counted = bench.counted();
        let mut setup = setup;
        setup.tuning.cap = 8;
        bench.draw(&mut random, &setup, &Palette::default(), false);
    }
}
