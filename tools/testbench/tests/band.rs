//! The band buffer: what it draws is what a plain depth test draws, and memory gets of every band what may have changed, in order.

use std::collections::VecDeque;
use std::ops::Range;

use glint_model::raymarch::{Tint, compose};
use glint_testbench::{Bits, Counters, Module, Port, Sink, Source, Stalls};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

const LANES: usize = 8;
const ROWS_OF_A_BANK: u64 = 2048;
/// Words that may be on their way: places of the FIFO, and the one at its end.
const WORDS: usize = 16;
const PICTURE_LINES: usize = 720;

#[derive(Clone, Debug)]
struct Group {
    row: usize,
    mask: u8,
    /// Of the colours: 3 both, 1 and 2 what the left and the right eye see.
    halves: u8,
    codes: [u32; LANES],
    colours: [u16; LANES],
}

#[derive(Clone, Copy, Debug)]
struct Band {
    base: u32,
    depth_base: u32,
    lines: usize,
    stride: usize,
    first_line: usize,
    slot: usize,
    whole: bool,
    with_depth: bool,
    clear: u16,
    /// How what two eyes see becomes colours: 0 not at all, 1 red and blue, 2 red and cyan.
    compose: u8,
}

impl Band {
    /// Its lines in the picture.
    fn picture_lines(&self) -> Range<usize> {
        self.first_line..self.first_line + self.lines
    }
}

type Word = (u32, [u32; 4]);

/// Of each line in each frame buffer the columns from the first to the last that were drawn in last, where that is known.
type Left = [Vec<Option<Range<usize>>>; 2];

/// Depth and colour of the pixels that have been drawn, by row.
struct Pixels(Vec<[Option<(u32, u16)>; LANES]>);

impl Pixels {
    fn clear() -> Self {
        Self(vec![[None; LANES]; ROWS_OF_A_BANK as usize])
    }

    fn draw(&mut self, group: &Group) {
        for lane in (0..LANES).filter(|lane| group.mask >> lane & 1 == 1) {
            let pixel = &mut self.0[group.row][lane];
            let (code, colour) = (group.codes[lane], group.colours[lane]);
            if group.halves != 3 {
                let (before, seen) = pixel.unwrap_or_default();
                *pixel = Some(match group.halves {
                    1 => (code, seen & 0xff00 | colour & 0x00ff),
                    _ => (before, seen & 0x00ff | colour & 0xff00),
                });
            } else if group.codes[lane] >= pixel.map_or(0, |(code, _)| code) {
                *pixel = Some((group.codes[lane], group.colours[lane]));
            }
        }
    }

    /// What goes to memory, in order.
    fn words(&self, band: &Band, left: &mut Left) -> Vec<Word> {
        let mut words = Vec::new();
        for (line, picture_line) in band.picture_lines().enumerate() {
            let rows = line * band.stride..(line + 1) * band.stride;
            let drawn = |row: &usize| self.0[*row].iter().any(Option::is_some);
            let now = match (rows.clone().find(drawn), rows.clone().rfind(drawn)) {
                (Some(first), Some(last)) => first - rows.start..last + 1 - rows.start,
                _ => 0..0,
            };
            let before = left[band.slot][picture_line].replace(now.clone());
            let both = if band.whole || band.with_depth {
                0..band.stride
            } else {
                match before.expect("a line of which nothing is known is flushed whole") {
                    before if before.is_empty() => now,
                    before if now.is_empty() => before,
                    before => now.start.min(before.start)..now.end.max(before.end),
                }
            };
            let span = both.map(|column| rows.start + column);
            words.extend(span.clone().map(|row| self.colours(row, band)));
            if band.with_depth {
                words.extend(span.flat_map(|row| self.depths(row, band)));
            }
        }
        words
    }

    fn colours(&self, row: usize, band: &Band) -> Word {
        let seen = |(_, colour): (u32, u16)| {
            let [left, right] = colour.to_le_bytes();
            match band.compose {
                0 => colour,
                1 => compose(Tint::RedBlue, left, right),
                _ => compose(Tint::RedCyan, left, right),
            }
        };
        let colour = self.0[row].map(|pixel| u32::from(pixel.map_or(band.clear, seen)));
        let pairs = [0, 1, 2, 3].map(|i| colour[2 * i] | colour[2 * i + 1] << 16);
        (band.base + row as u32, pairs)
    }

    fn depths(&self, row: usize, band: &Band) -> [Word; 2] {
        let codes = self.0[row].map(|pixel| pixel.map_or(0, |(code, _)| code));
        let (halves, base) = (codes.as_chunks::<4>().0, band.depth_base + 2 * row as u32);
        [(base, halves[0]), (base + 1, halves[1])]
    }
}

