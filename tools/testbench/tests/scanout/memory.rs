//! Model of the memory that scan-out reads, with configurable timing.

use std::collections::VecDeque;

use glint_testbench::{Bits, Module, Port};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::raster::{Raster, pixel_at};
use crate::settings::Settings;

/// Bytes per memory word.
pub const WORD: u64 = 16;

/// Timing of the memory: the shares of cycles in which it accepts a command (`ready`) and delivers a due word (`deliver`), and
/// its minimum and maximum latency in cycles.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    pub ready: f64,
    pub deliver: f64,
    pub latency: [u64; 2],
    /// Probability per cycle that a pause begins; `pause_cycles` is the maximum length of a pause in cycles.
    pub pause: f64,
    pub pause_cycles: u64,
}

impl Timing {
    /// A memory without stalls, with a latency of 8 cycles.
    pub const PROMPT: Self = Self {
        ready: 1.0,
        deliver: 1.0,
        latency: [8, 8],
        pause: 0.0,
        pause_cycles: 0,
    };
    /// A memory shared with mostly idle masters.
    pub const SHARED: Self = Self {
        ready: 0.8,
        deliver: 0.9,
        latency: [2, 20],
        ..Self::PROMPT
    };
    /// A memory shared with busy masters.
    pub const BUSY: Self = Self {
        ready: 0.5,
        deliver: 0.7,
        latency: [5, 60],
        ..Self::PROMPT
    };
}

/// Returns true with the probability `share`.
pub fn chance(random: &mut Pcg64Mcg, share: f64) -> bool {
    share >= 1.0 || share > 0.0 && random.random_bool(share)
}

/// Model of the memory at the module's read port.
pub struct Memory {
    pub timing: Timing,
    /// Whether the memory is paused: takes no commands and delivers no words.
    pub stopped: bool,
    cmd: [Port; 3],
    rdata: [Port; 2],
    /// For each command whose word was not delivered yet: the word address, and the cycle from which the word is due.
    commands: VecDeque<(u64, u64)>,
    /// Word address of a valid command that was not taken yet.
    held: Option<u64>,
    paused_until: u64,
}

impl Memory {
    pub fn new(module: &Module) -> Self {
        Self {
            timing: Timing::PROMPT,
            stopped: false,
            cmd: ["cmd_valid", "cmd_ready", "cmd_addr"].map(|name| module.port(name)),
            rdata: ["rdata_valid", "rdata"].map(|name| module.port(name)),
            commands: VecDeque::new(),
            held: None,
            paused_until: 0,
        }
    }

    /// Drops all commands, for a reset of the module.
    pub fn reset(&mut self, module: &mut Module) {
        self.commands.clear();
        self.held = None;
        self.rest(module);
    }

    /// Drives the port to take no command and deliver no word.
    pub fn rest(&self, module: &mut Module) {
        module.set_value(self.rdata[0], 0);
        module.set_value(self.cmd[1], 0);
    }

    /// Takes the command of this cycle if the memory is ready, and checks that its address is in a frame with the settings
    /// `from`. Returns whether a command waits because the memory is not ready.
    pub fn sample(
        &mut self,
        module: &Module,
        random: &mut Pcg64Mcg,
        raster: &Raster,
        cycle: u64,
        from: &Settings,
    ) -> bool {
        let valid = module.is_high(self.cmd[0]);
        let address = module.value(self.cmd[2]);
        if let Some(held) = self.held.take() {
            assert!(
                valid && address == held,
                "command {held:#x} was changed or withdrawn before it was taken"
            );
        }
        if !valid {
            return false;
        }
        if !module.is_high(self.cmd[1]) {
            self.held = Some(address);
            return true;
        }
        let words = raster.h_active / from.scale * (raster.v_active / from.scale) / 8;
        assert!(
            from.enable && address.wrapping_sub(from.base) < words,
            "read of word {address:#x}, outside the frame at {:#x}",
            from.base
        );
        assert!(
            (self.commands.len() as u64) < raster.h_active / 8,
            "more commands in flight than a line has words"
        );
        let [least, most] = self.timing.latency;
        let due = cycle + random.random_range(least..=most);
        // Words are delivered in the order of the commands.
        let due = self.commands.back().map_or(due, |&(_, last)| due.max(last));
        self.commands.push_back((address, due));
        false
    }

    /// Whether the memory delivers a word in this cycle.
    pub fn delivers(&self, module: &Module) -> bool {
        module.is_high(self.rdata[0])
    }

    /// Drives the port: chooses `ready` at random, and delivers a due word, otherwise random data that are not valid.
    pub fn drive(&mut self, module: &mut Module, random: &mut Pcg64Mcg, cycle: u64) {
        let timing = self.timing;
        if cycle >= self.paused_until && chance(random, timing.pause) {
            self.paused_until = cycle + random.random_range(0..timing.pause_cycles);
        }
        let awake = cycle >= self.paused_until && !self.stopped;
        module.set_value(
            self.cmd[1],
            u64::from(awake && chance(random, timing.ready)),
        );
        let due = self.commands.front().is_some_and(|&(_, due)| due <= cycle);
        let given = awake && due && chance(random, timing.deliver);
        module.set_value(self.rdata[0], u64::from(given));
        let words: [u32; 4] = match self.commands.front() {
            Some(&(address, _)) if given => {
                self.commands.pop_front();
                std::array::from_fn(|i| {
                    let byte = address * WORD + 4 * i as u64;
                    u32::from(pixel_at(byte)) | u32::from(pixel_at(byte + 2)) << 16
                })
            }
            _ => random.random(),
        };
        module.set(self.rdata[1], Bits::from_words(&words));
    }
}
