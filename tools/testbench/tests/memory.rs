//! Test of the whole path to main memory: CPU, engines and scan-out on one crossbar, with the
//! timing and the refreshes of the memory.

use std::collections::VecDeque;

use glint_testbench::{Bits, Module, Port};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const CLOCKS: u64 = 400_000;
/// Clocks between two refreshes: 64 ms for 8192 rows, at 81.25 MHz.
const REFRESH: u64 = 635;
/// Number of 16-byte words of a line of 1280 pixels.
const LINE: u64 = 160;
/// Number of clocks of such a line at 60 frames per second.
const LINE_CLOCKS: u64 = 1650 * 8125 / 7425;
/// Number of 16-byte words of each client's part of memory. All parts begin in the same bank, and
/// each part covers all banks.
const PART: u64 = 4096;
const DATA: u64 = 0;
const INSTRUCTIONS: u64 = 1;
const SCANOUT: u64 = 2;
const ENGINES: [u64; 2] = [3, 4];
/// Number of 32-bit words of a line of the CPU's caches.
const CACHE_LINE: u64 = 8;
/// Number of 32-bit words that the CPU uses in each of its parts.
const CPU_WORDS: u64 = 2048;

/// Contents of a word that never changes.
fn constant(word: u64) -> u32 {
    (word as u32).wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995
}

/// An access of the CPU: a write with its data and byte enables, or a read of one word or a line.
#[derive(Clone, Copy)]
enum Access {
    Write(u64, u32, u32),
    Read(u64, u64),
}

/// A bus of the CPU. A request stays valid until its last word is acknowledged.
struct Bus {
    cyc: Port,
    adr: Port,
    cti: Port,
    ack: Port,
    read: Port,
    /// Write enable, data and byte enables of the data bus.
    write: Option<[Port; 3]>,
    access: Option<Access>,
    beat: u64,
    pause: u32,
    done: u64,
}

impl Bus {
    fn new(module: &Module, name: &str, writes: bool) -> Self {
        let port = |signal: &str| module.port(&format!("{name}_{signal}"));
        Self {
            cyc: port("cyc"),
            adr: port("adr"),
            cti: port("cti"),
            ack: port("ack"),
            read: port("dat_r"),
            write: writes.then(|| ["we", "dat_w", "sel"].map(port)),
            access: None,
            beat: 0,
            pause: 0,
            done: 0,
        }
    }

    fn drive(&mut self, module: &mut Module, next: impl FnOnce() -> (Access, u32)) {
        if self.pause > 0 {
            self.pause -= 1;
        } else if self.access.is_none() {
            let (access, pause) = next();
            (self.access, self.beat, self.pause) = (Some(access), 0, pause);
            self.done += 1;
        }
        let shown = self.access.filter(|_| self.pause == 0);
        module.set(self.cyc, u64::from(shown.is_some()));
        let (word, length, write) = match shown {
            Some(Access::Write(word, data, sel)) => (word, 1, Some((data, sel))),
            Some(Access::Read(word, length)) => (word + self.beat, length, None),
            None => return,
        };
        module.set(self.adr, word);
        let more = self.beat + 1 < length;
        module.set(self.cti, if more { 2_u64 } else { 7 });
        if let Some([we, data, sel]) = self.write {
            module.set(we, u64::from(write.is_some()));
            module.set(data, write.map_or(0, |(data, _)| u64::from(data)));
            module.set(sel, write.map_or(0xf, |(_, sel)| u64::from(sel)));
        }
    }

    /// Takes the acknowledgement of this clock. `words` are the expected contents of the memory.
    fn take(&mut self, module: &Module, words: &mut [u32]) {
        let Some(access) = self.access.filter(|_| self.pause == 0) else {
            return;
        };
        if !module.is_high(self.ack) {
            return;
        }
        match access {
            Access::Write(word, data, sel) => {
                let mask = (0..4).fold(0, |mask, byte| {
                    mask | ((sel >> byte & 1) * 0xff) << (8 * byte)
                });
                let word = &mut words[word as usize];
                *word = *word & !mask | data & mask;
                self.access = None;
            }
            Access::Read(word, length) => {
                let word = word + self.beat;
                let (found, expected) = (module.value(self.read) as u32, words[word as usize]);
                assert_eq!(found, expected, "word {word} at clock {}", module.cycles());
                self.beat += 1;
                if self.beat == length {
                    self.access = None;
                }
            }
        }
    }
}

