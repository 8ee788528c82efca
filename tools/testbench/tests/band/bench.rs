//! Test bench of the band buffer: sources of pixel groups and of band ends, and a memory.

use glint_core::colour::Rounding;
use glint_testbench::{Bits, Counters, Module, Port, Sink, Source, Stalls};
use std::collections::VecDeque;

use crate::pixels::{Band, Group, Kind, Left, PICTURE_LINES, Pixels, ROWS_OF_A_BANK, WORDS, Word};
use crate::sky::scaled;

pub struct Bench {
    pub module: Module,
    pub group_source: Source,
    pub band_source: Source,
    sky_source: Source,
    pub words: Sink,
    /// Words (address and data) written to memory by the module.
    pub written: Vec<Word>,
    pub groups: VecDeque<Group>,
    pub bands: VecDeque<Band>,
    pub band_valid: Port,
    pub restart: Port,
    pub clearing: Port,
    pub flushed: Port,
    /// Whether `band_valid` was high in the previous clock: then no group may be taken.
    pub closed: bool,
    answer: [Port; 2],
    /// Expected masks of the lanes that pass the depth test, one for each non-empty query ([`Kind::Asks`]).
    pub asked: Vec<u8>,
    /// Number of lanes that pass the depth test, over all plain groups and queries.
    pub passed: u64,
    pub answered: Vec<u8>,
    pub drawn: Pixels,
    pub left: Left,
    /// The band of the last started flush.
    pub flushed_last: Option<Band>,
    pub expected: Vec<Word>,
    /// Number of rows of the band buffer per picture line; a row holds a group of eight pixels.
    pub stride: usize,
    pub counters: Counters,
}

impl Bench {
    /// Creates a bench with the module variant `name` right after reset, before the band buffer has cleared its banks.
    pub fn new(name: &str, seed: u64, group_stalls: f64, memory_stalls: f64) -> Self {
        let mut module = Module::new(name, seed as u32);
        let restart = module.port("restart");
        module.set(restart, 0_u64);
        Self {
            group_source: Source::new(
                &module,
                "group",
                &[
                    "row", "line", "column", "mask", "halves", "codes", "colours", "asks",
                    "blended",
                ],
                Stalls::new(seed, group_stalls),
            ),
            band_source: Source::new(
                &module,
                "band",
                &[
                    "base",
                    "depth_base",
                    "lines",
                    "stride",
                    "first_line",
                    "slot",
                    "whole",
                    "with_depth",
                    "clear",
                    "compose",
                    "sky",
                    "dither",
                ],
                Stalls::new(seed + 100, group_stalls),
            ),
            sky_source: Source::new(
                &module,
                "sky",
                &["line", "colour"],
                Stalls::new(seed + 300, group_stalls),
            ),
            words: Sink::new(
                &module,
                "word",
                &["addr", "data"],
                Stalls::new(seed + 200, memory_stalls),
            ),
            written: Vec::new(),
            groups: VecDeque::new(),
            bands: VecDeque::new(),
            band_valid: module.port("band_valid"),
            restart,
            clearing: module.port("clearing"),
            flushed: module.port("flushed"),
            closed: false,
            answer: ["answer_valid", "answer_lanes"].map(|name| module.port(name)),
            asked: Vec::new(),
            passed: 0,
            answered: Vec::new(),
            drawn: Pixels::clear(),
            left: [(); 2].map(|()| vec![None; PICTURE_LINES]),
            flushed_last: None,
            expected: Vec::new(),
            stride: 40,
            counters: Counters::new(&module, "events"),
            module,
        }
    }

    /// Creates a bench whose band buffer has cleared its banks.
    pub fn ready(seed: u64, group_stalls: f64, memory_stalls: f64) -> Self {
        Self::of("band_buffer", seed, group_stalls, memory_stalls)
    }

    /// Creates a bench as [`ready`](Self::ready) does, with the module variant `name`.
    pub fn of(name: &str, seed: u64, group_stalls: f64, memory_stalls: f64) -> Self {
        let mut bench = Self::new(name, seed, group_stalls, memory_stalls);
        bench.run_until(ROWS_OF_A_BANK + 10, |bench| !bench.is(bench.clearing));
        bench
    }

    pub fn is(&self, port: Port) -> bool {
        self.module.is_high(port)
    }

    pub fn counter(&self, name: &str) -> u64 {
        self.counters.get(name)
    }

    pub fn push_group(&mut self, group: Group) {
        self.group_source.push(vec![
            Bits::from(group.row as u64),
            Bits::from((group.row / self.stride) as u64),
            Bits::from((group.row % self.stride) as u64),
            Bits::from(u64::from(group.mask)),
            Bits::from(u64::from(group.halves)),
            Bits::pack(18, group.codes),
            Bits::pack(16, group.colours),
            Bits::from(u64::from(group.kind == Kind::Asks)),
            Bits::from(u64::from(group.kind == Kind::Blended)),
        ]);
        self.groups.push_back(group);
    }

