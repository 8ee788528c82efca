//! Implements the traits of the RISC-V crates for the interrupt lines.

use riscv_types::result::{Error, Result};
use riscv_types::{ExternalInterruptNumber, InterruptNumber};

use crate::Interrupt;

impl Interrupt {
    /// Bit of the line in the CPU's mask and pending registers.
    #[must_use]
    pub const fn bit(self) -> u32 {
        1 << self as u8
    }
}

// SAFETY: the variants are the interrupt lines of the SoC, each with its own number; `ALL` is sorted by number.
unsafe impl InterruptNumber for Interrupt {
    const MAX_INTERRUPT_NUMBER: usize = Self::ALL[Self::ALL.len() - 1] as usize;

    fn number(self) -> usize {
        self as usize
    }

    fn from_number(number: usize) -> Result<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|interrupt| interrupt.number() == number)
            .ok_or(Error::InvalidVariant(number))
    }
}

// SAFETY: VexRiscv has one core interrupt for all lines; the mask and pending registers distinguish the lines.
unsafe impl ExternalInterruptNumber for Interrupt {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_interrupts_match() {
        for number in 0..32 {
            match Interrupt::from_number(number) {
                Ok(interrupt) => {
                    assert_eq!(interrupt.number(), number);
                    assert_eq!(interrupt.bit(), 1 << number);
                    assert!(number <= Interrupt::MAX_INTERRUPT_NUMBER);
                }
                Err(error) => assert_eq!(error, Error::InvalidVariant(number)),
            }
        }
        let last = Interrupt::from_number(Interrupt::MAX_INTERRUPT_NUMBER);
        assert_eq!(last.ok(), Interrupt::ALL.last().copied());
    }
}
