//! Compares the texture filter with the model: averages of neighbouring texels, and lighting.

use std::collections::VecDeque;

use glint_core::colour::{Rgb565, Rounding};
use glint_model::triangle::textured::{average, lit};
use glint_testbench::{Bits, Module, Port};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Number of clocks from a step to its light, as in `texture_pkg`.
const LIGHT: usize = 5;
/// Number of clocks from a step to its colours, as in `texture_pkg`.
const LATENCY: usize = 9;
/// Full light of each channel.
const FULL: [u8; 3] = [248, 252, 248];

/// The texels of a step's pixels, before filtering.
#[derive(Clone, Copy, Debug)]
enum Texels {
    /// One texel for each lane.
    Nearest([u16; 4]),
    /// Four neighbours for each of two pixels: in the lanes 2 and 3 if `upper` is set, else in the
    /// lanes 0 and 1.
    Bilinear {
        upper: bool,
        neighbours: [[u16; 4]; 2],
        weights: [[u8; 2]; 2],
    },
}

#[derive(Clone, Copy, Debug)]
struct Step {
    texels: Texels,
    /// Covered lanes of the step, one bit each; at least one lane is covered.
    mask: u8,
    half: bool,
    last: bool,
    opaque: u8,
    light: [u8; 3],
    /// The lowest bits of the line in the picture.
    line: u8,
}

impl Step {
    fn is_bilinear(&self) -> bool {
        matches!(self.texels, Texels::Bilinear { .. })
    }

    /// The model's colour of each covered lane.
    fn colours(&self, rounding: Rounding) -> [Option<u16>; 4] {
        [0, 1, 2, 3].map(|lane: usize| {
            let texel = match self.texels {
                Texels::Nearest(texels) => Rgb565(texels[lane]).fractions(),
                Texels::Bilinear {
                    neighbours,
                    weights,
                    ..
                } => {
                    let neighbours = neighbours[lane % 2].map(|texel| Rgb565(texel).channels());
                    average(neighbours, weights[lane % 2].map(u32::from))
                }
            };
            let place = [lane as u32, self.line.into()];
            (self.mask >> lane & 1 == 1)
                .then(|| Rgb565::rounded(lit(texel, self.light, rounding), rounding, place).0)
        })
    }
}

struct Bench {
    module: Module,
    rounding: Rounding,
    light: Port,
    line: Port,
    inputs: [Port; 9],
    outputs: [Port; 6],
    /// Steps of the last clocks, newest first.
    inside: VecDeque<Option<Step>>,
    checked: usize,
}

impl Bench {
    fn new(seed: u32) -> Self {
        let mut module = Module::new("texture_filter", seed);
        let rounding = Rounding::new(!seed.is_multiple_of(2));
        module.drive("dither", rounding == Rounding::Dithered);
        Self {
            rounding,
            light: module.port("light"),
            line: module.port("line"),
            inputs: [
                "valid",
                "mask",
                "half",
                "last",
                "bilinear",
                "opaque",
                "texels",
                "neighbours",
                "weights",
            ]
            .map(|name| module.port(&format!("in_{name}"))),
            outputs: ["valid", "mask", "half", "last", "opaque", "colours"]
                .map(|name| module.port(&format!("out_{name}"))),
            inside: VecDeque::from([None; LATENCY + 1]),
            module,
            checked: 0,
        }
    }

    fn clock(&mut self, step: Option<Step>) {
        let [valid, mask, half, last, bilinear, opaque, rest @ ..] = self.inputs;
        let [texels, neighbours, weights] = rest;
        let module = &mut self.module;
        self.inside.pop_back();
        self.inside.push_front(step);
        module.set(valid, u64::from(step.is_some()));
        if let Some(step) = step {
            module.set(mask, u64::from(step.mask));
            module.set(half, u64::from(step.half));
            module.set(last, u64::from(step.last));
            module.set(opaque, u64::from(step.opaque));
            module.set(bilinear, u64::from(step.is_bilinear()));
            match step.texels {
                Texels::Nearest(colours) => module.set(texels, Bits::pack(16, colours)),
                Texels::Bilinear {
                    neighbours: colours,
                    weights: parts,
                    ..
                } => {
                    module.set(
                        neighbours,
                        Bits::pack(16, colours.as_flattened().iter().copied()),
                    );
                    module.set(weights, Bits::pack(4, parts.as_flattened().iter().copied()));
                }
            }
        }
        if let Some(step) = self.inside[LIGHT] {
            module.set(self.light, Bits::pack(8, step.light));
            module.set(self.line, u64::from(step.line));
        }
        module.settle();
        let [valid, mask, half, last, opaque, colours] = self.outputs;
        let expected = self.inside[LATENCY];
        assert_eq!(module.is_high(valid), expected.is_some(), "valid");
        if let Some(step) = expected {
            assert_eq!(module.value(mask), u64::from(step.mask), "{step:?}");
            assert_eq!(module.value(opaque), u64::from(step.opaque), "{step:?}");
            assert_eq!(module.is_high(half), step.half, "{step:?}");
            assert_eq!(module.is_high(last), step.last, "{step:?}");
            let found = module.value(colours);
            for (lane, colour) in step.colours(self.rounding).into_iter().enumerate() {
                let found = (found >> (16 * lane)) as u16;
                if let Some(colour) = colour {
                    assert_eq!(found, colour, "{found:04x}, lane {lane} of {step:?}");
                    self.checked += 1;
                }
            }
        }
        module.clock();
    }

