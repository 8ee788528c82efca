//! The event manager of a block, compatible with LiteX.

/// The registers `ev_status`, `ev_pending` and `ev_enable` of a block, with a bit for each event.
///
/// An event is a pulse ([`raise`](Self::raise)) or the rising edge of a level ([`set_level`](Self::set_level)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Events {
    level: u32,
    pending: u32,
    enabled: u32,
}

impl Events {
    /// The register `ev_status`: the levels of the events, 0 for an event that is a pulse.
    #[must_use]
    pub fn status(&self) -> u32 {
        self.level
    }

    /// The register `ev_pending`: the events that have occurred and have not been cleared.
    #[must_use]
    pub fn pending(&self) -> u32 {
        self.pending
    }

    /// The register `ev_enable`: the events that cause an interrupt.
    #[must_use]
    pub fn enabled(&self) -> u32 {
        self.enabled
    }

    /// Writes `ev_pending`: clears the events whose bits are set.
    pub fn clear(&mut self, bits: u32) {
        self.pending &= !bits;
    }

    /// Writes `ev_enable`.
    pub fn enable(&mut self, bits: u32) {
        self.enabled = bits;
    }

    /// Makes the events of `bits` pending.
    pub fn raise(&mut self, bits: u32) {
        self.pending |= bits;
    }

    /// Sets the levels of the events in `bits`; events whose level rises become pending.
    pub fn set_level(&mut self, bits: u32, level: bool) {
        let before = self.level;
        self.level = if level { before | bits } else { before & !bits };
        self.pending |= self.level & !before;
    }

    /// Whether an enabled event is pending.
    #[must_use]
    pub fn interrupt(&self) -> bool {
        self.pending & self.enabled != 0
    }
}

#[cfg(test)]
mod tests {
    use super::Events;

    #[test]
    fn a_level_is_pending_once_for_each_rise() {
        let mut events = Events::default();
        events.enable(1);
        events.set_level(0b11, true);
        assert!(events.interrupt());
        events.clear(0b01);
        events.set_level(0b01, true);
        assert_eq!((events.pending(), events.status()), (0b10, 0b11));
        assert!(!events.interrupt());
        events.set_level(0b01, false);
        events.set_level(0b01, true);
        assert_eq!(events.pending(), 0b11);
    }
}
