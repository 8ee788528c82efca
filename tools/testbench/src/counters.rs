//! Counters that a module reports as events: one packed struct with the growth of each counter in a clock.

use crate::{Bits, Module, Port};

/// Sums of the members of a port, by their names.
pub struct Counters {
    events: Port,
    /// Name and part of each member, and its sum.
    counts: Vec<(String, Port, u64)>,
}

impl Counters {
    /// Counters of the struct on the port `name`, from 0 on.
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

    /// Counts a clock, between [`Module::settle`] and [`Module::clock`].
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