    /// Queues the end of a band, which starts its flush. If the frame buffer's content in the band's lines is unknown, the flush
    /// must write all words of the band.
    pub fn push_band(&mut self, mut band: Band) {
        assert_eq!(band.stride, self.stride);
        let waiting = self.bands.iter().filter(|other| other.slot == band.slot);
        let mut known: Vec<_> = self.left[band.slot].iter().map(Option::is_some).collect();
        waiting.for_each(|other| known[other.picture_lines()].fill(true));
        band.whole |= known[band.picture_lines()].contains(&false) || band.sky;
        if band.sky {
            for row in 0..band.lines * band.stride {
                let (colour, line) = band.sky_of(row);
                let item = [line, scaled(colour)].map(|value| Bits::from(u64::from(value)));
                self.sky_source.push(item.to_vec());
            }
        }
        self.band_source.push(vec![
            Bits::from(u64::from(band.base)),
            Bits::from(u64::from(band.depth_base)),
            Bits::from(band.lines as u64),
            Bits::from(band.stride as u64),
            Bits::from(band.first_line as u64),
            Bits::from(band.slot as u64),
            Bits::from(u64::from(band.whole)),
            Bits::from(u64::from(band.with_depth)),
            Bits::from(u64::from(band.clear)),
            Bits::from(u64::from(band.compose)),
            Bits::from(u64::from(band.sky)),
            Bits::from(u64::from(band.rounding == Rounding::Dithered)),
        ]);
        self.bands.push_back(band);
    }

    pub fn clock(&mut self) {
        let module = &mut self.module;
        self.group_source.drive(module);
        self.band_source.drive(module);
        self.sky_source.drive(module);
        self.words.drive(module);
        module.settle();
        self.counters.sample(module);
        self.group_source.sample(module);
        self.band_source.sample(module);
        self.sky_source.sample(module);
        self.words.sample(module);
        self.written
            .extend(self.words.take().into_iter().map(|item| {
                let data = std::array::from_fn(|i| item[1].words()[i]);
                (item[0].words()[0], data)
            }));
        if self.group_source.len() < self.groups.len() {
            let group = self.groups.pop_front().expect("it was queued");
            let cycle = module.cycles();
            assert!(
                !self.closed,
                "cycle {cycle}: a group was taken after its band's end"
            );
            let passing = self.drawn.draw(&group);
            if group.kind != Kind::Blended {
                self.passed += u64::from(passing.count_ones());
            }
            if group.kind == Kind::Asks && group.mask != 0 {
                self.asked.push(passing);
            }
        }
        let [valid, lanes] = self.answer;
        if module.is_high(valid) {
            self.answered.push(module.value(lanes) as u8);
        }
        self.closed = module.is_high(self.band_valid);
        if self.band_source.len() < self.bands.len() {
            let band = self.bands.pop_front().expect("it was queued");
            self.expected
                .extend(self.drawn.words(&band, &mut self.left));
            self.flushed_last = Some(band);
            self.drawn = Pixels::clear();
            self.closed = false;
        }
        module.clock();
    }

    /// Clocks the module until `done`; returns the number of clocks.
    pub fn run_until(&mut self, limit: u64, done: impl Fn(&Self) -> bool) -> u64 {
        for clocks in 0..limit {
            self.module.settle();
            if done(self) {
                return clocks;
            }
            self.clock();
        }
        panic!("not done after {limit} clocks");
    }

    /// Queues groups and the end of their band, and runs until all groups are taken.
    pub fn draw(&mut self, groups: impl IntoIterator<Item = Group>, band: Band) {
        for group in groups {
            self.push_group(group);
        }
        let limit = 200 * (self.groups.len() as u64 + 4 * ROWS_OF_A_BANK);
        self.run_until(limit, |bench| bench.groups.is_empty());
        self.push_band(band);
    }

    /// Runs until all words are in memory, and compares them with the expected words.
    pub fn finish(&mut self) {
        self.run_until(200 * 4 * ROWS_OF_A_BANK, |bench| {
            bench.bands.is_empty() && bench.is(bench.flushed)
        });
        self.compare();
    }

    pub fn compare(&mut self) {
        for (index, (found, expected)) in self.written.iter().zip(&self.expected).enumerate() {
            assert_eq!(found, expected, "word {index} (address, data)");
        }
        assert_eq!(self.written.len(), self.expected.len(), "words");
        assert_eq!(self.answered, self.asked, "answers");
        self.written.clear();
        self.expected.clear();
    }
}

impl Bench {
    /// Restarts the band buffer while memory takes no words, and checks that the buffer still
    /// clears its banks. When memory takes words again, at most the words in the buffer's FIFO may
    /// arrive.
    pub fn restart_with_dead_memory(&mut self) {
        let alive = self.words.set_stalls(Stalls::new(1, 1.0));

        // At the restart, the sources drop all groups and bands not yet taken.
        self.module.set(self.restart, 1_u64);
        self.clock();
        self.module.set(self.restart, 0_u64);
        let seen = self.written.len();
        if let Some(band) = self.flushed_last {
            self.left[band.slot][band.picture_lines()].fill(None);
        }
        self.group_source.clear();
        self.groups.clear();
        self.band_source.clear();
        self.sky_source.clear();
        self.bands.clear();
        self.drawn = Pixels::clear();
        self.closed = false;

        self.module.settle();
        assert!(self.is(self.clearing));
        let clocks = self.run_until(2 * ROWS_OF_A_BANK, |bench| !bench.is(bench.clearing));
        assert!(clocks <= ROWS_OF_A_BANK + 8, "{clocks} clocks");

        self.words.set_stalls(alive);
        self.run_until(10_000, |bench| bench.is(bench.flushed));
        let more = self.written.len() - seen;
        assert!(more <= WORDS, "{more} words after the restart");
        self.expected.truncate(self.written.len());
        self.compare();
    }
}