    fn drain(&mut self) {
        for _ in 0..LATENCY {
            self.clock(None);
        }
    }
}

fn colour([r, g, b]: [usize; 3]) -> u16 {
    (r << 11 | g << 5 | b) as u16
}

/// A step with all its lanes covered.
fn step(texels: Texels, light: [u8; 3]) -> Step {
    let mask = match texels {
        Texels::Nearest(_) => 0b1111,
        Texels::Bilinear { upper, .. } => 0b11 << (2 * u32::from(upper)),
    };
    Step {
        texels,
        mask,
        half: false,
        last: false,
        opaque: mask,
        light,
        line: (light[0] ^ light[1]) % 4,
    }
}

/// Light: over all values of `number`, each channel takes all its values.
fn light(number: usize) -> [u8; 3] {
    FULL.map(|full| (number % (usize::from(full) + 1)) as u8)
}

#[test]
fn nearest_texels_with_every_light() {
    for seed in [1, 2] {
        nearest_texels(seed);
    }
}

/// Checks with dithering for an odd seed, without it for an even one.
fn nearest_texels(seed: u32) {
    let mut bench = Bench::new(seed);
    for number in 0..=252 {
        for value in 0..64 {
            let texels = [0, 19, 38, 57].map(|lane: usize| {
                let value = value + lane;
                colour([value % 32, value % 64, (value + 5) % 32])
            });
            bench.clock(Some(step(Texels::Nearest(texels), light(number))));
        }
    }
    bench.drain();
    assert_eq!(bench.checked, 4 * 253 * 64);
}

#[test]
fn averages_of_every_value_with_every_light() {
    for seed in [3, 4] {
        averages(seed);
    }
}

/// Checks with dithering for an odd seed, without it for an even one.
fn averages(seed: u32) {
    let mut bench = Bench::new(seed);
    for number in 0..=252 {
        for value in 0..64 {
            // The weights of the two pixels together are all even weights, which give all values of
            // red and blue.
            for weight in (0..16).step_by(4) {
                let neighbours = |value: usize| {
                    let at = |value: usize| colour([value.min(31), value.min(63), value.min(31)]);
                    [at(value), at(value + 1), 0, 0xFFFF]
                };
                let texels = Texels::Bilinear {
                    upper: (value + number) % 2 == 1,
                    neighbours: [neighbours(value), neighbours(value % 32)],
                    weights: [[weight, 0], [weight + 2, 0]],
                };
                bench.clock(Some(step(texels, light(number))));
            }
        }
    }
    bench.drain();
    assert_eq!(bench.checked, 2 * 4 * 64 * 253);
}

#[test]
fn every_weight_with_random_and_extreme_texels() {
    let mut bench = Bench::new(5);
    let mut random = Pcg64Mcg::new(7);
    for round in 0..64 {
        for weights in 0..=255 {
            let mut texel = || match (round % 4, random.random_range(0..4)) {
                (0, 0) => 0,
                (0, 1) => 0xFFFF,
                (0, 2) => 0xF81F,
                (0, _) => 0x07E0,
                _ => random.random(),
            };
            let neighbours = [(); 2].map(|()| [(); 4].map(|()| texel()));
            let other: u8 = random.random();
            let texels = Texels::Bilinear {
                upper: random.random(),
                neighbours,
                weights: [weights, other].map(|weights| [weights & 15, weights >> 4]),
            };
            let light = if round % 2 == 0 {
                FULL
            } else {
                FULL.map(|full| random.random_range(0..=full))
            };
            bench.clock(Some(step(texels, light)));
        }
    }
    bench.drain();
    assert_eq!(bench.checked, 2 * 64 * 256);
}

/// Full light does not change a texel, and steps of any kind, with gaps between them, come out in
/// order with their flags `half`, `last` and `opaque`.
#[test]
fn steps_keep_their_flags() {
    let mut bench = Bench::new(7);
    let mut random = Pcg64Mcg::new(8);
    for is_bilinear in [false, true, false, true] {
        for _ in 0..2000 {
            let upper = random.random();
            let texels = if is_bilinear {
                Texels::Bilinear {
                    upper,
                    neighbours: [(); 2].map(|()| [random.random(); 4]),
                    weights: [[(); 2]; 2].map(|pixel| pixel.map(|()| random.random_range(0..16))),
                }
            } else {
                Texels::Nearest(random.random())
            };
            let mut step = step(texels, FULL);
            step.mask = match (is_bilinear, upper) {
                (false, _) => random.random_range(1..16),
                (true, false) => random.random_range(1..4),
                (true, true) => 4 * random.random_range(1..4),
            };
            step.line = random.random_range(0..4);
            step.opaque = random.random_range(0..16);
            (step.half, step.last) = (random.random(), random.random());
            if let Texels::Nearest(texels) = texels {
                for (colour, texel) in step.colours(bench.rounding).into_iter().zip(texels) {
                    assert!(colour.is_none_or(|colour| colour == texel));
                }
            }
            bench.clock(random.random_bool(0.7).then_some(step));
        }
        bench.drain();
    }
}