struct Bench {
    module: Module,
    group_source: Source,
    band_source: Source,
    words: Sink,
    /// What `words` took.
    written: Vec<Word>,
    groups: VecDeque<Group>,
    bands: VecDeque<Band>,
    band_valid: Port,
    restart: Port,
    clearing: Port,
    flushed: Port,
    /// `band_valid` in the clock before: groups are not taken any more.
    closed: bool,
    drawn: Pixels,
    left: Left,
    /// The band that went to memory last.
    flushed_last: Option<Band>,
    expected: Vec<Word>,
    /// Rows of a line.
    stride: usize,
    counters: Counters,
}

impl Bench {
    /// A band buffer after reset, still clearing itself.
    fn new(name: &str, seed: u64, group_stalls: f64, memory_stalls: f64) -> Self {
        let mut module = Module::new(name, seed as u32);
        let restart = module.port("restart");
        module.set(restart, 0_u64);
        Self {
            group_source: Source::new(
                &module,
                "group",
                &[
                    "row", "line", "column", "mask", "halves", "codes", "colours",
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
                ],
                Stalls::new(seed + 100, group_stalls),
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
            drawn: Pixels::clear(),
            left: [(); 2].map(|()| vec![None; PICTURE_LINES]),
            flushed_last: None,
            expected: Vec::new(),
            stride: 40,
            counters: Counters::new(&module, "events"),
            module,
        }
    }

    /// As `new`, ready to draw.
    fn ready(seed: u64, group_stalls: f64, memory_stalls: f64) -> Self {
        Self::of("band_buffer", seed, group_stalls, memory_stalls)
    }

    /// As `ready`, one of the builds.
    fn of(name: &str, seed: u64, group_stalls: f64, memory_stalls: f64) -> Self {
        let mut bench = Self::new(name, seed, group_stalls, memory_stalls);
        bench.run_until(ROWS_OF_A_BANK + 10, |bench| !bench.is(bench.clearing));
        bench
    }

    fn is(&self, port: Port) -> bool {
        self.module.is_high(port)
    }

    fn counter(&self, name: &str) -> u64 {
        self.counters.get(name)
    }

    fn push_group(&mut self, group: Group) {
        self.group_source.push(vec![
            Bits::from(group.row as u64),
            Bits::from((group.row / self.stride) as u64),
            Bits::from((group.row % self.stride) as u64),
            Bits::from(u64::from(group.mask)),
            Bits::from(u64::from(group.halves)),
            Bits::pack(18, group.codes),
            Bits::pack(16, group.colours),
        ]);
        self.groups.push_back(group);
    }

    /// Ends a band, which is flushed whole where anything is unknown.
    fn push_band(&mut self, mut band: Band) {
        assert_eq!(band.stride, self.stride);
        let waiting = self.bands.iter().filter(|other| other.slot == band.slot);
        let mut known: Vec<_> = self.left[band.slot].iter().map(Option::is_some).collect();
        waiting.for_each(|other| known[other.picture_lines()].fill(true));
        band.whole |= known[band.picture_lines()].contains(&false);
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
        ]);
        self.bands.push_back(band);
    }

    fn clock(&mut self) {
        let module = &mut self.module;
        self.group_source.drive(module);
        self.band_source.drive(module);
        self.words.drive(module);
        module.settle();
        self.counters.sample(module);
        self.group_source.sample(module);
        self.band_source.sample(module);
        self.words.sample(module);
        self.written
            .extend(self.words.take().into_iter().map(|item| {
                let data = std::array::from_fn(|i| item[1].words()[i]);
                (item[0].words()[0], data)
            }));
        if self.group_source.len() < self.groups.len() {
            let group = self.groups.pop_front().expect("it was there");
            let cycle = module.cycles();
            assert!(
                !self.closed,
                "cycle {cycle}: a group was taken after its band's end"
            );
            self.drawn.draw(&group);
        }
        self.closed = module.is_high(self.band_valid);
        if self.band_source.len() < self.bands.len() {
            let band = self.bands.pop_front().expect("it was there");
            self.expected
                .extend(self.drawn.words(&band, &mut self.left));
            self.flushed_last = Some(band);
            self.drawn = Pixels::clear();
            self.closed = false;
        }
        module.clock();
    }

    /// Clocks until something is so, and returns how often.
    fn run_until(&mut self, limit: u64, done: impl Fn(&Self) -> bool) -> u64 {
        for clocks in 0..limit {
            self.module.settle();
            if done(self) {
                return clocks;
            }
            self.clock();
        }
        panic!("not done after {limit} clocks");
    }

    /// Draws groups and ends their band.
    fn draw(&mut self, groups: impl IntoIterator<Item = Group>, band: Band) {
        for group in groups {
            self.push_group(group);
        }
        let limit = 200 * (self.groups.len() as u64 + 4 * ROWS_OF_A_BANK);
        self.run_until(limit, |bench| bench.groups.is_empty());
        self.push_band(band);
    }

    /// Waits until everything is in memory and compares it.
    fn finish(&mut self) {
        self.run_until(200 * 4 * ROWS_OF_A_BANK, |bench| {
            bench.bands.is_empty() && bench.is(bench.flushed)
        });
        self.compare();
    }

    fn compare(&mut self) {
        for (index, (found, expected)) in self.written.iter().zip(&self.expected).enumerate() {
            assert_eq!(found, expected, "word {index} (address, data)");
        }
        assert_eq!(self.written.len(), self.expected.len(), "words");
        self.written.clear();
        self.expected.clear();
    }
}

