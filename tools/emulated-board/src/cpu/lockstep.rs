//! Execution instruction by instruction: follows another CPU, and compares the results.

use super::Cpu;
use crate::bus::{self, Bus};
use crate::csr;
use crate::decode::{Instruction, Operation};

/// An instruction that another CPU executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Executed {
    /// Clock cycle in which the instruction ended.
    pub cycle: u64,
    /// Address of the instruction.
    pub pc: u32,
    /// Number of the register that the instruction wrote, 0 for none.
    pub register: u32,
    /// Value that the instruction wrote to the register.
    pub value: u32,
}

/// A difference between two CPUs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Difference {
    /// The instructions are at different addresses.
    #[error("expected the instruction at {expected:#010x}, found the instruction at {found:#010x}")]
    Address {
        /// Address on the other CPU.
        expected: u32,
        /// Address on this CPU.
        found: u32,
    },
    /// The instructions write different values.
    #[error(
        "{pc:#010x} {word:#010x}: expected {expected:#010x} in x{register}, found {found:#010x}"
    )]
    Value {
        /// Address of the instruction.
        pc: u32,
        /// The instruction word.
        word: u32,
        /// Number of the register.
        register: u32,
        /// Value on the other CPU.
        expected: u32,
        /// Value on this CPU.
        found: u32,
    },
}

impl Cpu {
    /// Executes the next instruction, and compares its address and result with the instruction `other` of another CPU. `now` is
    /// the devices' time.
    ///
    /// Takes an interrupt where the other CPU took one. Results that depend on time are copied from the other CPU: loads from
    /// registers of devices, and reads of counters and of pending interrupts.
    pub fn follow(&mut self, bus: &mut Bus, now: u64, other: Executed) -> Result<(), Difference> {
        if self.pc != other.pc {
            self.csrs.lines = u32::MAX;
            self.pc = self.csrs.interrupt(self.pc).unwrap_or(self.pc);
        }
        if self.pc != other.pc {
            return Err(Difference::Address {
                expected: other.pc,
                found: self.pc,
            });
        }
        let word = bus.memory_word(self.pc).unwrap_or_default();
        let depends_on_time = self.depends_on_time(Instruction::decode(word));
        self.asleep = false;
        self.run(bus, now, now + super::CYCLES, 0);
        if other.register == 0 {
            return Ok(());
        }
        let register = &mut self.x[other.register as usize & 31];
        if depends_on_time {
            *register = other.value;
        }
        if *register == other.value {
            return Ok(());
        }
        Err(Difference::Value {
            pc: other.pc,
            word,
            register: other.register,
            expected: other.value,
            found: *register,
        })
    }

    fn depends_on_time(&self, instruction: Instruction) -> bool {
        use Operation::*;
        let Instruction {
            operation,
            rs1,
            immediate,
            ..
        } = instruction;
        match operation {
            Lb | Lh | Lw | Lbu | Lhu => {
                bus::is_register(self.x[usize::from(rs1 & 31)].wrapping_add(immediate))
            }
            Csr => csr::depends_on_time(immediate >> 20),
            _ => false,
        }
    }
}
