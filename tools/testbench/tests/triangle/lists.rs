//! Tests of the binner, which writes the triangle list of each band to memory.

use glint_model::triangle::descriptor::{band_rows, list_word};
use glint_testbench::{Bits, Layout, Memory, Module, Sink, Source, Stalls, exchange};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

const DESCRIPTORS: u32 = 0x1000;
const LISTS: u32 = 0x4000;
const EXCEPTIONS: u32 = 0x8000;
const LIST_SHIFT: u32 = 4;

struct Bench {
    module: Module,
    descriptors: Source,
    exceptions: Source,
    writes: Sink,
    memory: Memory,
}

impl Bench {
    fn new(size: usize, limit: u32, stalls: f64) -> Self {
        let mut module = Module::new("binner", size as u32);
        for (port, value) in [
            ("size", size as u32),
            ("descriptor_base", DESCRIPTORS),
            ("descriptor_limit", limit),
            ("list_base", LISTS),
            ("list_shift", LIST_SHIFT),
            ("exception_base", EXCEPTIONS),
            ("exception_limit", limit),
        ] {
            module.drive(port, value);
        }
        let stalls = |seed| Stalls::new(seed, stalls);
        let mut bench = Self {
            descriptors: Source::new(&module, "in", &["descriptor"], stalls(1)),
            exceptions: Source::new(&module, "exception", &["number"], stalls(2)),
            writes: Sink::new(&module, "write", &["addr", "data", "strobe"], stalls(3)),
            memory: Memory::new(0x1_0000),
            module,
        };
        bench.pulse("restart");
        bench
    }

    /// Returns the type of a descriptor at the module's input.
    fn descriptor(&self) -> Layout {
        self.module.record("in_descriptor").layout().clone()
    }

    fn value(&self, name: &str) -> u64 {
        self.module.read(name)
    }

    fn set(&mut self, name: &str, value: u64) {
        self.module.drive(name, value);
    }

    fn pulse(&mut self, name: &str) {
        self.set(name, 1);
        self.clock();
        self.set(name, 0);
    }

    fn clock(&mut self) {
        exchange(
            &mut self.module,
            &mut [&mut self.descriptors, &mut self.exceptions],
            &mut [&mut self.writes],
        );
        for item in self.writes.take() {
            self.memory
                .store(item[0].number() as u32, item[1], item[2].number() as u16);
        }
        self.module.clock();
    }

    /// Waits until all inputs are taken, then requests the module to write the lengths of the lists.
    fn finish(&mut self) {
        let start = self.module.cycles();
        let all_in = |bench: &Self| bench.descriptors.is_empty() && bench.exceptions.is_empty();
        while !(all_in(self) && self.value("idle") == 1) {
            assert!(
                self.module.cycles() < start + 1_000_000,
                "an input is not taken"
            );
            self.clock();
        }
        self.set("finish", 1);
        while self.value("done") == 0 || self.value("write_valid") == 1 {
            assert!(
                self.module.cycles() < start + 1_000_000,
                "the lists are not finished"
            );
            self.clock();
        }
        self.set("finish", 0);
        self.clock();
    }
}

/// Makes descriptors with random rows (picture lines) and other bits. Returns for each descriptor its first row, the row after
/// its last, and its bits.
fn descriptors(
    random: &mut Pcg64Mcg,
    layout: &Layout,
    count: usize,
    height: u32,
) -> Vec<(u32, u32, Bits)> {
    (0..count)
        .map(|_| {
            let top = random.random_range(0..height);
            let rows = if random.random_bool(0.8) { 20 } else { height };
            let bottom = random.random_range(top + 1..=height.min(top + rows));
            let words: [u32; 12] = random.random();
            let record = layout.record_of(Bits::from_words(&words));
            let record = record.with("top", top).with("bottom", bottom);
            (top, bottom, record.bits())
        })
        .collect()
}

#[test]
fn every_band_lists_what_touches_it() {
    for (size, (width, height)) in glint_model::SIZES.into_iter().enumerate() {
        for stalls in [0.0, 0.6] {
            let mut random = Pcg64Mcg::new(size as u128 + 1);
            let mut bench = Bench::new(size, 1000, stalls);
            // Draws two frames; the second must start with empty lists.
            for count in [90, 50] {
                let given = descriptors(&mut random, &bench.descriptor(), count, height);
                let exceptions: Vec<u32> = (0..30).map(|_| random.random()).collect();
                for &(_, _, bits) in &given {
                    bench.descriptors.push(vec![bits]);
                }
                for &number in &exceptions {
                    bench.exceptions.push(vec![Bits::from(u64::from(number))]);
                }
                bench.finish();

                assert_eq!(bench.value("full"), 0);
                let counts = (bench.value("descriptors"), bench.value("exceptions"));
                assert_eq!(counts, (count as u64, exceptions.len() as u64));
                for (number, (_, _, bits)) in (0..).zip(&given) {
                    for word in 0..3 {
                        let expected = &bits.words()[4 * word as usize..][..4];
                        let found = bench.memory.word(DESCRIPTORS + 3 * number + word);
                        assert_eq!(found, Bits::from_words(expected), "descriptor {number}");
                    }
                }
                for band in 0..64 {
                    let rows = band * band_rows(width)..(band + 1) * band_rows(width);
                    let expected: Vec<u32> = (0..)
                        .zip(&given)
                        .filter(|(_, (top, bottom, _))| *top < rows.end && *bottom > rows.start)
                        .map(|(number, _)| number)
                        .collect();
                    let length = bench.memory.entry(LISTS, band);
                    let list = LISTS + list_word(band, LIST_SHIFT);
                    let found: Vec<u32> =
                        (0..length).map(|i| bench.memory.entry(list, i)).collect();
                    assert_eq!(found, expected, "band {band} of {width}x{height}");
                }
                let found: Vec<u32> = (0..)
                    .map(|i| bench.memory.entry(EXCEPTIONS, i))
                    .take(exceptions.len())
                    .collect();
                assert_eq!(found, exceptions);
                bench.pulse("restart");
            }
        }
    }
}

#[test]
fn full_lists_are_reported() {
    let one_row = |random: &mut Pcg64Mcg, layout: &Layout| {
        let mut given = descriptors(random, layout, 1, 720);
        let record = layout.record_of(given.remove(0).2);
        record.with("top", 5).with("bottom", 6).bits()
    };
    let mut random = Pcg64Mcg::new(1);
    // Capacity of a list in entries. The cases are: number of descriptors, limit, and the expected output `full`.
    let room = 4 << LIST_SHIFT;
    for (count, limit, full) in [
        (room, 1000, 0),
        (room + 1, 1000, 1),
        (10, 10, 0),
        (11, 10, 1),
    ] {
        let mut bench = Bench::new(2, limit, 0.3);
        let layout = bench.descriptor();
        for _ in 0..count {
            bench.descriptors.push(vec![one_row(&mut random, &layout)]);
        }
        bench.finish();
        assert_eq!(bench.value("full"), full, "{count} of at most {limit}");
        assert_eq!(bench.memory.entry(LISTS, 0), count.min(limit).min(room));
    }
}
