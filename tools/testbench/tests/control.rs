//! What the engine is asked for, and what becomes of it: `triangle_control` with something like an engine behind it.

use glint_testbench::{Module, Port};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

const BASE: u64 = 0x4000_0000;
const MEMORY: u64 = 128 << 20;
/// Clocks from an ask to the start, of a pass alone.
const LATENCY: u64 = 15;

const NONE: u64 = 0;
const SIZE: u64 = 1;
const ADDRESS: u64 = 2;
const BUSY: u64 = 3;
const MESH: u64 = 4;
const FULL: u64 = 5;
const LIST: u64 = 6;
const CANCELLED: u64 = 7;

/// The two passes, in arrays of two.
const GEOMETRY: usize = 0;
const RASTER: usize = 1;
const NAMES: [&str; 2] = ["geometry", "raster"];

/// The size of a picture, and whether each of the other flags is set.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Flags {
    size: u64,
    others: Vec<(&'static str, bool)>,
}

impl Flags {
    fn is_set(&self, name: &str) -> bool {
        self.others.contains(&(name, true))
    }

    /// Sets the flags that are named and clears the others.
    fn choose(&mut self, names: &[&str]) {
        for (name, set) in &mut self.others {
            *set = names.contains(name);
        }
    }

    fn invert(&mut self) {
        self.size ^= 3;
        for (_, set) in &mut self.others {
            *set = !*set;
        }
    }

    /// The members of a port with these flags, and their values.
    fn members(&self, port: &str) -> Vec<(String, u64)> {
        let others = self.others.iter().map(|&(name, set)| (name, set.into()));
        let all = [("size", self.size)].into_iter().chain(others);
        all.map(|(name, value)| (format!("{port}.{name}"), value))
            .collect()
    }
}

/// A pass with its parameters: flags, and values of ports.
#[derive(Clone, Debug)]
struct Pass {
    flags: Flags,
    ports: Vec<(&'static str, u64)>,
}

impl Pass {
    fn get(&self, name: &str) -> u64 {
        self.ports.iter().find(|(port, _)| *port == name).unwrap().1
    }

    fn set(&mut self, name: &str, value: u64) {
        let port = self.ports.iter_mut().find(|(port, _)| *port == name);
        port.unwrap().1 = value;
    }

    /// Passes that can be done.
    fn good() -> [Self; 2] {
        let geometry = [
            ("geometry.mesh", BASE + 0x10_0000),
            ("geometry.mesh_bytes", 0x1000),
            ("geometry.descriptors", BASE + 0x20_0000),
            ("geometry.descriptor_limit", 1000),
            ("geometry.lists", BASE + 0x40_0000),
            ("geometry.exceptions", BASE + 0x60_0000),
            ("geometry.exception_limit", 1000),
        ];
        let raster = [
            ("raster.frame", BASE + 0x100_0000),
            ("raster.depth", BASE + 0x200_0000),
            ("raster.lists[0]", BASE + 0x40_0000),
            ("raster.lists[1]", BASE + 0x60_0000),
            ("raster.descriptors[0]", BASE + 0x20_0000),
            ("raster.descriptors[1]", BASE + 0x30_0000),
            ("raster.count[0]", 1000),
            ("raster.count[1]", 1000),
        ];
        [
            Self {
                flags: Flags {
                    size: 1,
                    others: vec![("cull", true), ("smooth", false)],
                },
                ports: geometry.to_vec(),
            },
            Self {
                flags: Flags {
                    size: 0,
                    others: vec![
                        ("first", true),
                        ("second", true),
                        ("depth", true),
                        ("slot", false),
                        ("whole", false),
                    ],
                },
                ports: raster.to_vec(),
            },
        ]
    }

