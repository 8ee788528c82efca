//! Tests of the flash reader, with a virtual flash on its pins.

use std::ops::Range;

use glint_testbench::{Module, Port};
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use virtual_flash::{Flash, MAX_BYTES, Pins};

/// Number of clocks to read a word: eight nibbles of two clocks each, and one clock each for the
/// request and the end.
const WORD: u64 = 2 * 8 + 2;
/// Number of clocks of a command before its first word: eight idle clocks, 32 bits and eight dummy
/// clocks, of two clocks each.
const COMMAND: u64 = 2 * (8 + 32 + 8);

struct Bench {
    module: Module,
    flash: Flash,
    rst: Port,
    request: [Port; 2],
    answer: [Port; 2],
    /// CS#, clock, level of line 0, output enable of line 0, and the input lines.
    pins: [Port; 5],
    /// Levels driven by the flash that have not reached the reader yet.
    way: Option<u8>,
    rng: Pcg64Mcg,
    /// Rising edges of the flash's clock since it was deselected.
    idle_clocks: u32,
}

impl Bench {
    fn new(bytes: Vec<u8>) -> Self {
        let module = Module::new("flash_reader", 5);
        let port = |name: &str| module.port(name);
        let mut bench = Self {
            rst: port("rst"),
            request: ["request", "address"].map(port),
            answer: ["done", "data"].map(port),
            pins: ["cs_n", "sclk", "command", "sending", "lines"].map(port),
            module,
            flash: Flash::new(bytes),
            way: None,
            rng: Pcg64Mcg::seed_from_u64(7),
            idle_clocks: 0,
        };
        bench.reset();
        bench
    }

    fn reset(&mut self) {
        self.module.set(self.request[0], 0);
        self.module.set(self.rst, 1);
        self.clock();
        self.module.set(self.rst, 0);
    }

    /// Advances by one clock. A level takes almost one clock to reach the other side; undriven
    /// lines have random levels.
    fn clock(&mut self) {
        let [cs_n, clk, command, sending, lines] = self.pins;
        let is_high = |port| self.module.is_high(port);
        let (cs_n, clk, sending) = (is_high(cs_n), is_high(clk), is_high(sending));
        let sent = 0b1110 | u8::from(is_high(command));
        let answer = self.way;
        self.way = self.flash.update(Pins {
            cs_n,
            clk,
            lines: if sending { sent } else { 0xf },
        });
        assert!(
            !(sending && self.way.is_some()),
            "flash and reader drive the lines at the same time"
        );
        let level = answer.unwrap_or_else(|| self.rng.random::<u8>() & 0xf);
        self.module.set(lines, u64::from(level));
        self.module.clock();
        let rises = !clk && self.module.is_high(self.pins[1]);
        if !self.module.is_high(self.pins[0]) {
            if cs_n {
                assert!(
                    self.idle_clocks >= 3,
                    "expected three idle clocks, because STARTUPE2 drops the first three"
                );
                assert!(!clk && !rises, "the clock has an edge together with CS#");
            }
            self.idle_clocks = 0;
        }
        self.idle_clocks += u32::from(rises);
    }

    /// Reads the word with this number, and returns the number of clocks of the access.
    fn read(&mut self, number: u32) -> u64 {
        let start = self.module.cycles();
        self.module.set(self.request[0], 1);
        self.module.set(self.request[1], u64::from(number));
        self.clock();
        while !self.module.is_high(self.answer[0]) {
            assert!(self.module.cycles() - start < 1000, "no answer");
            self.clock();
        }
        let (found, expected) = (
            self.module.value(self.answer[1]) as u32,
            self.flash.word(4 * number as usize),
        );
        assert_eq!(found, expected, "word {number:#x}");
        self.clock();
        self.module.set(self.request[0], 0);
        self.module.cycles() - start
    }

    /// Advances by a random number of clocks.
    fn wait(&mut self, clocks: Range<u32>) {
        for _ in 0..self.rng.random_range(clocks) {
            self.clock();
        }
    }
}

fn noise(length: usize) -> Vec<u8> {
    let mut bytes = vec![0; length];
    Pcg64Mcg::seed_from_u64(1).fill_bytes(&mut bytes);
    bytes
}

#[test]
fn words_at_random_addresses_and_in_runs() {
    let mut bench = Bench::new(noise(MAX_BYTES));
    let words = (MAX_BYTES / 4) as u32;
    let mut commands = 0;
    let mut follower = None;
    for _ in 0..300 {
        let first = bench.rng.random_range(0..words);
        // Some runs continue at the end of the last run.
        let first = follower.filter(|_| bench.rng.random()).unwrap_or(first);
        let back_to_back: bool = bench.rng.random();
        for number in first..(first + bench.rng.random_range(1..20)).min(words) {
            let follows = follower == Some(number);
            let clocks = bench.read(number);
            assert_eq!(clocks, WORD + if follows { 0 } else { COMMAND });
            commands += u64::from(!follows);
            follower = Some((number + 1) % words);
            if !back_to_back {
                bench.wait(0..40);
            }
        }
    }
    assert_eq!(bench.flash.commands(), commands);
}

#[test]
fn a_run_goes_on_behind_the_last_address() {
    let mut bench = Bench::new(noise(MAX_BYTES));
    let last = (MAX_BYTES / 4) as u32 - 1;
    let clocks = [last - 1, last, 0, 1].map(|number| bench.read(number));
    assert_eq!(clocks, [COMMAND + WORD, WORD, WORD, WORD]);
}

#[test]
fn the_same_word_again_and_the_one_before_are_new_commands() {
    let mut bench = Bench::new(noise(256));
    let clocks = [5, 5, 4, 5].map(|number| bench.read(number));
    assert_eq!(
        clocks,
        [COMMAND + WORD, COMMAND + WORD, COMMAND + WORD, WORD]
    );
}

#[test]
fn a_reset_in_the_middle_leaves_nothing_behind() {
    let mut bench = Bench::new(noise(4096));
    for _ in 0..200 {
        let number = bench.rng.random_range(0..1024_u32);
        bench.module.set(bench.request[0], 1);
        bench.module.set(bench.request[1], u64::from(number));
        bench.wait(0..130);
        bench.reset();
        assert!(
            bench.module.is_high(bench.pins[0]),
            "CS# is high after a reset"
        );
        bench.wait(0..20);
        let number = bench.rng.random_range(0..1024_u32);
        assert_eq!(bench.read(number), COMMAND + WORD);
    }
}