/// A client of a port of the crossbar for one direction.
struct Client {
    valid: Port,
    ready: Port,
    addr: Port,
    data: Port,
    /// `word_valid` of read data, or `word_ready` of written data.
    moves: Port,
    /// Addresses of the words that are not requested yet.
    asks: VecDeque<u64>,
    /// Data that were read, or that are still to be written.
    words: VecDeque<Bits>,
}

impl Client {
    fn new(module: &Module, name: &str, reads: bool) -> Self {
        let port = |signal: &str| module.port(&format!("{name}_{signal}"));
        Self {
            valid: port("valid"),
            ready: port("ready"),
            addr: port("addr"),
            data: port("word_data"),
            moves: port(if reads { "word_valid" } else { "word_ready" }),
            asks: VecDeque::new(),
            words: VecDeque::new(),
        }
    }

    fn drive(&self, module: &mut Module, writes: bool) {
        module.set(self.valid, u64::from(!self.asks.is_empty()));
        module.set(self.addr, self.asks.front().copied().unwrap_or_default());
        if writes {
            module.set(self.data, self.words.front().copied().unwrap_or_default());
        }
    }

    fn take(&mut self, module: &Module, writes: bool) {
        if !self.asks.is_empty() && module.is_high(self.ready) {
            self.asks.pop_front();
        }
        match (module.is_high(self.moves), writes) {
            (true, true) => {
                let word = self.words.pop_front();
                assert!(word.is_some(), "data without a command");
            }
            (true, false) => self.words.push_back(module.get(self.data)),
            (false, _) => {}
        }
    }
}

/// State of an engine, which writes a run of words, waits until they are in memory, and reads them
/// back.
enum Work {
    Writes,
    Waits(u32),
    Reads,
}

struct Engine {
    part: u64,
    reader: Client,
    writer: Client,
    work: Work,
    run: Vec<Bits>,
    start: u64,
    words: u64,
}

impl Engine {
    fn new(module: &Module, number: usize) -> Self {
        Self {
            part: ENGINES[number] * PART,
            reader: Client::new(module, &format!("read{number}"), true),
            writer: Client::new(module, &format!("write{number}"), false),
            work: Work::Waits(0),
            run: Vec::new(),
            start: 0,
            words: 0,
        }
    }

    fn begin(&mut self, start: u64, run: Vec<Bits>) {
        self.writer.asks = (start..start + run.len() as u64).collect();
        self.writer.words = run.iter().copied().collect();
        (self.start, self.run, self.work) = (start, run, Work::Writes);
    }

    fn advance(&mut self, rng: &mut Pcg64Mcg) {
        match self.work {
            Work::Writes if self.writer.words.is_empty() => {
                assert!(self.writer.asks.is_empty(), "data before their command");
                // The last words are in memory some clocks after they were taken.
                self.work = Work::Waits(12);
            }
            Work::Waits(0) if self.run.is_empty() => {
                let run = (0..rng.random_range(1..200))
                    .map(|_| Bits::from_words(&rng.random::<[u32; 4]>()))
                    .collect();
                self.begin(self.part + rng.random_range(0..PART - 200), run);
            }
            Work::Waits(0) => {
                self.reader.asks = (self.start..self.start + self.run.len() as u64).collect();
                self.work = Work::Reads;
            }
            Work::Waits(clocks) => self.work = Work::Waits(clocks - 1),
            Work::Reads if self.reader.words.len() == self.run.len() => {
                let found: Vec<_> = self.reader.words.drain(..).collect();
                assert!(found == self.run, "the words from {} on differ", self.start);
                self.words += 2 * found.len() as u64;
                self.run.clear();
                self.work = Work::Waits(rng.random_range(0..60));
            }
            Work::Writes | Work::Reads => {}
        }
    }
}

