//! A device on the two wires SCL and SDA of an I2C bus, or of its subset SCCB: [`Wires`] simulates the bus edge by edge, and a [`Device`]
//! holds the registers.

#![forbid(unsafe_code)]

/// Minimum times between edges on SCL and SDA that a master must keep in fast mode (400 kHz), in ns.
const LOW: u64 = 1_300;
const HIGH: u64 = 600;
const START_SETUP: u64 = 600;
const START_HOLD: u64 = 600;
const DATA_SETUP: u64 = 100;
const STOP_SETUP: u64 = 600;
const FREE: u64 = 1_300;

/// The registers of a device, and its behaviour on the bus.
pub trait Device {
    /// A fault of the device, for tests.
    type Fault;

    /// Number of bytes of a register number, 1 or 2; the high byte comes first. With 1 byte, the device ignores the high byte.
    fn number_bytes(&self) -> u8;
    /// Sets the current fault.
    fn set_fault(&mut self, fault: Option<Self::Fault>);
    /// Advances the time to `now`, in ns. A `now` before the current time has no effect.
    fn advance(&mut self, _now: u64) {}
    /// Notifies the device of the start or end of a transfer.
    fn set_addressed(&mut self, _is_addressed: bool) {}
    /// Whether the device acknowledges `address`.
    fn answers(&self, address: u8) -> bool;
    /// Whether the device acknowledges the bytes after its address.
    fn acknowledges(&self) -> bool;
    /// Time in ns for which the device stretches the clock after each acknowledged byte from the master.
    fn stretch(&self) -> Option<u64> {
        None
    }
    /// Whether the device still holds SDA low after `clocks` clocks of the master since the fault
    /// was set.
    fn is_stuck(&self, clocks: u32) -> bool;
    /// Reads a register.
    fn read(&mut self, register: u16) -> u8;
    /// Writes a register.
    fn write(&mut self, register: u16, value: u8);
}

/// State of the transfer between the master and the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// The device is not addressed and waits for the next start.
    Idle,
    /// The device receives a byte from the master: the bits so far, their number, and the meaning of the byte.
    In { bits: u8, count: u8, what: Byte },
    /// The device sends a byte to the master: the byte, and the number of its bits sent so far.
    Out { byte: u8, count: u8 },
}

/// Meaning of a byte from the master.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Byte {
    Address,
    /// A byte of a register number, with the number of bytes that follow.
    Register(u8),
    Value,
}

/// Times of the last edges on the wires, in ns.
#[derive(Clone, Copy, Debug, Default)]
struct Edges {
    scl_rose: u64,
    scl_fell: u64,
    sda: u64,
    start: u64,
    stop: u64,
}

/// A device, driven by the levels of SCL and SDA.
pub struct Wires<D> {
    /// The registers of the device.
    pub chip: D,
    /// Log of the traffic; `None` if no log is kept. S is a start, P a stop. A byte is followed by + if it was acknowledged, and
    /// by - if not.
    pub log: Option<Vec<String>>,
    /// Violations of the minimum times by the master, as messages.
    pub violations: Vec<String>,
    phase: Phase,
    register: u16,
    /// Last levels of SCL and SDA; `true` is high.
    wires: (bool, bool),
    /// Whether the device pulls SDA low.
    pulls: bool,
    /// Time until which the device stretches the clock, in ns.
    holds: u64,
    /// Number of clocks since the last call of `set_fault`. A device that holds SDA low releases it after enough clocks.
    clocks: u32,
    edges: Edges,
}

impl<D: Device> Wires<D> {
    /// Connects a device to a free bus.
    #[must_use]
    pub fn new(chip: D) -> Self {
        Self {
            chip,
            log: None,
            violations: Vec::new(),
            phase: Phase::Idle,
            register: 0,
            wires: (true, true),
            pulls: false,
            holds: 0,
            clocks: 0,
            edges: Edges::default(),
        }
    }

    /// Sets the master's outputs for SCL and SDA at the time `now` in ns (`true` releases, `false` pulls low), and
    /// returns the resulting levels of the wires. Call this at each change of the outputs, and every few µs.
    pub fn update(&mut self, now: u64, scl: bool, sda: bool) -> (bool, bool) {
        self.chip.advance(now);
        let mut wires = self.wires(now, scl, sda);
        // The device can change SDA in response to an edge, so the loop repeats until the levels are stable.
        while wires != self.wires {
            let (before, after) = (std::mem::replace(&mut self.wires, wires), wires);
            self.on_edge(now, before, after);
            wires = self.wires(now, scl, sda);
        }
        wires
    }

    fn wires(&self, now: u64, scl: bool, sda: bool) -> (bool, bool) {
        (
            scl && now >= self.holds,
            sda && !self.pulls && !self.chip.is_stuck(self.clocks),
        )
    }

    fn record(&mut self, what: impl Into<String>) {
        if let Some(log) = &mut self.log {
            log.push(what.into());
        }
    }

    /// Records a violation of the minimum time `what` if the time from `since` to `now` is below `least`, in ns.
    fn check(&mut self, now: u64, since: u64, least: u64, what: &str) {
        if since != 0 && now - since < least {
            let time = now - since;
            self.violations.push(format!(
                "{what} of {time} ns at {now} ns: expected at least {least} ns"
            ));
        }
    }

