//! The registers of the virtual image sensor.

use std::ops::BitXor;

use virtual_i2c_device::Device;

/// Duration after a reset in which the chip does not answer, in ns.
const RESET_TIME: u64 = 1_000_000;

/// Registers of the OV7670.
mod ov7670 {
    pub const COM3: u16 = 0x0c;
    pub const COM2: u16 = 0x09;
    pub const COM7: u16 = 0x12;
    pub const COM10: u16 = 0x15;
    pub const COM15: u16 = 0x40;
    /// Reset values that are not 0: identity, standby off, full range of the output.
    pub const RESET: [(u16, u8); 6] = [
        (0x0a, 0x76),
        (0x0b, 0x73),
        (0x1c, 0x7f),
        (0x1d, 0xa2),
        (COM2, 0x01),
        (COM15, 0xc0),
    ];
}

/// Registers of the OV5640.
mod ov5640 {
    pub const SYSTEM: u16 = 0x3008;
    pub const FORMAT: u16 = 0x4300;
    pub const POLARITY: u16 = 0x4740;
    pub const FORMAT_MUX: u16 = 0x501f;
    /// Reset values that are not 0: identity, running, raw output, polarity.
    pub const RESET: [(u16, u8); 5] = [
        (0x300a, 0x56),
        (0x300b, 0x40),
        (SYSTEM, 0x02),
        (FORMAT, 0xf8),
        (POLARITY, 0x20),
    ];
}

/// Kind of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// OV7670: registers of 8-bit numbers at the SCCB address 0x21, identity 0x7673.
    Ov7670,
    /// OV5640: registers of 16-bit numbers at the SCCB address 0x3c, identity 0x5640.
    Ov5640,
}

impl Model {
    /// The 7-bit SCCB address.
    #[must_use]
    pub const fn address(self) -> u8 {
        match self {
            Self::Ov7670 => 0x21,
            Self::Ov5640 => 0x3c,
        }
    }

    /// Registers that hold the high and the low byte of the identity.
    const fn identity(self) -> [u16; 2] {
        match self {
            Self::Ov7670 => [0x0a, 0x0b],
            Self::Ov5640 => [0x300a, 0x300b],
        }
    }

    const fn reset_values(self) -> &'static [(u16, u8)] {
        match self {
            Self::Ov7670 => &ov7670::RESET,
            Self::Ov5640 => &ov5640::RESET,
        }
    }
}

/// Format of the pixels on the port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Two bytes per pixel: red with the upper bits of green, then the rest of green with blue.
    Rgb565,
    /// Two bytes per pixel: luma, then a chroma sample, alternately Cb and Cr.
    Yuv422,
}

/// Active levels and edges of the port. The default is the state of an OV7670 after a reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Polarity {
    /// VSYNC is low between frames, not high.
    pub vsync_low: bool,
    /// HREF is low during a line, not high.
    pub href_low: bool,
    /// The second byte of a pixel comes first.
    pub swap: bool,
    /// The levels are stable at the falling edge of PCLK, not at the rising edge.
    pub falling: bool,
}

impl BitXor for Polarity {
    type Output = Self;

    /// Inverts each polarity that is set in `other`.
    fn bitxor(self, other: Self) -> Self {
        Self {
            vsync_low: self.vsync_low ^ other.vsync_low,
            href_low: self.href_low ^ other.href_low,
            swap: self.swap ^ other.swap,
            falling: self.falling ^ other.falling,
        }
    }
}

/// A fault of the chip on its SCCB wires, for tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChipFault {
    /// The chip does not answer, and the levels of its port do not change.
    Absent,
    /// The chip acknowledges its address, but no further byte.
    NoAcknowledge,
    /// The chip holds SDA low.
    StuckData,
    /// The identity reads as this value.
    Identity(u16),
    /// Writes do not change this register.
    Kept(u16),
}

/// Registers of a virtual image sensor, accessed by an SCCB master.
pub struct Chip {
    model: Model,
    registers: Vec<u8>,
    now: u64,
    /// Time from which the chip answers after a reset, in ns.
    answers: u64,
    /// Current fault.
    pub fault: Option<ChipFault>,
    /// Whether the chip has a master clock, and is neither in reset nor in power-down. Otherwise the chip does not answer.
    pub is_awake: bool,
    /// Number of writes to registers so far.
    pub writes: u64,
}

impl Chip {
    /// Creates a chip in the state after power-up.
    #[must_use]
    pub fn new(model: Model) -> Self {
        let mut chip = Self {
            model,
            registers: Vec::new(),
            now: 0,
            answers: 0,
            fault: None,
            is_awake: true,
            writes: 0,
        };
        chip.reset();
        chip.answers = 0;
        chip
    }

