//! Event counters of a module. The module's output port is a packed struct with the increments of the counters in the current clock.

use crate::{Bits, Module, Port};

/// The counters of a module: for each member of the port, the sum over all sampled clocks. Methods
/// panic when there is no port or member of the given name.
pub struct Counters {
    events: Port,
    /// For each member of the port: its name, its bits within the port, and its sum so far.
    counts: Vec<(String, Port, u64)>,
}

impl Counters {
    /// Creates the counters of the struct on the port `name`; they start at 0.
    #[must_use]
    pub fn new(module: &Module, name: &str) -> Self {
        let members = module.record(name).layout().member_names();
        let counts = members.into_iter().map(|member| {
            let port = module.port(&format!("{name}.{member}"));
            (member, port, 0)
        });
        Self {
            events: module.port(name),
            counts: counts.collect(),
        }
    }

    /// Adds the increments of the current clock; call this method between [`Module::settle`] and
    /// [`Module::clock`].
    pub fn sample(&mut self, module: &Module) {
        let events = module.get(self.events);
        if events == Bits::default() {
            return;
        }
        for (_, part, count) in &mut self.counts {
            *count += events.field(part.low, part.width);
        }
    }

    /// Returns the sum of a member over all sampled clocks.
    #[must_use]
    pub fn get(&self, member: &str) -> u64 {
        let found = self.counts.iter().find(|(name, ..)| name == member);
        found.unwrap_or_else(|| panic!("no counter {member:?}")).2
    }
}
