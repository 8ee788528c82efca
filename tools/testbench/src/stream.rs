//! The test bench's side of a module's streams: sources and sinks. A stream has the ports `valid`
//! and `ready`, and the ports of its payload.
//!
//! In each cycle, a test bench calls `drive` of all sources and sinks, [`Module::settle`], `sample`
//! of all sources and sinks, and [`Module::clock`]. [`step`] does this for a module whose ports are
//! all streams.

use std::collections::VecDeque;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::{Bits, Module, Port};

/// Runs one cycle of a module: [`exchange`], then the clock edge.
pub fn step(module: &mut Module, sources: &mut [&mut Source], sinks: &mut [&mut Sink]) {
    exchange(module, sources, sinks);
    module.clock();
}

/// Drives sources and sinks, settles the module's outputs, and samples sources and sinks. The
/// caller then advances the clock.
pub fn exchange(module: &mut Module, sources: &mut [&mut Source], sinks: &mut [&mut Sink]) {
    sources.iter_mut().for_each(|source| source.drive(module));
    sinks.iter_mut().for_each(|sink| sink.drive(module));
    module.settle();
    sources.iter_mut().for_each(|source| source.sample(module));
    sinks.iter_mut().for_each(|sink| sink.sample(module));
}

/// Random stalls of a source or a sink: runs of random length that make up a given share of the
/// cycles.
pub struct Stalls {
    random: Pcg64Mcg,
    share: f64,
    /// Number of cycles until the next random choice between stall and no stall.
    left: u32,
    stalled: bool,
}

impl Stalls {
    /// Largest number of cycles between two random choices.
    const RUN: u32 = 8;

    /// Creates stalls in a `share` of the cycles, from 0 (never) to 1 (always).
    #[must_use]
    pub fn new(seed: u64, share: f64) -> Self {
        Self {
            random: Pcg64Mcg::new(u128::from(seed) << 1 | 1),
            share,
            left: 0,
            stalled: false,
        }
    }

    /// Advances by one cycle; returns whether the cycle stalls.
    pub fn next_stalled(&mut self) -> bool {
        if self.left == 0 {
            self.left = self.random.random_range(1..=Self::RUN);
            self.stalled = self.random.random_bool(self.share);
        }
        self.left -= 1;
        self.stalled
    }
}

/// The ports of a stream.
struct Ports {
    name: String,
    valid: Port,
    ready: Port,
    payload: Vec<Port>,
}

impl Ports {
    fn new(module: &Module, name: &str, payload: &[&str]) -> Self {
        let port = |suffix: &str| module.port(&format!("{name}_{suffix}"));
        Self {
            name: name.to_owned(),
            valid: port("valid"),
            ready: port("ready"),
            payload: payload.iter().map(|suffix| port(suffix)).collect(),
        }
    }

    fn moves(&self, module: &Module) -> bool {
        module.is_high(self.valid) && module.is_high(self.ready)
    }
}

/// Sends items to a module. An item has one `Bits` for each port of the payload.
pub struct Source {
    ports: Ports,
    items: VecDeque<Vec<Bits>>,
    stalls: Stalls,
    /// Whether the first of `items` is on the ports, where it stays valid until it is taken.
    shown: bool,
}

impl Source {
    /// Creates the source of the input stream `name`: the ports `name_valid`, `name_ready`, and `name_…` for each of `payload`.
    #[must_use]
    pub fn new(module: &Module, name: &str, payload: &[&str], stalls: Stalls) -> Self {
        Self {
            ports: Ports::new(module, name, payload),
            items: VecDeque::new(),
            stalls,
            shown: false,
        }
    }

    /// Queues an item.
    pub fn push(&mut self, item: Vec<Bits>) {
        assert_eq!(item.len(), self.ports.payload.len(), "{}", self.ports.name);
        self.items.push_back(item);
    }

    /// Drops all items not yet taken, even a valid item on the ports, as a reset of the sender does.
    pub fn clear(&mut self) {
        self.items.clear();
        self.shown = false;
    }

    /// Number of items not yet taken.
    #[must_use]
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether all items have been taken.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Drives the next item, or zeros if the queue is empty or stalls.
    pub fn drive(&mut self, module: &mut Module) {
        let stalled = self.stalls.next_stalled();
        self.shown |= !stalled && !self.items.is_empty();
        module.set_value(self.ports.valid, u64::from(self.shown));
        for (i, &port) in self.ports.payload.iter().enumerate() {
            match self.items.front() {
                Some(item) if self.shown => module.set(port, item[i]),
                _ => module.set(port, 0),
            }
        }
    }

