//! Test bench of the scan-out module: two clocks, a memory, software that changes the settings, and a monitor.

use glint_testbench::{Module, Port};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::memory::Memory;
use crate::monitor::Monitor;
use crate::raster::{Clocks, Raster};
use crate::settings::{Settings, error};

/// Expected values of the module's counters.
#[derive(Clone, Copy, Debug, Default)]
struct Counted {
    vblanks: u32,
    stalled: u32,
    words: u32,
}

struct Ports {
    sys_clk: Port,
    sys_rst: Port,
    pix_clk: Port,
    pix_rst: Port,
    settings: [Port; 3],
    fetching: Port,
    vblank: Port,
    underflows: Port,
    line_ended: Port,
    registers: [Port; 7],
}

impl Ports {
    /// Names of the outputs compared in every cycle of `sys_clk`.
    const REGISTERS: [&str; 7] = [
        "enabled",
        "scale_current",
        "frame_current",
        "frames",
        "stalled",
        "word_came",
        "error",
    ];

    fn of(module: &Module) -> Self {
        Self {
            sys_clk: module.port("sys_clk"),
            sys_rst: module.port("sys_rst"),
            pix_clk: module.port("pix_clk"),
            pix_rst: module.port("pix_rst"),
            settings: ["enable", "scale", "frame_base"].map(|name| module.port(name)),
            fetching: module.port("fetching"),
            vblank: module.port("vblank"),
            underflows: module.port("underflows"),
            line_ended: module.port("line_ended"),
            registers: Self::REGISTERS.map(|name| module.port(name)),
        }
    }
}

pub struct Bench {
    pub module: Module,
    pub random: Pcg64Mcg,
    pub memory: Memory,
    pub monitor: Monitor,
    /// Settings requested by software; they drive the inputs from the next edge of `sys_clk` on.
    pub asked: Settings,
    /// Callback in each cycle of `sys_clk`, which may change the requested settings.
    pub software: Option<fn(&mut Pcg64Mcg, &mut Settings)>,
    ports: Ports,
    raster: Raster,
    clocks: Clocks,
    next_sys: u64,
    next_pix: u64,
    now: u64,
    cycles: u64,
    vblanks: u64,
    driven: Settings,
    /// Settings that the module latched at the last vertical blanking.
    in_force: Settings,
    /// Settings of the frame whose line is fetched or was fetched last.
    fetched_from: Settings,
    was_fetching: bool,
    counted: Counted,
    counted_before: Counted,
    /// Number of source lines that the module has reported as complete.
    pub lines: u64,
    /// Number of words that the module has reported as read.
    pub words: u64,
    expected_error: u64,
    late_before: u64,
    /// Time of the last pixel of the picture; `None` once the module has reported the following vertical blanking.
    active_end: Option<u64>,
}

impl Bench {
    /// Creates a bench with the module `name` after both resets.
    pub fn new(name: &str, raster: Raster, clocks: Clocks, seed: u64) -> Self {
        let module = Module::load(name, seed as u32);
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut bench = Self {
            memory: Memory::new(&module),
            monitor: Monitor::new(&module, raster),
            ports: Ports::of(&module),
            module,
            asked: Settings::RESET,
            software: None,
            raster,
            clocks,
            // The unit of time makes a period of sys_clk `clocks.pix` units and a period of pix_clk `clocks.sys` units; each
            // clock has a random phase.
            next_sys: 1 + random.random_range(0..clocks.pix),
            next_pix: 1 + random.random_range(0..clocks.sys),
            random,
            now: 0,
            cycles: 0,
            vblanks: 0,
            driven: Settings::RESET,
            in_force: Settings::RESET,
            fetched_from: Settings::RESET,
            was_fetching: false,
            counted: Counted::default(),
            counted_before: Counted::default(),
            lines: 0,
            words: 0,
            expected_error: error::NONE,
            late_before: 0,
            active_end: None,
        };
        bench.module.set_value(bench.ports.sys_rst, 1);
        bench.module.set_value(bench.ports.pix_rst, 1);
        bench.drive();
        bench.module.settle();
        for _ in 0..40 {
            bench.edge();
        }
        bench.reset_sys(false);
        bench.reset_pix(false);
        bench
    }

    /// Creates a bench with the module `scanout_small`.
    pub fn small(clocks: Clocks, seed: u64) -> Self {
        Self::new("scanout_small", Raster::SMALL, clocks, seed)
    }

    pub fn run_cycles(&mut self, count: u64) {
        let end = self.cycles + count;
        while self.cycles < end {
            self.edge();
        }
    }

    /// Runs for the time of `count` lines of the video output.
    pub fn run_lines(&mut self, count: u64) {
        self.run_cycles(self.clocks.sys_cycles(count * self.raster.h_total()));
    }

    /// Runs until the next vertical blanking.
    pub fn run_to_vblank(&mut self) {
        let before = self.vblanks;
        let limit = self.cycles + self.clocks.sys_cycles(3 * self.raster.frame()) + 1000;
        while self.vblanks == before {
            self.edge();
            assert!(self.cycles <= limit, "no vblank within three frames");
        }
    }

    pub fn run_frames(&mut self, count: u64) {
        for _ in 0..count {
            self.run_to_vblank();
        }
    }