/// Groups of a few rows and few depths, so that they meet often.
fn random_group(random: &mut Pcg64Mcg, rows: usize) -> Group {
    Group {
        row: random.random_range(0..rows),
        mask: if random.random_ratio(1, 10) {
            0
        } else {
            random.random()
        },
        halves: 3,
        codes: std::array::from_fn(|_| match random.random_range(0..4) {
            0 => 1,
            1 => (1 << 18) - 1,
            2 => random.random_range(1..=3),
            _ => random.random_range(1..1 << 18),
        }),
        colours: random.random(),
    }
}

/// A band somewhere in one of few places of the picture: most were there before.
fn random_band(random: &mut Pcg64Mcg, [lines, stride]: [usize; 2]) -> Band {
    Band {
        base: random.random_range(0..1 << 22),
        depth_base: random.random_range(0..1 << 22),
        lines,
        stride,
        first_line: [0, 2, PICTURE_LINES - lines][random.random_range(0..3)],
        slot: random.random_range(0..2),
        whole: random.random_ratio(1, 8),
        with_depth: random.random_ratio(1, 4),
        clear: random.random(),
        compose: 0,
    }
}

/// A group that covers a whole row.
fn full_group(row: usize, code: u32) -> Group {
    Group {
        row,
        mask: 0xff,
        halves: 3,
        codes: [code; LANES],
        colours: std::array::from_fn(|lane| (row * LANES + lane) as u16),
    }
}

/// A band of which nothing is known.
fn plain_band([lines, stride]: [usize; 2]) -> Band {
    Band {
        base: 0x12_3456,
        depth_base: 0x65_4321,
        lines,
        stride,
        first_line: 0,
        slot: 0,
        whole: true,
        with_depth: false,
        clear: 0xa55a,
        compose: 0,
    }
}

#[test]
fn random_groups_in_many_bands_with_stalls() {
    let shares = [(0.0, 0.0), (0.3, 0.3), (0.0, 0.9), (0.8, 0.1)];
    for (seed, (group_stalls, memory_stalls)) in (1..).zip(shares) {
        println!("seed {seed}, stalls {group_stalls} and {memory_stalls}");
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::ready(seed, group_stalls, memory_stalls);
        // The same in all bands: groups that are taken just before a band ends belong to it, whoever they were meant for.
        let shape @ [lines, stride] = [random.random_range(1..20), random.random_range(1..6)];
        bench.stride = stride;
        for _ in 0..60 {
            // Often few, so that lines are empty and extents differ.
            let most = [4, 20, 200][random.random_range(0..3)];
            let groups: Vec<_> = (0..random.random_range(0..most))
                .map(|_| random_group(&mut random, lines * stride))
                .collect();
            let band = random_band(&mut random, shape);
            bench.draw(groups, band);
        }
        bench.finish();
    }
}

/// What two eyes see, pixel by pixel in any order, in turns with bands of groups for both.
#[test]
fn what_two_eyes_see_is_composed() {
    for (seed, stalls) in [(1, 0.0), (2, 0.4)] {
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::of("band_buffer_stereo", seed, stalls, stalls);
        let shape @ [lines, stride] = [7, 3];
        bench.stride = stride;
        for _ in 0..40 {
            let mut band = random_band(&mut random, shape);
            band.compose = random.random_range(0..3);
            let mut groups: Vec<_> = (0..random.random_range(0..100))
                .map(|_| random_group(&mut random, lines * stride))
                .collect();
            if band.compose != 0 {
                // Each pixel that is drawn is drawn for both.
                groups = groups
                    .into_iter()
                    .flat_map(|group| {
                        [1, 2].map(|halves| Group {
                            halves,
                            ..group.clone()
                        })
                    })
                    .collect();
                let order = |random: &mut Pcg64Mcg| random.random::<u32>();
                groups.sort_by_cached_key(|_| order(&mut random));
            }
            bench.draw(groups, band);
            // Those of the next band are of another kind.
            bench.run_until(100_000, |bench| bench.bands.is_empty());
        }
        bench.finish();
    }
}