#[test]
fn no_word_is_lost_and_each_line_is_in_time() {
    let mut module = Module::new("memory_machine", 3);
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    let mut data = Bus::new(&module, "data", true);
    let mut instructions = Bus::new(&module, "instructions", false);
    let mut engines = [0, 1].map(|number| Engine::new(&module, number));
    let mut scanout = Client::new(&module, "scanout", true);
    let refreshed = module.port("refreshed");
    let instruction_start = INSTRUCTIONS * PART * 4;
    let mut words: Vec<u32> = (0..instruction_start + CPU_WORDS).map(constant).collect();
    // The CPU fills its parts of memory; engine 0 fills the part of scan-out.
    let mut fill: VecDeque<u64> = (0..CPU_WORDS)
        .chain(instruction_start..instruction_start + CPU_WORDS)
        .collect();
    let pictures: Vec<_> = (SCANOUT * PART..SCANOUT * PART + 2 * LINE)
        .map(|word| Bits::from_words(&[constant(word); 4]))
        .collect();
    engines[0].begin(SCANOUT * PART, pictures.clone());
    let (mut shown, mut fetched, mut longest, mut refreshes) = (0, None, 0, 0);
    let (mut lines, mut is_filled) = (0, false);

    for clock in 0..CLOCKS {
        data.drive(&mut module, || {
            if let Some(word) = fill.pop_front() {
                return (Access::Write(word, constant(word), 0xf), 0);
            }
            let word = DATA + rng.random_range(0..CPU_WORDS);
            let pause = [0, 0, 0, rng.random_range(0..60)][rng.random_range(0..4)];
            let access = match rng.random_range(0..4) {
                0 | 1 => Access::Write(word, rng.random(), rng.random_range(1..16)),
                2 => Access::Read(word, 1),
                _ => Access::Read(word / CACHE_LINE * CACHE_LINE, CACHE_LINE),
            };
            (access, pause)
        });
        if is_filled {
            instructions.drive(&mut module, || {
                let word = instruction_start + rng.random_range(0..CPU_WORDS);
                let pause = [0, rng.random_range(0..200)][rng.random_range(0..2)];
                (
                    Access::Read(word / CACHE_LINE * CACHE_LINE, CACHE_LINE),
                    pause,
                )
            });
        }
        if clock >= 10 * LINE_CLOCKS && clock % LINE_CLOCKS == 0 {
            assert!(fetched.is_none(), "line {lines} is late at clock {clock}");
            shown = rng.random_range(0..LINE);
            scanout.asks = (SCANOUT * PART + shown..SCANOUT * PART + shown + LINE).collect();
            (fetched, lines) = (Some(clock), lines + 1);
        }
        for engine in &engines {
            engine.reader.drive(&mut module, false);
            engine.writer.drive(&mut module, true);
        }
        scanout.drive(&mut module, false);
        module.settle();
        data.take(&module, &mut words);
        is_filled |= fill.is_empty() && data.access.is_none();
        instructions.take(&module, &mut words);
        scanout.take(&module, false);
        for engine in &mut engines {
            engine.reader.take(&module, false);
            engine.writer.take(&module, true);
            engine.advance(&mut rng);
        }
        if let Some(start) = fetched.filter(|_| scanout.words.len() as u64 == LINE) {
            let line: Vec<_> = scanout.words.drain(..).collect();
            assert!(
                line == pictures[shown as usize..][..LINE as usize],
                "line {lines} differs"
            );
            longest = longest.max(clock - start);
            fetched = None;
        }
        refreshes += u64::from(module.is_high(refreshed));
        module.clock();
    }
    let accesses = (
        data.done,
        instructions.done,
        engines.each_ref().map(|engine| engine.words),
    );
    println!("{accesses:?}, {lines} lines in at most {longest} clocks, {refreshes} refreshes");
    assert!(refreshes >= CLOCKS / REFRESH - 1, "{refreshes} refreshes");
    assert!(
        data.done > CLOCKS / 100 && instructions.done > CLOCKS / 400,
        "{accesses:?}"
    );
    assert!(
        engines.iter().all(|engine| engine.words > CLOCKS / 20),
        "{accesses:?}"
    );
}
