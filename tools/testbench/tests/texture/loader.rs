//! Tests of the texture loader with a model of the memory: encoded textures of all sizes and
//! formats, and random data.

use std::collections::VecDeque;

use glint_core::colour::Rgb565;
use glint_core::records::WORD;
use glint_core::texture::{
    Blend, Filter, Format, Sampler, Source, Texture, TextureHeader, Wrap, encode,
};
use glint_testbench::{Memory, Module, Port, Record, Stalls};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Number of words that the port of memory holds for the loader.
const ROOM: usize = 32;
/// Largest base-2 logarithm of a side, and largest level number, that the gateware supports.
const LIMIT: u64 = 10;

/// The loader's output for a texture.
struct Loaded {
    sampler: Record,
    /// Word address of each level that the loader reported.
    levels: [Option<u32>; 16],
    /// The colours that the loader wrote to the palette.
    palette: [Option<u16>; 256],
    clocks: u64,
}

struct Bench {
    module: Module,
    /// Contents of the memory; addresses beyond the end wrap around.
    memory: Memory,
    words: u32,
    /// Word address of the table of textures.
    table: u32,
    start: Port,
    done: Port,
    ask: [Port; 3],
    data: [Port; 3],
    level: [Port; 3],
    palette: [Port; 3],
    stalls: [Stalls; 2],
    latency: u64,
    /// Addresses of the requested words, each with the clock from which the word is available.
    queue: VecDeque<(u64, u32)>,
    /// Whether the first of `queue` is on the port, where it stays until it is taken.
    is_shown: bool,
}

impl Bench {
    fn new(seed: u32, words: u32, latency: u64, shares: [f64; 2]) -> Self {
        let mut module = Module::new("texture_loader", seed);
        let table = words - 64;
        module.drive("table_base", table);
        let ports = |names: [&str; 3]| names.map(|name| module.port(name));
        let stalls = [0, 1].map(|i: usize| Stalls::new(u64::from(seed) * 2 + i as u64, shares[i]));
        Self {
            start: module.port("start"),
            done: module.port("done"),
            ask: ports(["ask_valid", "ask_ready", "ask_addr"]),
            data: ports(["data_valid", "data_ready", "data"]),
            level: ports(["level_write", "level_number", "level_first"]),
            palette: ports(["palette_write", "palette_index", "palette_colour"]),
            memory: Memory::new(words as usize),
            words,
            table,
            stalls,
            latency,
            queue: VecDeque::new(),
            is_shown: false,
            module,
        }
    }

    /// Writes an entry of the table: the byte address of a texture.
    fn set_entry(&mut self, number: u8, address: u32) {
        let place = self.table + u32::from(number) / 4;
        let mut entries = [0, 1, 2, 3].map(|i| self.memory.entry(place, i));
        entries[usize::from(number) % 4] = address;
        self.memory
            .write(place, entries.map(u32::to_le_bytes).as_flattened());
    }

    /// Drives the memory's side of the port, and settles.
    fn settle(&mut self) {
        let now = self.module.cycles();
        let [_, ask_ready, _] = self.ask;
        let [data_valid, _, data] = self.data;
        let has_room = self.queue.len() < ROOM && !self.stalls[0].next_stalled();
        let is_due = self.queue.front().is_some_and(|&(due, _)| due <= now);
        self.is_shown |= is_due && !self.stalls[1].next_stalled();
        self.module.set(ask_ready, u64::from(has_room));
        self.module.set(data_valid, u64::from(self.is_shown));
        if let Some(&(_, address)) = self.queue.front() {
            self.module
                .set(data, self.memory.word(address % self.words));
        }
        self.module.settle();
    }

    /// Executes the transfers of this clock.
    fn clock(&mut self) {
        let moves =
            |[valid, ready, _]: [Port; 3]| self.module.is_high(valid) && self.module.is_high(ready);
        let (asks, takes) = (moves(self.ask), moves(self.data));
        if takes {
            self.queue.pop_front();
            self.is_shown = false;
        }
        if asks {
            let address = self.module.value(self.ask[2]) as u32;
            self.queue
                .push_back((self.module.cycles() + self.latency, address));
        }
        self.module.clock();
    }

    fn load(&mut self, number: u8) -> Loaded {
        let mut levels = [None; 16];
        let mut palette = [None; 256];
        self.module.drive("number", number);
        let begin = self.module.cycles();
        loop {
            let clocks = self.module.cycles() - begin;
            assert!(
                clocks < 20_000,
                "the loading of texture {number} does not end"
            );
            self.module.set(self.start, u64::from(clocks == 0));
            self.settle();
            let value = |port| self.module.value(port);
            if self.module.is_high(self.level[0]) {
                let found =
                    levels[value(self.level[1]) as usize].replace(value(self.level[2]) as u32);
                assert_eq!(found, None, "a level was written twice");
            }
            if self.module.is_high(self.palette[0]) {
                let found =
                    palette[value(self.palette[1]) as usize].replace(value(self.palette[2]) as u16);
                assert_eq!(found, None, "a colour was written twice");
            }
            let is_done = self.module.is_high(self.done);
            self.clock();
            if is_done {
                assert!(
                    self.queue.is_empty(),
                    "requested words that the loader did not take"
                );
                return Loaded {
                    sampler: self.module.read_record("sampler"),
                    levels,
                    palette,
                    clocks,
                };
            }
        }
    }