    fn size(&self) -> usize {
        self.flags.size as usize
    }
}

/// The regions of a pass: the port with the address, and the bytes; only those that are looked at.
fn regions(
    which: usize,
    pass: &Pass,
    list_shift: u64,
    descriptor: u64,
) -> Vec<(&'static str, u64)> {
    let size = pass.size();
    let bands = [4, 15, 60, 60][size];
    let lists = match list_shift {
        // A table of lengths, then lists with space between them.
        0..=17 => 16 * (16 + (bands << list_shift) + 128 * bands),
        _ => 1 << 60,
    };
    let pixels = (320 * 180) << (2 * size);
    let flag = |name| pass.flags.is_set(name);
    match which {
        GEOMETRY => vec![
            ("geometry.mesh", pass.get("geometry.mesh_bytes") & !15),
            (
                "geometry.descriptors",
                descriptor * pass.get("geometry.descriptor_limit"),
            ),
            ("geometry.lists", lists),
            (
                "geometry.exceptions",
                4 * pass.get("geometry.exception_limit"),
            ),
        ],
        _ => [
            (true, "raster.frame", 2 * pixels),
            (flag("depth"), "raster.depth", 4 * pixels),
            (flag("first"), "raster.lists[0]", lists),
            (flag("second"), "raster.lists[1]", lists),
            (
                flag("first"),
                "raster.descriptors[0]",
                descriptor * pass.get("raster.count[0]"),
            ),
            (
                flag("second"),
                "raster.descriptors[1]",
                descriptor * pass.get("raster.count[1]"),
            ),
        ]
        .into_iter()
        .filter_map(|(used, name, bytes)| used.then_some((name, bytes)))
        .collect(),
    }
}

/// Why a pass is refused.
fn refusal(which: usize, pass: &Pass, list_shift: u64, descriptor: u64) -> u64 {
    let misplaced = |&(port, bytes): &(&str, u64)| {
        let first = pass.get(port);
        !first.is_multiple_of(16)
            || !(BASE..BASE + MEMORY).contains(&first)
            || bytes.next_multiple_of(16) > BASE + MEMORY - first
    };
    if pass.size() == 3 {
        SIZE
    } else if regions(which, pass, list_shift, descriptor)
        .iter()
        .any(misplaced)
    {
        ADDRESS
    } else {
        NONE
    }
}

/// What a pass has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    /// Asked for in this clock, with what becomes of it if nothing comes in between.
    Asked(u64, u64),
    /// Runs for so many clocks more.
    Runs(u64),
}

/// Whether it may start: not from a cancel on until the engine is ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Recovery {
    Since(u64),
    Waits,
}

/// The controller, an engine behind it, and what both should do.
struct Bench {
    module: Module,
    /// Bytes of a descriptor.
    descriptor: u64,
    passes: [Pass; 2],
    list_shift: u64,
    states: [State; 2],
    /// What `error` should say, and the flags that should be kept.
    errors: [u64; 2],
    kept: [Option<Flags>; 2],
    recovery: Recovery,
    /// Clocks until the engine is ready again.
    ready_in: u64,
    /// How long passes run, and what they end with.
    runs: [u64; 2],
    ends: [u64; 2],
    /// Asks that were taken, starts, ends.
    counts: [[u64; 3]; 2],
    clocks: u64,
}

/// What happens in a clock.
#[derive(Clone, Copy, Debug, Default)]
struct Events {
    ask: [bool; 2],
    cancel: bool,
    /// With `cancel`: clocks until the engine is ready again.
    recovers: u64,
}

impl Bench {
    fn new(seed: u32) -> Self {
        Self::of("triangle_control", 48, seed)
    }

    /// Of an engine that shades smoothly.
    fn smooth(seed: u32) -> Self {
        Self::of("triangle_control_smooth", 96, seed)
    }

    fn of(name: &str, descriptor: u64, seed: u32) -> Self {
        let mut bench = Self {
            module: Module::new(name, seed),
            descriptor,
            passes: Pass::good(),
            list_shift: 9,
            states: [State::Idle; 2],
            errors: [NONE; 2],
            kept: [None, None],
            recovery: Recovery::Waits,
            ready_in: 0,
            runs: [20, 30],
            ends: [NONE; 2],
            counts: [[0; 3]; 2],
            clocks: 0,
        };
        // A clock with `ready`, which it waits for.
        bench.clock(Events::default());
        bench
    }