    fn on_edge(&mut self, now: u64, before: (bool, bool), after: (bool, bool)) {
        let edges = self.edges;
        match (before, after) {
            ((true, true), (true, false)) => {
                self.check(now, edges.scl_rose, START_SETUP, "start set-up");
                self.check(now, edges.stop, FREE, "free bus");
                self.edges.start = now;
                self.record("S");
                self.begin(Byte::Address);
                self.pulls = false;
                self.chip.set_addressed(true);
            }
            ((true, false), (true, true)) => {
                self.check(now, edges.scl_rose, STOP_SETUP, "stop set-up");
                self.edges.stop = now;
                self.record("P");
                self.phase = Phase::Idle;
                self.chip.set_addressed(false);
            }
            ((false, _), (true, sda)) => {
                self.check(now, edges.scl_fell, LOW, "low SCL");
                self.check(now, edges.sda, DATA_SETUP, "data set-up");
                self.edges.scl_rose = now;
                self.rise(sda);
            }
            ((true, _), (false, _)) => {
                self.check(now, edges.scl_rose, HIGH, "high SCL");
                self.check(now, edges.start, START_HOLD, "start hold");
                self.edges.scl_fell = now;
                self.clocks = self.clocks.saturating_add(1);
                self.fall(now);
            }
            _ => {}
        }
        if before.1 != after.1 {
            self.edges.sda = now;
        }
    }

    fn begin(&mut self, what: Byte) {
        self.phase = Phase::In {
            bits: 0,
            count: 0,
            what,
        };
    }

    fn rise(&mut self, sda: bool) {
        match &mut self.phase {
            Phase::Idle => {}
            Phase::In { bits, count, .. } => {
                if *count < 8 {
                    *bits = *bits << 1 | u8::from(sda);
                }
                *count += 1;
            }
            Phase::Out { byte, count } => {
                *count += 1;
                if *count == 9 {
                    let byte = *byte;
                    self.record(format!("{byte:02x}{}", if sda { '-' } else { '+' }));
                    self.phase = if sda { Phase::Idle } else { self.next_out() };
                }
            }
        }
    }

    /// Reads the next register of the device, and starts to send its value to the master.
    fn next_out(&mut self) -> Phase {
        let byte = self.chip.read(self.register);
        self.register = self.register.wrapping_add(1);
        Phase::Out { byte, count: 0 }
    }

    fn fall(&mut self, now: u64) {
        self.pulls = false;
        match self.phase {
            Phase::In {
                bits,
                count: 8,
                what,
            } => {
                self.pulls = match what {
                    Byte::Address => self.chip.answers(bits >> 1),
                    _ => self.chip.acknowledges(),
                };
                let mark = if self.pulls { '+' } else { '-' };
                self.record(format!("{bits:02x}{mark}"));
                if !self.pulls {
                    self.phase = Phase::Idle;
                } else if let Some(time) = self.chip.stretch() {
                    self.holds = now.saturating_add(time);
                }
            }
            Phase::In {
                bits,
                count: 9,
                what,
            } => match what {
                Byte::Address if bits & 1 != 0 => {
                    self.phase = self.next_out();
                    self.fall(now);
                }
                Byte::Address => self.begin(Byte::Register(self.chip.number_bytes() - 1)),
                Byte::Register(following) => {
                    self.register = self.register << 8 | u16::from(bits);
                    self.begin(match following {
                        0 => Byte::Value,
                        following => Byte::Register(following - 1),
                    });
                }
                Byte::Value => {
                    self.chip.write(self.register, bits);
                    self.register = self.register.wrapping_add(1);
                    self.begin(Byte::Value);
                }
            },
            Phase::Out { byte, count } if count < 8 => self.pulls = byte << count & 0x80 == 0,
            _ => {}
        }
    }

    /// Sets the device's fault.
    pub fn set_fault(&mut self, fault: Option<D::Fault>) {
        self.chip.set_fault(fault);
        self.clocks = 0;
        self.holds = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that only holds SDA low until the master has sent a clock.
    struct Stuck;

    impl Device for Stuck {
        type Fault = ();

        fn number_bytes(&self) -> u8 {
            1
        }

        fn set_fault(&mut self, _fault: Option<()>) {}

        fn answers(&self, _address: u8) -> bool {
            false
        }

        fn acknowledges(&self) -> bool {
            false
        }

        fn is_stuck(&self, clocks: u32) -> bool {
            clocks == 0
        }

        fn read(&mut self, _register: u16) -> u8 {
            0
        }

        fn write(&mut self, _register: u16, _value: u8) {}
    }

    /// At 1,000 samples per second, the master sends 2^32 clocks in 8.3 hours, so the count must
    /// saturate.
    #[test]
    fn the_number_of_clocks_stays_at_its_largest() {
        let mut wires = Wires::new(Stuck);
        wires.clocks = u32::MAX - 1;
        for (number, scl) in [false, true, false, true, false, true]
            .into_iter()
            .enumerate()
        {
            let now = 2_000 * (number as u64 + 1);
            assert_eq!(wires.update(now, scl, true), (scl, true));
        }
        assert_eq!(wires.clocks, u32::MAX);
        wires.set_fault(None);
        assert_eq!(wires.update(20_000, true, true), (true, false));
    }
}
