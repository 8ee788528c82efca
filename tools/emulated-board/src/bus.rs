//! The CPU's bus: memories and register windows.

use litex_pac::Memory;
use litex_pac::memories::{FLASH, ROM, SRAM};
use virtual_flash::Flash;

use crate::MainMemory;
use crate::devices::{Devices, REGISTERS};

/// Number of clock cycles after which the bus answers an access to an unused address.
const TIMEOUT: u64 = 1_000_000;

/// Number of words in a cache line of the CPU; a line fill makes one bus access per word.
const LINE: u32 = 8;

/// First address that bypasses the data cache.
const IO: u32 = 0x8000_0000;

/// Value that a load from an unused address returns.
const UNUSED: u32 = u32::MAX;

/// Result of an access outside main memory.
pub struct Access {
    /// The word that contains the address, for a load.
    pub value: u32,
    /// Number of cycles that the CPU waits, in addition to the cycles of the instruction.
    pub cycles: u64,
    /// Whether a device was accessed. Such an access may change interrupts and the time of the device's next event.
    pub device: bool,
}

impl Access {
    fn memory(value: u32) -> Self {
        Self {
            value,
            cycles: 0,
            device: false,
        }
    }
}

/// Memories and devices.
pub struct Bus {
    pub ram: MainMemory,
    pub devices: Devices,
    pub flash: Flash,
    rom: Vec<u8>,
    sram: Vec<u8>,
}

impl Bus {
    /// A bus with zeroed memories, an erased flash, and `devices`.
    pub fn new(devices: Devices) -> Self {
        Self {
            ram: MainMemory::new(),
            devices,
            flash: Flash::new(Vec::new()),
            rom: vec![0; ROM.size as usize],
            sram: vec![0; SRAM.size as usize],
        }
    }

    /// Replaces the content of the ROM by `image`; bytes beyond the ROM's size are ignored.
    pub fn set_rom(&mut self, image: &[u8]) {
        self.rom.fill(0);
        for (place, byte) in self.rom.iter_mut().zip(image) {
            *place = *byte;
        }
    }

    /// Writes bytes from `address` on. Returns whether all of them are in SRAM; otherwise none is written.
    pub fn write_sram(&mut self, address: u32, bytes: &[u8]) -> bool {
        let Target::Sram(offset) = place(address) else {
            return false;
        };
        let place = self.sram.get_mut(offset..offset + bytes.len());
        place.is_some_and(|place| {
            place.copy_from_slice(bytes);
            true
        })
    }

    /// The word at `address`, a multiple of 4, if it is in a memory.
    pub fn memory_word(&self, address: u32) -> Option<u32> {
        let bytes = match place(address) {
            Target::Rom(offset) => self.rom.get(offset..)?.first_chunk(),
            Target::Sram(offset) => self.sram.get(offset..)?.first_chunk(),
            Target::Flash(offset) => return Some(self.flash.word(offset)),
            Target::Register(_) | Target::Unused => return self.ram.word(address),
        };
        bytes.copied().map(u32::from_le_bytes)
    }

    /// Loads the word that contains `address`.
    pub fn load(&mut self, address: u32, now: u64) -> Access {
        let address = address & !3;
        if let Target::Register(offset) = place(address) {
            return Access {
                value: self.devices.read(offset, now, &mut self.ram),
                cycles: 0,
                device: true,
            };
        }
        match self.memory_word(address) {
            Some(word) => Access::memory(word),
            None => self.time_out(if address < IO { LINE } else { 1 }),
        }
    }

    /// Fetches the word at `address`, a multiple of 4 outside the memories, as an instruction. A fetch reads a whole cache line at any
    /// address.
    pub fn fetch(&mut self, address: u32, now: u64) -> Access {
        match place(address) {
            Target::Unused => self.time_out(LINE),
            Target::Rom(_) | Target::Sram(_) | Target::Flash(_) | Target::Register(_) => {
                self.load(address, now)
            }
        }
    }

    /// Stores the low `size` bytes of `value` at `address`, a multiple of `size`, outside main memory.
    pub fn store(&mut self, address: u32, value: u32, size: usize, now: u64) -> Access {
        match place(address) {
            // Writes to these memories have no effect.
            Target::Rom(_) | Target::Flash(_) => Access::memory(0),
            Target::Sram(offset) => {
                if let Some(bytes) = self.sram.get_mut(offset..offset + size) {
                    bytes.copy_from_slice(&value.to_le_bytes()[..size]);
                }
                Access::memory(0)
            }
            Target::Register(offset) => {
                // The CPU repeats a byte or a half word in all byte lanes, and a register stores all byte lanes.
                let value = match size {
                    1 => (value & 0xff) * 0x0101_0101,
                    2 => (value & 0xffff) * 0x0001_0001,
                    _ => value,
                };
                self.devices.write(offset & !3, value, now, &mut self.ram);
                Access {
                    value: 0,
                    cycles: 0,
                    device: true,
                }
            }
            Target::Unused => self.time_out(1),
        }
    }

    /// Result of `accesses` bus accesses to unused addresses.
    fn time_out(&mut self, accesses: u32) -> Access {
        self.devices.controller.count_bus_errors(accesses);
        Access {
            value: UNUSED,
            cycles: u64::from(accesses) * TIMEOUT,
            device: false,
        }
    }
}

/// Target of an address outside main memory, with the offset from the start of the target.
enum Target {
    Rom(usize),
    Sram(usize),
    Flash(usize),
    Register(u32),
    Unused,
}

/// Whether `address` is the address of a device register.
pub fn is_register(address: u32) -> bool {
    matches!(place(address), Target::Register(_))
}

fn place(address: u32) -> Target {
    let within = |memory: Memory| {
        let offset = address.wrapping_sub(memory.base);
        (offset < memory.size).then_some(offset)
    };
    if let Some(offset) = within(ROM) {
        Target::Rom(offset as usize)
    } else if let Some(offset) = within(SRAM) {
        Target::Sram(offset as usize)
    } else if let Some(offset) = within(FLASH) {
        Target::Flash(offset as usize)
    } else if let Some(offset) = within(REGISTERS) {
        Target::Register(offset)
    } else {
        Target::Unused
    }
}