    /// A region of a pass with counts from nothing to the most: it ends with memory, or a word beyond it.
    fn lengths(&mut self, which: usize, count: &str, region: &str, item: u64) {
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

    fn port(&self, which: usize, name: &str) -> Port {
        self.module.port(&format!("{}_{name}", NAMES[which]))
    }

    fn set(&mut self, which: usize, name: &str, value: u64) {
        let port = self.port(which, name);
        self.module.set(port, value);
    }

    fn value(&self, which: usize, name: &str) -> u64 {
        self.module.value(self.port(which, name))
    }

    fn set_flags(&mut self, which: usize, flags: &Flags) {
        for (path, value) in flags.members(&format!("{}_flags", NAMES[which])) {
            self.module.drive(&path, value);
        }
    }

    /// Puts the parameters on the ports.
    fn configure(&mut self) {
        for path in ["geometry.list_shift", "raster.list_shift"] {
            self.module.drive(path, self.list_shift);
        }
        for pass in self.passes.clone() {
            for (name, value) in pass.ports {
                let port = self.module.port(name);
                self.module.set(port, value);
            }
        }
        for which in [GEOMETRY, RASTER] {
            let flags = self.passes[which].flags.clone();
            self.set_flags(which, &flags);
        }
    }

    fn is_active(&self, which: usize) -> bool {
        self.states[which] != State::Idle
    }

    /// A clock: the engine's side of it first.
    fn clock(&mut self, events: Events) {
        let now = self.clocks;
        let ready = self.ready_in == 0;
        let port = self.module.port("engine.ready");
        self.module.set(port, u64::from(ready));
        let port = self.module.port("cancel");
        self.module.set(port, u64::from(events.cancel));
        for which in [GEOMETRY, RASTER] {
            self.set(which, "ask", events.ask[which].into());
        }
        self.module.clock();
        self.clocks += 1;
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
                    let refusal =
                        refusal(which, &self.passes[which], self.list_shift, self.descriptor);
                    self.states[which] = State::Asked(now, refusal);
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
                    assert!(!started, "{name} starts though cancelled");
                }
                State::Asked(since, refusal) => {
                    // Both may be asked for at once, and a start waits for the engine.
                    if let Recovery::Since(ready) = self.recovery {
                        let waited = now - since.max(ready);
                        assert!(waited <= 2 * LATENCY, "{name}: nothing for {waited} clocks");
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
                State::Idle => assert!(!started, "{name} starts unasked"),
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

    /// What the engine says in the clock that comes.
    fn drive_engine(&mut self) {
        for which in [GEOMETRY, RASTER] {
            // `busy` rises after the start and falls with `done`.
            let done = self.states[which] == State::Runs(0);
            let busy = matches!(self.states[which], State::Runs(left) if left > 0 && left < self.runs[which]);
            let name = NAMES[which];
            self.module.drive(&format!("engine.{name}_busy"), busy);
            self.module.drive(&format!("engine.{name}_done"), done);
            // What a pass has come to counts only with `done`.
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
                let port = self.module.port(port);
                self.module.set(port, value);
            }
        }
        self.module.settle();
    }
    /// Asks for passes and waits for their ends; returns the errors.
    fn ask(&mut self, ask: [bool; 2]) -> [u64; 2] {
        self.configure();
        self.clock(Events {
            ask,
            ..Events::default()
        });
        self.finish();
        self.errors
    }

    fn finish(&mut self) {
        for _ in 0..1000 {
            if !self.is_active(GEOMETRY) && !self.is_active(RASTER) {
                // What has ended stays ended, and its error stays.
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

    fn wait(&mut self, clocks: u64) {
        for _ in 0..clocks {
            self.clock(Events::default());
        }
    }
}

/// Each region of both passes, at places that are right and wrong; alone, and with the other pass.
#[test]
fn regions_are_wholly_in_memory() {
    let mut bench = Bench::new(1);
    let mut cases = 0;
    for which in [GEOMETRY, RASTER] {
        for size in 0..3 {
            bench.passes = Pass::good();
            // All that there is, of the raster.
            let flags = &mut bench.passes[which].flags;
            flags.size = size;
            flags.choose(&["cull", "first", "second", "depth", "slot", "whole"]);
            for (port, bytes) in regions(
                which,
                &bench.passes[which],
                bench.list_shift,
                bench.descriptor,
            ) {
                let right = bench.passes[which].get(port);
                let last = BASE + MEMORY - bytes.next_multiple_of(16);
                for (address, expected) in [
                    (right, NONE),
                    (BASE, NONE),
                    (last, NONE),
                    (right + 1, ADDRESS),
                    (right + 8, ADDRESS),
                    (last - 8, ADDRESS),
                    (last + 16, ADDRESS),
                    (BASE + MEMORY - 16, if bytes <= 16 { NONE } else { ADDRESS }),
                    (BASE - 16, ADDRESS),
                    (BASE + MEMORY, ADDRESS),
                    (right - BASE, ADDRESS),
                    (right + MEMORY, ADDRESS),
                    (right ^ 0x8000_0000, ADDRESS),
                    (0, ADDRESS),
                    (0xffff_fff0, ADDRESS),
                ] {
                    bench.passes[which].set(port, address);
                    for both in [false, true] {
                        let ask = [which == GEOMETRY || both, which == RASTER || both];
                        let error = bench.ask(ask)[which];
                        assert_eq!(
                            error, expected,
                            "{port} {address:#x}, size {size}, both {both}"
                        );
                        cases += 1;
                    }
                }
                bench.passes[which].set(port, right);
            }
        }
    }
    println!("{cases} cases");
}

/// Counts and lengths from nothing to the largest that there is: the region ends with memory, or a word beyond it.
#[test]
fn lengths_are_counted_to_the_last_word() {
    let mut bench = Bench::new(2);
    for (which, count, region, item) in [
        (
            GEOMETRY,
            "geometry.exception_limit",
            "geometry.exceptions",
            4,
        ),
        (GEOMETRY, "geometry.mesh_bytes", "geometry.mesh", 1),
    ] {
        bench.lengths(which, count, region, item);
    }
    for mut bench in [Bench::new(2), Bench::smooth(2)] {
        for (which, count, region) in [
            (
                GEOMETRY,
                "geometry.descriptor_limit",
                "geometry.descriptors",
            ),
            (RASTER, "raster.count[0]", "raster.descriptors[0]"),
            (RASTER, "raster.count[1]", "raster.descriptors[1]"),
        ] {
            bench.lengths(which, count, region, bench.descriptor);
        }
    }

    // Longer than memory, wherever.
    bench.passes = Pass::good();
    bench.passes[GEOMETRY].set("geometry.mesh", BASE);
    for bytes in [MEMORY + 16, 1 << 28, 1 << 29, 1 << 30, 1 << 31, 0xffff_fff0] {
        bench.passes[GEOMETRY].set("geometry.mesh_bytes", bytes);
        assert_eq!(
            bench.ask([true, false])[GEOMETRY],
            ADDRESS,
            "a mesh of {bytes:#x}"
        );
    }
    // Lists of every length, for every size.
    for size in 0..4 {
        for shift in 0..32 {
            bench.passes = Pass::good();
            bench.list_shift = shift;
            for which in [GEOMETRY, RASTER] {
                bench.passes[which].flags.size = size;
                bench.passes[which].flags.choose(&["first", "second"]);
            }
            for port in ["raster.lists[0]", "raster.lists[1]"] {
                bench.passes[RASTER].set(port, BASE);
            }
            bench.passes[GEOMETRY].set("geometry.lists", BASE);
            let expected = [GEOMETRY, RASTER]
                .map(|which| refusal(which, &bench.passes[which], shift, bench.descriptor));
            assert_eq!(expected[GEOMETRY], expected[RASTER]);
            assert_eq!(
                bench.ask([true, true]),
                expected,
                "size {size}, shift {shift}"
            );
        }
    }
}

/// What is not used may be anywhere.
#[test]
fn regions_without_use_are_not_looked_at() {
    let mut bench = Bench::new(3);
    for used in 0..8 {
        let used: Vec<_> = (0..3)
            .filter(|bit| used >> bit & 1 == 1)
            .map(|bit| ["first", "second", "depth"][bit])
            .collect();
        for (wrong, flag) in [
            ("raster.depth", "depth"),
            ("raster.lists[0]", "first"),
            ("raster.lists[1]", "second"),
            ("raster.descriptors[0]", "first"),
            ("raster.descriptors[1]", "second"),
        ] {
            bench.passes = Pass::good();
            bench.passes[RASTER].flags.choose(&used);
            bench.passes[RASTER].set(wrong, 4);
            let expected = if used.contains(&flag) { ADDRESS } else { NONE };
            assert_eq!(
                bench.ask([false, true])[RASTER],
                expected,
                "{wrong}, flags {used:?}"
            );
        }
    }
}

/// A pass alone starts in time, and ends as the engine says.
#[test]
fn passes_end_as_the_engine_says() {
    let mut bench = Bench::new(4);
    for [geometry, raster] in [
        [NONE, NONE],
        [MESH, LIST],
        [FULL, LIST],
        [NONE, LIST],
        [FULL, NONE],
    ] {
        bench.ends = [geometry, raster];
        for ask in [[true, false], [false, true], [true, true]] {
            let starts = bench.counts.map(|counts| counts[1]);
            let errors = bench.ask(ask);
            for which in [GEOMETRY, RASTER] {
                assert_eq!(
                    bench.counts[which][1] - starts[which],
                    u64::from(ask[which])
                );
                assert!(!ask[which] || errors[which] == bench.ends[which]);
            }
        }
    }
    for which in [GEOMETRY, RASTER] {
        bench.clock(Events {
            ask: [which == GEOMETRY, which == RASTER],
            ..Events::default()
        });
        let start = bench.clocks;
        while bench.value(which, "start") == 0 {
            bench.clock(Events::default());
        }
        println!("{}: {} clocks", NAMES[which], bench.clocks - start);
        assert!(bench.clocks - start <= LATENCY);
        bench.finish();
    }
}

/// Asked for again while it is pending, being checked, started, busy, done: the pass goes on and ends, once.
#[test]
fn asks_in_between_are_refused() {
    let mut bench = Bench::new(5);
    bench.runs = [12, 14];
    for which in [GEOMETRY, RASTER] {
        let mine = [which == GEOMETRY, which == RASTER];
        for end in [NONE, [MESH, LIST][which]] {
            for wrong in [false, true] {
                for after in 0..40 {
                    bench.passes = Pass::good();
                    bench.ends = [end; 2];
                    if wrong {
                        bench.passes[which].set(["geometry.mesh", "raster.frame"][which], 0);
                    }
                    bench.configure();
                    let ask = Events {
                        ask: mine,
                        ..Events::default()
                    };
                    bench.clock(ask);
                    bench.wait(after);
                    let was_active = bench.is_active(which);
                    // The flags of a refused pass are ignored.
                    let flags = bench.passes[which].flags.clone();
                    let mut others = flags.clone();
                    others.invert();
                    bench.set_flags(which, if was_active { &others } else { &flags });
                    bench.clock(ask);
                    bench.set_flags(which, &flags);
                    bench.finish();
                    let own = if wrong { ADDRESS } else { end };
                    let expected = if was_active && own == NONE { BUSY } else { own };
                    assert_eq!(
                        bench.errors[which], expected,
                        "{} after {after}",
                        NAMES[which]
                    );
                }
            }
        }
    }
}

/// Cancelled at any time, with one pass or both, and asked for again while the engine is not ready and later.
#[test]
fn what_is_asked_after_a_cancel_waits_for_the_engine() {
    let mut bench = Bench::new(6);
    bench.runs = [12, 14];
    bench.configure();
    for asks in [[true, false], [false, true], [true, true]] {
        for after in 0..45 {
            for recovers in [0, 1, 2, 40] {
                for again in [0, 1, 20, 60] {
                    bench.clock(Events {
                        ask: asks,
                        ..Events::default()
                    });
                    bench.wait(after);
                    let active = [GEOMETRY, RASTER].map(|which| bench.is_active(which));
                    let events = Events {
                        cancel: true,
                        recovers,
                        ..Events::default()
                    };
                    bench.clock(events);
                    for which in [GEOMETRY, RASTER] {
                        assert!(!active[which] || bench.errors[which] == CANCELLED);
                    }
                    bench.wait(again);
                    let starts = bench.counts.map(|counts| counts[1]);
                    assert_eq!(bench.ask([true, true]), [NONE; 2]);
                    assert_eq!(
                        bench.counts.map(|counts| counts[1]),
                        starts.map(|count| count + 1)
                    );
                }
            }
        }
    }
}

/// Anything at any time.
#[test]
fn random_sequences() {
    let mut random = Pcg64Mcg::new(7);
    for seed in 0..10 {
        let mut bench = Bench::new(seed);
        bench.configure();
        for _ in 0..20_000 {
            let mut events = Events::default();
            let rate = [0.01, 0.05, 0.3][seed as usize % 3];
            for which in [GEOMETRY, RASTER] {
                events.ask[which] = random.random_bool(rate);
                if events.ask[which] && !bench.is_active(which) {
                    bench.passes[which] = some_pass(&mut random, which);
                    bench.runs[which] = random.random_range(1..40);
                    bench.ends[which] = if random.random() {
                        NONE
                    } else {
                        [[MESH, FULL], [LIST, LIST]][which][random.random_range(0..2)]
                    };
                }
            }
            if !bench.is_active(GEOMETRY) && !bench.is_active(RASTER) {
                bench.list_shift = random.random_range(0..20);
            }
            bench.configure();
            events.cancel = random.random_bool(rate / 4.0);
            events.recovers = random.random_range(0..60);
            bench.clock(events);
        }
        bench.finish();
        println!("{:?} asks, starts and ends", bench.counts);
        assert!(bench.counts.iter().flatten().all(|&count| count > 20));
    }
}

/// A pass that is good, or of which something is wrong.
fn some_pass(random: &mut Pcg64Mcg, which: usize) -> Pass {
    let mut pass = Pass::good()[which].clone();
    pass.flags.size = random.random_range(0..4);
    for (_, set) in &mut pass.flags.others {
        *set = random.random();
    }
    if pass.flags.size == 3 && random.random_bool(0.9) {
        pass.flags.size = 2;
    }
    if random.random_bool(0.5) {
        let (name, value) = pass.ports[random.random_range(0..pass.ports.len())];
        let value = match random.random_range(0..4) {
            0 => value ^ 8,
            1 => value ^ (1 << random.random_range(4..20)),
            2 => value & 0xf_fff0,
            _ => value,
        };
        let small = name.contains("count") || name.ends_with("limit");
        pass.set(name, if small { value & 0xf_ffff } else { value });
    }
    pass
}