#[test]
fn whole_bands_leave_nothing_to_the_next() {
    let mut bench = Bench::ready(5, 0.0, 0.1);
    for shape @ [lines, stride] in [[12, 160], [24, 80], [45, 40], [45, 40]] {
        bench.stride = stride;
        let groups = (0..lines * stride).map(|row| full_group(row, 9));
        bench.draw(groups, plain_band(shape));
    }
    bench.stride = 160;
    // Both banks, without a group.
    for clear in [1, 2, 3] {
        let band = Band {
            clear,
            with_depth: clear == 2,
            ..plain_band([12, 160])
        };
        bench.draw([], band);
    }
    bench.finish();
}

/// Extents at all four corners of the largest bands, and of the picture.
#[test]
fn only_what_was_drawn_now_or_last_is_flushed() {
    let mut bench = Bench::ready(11, 0.0, 0.1);
    for shape @ [lines, stride] in [[45, 40], [24, 80], [12, 160]] {
        bench.stride = stride;
        let places = [0, PICTURE_LINES - lines];
        let bands = places.map(|first_line| {
            [0, 1].map(|slot| Band {
                first_line,
                slot,
                ..plain_band(shape)
            })
        });
        for band in bands.iter().flatten() {
            bench.draw([], *band);
        }
        let last = lines * stride - 1;
        // A row in the first line and one in the last; nothing.
        for rows in [
            [0, last],
            [stride - 1, last + 1 - stride],
            [1, 1],
            [0, last],
        ] {
            for band in bands.iter().flatten() {
                let groups = rows.map(|row| full_group(row, 9));
                bench.draw(
                    groups.into_iter().take(2 - band.slot),
                    Band {
                        whole: false,
                        ..*band
                    },
                );
            }
        }
        for band in bands.iter().flatten() {
            bench.draw(
                [],
                Band {
                    whole: false,
                    ..*band
                },
            );
        }
        bench.finish();
    }
}

#[test]
fn a_bank_after_reset_is_clear() {
    let mut bench = Bench::new("band_buffer", 6, 0.0, 0.0);
    assert!(bench.is(bench.clearing));
    for _ in 0..2 {
        bench.push_band(plain_band([48, 40]));
    }
    bench.finish();
    assert_eq!(bench.counter("groups"), 0);
}

#[test]
fn one_group_a_clock_where_rows_or_lanes_differ() {
    const COUNT: usize = 1920;
    let mut bench = Bench::ready(7, 0.0, 0.0);
    let rows = (0..COUNT).map(|i| full_group(i, 1));
    // Neighbouring triangles: the same row, other lanes.
    let lanes = (0..COUNT).map(|i| Group {
        mask: 0x0f << (i % 2 * 4),
        ..full_group(i / 2, 2)
    });
    let start = bench.module.cycles();
    bench.draw(rows.chain(lanes), plain_band([COUNT / 40, 40]));
    let clocks = bench.module.cycles() - start;
    assert!(clocks <= 2 * COUNT as u64 + 2, "{clocks} clocks");
    bench.finish();
    assert_eq!(bench.counter("cycles_held"), 0);
    assert_eq!(bench.counter("groups"), 2 * COUNT as u64);
}

#[test]
fn a_group_waits_for_the_lanes_it_shares() {
    // Groups of other rows between two of the same row, and the clocks the second one is held.
    for (between, held) in [(0, 3), (1, 2), (2, 1), (3, 0)] {
        let mut bench = Bench::ready(8, 0.0, 0.0);
        let others = (0..between).map(|i| full_group(100 + i, 5));
        let groups = [full_group(7, 3)].into_iter().chain(others).chain([Group {
            halves: 3,
            mask: 0x81,
            codes: [3, 9, 9, 9, 9, 9, 9, 2],
            colours: [0xffff; LANES],
            row: 7,
        }]);
        bench.draw(groups, plain_band([5, 40]));
        bench.finish();
        assert_eq!(bench.counter("cycles_held"), held, "{between} between");
    }
}

