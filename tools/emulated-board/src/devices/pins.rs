//! Buttons, switches, LEDs, and the seven-segment displays.

use litex_pac::buttons::offset;

use crate::{Device, Events, MainMemory};

/// Pins that the CPU reads. Each button has an event. The switches have no events, so `in` is their last register.
pub struct Inputs {
    levels: u32,
    mask: u32,
    has_events: bool,
    mode: u32,
    edge: u32,
    events: Events,
}

impl Inputs {
    /// `bits` pins, which are low.
    pub fn new(bits: u32, has_events: bool) -> Self {
        Self {
            levels: 0,
            mask: (1 << bits) - 1,
            has_events,
            mode: 0,
            edge: 0,
            events: Events::default(),
        }
    }

    /// Resets the registers; the pins keep their levels.
    pub fn reset(&mut self) {
        let levels = self.levels;
        *self = Self {
            mask: self.mask,
            ..Self::new(0, self.has_events)
        };
        self.set(levels);
    }

    /// Sets the levels of the pins.
    pub fn set(&mut self, levels: u32) {
        let changed = (self.levels ^ levels) & self.mask;
        self.levels = levels & self.mask;
        // In the mode `change`, an edge sets the event's level high for one cycle.
        self.events.raise(changed & self.mode);
        self.update();
    }

    fn update(&mut self) {
        let levels = (self.levels ^ self.edge) & !self.mode & self.mask;
        self.events.set_level(levels, true);
        self.events.set_level(!levels, false);
    }
}

impl Device for Inputs {
    fn read(&mut self, offset: u32, _now: u64) -> u32 {
        match offset {
            offset::IN => self.levels,
            _ if !self.has_events => 0,
            offset::MODE => self.mode,
            offset::EDGE => self.edge,
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, _now: u64, _ram: &mut MainMemory) {
        if !self.has_events {
            return;
        }
        match offset {
            offset::MODE => self.mode = value & self.mask,
            offset::EDGE => self.edge = value & self.mask,
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & self.mask),
            _ => {}
        }
        self.update();
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}

/// Pins that the CPU writes.
#[derive(Default)]
pub struct Outputs {
    /// Levels of the 16 pins.
    pub levels: u16,
}

impl Device for Outputs {
    fn read(&mut self, offset: u32, _now: u64) -> u32 {
        match offset {
            litex_pac::leds::offset::OUT => self.levels.into(),
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, _now: u64, _ram: &mut MainMemory) {
        if offset == litex_pac::leds::offset::OUT {
            self.levels = value as u16;
        }
    }
}

/// Two displays of four digits. A reset does not change the displayed segments.
#[derive(Default)]
pub struct Digits {
    /// Segments of each digit, in the order of the registers: from left to right.
    pub segments: [u8; 8],
}

impl Device for Digits {
    fn read(&mut self, _offset: u32, _now: u64) -> u32 {
        0
    }

    fn write(&mut self, offset: u32, value: u32, _now: u64, _ram: &mut MainMemory) {
        let (left, right) = self.segments.split_at_mut(4);
        match offset {
            litex_pac::digits::offset::LEFT => left.copy_from_slice(&value.to_le_bytes()),
            litex_pac::digits::offset::RIGHT => right.copy_from_slice(&value.to_le_bytes()),
            _ => {}
        }
    }
}
