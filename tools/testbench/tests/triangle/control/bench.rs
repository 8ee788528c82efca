//! Test bench of `triangle_control`, between software and a simple model of the engine.

use glint_testbench::{Module, Port};

use crate::control::passes::{
    ADDRESS, BASE, BUSY, CANCELLED, FULL, Flags, GEOMETRY, LATENCY, LIST, Limits, MEMORY, MESH,
    NAMES, NONE, Pass, RASTER, refusal, regions,
};

/// Expected state of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    Idle,
    /// Requested: the clock of the request, and the error of the expected refusal, if any.
    Asked(u64, u64),
    /// Started: the remaining clocks of the pass.
    Runs(u64),
}

/// Whether the engine can start a pass: `Since` this clock, or not yet, because it `Waits` until it
/// is ready after a cancel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    Since(u64),
    Waits,
}

/// The module with the model of the engine, and the module's expected state.
pub struct Bench {
    pub module: Module,
    /// Bytes per descriptor.
    pub descriptor: u64,
    pub passes: [Pass; 2],
    pub list_shift: u64,
    pub limits: Limits,
    pub states: [State; 2],
    /// Expected value of the output `error` of each pass.
    pub errors: [u64; 2],
    /// Expected flags at the output `kept` of each pass.
    pub kept: [Option<Flags>; 2],
    pub recovery: Recovery,
    /// Number of clocks until the engine is ready again.
    pub ready_in: u64,
    /// Run time of each pass in clocks.
    pub runs: [u64; 2],
    /// Result of each pass, an error code.
    pub ends: [u64; 2],
    /// Load time of each pass's parameters after an accepted request, in clocks. While the
    /// parameters load, the addresses of the regions are wrong.
    pub loads: [u64; 2],
    /// Remaining load time of each pass, in clocks.
    pub loading: [u64; 2],
    /// Numbers of accepted requests, starts and ends of each pass.
    pub counts: [[u64; 3]; 2],
    pub clocks: u64,
}

/// Requests of software in one clock.
#[derive(Clone, Copy, Debug, Default)]
pub struct Events {
    pub ask: [bool; 2],
    pub cancel: bool,
    /// With `cancel`: clocks until the engine is ready again.
    pub recovers: u64,
}

impl Events {
    /// Requests passes.
    pub fn ask(ask: [bool; 2]) -> Self {
        Self {
            ask,
            ..Self::default()
        }
    }

    /// Cancels passes; the engine is ready again after `recovers` clocks.
    pub fn cancel(recovers: u64) -> Self {
        Self {
            cancel: true,
            recovers,
            ..Self::default()
        }
    }
}

impl Bench {
    pub fn new(seed: u32) -> Self {
        Self::of("triangle_control", 48, seed)
    }

    /// Creates a bench of the module variant with smooth shading.
    pub fn smooth(seed: u32) -> Self {
        Self::of("triangle_control_smooth", 96, seed)
    }

    pub fn of(name: &str, descriptor: u64, seed: u32) -> Self {
        let mut bench = Self {
            module: Module::new(name, seed),
            descriptor,
            passes: Pass::good(),
            list_shift: 9,
            limits: Limits {
                memory: MEMORY,
                sizes: 3,
                triangles: true,
                lines: false,
                geometry: true,
            },
            states: [State::Idle; 2],
            errors: [NONE; 2],
            kept: [None, None],
            recovery: Recovery::Waits,
            ready_in: 0,
            runs: [20, 30],
            ends: [NONE; 2],
            loads: [0; 2],
            loading: [0; 2],
            counts: [[0; 3]; 2],
            clocks: 0,
        };
        // Runs one clock with the engine ready, after which passes can start.
        bench.clock(Events::default());
        bench
    }

