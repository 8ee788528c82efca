//! Registers and instructions of the CPU (VexRiscv), which are not part of the SoC's description. Features replace what some
//! [variants](crate::variant) lack.

use core::arch::asm;
use core::sync::atomic::{Ordering, compiler_fence};

use crate::register::{ReadOnly, WideRegister};
use crate::timer0::Timer0;

/// The mask of enabled interrupt lines, with one [`Interrupt::bit`](crate::Interrupt::bit) per line: the CPU's CSR 0xBC0.
#[inline]
#[must_use]
pub fn interrupt_mask() -> u32 {
    let mask;
    // SAFETY: reads a register that VexRiscv has and that has no side effect.
    unsafe { asm!("csrr {}, 0xbc0", out(reg) mask, options(nomem, nostack)) };
    mask
}

/// Enables the interrupt lines in `mask` and disables all others.
///
/// # Safety
/// No critical section may rely on the old mask, and the handlers of the enabled lines must be ready.
#[inline]
pub unsafe fn set_interrupt_mask(mask: u32) {
    // SAFETY: writes a register that VexRiscv has; the caller guarantees handlers for the enabled lines.
    unsafe { asm!("csrw 0xbc0, {}", in(reg) mask, options(nostack)) };
}

/// The interrupt lines that are active and not masked: the CPU's CSR 0xFC0.
#[inline]
#[must_use]
pub fn interrupts_pending() -> u32 {
    let pending;
    // SAFETY: reads a register that VexRiscv has and that has no side effect.
    unsafe { asm!("csrr {}, 0xfc0", out(reg) pending, options(nomem, nostack)) };
    pending
}

/// The implementation of the CPU, its register `mimpid`: [`EMULATED`](crate::EMULATED) on the emulated board; 0 with the feature
/// `uptime`.
#[must_use]
pub fn implementation() -> u32 {
    if cfg!(feature = "uptime") {
        return 0;
    }
    let implementation;
    // SAFETY: reads a register that a CPU with a cycle counter has and that has no side effect.
    unsafe { asm!("csrr {}, mimpid", out(reg) implementation, options(nomem, nostack)) };
    implementation
}

/// Invalidates the data cache, so that reads see memory written by other bus masters. The cache writes through, so memory already holds all
/// data written by the CPU. Does nothing with the feature `uncached`.
#[inline]
pub fn flush_data_cache() {
    compiler_fence(Ordering::SeqCst);
    #[cfg(not(feature = "uncached"))]
    // SAFETY: the VexRiscv instruction to flush the data cache changes no memory.
    unsafe {
        asm!(".word 0x500f", options(nostack));
    }
    compiler_fence(Ordering::SeqCst);
}

/// Invalidates the instruction cache, so that the CPU fetches code that was written as data.
#[inline]
pub fn flush_instruction_cache() {
    // SAFETY: these are `fence.i` and as many `nop`s as the pipeline may have fetched before it; they change no memory.
    unsafe {
        asm!(
            ".word 0x100f",
            "nop",
            "nop",
            "nop",
            "nop",
            "nop",
            options(nostack)
        )
    };
}

/// Clock cycles since reset, modulo 2^64.
#[inline]
#[must_use]
pub fn cycles() -> u64 {
    if cfg!(feature = "uptime") {
        return uptime().read();
    }
    loop {
        let (high, low, again): (u32, u32, u32);
        // SAFETY: reads counters of the CPU, which exist without the feature `uptime`; no side effects.
        unsafe {
            asm!(
                "csrr {high}, mcycleh",
                "csrr {low}, mcycle",
                "csrr {again}, mcycleh",
                high = out(reg) high,
                low = out(reg) low,
                again = out(reg) again,
                options(nomem, nostack)
            );
        }
        if high == again {
            return u64::from(high) << 32 | u64::from(low);
        }
    }
}

/// The low word of [`cycles`], which is faster to read and suffices for intervals below 2^32 cycles (52 s at 81.25 MHz).
#[inline]
#[must_use]
pub fn cycles_low() -> u32 {
    if cfg!(feature = "uptime") {
        return uptime().read_low();
    }
    let cycles;
    // SAFETY: reads a counter of the CPU, which exists without the feature `uptime`; no side effects.
    unsafe { asm!("csrr {}, mcycle", out(reg) cycles, options(nomem, nostack)) };
    cycles
}

/// The counter of `timer0`. If an interrupt latches the counter between the latch and the read, the value is the later one.
#[inline]
fn uptime() -> WideRegister<ReadOnly> {
    // SAFETY: all code that accesses these registers latches the counter and then reads it.
    let timer = unsafe { Timer0::steal() };
    timer.uptime_latch().write(true);
    timer.uptime_cycles()
}
