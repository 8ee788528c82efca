//! The SoC's controller and its identity block.

use litex_pac::register::Value;
use litex_pac::{BUILD_ID, constants, ctrl, identity, memories};

use crate::{Device, MainMemory};

/// Content of `scratch` after a reset.
const SCRATCH: u32 = 0x1234_5678;

/// The SoC's controller: reset, scratch register, counter of bus errors.
pub struct Controller {
    scratch: u32,
    bus_errors: u32,
    /// Whether the CPU has requested a reset of the SoC.
    pub reset: bool,
    /// Whether the CPU is held in reset.
    pub holds_cpu: bool,
}

impl Controller {
    /// The controller after a reset.
    pub fn new() -> Self {
        Self {
            scratch: SCRATCH,
            bus_errors: 0,
            reset: false,
            holds_cpu: false,
        }
    }

    /// Counts `accesses` to unused addresses.
    pub fn count_bus_errors(&mut self, accesses: u32) {
        self.bus_errors = self.bus_errors.saturating_add(accesses);
    }
}

impl Device for Controller {
    fn read(&mut self, offset: u32, _now: u64) -> u32 {
        match offset {
            ctrl::offset::SCRATCH => self.scratch,
            ctrl::offset::BUS_ERRORS => self.bus_errors,
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, _now: u64, _ram: &mut MainMemory) {
        match offset {
            ctrl::offset::RESET => {
                let reset = ctrl::Reset::from_bits(value);
                self.reset |= reset.soc_rst();
                // `soc_rst` is a pulse. `cpu_rst` is a level: it holds the CPU in reset, so the CPU cannot clear it.
                self.holds_cpu = reset.cpu_rst();
            }
            ctrl::offset::SCRATCH => self.scratch = value,
            _ => {}
        }
    }
}

/// Identity of the emulated gateware.
pub struct Identity {
    /// The optional blocks, as bits of the register `blocks`.
    pub blocks: u32,
}

impl Device for Identity {
    fn read(&mut self, offset: u32, _now: u64) -> u32 {
        match offset {
            identity::offset::BUILD_ID => BUILD_ID,
            identity::offset::BLOCKS => self.blocks,
            identity::offset::CLOCK => constants::CONFIG_CLOCK_FREQUENCY,
            identity::offset::MAIN_RAM => memories::MAIN_RAM.size,
            _ => 0,
        }
    }

    fn write(&mut self, _offset: u32, _value: u32, _now: u64, _ram: &mut MainMemory) {}
}
