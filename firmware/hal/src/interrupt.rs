//! The CPU's interrupt lines, as values of the type `Interrupt`.
//!
//! VexRiscv has one external interrupt with up to 32 lines. Each line is the interrupt of a peripheral and stays active until its
//! handler clears the pending register of that peripheral.

use litex_pac::Interrupt;

/// Calls `handle` for each interrupt of `pending`, lowest number first. Returns the pending lines that have no [`Interrupt`].
///
/// Handlers match on [`Interrupt`], so the compiler reports an interrupt without a handler.
pub fn dispatch(pending: u32, mut handle: impl FnMut(Interrupt)) -> u32 {
    let mut unknown = pending;
    for interrupt in Interrupt::ALL {
        if pending & interrupt.bit() != 0 {
            unknown &= !interrupt.bit();
            handle(interrupt);
        }
    }
    unknown
}

/// Enables `interrupt`.
///
/// # Safety
/// The handler of the interrupt must be ready, and no critical section may rely on the line being disabled.
#[cfg(target_arch = "riscv32")]
pub unsafe fn enable(interrupt: Interrupt) {
    use litex_pac::cpu;
    critical_section::with(|_| {
        // SAFETY: the caller guarantees the handler; the critical section makes the change atomic.
        unsafe { cpu::set_interrupt_mask(cpu::interrupt_mask() | interrupt.bit()) }
    });
}

/// Disables the interrupt lines of the mask `lines`, in which each line has its [`Interrupt::bit`].
#[cfg(target_arch = "riscv32")]
pub fn disable(lines: u32) {
    use litex_pac::cpu;
    critical_section::with(|_| {
        // SAFETY: the change enables no line, and the critical section makes it atomic.
        unsafe { cpu::set_interrupt_mask(cpu::interrupt_mask() & !lines) }
    });
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    fn dispatched(pending: u32) -> (Vec<Interrupt>, u32) {
        let mut handled = Vec::new();
        let unknown = dispatch(pending, |interrupt| handled.push(interrupt));
        (handled, unknown)
    }

    #[test]
    fn every_pending_line_is_handled_once_and_in_order() {
        assert_eq!(dispatched(0), (Vec::new(), 0));
        let both = Interrupt::Scanout.bit() | Interrupt::Uart.bit();
        assert_eq!(
            dispatched(both),
            (Vec::from([Interrupt::Uart, Interrupt::Scanout]), 0)
        );
        assert_eq!(dispatched(u32::MAX).0, Interrupt::ALL);
    }

    #[test]
    fn lines_without_a_name_are_returned() {
        assert_eq!(
            dispatched(1 << 31 | Interrupt::Timer0.bit()),
            (Vec::from([Interrupt::Timer0]), 1 << 31)
        );
    }
}