    /// Removes the first item from the queue if the module takes it in this cycle.
    pub fn sample(&mut self, module: &Module) {
        if self.ports.moves(module) {
            self.items.pop_front();
            self.shown = false;
        }
    }
}

/// Takes items from a module.
pub struct Sink {
    ports: Ports,
    items: Vec<Vec<Bits>>,
    stalls: Stalls,
    /// Payload that was valid but not taken in the last cycle, and must not change.
    waiting: Option<Vec<Bits>>,
}

impl Sink {
    /// Creates the sink of the output stream `name`: the ports `name_valid`, `name_ready`, and `name_…` for each of `payload`.
    #[must_use]
    pub fn new(module: &Module, name: &str, payload: &[&str], stalls: Stalls) -> Self {
        Self {
            ports: Ports::new(module, name, payload),
            items: Vec::new(),
            stalls,
            waiting: None,
        }
    }

    /// Items taken so far.
    #[must_use]
    pub fn items(&self) -> &[Vec<Bits>] {
        &self.items
    }

    /// Removes and returns the items taken so far.
    pub fn take(&mut self) -> Vec<Vec<Bits>> {
        std::mem::take(&mut self.items)
    }

    /// Replaces the stalls, and returns the previous stalls.
    pub fn set_stalls(&mut self, stalls: Stalls) -> Stalls {
        std::mem::replace(&mut self.stalls, stalls)
    }

    /// Drives `ready`: high, or low during a stall.
    pub fn drive(&mut self, module: &mut Module) {
        let ready = !self.stalls.next_stalled();
        module.set_value(self.ports.ready, u64::from(ready));
    }

    /// Takes the item on the ports if it is valid and the sink is ready in this cycle.
    ///
    /// # Panics
    /// When a valid payload changed or disappeared before it was taken.
    pub fn sample(&mut self, module: &Module) {
        let (name, cycle) = (&self.ports.name, module.cycles());
        let waiting = self.waiting.take();
        if !module.is_high(self.ports.valid) {
            assert!(
                waiting.is_none(),
                "{name}: payload withdrawn in cycle {cycle} before it was taken"
            );
            return;
        }
        let payload = self.ports.payload.iter();
        let found = payload.map(|&port| module.get(port)).collect();
        if let Some(waiting) = waiting {
            assert_eq!(
                found, waiting,
                "{name}: payload changed in cycle {cycle} before it was taken"
            );
        }
        if self.ports.moves(module) {
            self.items.push(found);
        } else {
            self.waiting = Some(found);
        }
    }
}

/// A module between a source and a sink.
pub struct Pipe {
    /// The module.
    pub module: Module,
    /// The source of its input stream.
    pub source: Source,
    /// The sink of its output stream.
    pub sink: Sink,
}

impl Pipe {
    /// Loads a module, given the names and payloads of its two streams. `shares` are the shares of stalls of source and sink.
    #[must_use]
    pub fn new(
        name: &str,
        seed: u32,
        (input, sent): (&str, &[&str]),
        (output, received): (&str, &[&str]),
        shares: [f64; 2],
    ) -> Self {
        let module = Module::new(name, seed);
        let [source, sink] =
            [1, 2].map(|i| Stalls::new(u64::from(seed) + i, shares[i as usize - 1]));
        Self {
            source: Source::new(&module, input, sent, source),
            sink: Sink::new(&module, output, received, sink),
            module,
        }
    }

    /// Runs until `done`, evaluated in each clock after the outputs settle and before the clock edge. Returns the number of clocks.
    ///
    /// # Panics
    /// When `done` is still false after `limit` clocks.
    pub fn run(&mut self, limit: u64, mut done: impl FnMut(&Self) -> bool) -> u64 {
        let start = self.module.cycles();
        loop {
            exchange(
                &mut self.module,
                &mut [&mut self.source],
                &mut [&mut self.sink],
            );
            let clocks = self.module.cycles() - start;
            if done(self) {
                return clocks;
            }
            assert!(clocks < limit, "not done after {clocks} clocks");
            self.module.clock();
        }
    }

    /// Runs until all items are sent and the output `idle` is high, and calls `each` in each clock. Returns the number of clocks.
    ///
    /// # Panics
    /// When the module is not idle after `limit` clocks.
    pub fn drain(&mut self, limit: u64, idle: Port, mut each: impl FnMut(&Self)) -> u64 {
        // An item sent in this clock affects `idle` only after the clock edge.
        let mut is_sent = self.source.is_empty();
        self.run(limit, |pipe| {
            each(pipe);
            let is_done = is_sent && pipe.module.is_high(idle);
            is_sent = pipe.source.is_empty();
            is_done
        })
    }
}