#[test]
fn the_flush_keeps_up_with_memory_and_overlaps_with_drawing() {
    let mut bench = Bench::ready(9, 0.0, 0.0);
    for (with_depth, words) in [(false, 1920), (true, 3 * 1920)] {
        let band = Band {
            with_depth,
            ..plain_band([48, 40])
        };
        bench.draw([], band);
        let start = bench.module.cycles();
        bench.finish();
        let clocks = bench.module.cycles() - start;
        assert!(clocks <= words + 16, "{clocks} clocks for {words} words");
    }
    // Six bands of as many groups as words.
    let start = bench.module.cycles();
    for _ in 0..6 {
        let band = Band {
            whole: false,
            ..plain_band([48, 40])
        };
        bench.draw((0..1920).map(|row| full_group(row, 1)), band);
    }
    bench.finish();
    let clocks = bench.module.cycles() - start;
    assert!(clocks <= 7 * (1920 + 24), "{clocks} clocks");
    let (memory, flush) = (
        bench.counter("cycles_memory"),
        bench.counter("cycles_flush"),
    );
    assert!(memory == 0 && flush < 6 * 24, "{memory} and {flush} clocks");
}

/// No clock is lost between lines, and an empty line takes one.
#[test]
fn a_line_takes_a_clock_for_each_word_and_one_at_least() {
    let mut bench = Bench::ready(12, 0.0, 0.0);
    let band = Band {
        whole: false,
        ..plain_band([45, 40])
    };
    bench.draw([], band);
    bench.finish();
    // Words in every so many lines, and the clocks they take when the lines before were the same.
    for (words, every, clocks) in [(1, 1, 45), (2, 1, 90), (5, 3, 75), (1, 3, 45), (1, 45, 45)] {
        for same in [false, true] {
            let rows = (0..45)
                .step_by(every)
                .flat_map(|line| 40 * line + 7..40 * line + 7 + words);
            bench.draw(rows.map(|row| full_group(row, 1)), band);
            bench.run_until(100, |bench| bench.bands.is_empty());
            let start = bench.module.cycles();
            bench.finish();
            let found = bench.module.cycles() - start;
            assert!(
                !same || found <= clocks + 14,
                "{found} clocks for {words} words in every line of {every}"
            );
        }
    }
}

#[test]
fn waits_for_memory_are_counted() {
    let mut bench = Bench::ready(10, 0.0, 0.75);
    for _ in 0..2 {
        bench.draw([], plain_band([25, 40]));
    }
    bench.finish();
    assert!(bench.counter("cycles_memory") > 1000);
    assert!(bench.counter("cycles_flush") > 1000);
}

#[test]
fn a_restart_ends_whatever_goes_on() {
    for seed in 20..60_u64 {
        println!("seed {seed}");
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::ready(seed, 0.2, 0.3);
        // One band on its way to memory, one being drawn.
        // Few rows: what is drawn last is what is cleared first.
        let lines = random.random_range(if seed % 2 == 0 { 1..4 } else { 10..40 });
        let stride = random.random_range(1..10);
        let (shape, rows) = ([lines, stride], lines * stride);
        bench.stride = stride;
        // What is known of these lines stays so.
        bench.draw(
            (0..rows / 2).map(|row| full_group(row, 9)),
            Band {
                first_line: 300,
                ..plain_band(shape)
            },
        );
        bench.draw(
            (0..rows).map(|row| full_group(row, 9)),
            random_band(&mut random, shape),
        );
        bench.run_until(100_000, |bench| bench.bands.is_empty());
        for _ in 0..500 {
            bench.push_group(random_group(&mut random, rows));
        }
        for _ in 0..random.random_range(0..400) {
            bench.clock();
        }
        // Sometimes with a band's end waiting.
        if random.random() {
            bench.push_band(random_band(&mut random, shape));
            bench.clock();
        }

        bench.restart_with_dead_memory();

        for _ in 0..4 {
            let groups: Vec<_> = (0..100).map(|_| random_group(&mut random, rows)).collect();
            let band = random_band(&mut random, shape);
            bench.draw(groups, band);
        }
        let elsewhere = Band {
            first_line: 300,
            whole: false,
            ..plain_band(shape)
        };
        bench.draw([full_group(0, 1)], elsewhere);
        bench.finish();
    }
}

impl Bench {
    /// Memory stops, the buffer is restarted and gets clear all the same; then memory goes on.
    fn restart_with_dead_memory(&mut self) {
        let alive = self.words.set_stalls(Stalls::new(1, 1.0));

        // The renderers are restarted in the same clock.
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