    /// Kind of the chip.
    #[must_use]
    pub fn model(&self) -> Model {
        self.model
    }

    /// Resets all registers.
    pub fn reset(&mut self) {
        self.registers.clear();
        self.registers.resize(1 << (8 * self.number_bytes()), 0);
        for &(register, value) in self.model.reset_values() {
            self.registers[usize::from(register)] = value;
        }
        self.answers = self.now + RESET_TIME;
    }

    /// The index of a register: an OV7670 ignores the high byte of the register number.
    fn place(&self, register: u16) -> u16 {
        match self.model {
            Model::Ov7670 => register & 0xff,
            Model::Ov5640 => register,
        }
    }

    /// The value of a register. A fault does not affect it.
    #[must_use]
    pub fn register(&self, register: u16) -> u8 {
        self.registers[usize::from(self.place(register))]
    }

    /// Format of the pixels, or `None` while the chip is not awake, or is in standby according to its registers.
    #[must_use]
    pub fn format(&self) -> Option<Format> {
        let (standby, is_rgb565) = match self.model {
            Model::Ov7670 => (
                self.register(ov7670::COM2) & 0x10 != 0,
                self.register(ov7670::COM7) & 0x05 == 0x04
                    && self.register(ov7670::COM15) & 0x30 == 0x10,
            ),
            Model::Ov5640 => (
                self.register(ov5640::SYSTEM) & 0x40 != 0,
                self.register(ov5640::FORMAT) >> 4 == 6
                    && self.register(ov5640::FORMAT_MUX) & 7 == 1,
            ),
        };
        let format = if is_rgb565 {
            Format::Rgb565
        } else {
            Format::Yuv422
        };
        (self.is_awake && !standby).then_some(format)
    }

    /// Levels and edges that the registers select.
    #[must_use]
    pub fn polarity(&self) -> Polarity {
        match self.model {
            Model::Ov7670 => {
                let sync = self.register(ov7670::COM10);
                Polarity {
                    vsync_low: sync & 0x02 != 0,
                    href_low: sync & 0x08 != 0,
                    swap: self.register(ov7670::COM3) & 0x40 != 0,
                    falling: sync & 0x10 != 0,
                }
            }
            Model::Ov5640 => {
                let sync = self.register(ov5640::POLARITY);
                Polarity {
                    vsync_low: sync & 0x01 == 0,
                    href_low: sync & 0x02 != 0,
                    // The low digit of the format is the byte order: 1 is the order of the OV7670.
                    swap: self.register(ov5640::FORMAT) & 0x0f != 1,
                    falling: sync & 0x20 == 0,
                }
            }
        }
    }

    /// Whether PCLK stops while HREF is not active.
    #[must_use]
    pub fn gates_clock(&self) -> bool {
        self.model == Model::Ov7670 && self.register(ov7670::COM10) & 0x20 != 0
    }
}

impl Device for Chip {
    type Fault = ChipFault;

    fn number_bytes(&self) -> u8 {
        match self.model {
            Model::Ov7670 => 1,
            Model::Ov5640 => 2,
        }
    }

    fn set_fault(&mut self, fault: Option<ChipFault>) {
        self.fault = fault;
    }

    fn advance(&mut self, now: u64) {
        self.now = self.now.max(now);
    }

    fn answers(&self, address: u8) -> bool {
        address == self.model.address()
            && self.fault != Some(ChipFault::Absent)
            && self.is_awake
            && self.now >= self.answers
    }

    fn acknowledges(&self) -> bool {
        self.fault != Some(ChipFault::NoAcknowledge)
    }

    fn is_stuck(&self, _: u32) -> bool {
        self.fault == Some(ChipFault::StuckData)
    }

    fn read(&mut self, register: u16) -> u8 {
        let [high, low] = self.model.identity();
        let register = self.place(register);
        match self.fault {
            Some(ChipFault::Identity(identity)) if register == high => (identity >> 8) as u8,
            Some(ChipFault::Identity(identity)) if register == low => identity as u8,
            _ => self.register(register),
        }
    }

    fn write(&mut self, register: u16, value: u8) {
        self.writes += 1;
        let register = self.place(register);
        let resets = match self.model {
            Model::Ov7670 => register == ov7670::COM7,
            Model::Ov5640 => register == ov5640::SYSTEM,
        };
        if resets && value & 0x80 != 0 {
            self.reset();
        } else if !self.model.identity().contains(&register)
            && self.fault != Some(ChipFault::Kept(register))
        {
            self.registers[usize::from(register)] = value;
        }
    }
}