    /// Requests the pass `which` with several values of the port `count`, in units of `item` bytes. The region at the address on
    /// the port `region` must be accepted if it ends at the end of memory, and refused if it ends one word beyond.
    pub fn lengths(&mut self, which: usize, count: &str, region: &str, item: u64) {
        const MOST: u64 = (1 << 20) - 1;
        let counts: &[u64] = if item == 1 {
            &[
                16,
                0xf0,
                1 << 24,
                (1 << 25) - 16,
                1 << 25,
                1 << 26,
                MEMORY - 16,
                MEMORY,
            ]
        } else {
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 255, 256, 1 << 19, MOST - 1, MOST]
        };
        self.passes = Pass::good();
        for &count_value in counts {
            self.passes[which].set(count, count_value);
            let bytes = (count_value * item).next_multiple_of(16);
            let asks = [which == GEOMETRY, which == RASTER];
            let last = BASE + MEMORY - bytes.max(16);
            for (address, expected) in [(last, NONE), (last + 16, ADDRESS)] {
                self.passes[which].set(region, address);
                let error = self.ask(asks)[which];
                assert_eq!(error, expected, "{count} {count_value} at {address:#x}");
            }
        }
    }

    pub fn port(&self, which: usize, name: &str) -> Port {
        self.module.port(&format!("{}_{name}", NAMES[which]))
    }

    pub fn set(&mut self, which: usize, name: &str, value: u64) {
        let port = self.port(which, name);
        self.module.set(port, value);
    }

    pub fn value(&self, which: usize, name: &str) -> u64 {
        self.module.value(self.port(which, name))
    }

    pub fn set_flags(&mut self, which: usize, flags: &Flags) {
        for (path, value) in flags.members(&format!("{}_flags", NAMES[which])) {
            self.module.drive(&path, value);
        }
    }

    /// Drives the parameters of both passes.
    pub fn configure(&mut self) {
        for path in ["geometry.list_shift", "raster.list_shift"] {
            self.module.drive(path, self.list_shift);
        }
        for which in [GEOMETRY, RASTER] {
            let flags = self.passes[which].flags.clone();
            self.set_flags(which, &flags);
            self.drive_regions(which);
        }
    }

    /// Drives the addresses and lengths of a pass.
    fn drive_regions(&mut self, which: usize) {
        for (name, value) in &self.passes[which].ports {
            self.module.drive_bits(name, *value);
        }
    }

    /// Starts loading the parameters of a pass.
    fn load(&mut self, which: usize) {
        self.loading[which] = self.loads[which];
        if self.loads[which] > 0 {
            for (name, _) in &self.passes[which].ports {
                self.module.drive(name, 1);
            }
        }
    }

    /// The error with which the module must refuse a pass, or `NONE`.
    pub fn refusal(&self, which: usize) -> u64 {
        let (pass, shift) = (&self.passes[which], self.list_shift);
        refusal(which, pass, shift, self.descriptor, self.limits)
    }

    /// The memory regions of a pass: the port of the address, and the length in bytes.
    pub fn regions(&self, which: usize) -> Vec<(&'static str, u64)> {
        regions(which, &self.passes[which], self.list_shift, self.descriptor)
    }

    pub fn is_active(&self, which: usize) -> bool {
        self.states[which] != State::Idle
    }

    /// Advances by one clock, and checks the module's outputs.
    pub fn clock(&mut self, events: Events) {
        let now = self.clocks;
        let ready = self.ready_in == 0;
        self.module.drive("engine.ready", ready);
        self.module.drive("cancel", events.cancel);
        for which in [GEOMETRY, RASTER] {
            self.set(which, "ask", events.ask[which].into());
            self.set(which, "loading", u64::from(self.loading[which] > 0));
        }
        self.module.clock();
        self.clocks += 1;
        for which in [GEOMETRY, RASTER] {
            if self.loading[which] == 1 {
                self.drive_regions(which);
            }
            self.loading[which] = self.loading[which].saturating_sub(1);
        }
        if ready && self.recovery == Recovery::Waits {
            self.recovery = Recovery::Since(now);
        }
        self.ready_in = self.ready_in.saturating_sub(1);

        for which in [GEOMETRY, RASTER] {
            let name = NAMES[which];
            let started = self.value(which, "start") == 1;
            let told = self.value(which, "ended") == 1;
            let mut expects_end = false;
            if events.ask[which] {
                if self.is_active(which) {
                    self.errors[which] = BUSY;
                } else {
                    let refusal = self.refusal(which);
                    self.load(which);
                    self.states[which] = State::Asked(now + self.loads[which], refusal);
                    self.errors[which] = NONE;
                    self.kept[which] = Some(self.passes[which].flags.clone());
                    self.counts[which][0] += 1;
                }
            }
            match self.states[which] {
                _ if events.cancel => {
                    if self.is_active(which) {
                        self.errors[which] = CANCELLED;
                        self.states[which] = State::Idle;
                        expects_end = true;
                    }
                    assert!(!started, "{name} starts after it was cancelled");
                }
                State::Asked(since, _) if now < since => {
                    assert!(!started, "{name} starts before its parameters are loaded");
                }
                State::Asked(since, refusal) => {
                    // Both passes may be requested in one clock, so the limit is twice a pass's latency. The limit counts from
                    // the request, or from `ready` of the engine if that is later.
                    if let Recovery::Since(ready) = self.recovery {
                        let waited = now - since.max(ready);
                        assert!(
                            waited <= 2 * LATENCY,
                            "{name}: neither start nor refusal for {waited} clocks"
                        );
                    }
                    if refusal != NONE {
                        assert!(!started, "{name} starts, expected error {refusal}");
                        if told {
                            expects_end = true;
                            self.errors[which] = refusal;
                            self.states[which] = State::Idle;
                        }
                    } else if started {
                        assert_ne!(
                            self.recovery,
                            Recovery::Waits,
                            "{name} starts before `ready`"
                        );
                        self.counts[which][1] += 1;
                        self.states[which] = State::Runs(self.runs[which]);
                    }
                }
                State::Runs(0) => {
                    assert!(!started, "{name} starts twice");
                    expects_end = true;
                    self.states[which] = State::Idle;
                    if self.ends[which] != NONE {
                        self.errors[which] = self.ends[which];
                    }
                }
                State::Runs(left) => {
                    assert!(!started, "{name} starts twice");
                    self.states[which] = State::Runs(left - 1);
                }
                State::Idle => assert!(!started, "{name} starts without a request"),
            }
            assert_eq!(
                told, expects_end,
                "{name}: ended, in state {:?}",
                self.states[which]
            );
            self.counts[which][2] += u64::from(told);
        }
        if events.cancel {
            self.recovery = Recovery::Waits;
            self.ready_in = events.recovers;
        }
        self.drive_engine();
        for which in [GEOMETRY, RASTER] {
            let name = NAMES[which];
            let found = ["active", "error"].map(|port| self.value(which, port));
            let active = u64::from(self.is_active(which));
            assert_eq!(found, [active, self.errors[which]], "{name}: active, error");
            if let Some(kept) = &self.kept[which] {
                for (path, value) in kept.members(&format!("{name}_kept")) {
                    assert_eq!(self.module.read(&path), value, "{path}");
                }
            }
        }
    }

    /// Drives the engine's outputs for the next clock.
    pub fn drive_engine(&mut self) {
        for which in [GEOMETRY, RASTER] {
            // `busy` rises after the start and falls with `done`.
            let done = self.states[which] == State::Runs(0);
            let busy = matches!(self.states[which], State::Runs(left) if left > 0 && left < self.runs[which]);
            let name = NAMES[which];
            self.module.drive(&format!("engine.{name}_busy"), busy);
            self.module.drive(&format!("engine.{name}_done"), done);
            // Results are valid only with `done`, otherwise random.
            let noise = self.clocks.is_multiple_of(3);
            let says = |error| {
                u64::from(if done {
                    self.ends[which] == error
                } else {
                    noise
                })
            };
            let ports: &[_] = match which {
                GEOMETRY => &[
                    ("engine.mesh_error", says(MESH)),
                    ("engine.full", says(FULL)),
                ],
                _ => &[("engine.list_error", says(LIST))],
            };
            for &(port, value) in ports {
                self.module.drive(port, value);
            }
        }
        self.module.settle();
    }

    /// Requests passes and waits for their ends; returns the errors of both passes.
    pub fn ask(&mut self, ask: [bool; 2]) -> [u64; 2] {
        self.configure();
        self.clock(Events::ask(ask));
        self.finish();
        self.errors
    }

    pub fn finish(&mut self) {
        for _ in 0..1000 {
            if !self.is_active(GEOMETRY) && !self.is_active(RASTER) {
                // After its end, a pass stays idle and its error does not change.
                for _ in 0..3 {
                    self.clock(Events::default());
                }
                for [asks, _, ends] in self.counts {
                    assert_eq!(asks, ends);
                }
                return;
            }
            self.clock(Events::default());
        }
        panic!("no end: {:?}", self.states);
    }

    pub fn wait(&mut self, clocks: u64) {
        for _ in 0..clocks {
            self.clock(Events::default());
        }
    }
}