    /// Writes an encoded texture at the word address `place`, loads it, and compares the loader's
    /// output with the source. The first texel of each level must be the level's number plus 1.
    fn check(&mut self, number: u8, place: u32, source: &Source) -> u64 {
        let bytes = encode(source).unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        self.memory.write(place, &bytes);
        self.set_entry(number, place * WORD as u32);
        let loaded = self.load(number);

        let text = format!("{:?} {:?}", source.format, source.size_log2);
        let sampler = &loaded.sampler;
        let found = |path: &str| sampler.get(path);
        assert_eq!(found("format"), source.format as u64, "{text}");
        for axis in 0..2 {
            let side = found(&format!("side_log2[{axis}]"));
            assert_eq!(side, u64::from(source.size_log2[axis]), "{text}");
            let wrap = found(&format!("wrap[{axis}]"));
            assert_eq!(wrap, source.sampler.wrap[axis] as u64, "{text}");
        }
        assert_eq!(
            found("last_level") + 1,
            u64::from(texture.levels()),
            "{text}"
        );
        assert_eq!(found("bilinear"), source.sampler.filter as u64, "{text}");
        assert_eq!(found("cut_out"), u64::from(source.key.is_some()), "{text}");
        assert_eq!(found("key"), u64::from(source.key.unwrap_or(0)), "{text}");
        assert_eq!(found("blend"), u64::from(source.blend.number()), "{text}");
        let colours = source.format.colours();
        for (index, &colour) in loaded.palette.iter().enumerate() {
            let expected = source.palette.get(index).filter(|_| index < colours);
            assert_eq!(colour, expected.map(|colour| colour.0), "{index} of {text}");
        }
        let mut next = place + ((TextureHeader::BYTES + 2 * colours) / WORD) as u32;
        for (level, &first) in (0..).zip(&loaded.levels) {
            let is_there = level < texture.levels();
            assert_eq!(first.is_some(), is_there, "level {level} of {text}");
            if let Some(first) = first {
                assert_eq!(first, next, "level {level} of {text}");
                let texel = self.memory.word(first).element(source.format.bits(), 0);
                assert_eq!(texel, u64::from(level) + 1, "level {level} of {text}");
                let blocks = [0, 1].map(|axis: usize| {
                    texture.level_log2(level)[axis].saturating_sub(source.format.block_log2()[axis])
                });
                next += 2 << (blocks[0] + blocks[1]);
            }
        }
        assert_eq!(next, place + (bytes.len() / WORD) as u32, "{text}");
        loaded.clocks
    }
}

fn source(random: &mut Pcg64Mcg, format: Format, size_log2: [u8; 2], has_levels: bool) -> Source {
    let levels = if has_levels {
        1 + u16::from(size_log2[0].max(size_log2[1]))
    } else {
        1
    };
    let mut wrap = || Wrap::ALL[random.random_range(0..3)];
    let wrap = [wrap(), wrap()];
    let filter = Filter::ALL[random.random_range(0..2)];
    let largest = (1 << format.bits()) - 1;
    Source {
        format,
        size_log2,
        sampler: Sampler { wrap, filter },
        key: random
            .random_bool(0.5)
            .then(|| random.random_range(0..=largest) as u16),
        blend: Blend::ALL[random.random_range(0..=8)],
        palette: (0..format.colours())
            .map(|_| Rgb565(random.random()))
            .collect(),
        levels: (1..=levels).map(|number| vec![number]).collect(),
    }
}

/// Number of words of the largest texture and of the table.
const WORDS: u32 = (1 << 18) * 3 / 4 + 256;

#[test]
fn all_formats_and_sizes() {
    let mut random = Pcg64Mcg::new(5);
    let mut bench = Bench::new(1, WORDS, 12, [0.3, 0.3]);
    for format in Format::ALL {
        for width in 3..=10 {
            for height in 3..=10 {
                for has_levels in [false, true] {
                    let source = source(&mut random, format, [width, height], has_levels);
                    let place = random.random_range(0..200);
                    bench.latency = random.random_range(1..40);
                    bench.check(random.random(), place, &source);
                }
            }
        }
    }
}

#[test]
fn a_load_takes_twice_the_latency_and_a_clock_per_colour() {
    let mut random = Pcg64Mcg::new(6);
    for latency in [1, 20] {
        let mut bench = Bench::new(2, WORDS, latency, [0.0; 2]);
        for format in Format::ALL {
            let source = source(&mut random, format, [8, 8], true);
            let clocks = bench.check(7, 9, &source);
            let colours = format.colours() as u64;
            let words = if colours > 0 { latency + 2 } else { 0 };
            let most = 2 * latency + 22 + words + colours;
            assert!(
                clocks <= most,
                "{format:?}: {clocks} clocks: expected at most {most}"
            );
        }
    }
}

#[test]
fn random_memory_ends_and_is_limited() {
    const ROUNDS: u32 = 2000;
    let mut random = Pcg64Mcg::new(7);
    let mut bench = Bench::new(3, 1 << 12, 8, [0.2, 0.2]);
    for round in 0..ROUNDS {
        for word in 0..bench.words {
            if round % 100 == 0 {
                let bytes: [u8; WORD] = random.random();
                bench.memory.write(word, &bytes);
            }
        }
        let number = random.random();
        // The table's random entry can be any byte address, mostly beyond the memory.
        let loaded = bench.load(number);
        let found = |path: &str| loaded.sampler.get(path);
        let last = found("last_level");
        assert!(found("format") < 3 && last <= LIMIT);
        for axis in 0..2 {
            assert!(found(&format!("side_log2[{axis}]")) <= LIMIT);
            assert!(found(&format!("wrap[{axis}]")) < 3);
        }
        for (level, first) in (0..).zip(loaded.levels) {
            assert_eq!(first.is_some(), level <= last, "level {level}");
        }
        let colours = Format::ALL[found("format") as usize].colours();
        for (index, colour) in loaded.palette.into_iter().enumerate() {
            assert_eq!(colour.is_some(), index < colours, "colour {index}");
        }
    }
}
