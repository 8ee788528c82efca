//! Both ends of a stream: valid, ready, and a payload of some ports.
//!
//! In every cycle: `drive` all ends, [`Module::settle`], `sample` all ends, [`Module::clock`].

use std::collections::VecDeque;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::{Bits, Module, Port};

/// When an end of a stream does not take part: a share of the cycles, in runs of random length.
pub struct Stalls {
    random: Pcg64Mcg,
    share: f64,
    /// Cycles until it is decided anew.
    left: u32,
    stalled: bool,
}

impl Stalls {
    /// The longest run without a new decision.
    const RUN: u32 = 8;

    /// Stalls in a `share` of the cycles: 0 never, 1 always.
    #[must_use]
    pub fn new(seed: u64, share: f64) -> Self {
        Self {
            random: Pcg64Mcg::new(u128::from(seed) << 1 | 1),
            share,
            left: 0,
            stalled: false,
        }
    }

    /// Whether the next cycle is stalled.
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

/// Gives a module items, one `Bits` for each port of the payload.
pub struct Source {
    ports: Ports,
    items: VecDeque<Vec<Bits>>,
    stalls: Stalls,
    /// An item that has been shown stays until it is taken.
    shown: bool,
}

impl Source {
    /// The input stream `name`: ports `name_valid`, `name_ready` and `name_…` for each of `payload`.
    #[must_use]
    pub fn new(module: &Module, name: &str, payload: &[&str], stalls: Stalls) -> Self {
        Self {
            ports: Ports::new(module, name, payload),
            items: VecDeque::new(),
            stalls,
            shown: false,
        }
    }

    /// Adds an item to be given.
    pub fn push(&mut self, item: Vec<Bits>) {
        assert_eq!(item.len(), self.ports.payload.len(), "{}", self.ports.name);
        self.items.push_back(item);
    }

    /// Drops what has not been taken, even the item that is shown: its giver has been reset.
    pub fn clear(&mut self) {
        self.items.clear();
        self.shown = false;
    }

    /// Items that have not been taken.
    #[must_use]
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether all items have been taken.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Shows the next item, or zeros while there is none.
    pub fn drive(&mut self, module: &mut Module) {
        let stalled = self.stalls.next_stalled();
        self.shown |= !stalled && !self.items.is_empty();
        module.set(self.ports.valid, u64::from(self.shown));
        for (i, &port) in self.ports.payload.iter().enumerate() {
            match self.items.front() {
                Some(item) if self.shown => module.set(port, item[i]),
                _ => module.set(port, 0),
            }
        }
    }

    /// Sees whether the item is taken.
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
    /// What was valid and not taken: it must be there again.
    waiting: Option<Vec<Bits>>,
}

impl Sink {
    /// The output stream `name`: ports `name_valid`, `name_ready` and `name_…` for each of `payload`.
    #[must_use]
    pub fn new(module: &Module, name: &str, payload: &[&str], stalls: Stalls) -> Self {
        Self {
            ports: Ports::new(module, name, payload),
            items: Vec::new(),
            stalls,
            waiting: None,
        }
    }

    /// What was taken so far.
    #[must_use]
    pub fn items(&self) -> &[Vec<Bits>] {
        &self.items
    }

    /// Takes out what was taken so far.
    pub fn take(&mut self) -> Vec<Vec<Bits>> {
        std::mem::take(&mut self.items)
    }

    /// Stalls in another way from now on, and returns how it did.
    pub fn set_stalls(&mut self, stalls: Stalls) -> Stalls {
        std::mem::replace(&mut self.stalls, stalls)
    }

    /// Is ready, or stalls.
    pub fn drive(&mut self, module: &mut Module) {
        let ready = !self.stalls.next_stalled();
        module.set(self.ports.ready, u64::from(ready));
    }

    /// Takes an item that is there.
    ///
    /// # Panics
    /// When a payload has changed, or has gone, that was not taken.
    pub fn sample(&mut self, module: &Module) {
        let valid = module.is_high(self.ports.valid);
        let found: Vec<Bits> = self
            .ports
            .payload
            .iter()
            .map(|&port| module.get(port))
            .collect();
        if let Some(waiting) = &self.waiting {
            let (name, cycle) = (&self.ports.name, module.cycles());
            assert!(valid, "{name}: gone in cycle {cycle} without being taken");
            assert_eq!(&found, waiting, "{name}: changed in cycle {cycle}");
        }
        self.waiting = None;
        if self.ports.moves(module) {
            self.items.push(found);
        } else if valid {
            self.waiting = Some(found);
        }
    }
}
