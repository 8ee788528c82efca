//! Counters of a module's events: one packed struct with each counter's increment per clock.

use crate::{Bits, Module, Port};

/// Sums of a port's members, by name.
pub struct Counters {
    events: Port,
    /// Name and part of each member, and its sum.
    counts: Vec<(String, Port, u64)>,
}

impl Counters {
    /// Counters of the struct on the port `name`, starting at 0.
    ///
    /// # Panics
    /// When there is no such port.
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

    /// Adds the increments of a clock; call between [`Module::settle`] and [`Module::clock`].
    pub fn sample(&mut self, module: &Module) {
        let events = module.get(self.events);
        if events == Bits::default() {
            return;
        }
        for (_, part, count) in &mut self.counts {
            *count += events.field(part.low, part.width);
        }
    }

    /// The count of a member.
    ///
    /// # Panics
    /// When there is no such member.
    #[must_use]
    pub fn get(&self, member: &str) -> u64 {
        let found = self.counts.iter().find(|(name, ..)| name == member);
        found.unwrap_or_else(|| panic!("no counter {member:?}")).2
    }
}
