//! Supervision of a program: each vertical blanking checks for an endless loop and for a stack overflow. Both end the program with a
//! message, as a panic does.

use core::sync::atomic::{AtomicU32, Ordering};

use riscv::register::mepc;

use crate::panic;

/// Number of vertical blankings without a picture after which a program is in an endless loop: ten seconds.
const LONGEST: u32 = 600;
/// Maximum number of bytes of the stack that a program may use, or half of the memory that is free for the stack, if that is less. An
/// overflow is missed only if it occurs between two vertical blankings, or skips the check with large arrays that are never written.
const STACK: usize = 1 << 20;

/// Number of vertical blankings since the last picture, plus 1; 0 before supervision starts.
static BLANKINGS: AtomicU32 = AtomicU32::new(0);

unsafe extern "C" {
    static _stack_start: u8;
    static __ebss: u8;
}

/// Starts the supervision, or continues it for the next picture.
pub fn on_picture() {
    BLANKINGS.store(1, Ordering::Relaxed);
}

/// Checks the interrupted program. Call this in the interrupt of the vertical blanking.
pub fn on_blanking() {
    let blankings = BLANKINGS.load(Ordering::Relaxed);
    if blankings == 0 {
        return;
    }
    // Only interrupts and `on_picture` write this number, and an interrupt is not interrupted.
    BLANKINGS.store(blankings + 1, Ordering::Relaxed);
    let here = 0_u8;
    let top = (&raw const _stack_start).addr();
    let used = top - (&raw const here).addr();
    let most = ((top - (&raw const __ebss).addr()) / 2).min(STACK);
    if used > most {
        BLANKINGS.store(0, Ordering::Relaxed);
        panic::report(format_args!(
            "stack overflow: {} KB are in use, expected at most {} KB; an endless recursion? at {:#010x}",
            used >> 10,
            most >> 10,
            mepc::read()
        ));
    }
    if blankings > LONGEST {
        BLANKINGS.store(0, Ordering::Relaxed);
        panic::report(format_args!(
            "no picture for {} seconds: an endless loop? at {:#010x}",
            LONGEST / 60,
            mepc::read()
        ));
    }
}