    /// Asserts or releases the reset of the `sys_clk` domain (memory and registers).
    pub fn reset_sys(&mut self, on: bool) {
        self.module.set_value(self.ports.sys_rst, u64::from(on));
        // A vertical blanking during the reset is reported after the reset, so its time is not checked.
        self.active_end = None;
        if on {
            self.asked = Settings::RESET;
            self.in_force = Settings::RESET;
            self.drive();
            self.memory.reset(&mut self.module);
            self.monitor.line_unchecked = true;
            self.monitor.line_shown = None;
            self.monitor.late = 0;
            self.late_before = 0;
            self.counted = Counted::default();
            self.counted_before = Counted::default();
            self.was_fetching = false;
            self.expected_error = error::NONE;
        }
    }

    /// Asserts or releases the reset of the `pix_clk` domain (video).
    pub fn reset_pix(&mut self, on: bool) {
        self.module.set_value(self.ports.pix_rst, u64::from(on));
        if on {
            self.monitor.reset();
            self.active_end = None;
        }
    }

    /// Whether the module is fetching a source line from memory.
    pub fn is_fetching(&self) -> bool {
        self.module.is_high(self.ports.fetching)
    }

    fn in_sys_reset(&self) -> bool {
        self.module.is_high(self.ports.sys_rst)
    }

    /// Advances to the next rising edge of either clock, or of both clocks if they rise at the same time.
    fn edge(&mut self) {
        self.now = self.next_sys.min(self.next_pix);
        let (sys, pix) = (self.now == self.next_sys, self.now == self.next_pix);
        if sys && !self.in_sys_reset() {
            self.before_sys_edge();
        }
        self.module.set_value(self.ports.sys_clk, u64::from(sys));
        self.module.set_value(self.ports.pix_clk, u64::from(pix));
        self.module.settle();
        if sys {
            self.after_sys_edge();
        }
        if pix
            && !self.module.is_high(self.ports.pix_rst)
            && self.monitor.watch(&self.module, &self.in_force)
        {
            self.active_end = Some(self.now);
        }
        self.module.set_value(self.ports.sys_clk, 0);
        self.module.set_value(self.ports.pix_clk, 0);
        self.module.settle();
        if sys {
            self.next_sys += self.clocks.pix;
            self.cycles += 1;
        }
        if pix {
            self.next_pix += self.clocks.sys;
        }
    }

    fn drive(&mut self) {
        self.driven = self.asked;
        let Settings {
            enable,
            scale,
            base,
        } = self.asked;
        for (port, value) in self
            .ports
            .settings
            .into_iter()
            .zip([enable.into(), scale, base])
        {
            self.module.set_value(port, value);
        }
    }

    fn before_sys_edge(&mut self) {
        let fetching = self.is_fetching();
        if fetching && !self.was_fetching {
            self.fetched_from = self.in_force;
        }
        self.was_fetching = fetching;
        let stalled = self.memory.sample(
            &self.module,
            &mut self.random,
            &self.raster,
            self.cycles,
            &self.fetched_from,
        );
        self.counted_before = self.counted;
        self.counted.stalled += u32::from(stalled);
        self.counted.words += u32::from(self.memory.delivers(&self.module));
        if self.module.is_high(self.ports.vblank) {
            self.at_vblank();
        }
    }

    fn at_vblank(&mut self) {
        self.vblanks += 1;
        self.counted.vblanks += 1;
        if let Some(end) = self.active_end.take() {
            let limit = (self.raster.h_front + 8) * self.clocks.sys + 4 * self.clocks.pix;
            assert!(
                self.now - end <= limit,
                "vblank {} pixels after the last pixel",
                (self.now - end) / self.clocks.sys
            );
        }
        let scale_known = [1, 2, 4].contains(&self.driven.scale);
        let scale = self.in_force.scale;
        self.in_force = self.driven;
        if !scale_known {
            self.in_force.scale = scale;
        }
        self.monitor.line_shown = None;
        let late = self.monitor.late;
        self.expected_error = match scale_known {
            false => error::SCALE,
            true if late != self.late_before => error::UNDERFLOW,
            true => error::NONE,
        };
        self.late_before = late;
        let counted = self.module.value(self.ports.underflows);
        assert_eq!(
            counted, late,
            "number of underflows, expected the number of late lines"
        );
    }

    fn after_sys_edge(&mut self) {
        if self.in_sys_reset() {
            self.memory.rest(&mut self.module);
            return;
        }
        self.check_registers();
        self.lines += self.module.value(self.ports.line_ended);
        self.words += u64::from(self.counted.words - self.counted_before.words);
        if let Some(software) = self.software {
            software(&mut self.random, &mut self.asked);
        }
        self.drive();
        self.memory
            .drive(&mut self.module, &mut self.random, self.cycles);
    }

    fn check_registers(&self) {
        let Counted {
            vblanks,
            stalled,
            words,
        } = self.counted;
        let before = self.counted_before;
        let expected = [
            self.in_force.enable.into(),
            self.in_force.scale,
            self.in_force.base,
            vblanks.into(),
            (stalled - before.stalled).into(),
            (words - before.words).into(),
            self.expected_error,
        ];
        for (i, expected) in expected.into_iter().enumerate() {
            let found = self.module.value(self.ports.registers[i]);
            assert_eq!(found, expected, "{}", Ports::REGISTERS[i]);
        }
    }
}
