//! Measurement of a kernel's clock cycles.
//!
//! A kernel, the measured function, is called with [`INPUTS`] inputs spread over the kernel's range. The code and tables of the kernel are
//! in the caches, and interrupts are disabled. The overhead of the measuring code is measured in the same way, and subtracted.
//!
//! The instruction cache is direct-mapped, and a miss costs more than a kernel. If measuring code and kernel mapped to the same cache
//! lines, the misses would distort the result. The measuring code therefore exists at two addresses, and the copy with fewer misses is
//! used.

use core::arch::asm;
use core::hint::black_box;

use litex_pac::cpu;

/// Number of inputs with which each kernel is measured.
const INPUTS: usize = 256;

/// Number of inputs for the comparison of the two copies of the measuring code.
const TRIALS: usize = 16;

/// Clock cycles of one call of a kernel: statistics over all inputs.
#[derive(Clone, Copy)]
pub struct Cycles {
    /// Smallest number of cycles.
    pub min: u32,
    /// Median of the cycles.
    pub median: u32,
    /// Largest number of cycles.
    pub max: u32,
}

impl Cycles {
    /// Minimum, median and maximum of measurements, all 0 without measurements. Sorts the measurements in place.
    pub fn of(cycles: &mut [u32]) -> Self {
        cycles.sort_unstable();
        let at = |index: usize| cycles.get(index).copied().unwrap_or(0);
        Self {
            min: at(0),
            median: at(cycles.len() / 2),
            max: at(cycles.len().saturating_sub(1)),
        }
    }
}

/// Receiver of a kernel's name and cycles.
pub type Report<'a> = &'a mut dyn FnMut(&str, Cycles);

/// Measures `kernel` and reports its cycles under `name`. Each input is computed by `input` from a phase of 32 bits; the
/// phases are spread over the full circle.
pub fn measure<I: Copy, O>(
    report: Report,
    name: &str,
    input: impl Fn(u32) -> I,
    kernel: impl Fn(I) -> O,
) {
    // Multiples of 2^32 divided by the golden ratio fill the full circle evenly, in a pseudo-random order.
    let input = |index: usize| input((index as u32).wrapping_mul(0x9e37_79b9));
    let timers: [fn(&_, I) -> u32; 2] = [timed::<0, _, I, O>, timed::<1, _, I, O>];
    let noise = |timer: &fn(&_, I) -> u32| {
        let pass = || {
            (0..TRIALS)
                .map(|index| timer(&kernel, input(index)))
                .sum::<u32>()
        };
        // The first pass loads code and tables into the caches.
        pass().min(pass())
    };
    let quieter = if noise(&timers[0]) <= noise(&timers[1]) {
        timers[0]
    } else {
        timers[1]
    };
    let mut cycles: [u32; INPUTS] = core::array::from_fn(|index| quieter(&kernel, input(index)));
    let nothing = |input: I| input;
    let overhead = (0..TRIALS)
        .map(|index| timed::<0, _, I, I>(&nothing, input(index)))
        .min()
        .unwrap_or(0);
    cycles = cycles.map(|cycles| cycles.saturating_sub(overhead));
    report(name, Cycles::of(&mut cycles));
}

/// Clock cycles of one call of the kernel, including one read of the cycle counter. The two values of `PLACE`, 0 and 1, make two copies of
/// this code, half a cache apart.
#[inline(never)]
#[allow(unsafe_code)]
fn timed<const PLACE: usize, K: Fn(I) -> O, I, O>(kernel: &K, input: I) -> u32 {
    // SAFETY: the instruction jumps over unused bytes, and has no other effect.
    unsafe {
        asm!("j 1f", ".space {}", "1:", const PLACE * 2048 + 4, options(nomem, nostack, preserves_flags))
    };
    riscv::interrupt::free(|| {
        let start = cpu::cycles_low();
        black_box(kernel(black_box(input)));
        cpu::cycles_low().wrapping_sub(start)
    })
}
