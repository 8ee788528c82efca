//! Clock cycles of single kernels, measured on the soft core.
//!
//! Each kernel is called with [`INPUTS`] inputs spread over its range, its code and tables in the caches, with interrupts
//! kept out. What the measurement itself costs is measured the same way and taken off.
//!
//! The instruction cache is direct-mapped, and a miss costs more than a kernel. Where the measuring code happens to share
//! cache lines with the kernel, it would measure their fight; so it exists at several places, and the quietest counts.

use core::arch::asm;
use core::hint::black_box;

use glint_core::fixed::Turns;
use glint_core::trig::{sin_cos_q14, sin_cos_q30};
use litex_pac::cpu;

use crate::terminal::Terminal;

#[cfg(feature = "peers")]
mod peers;

/// What can be measured.
pub const KERNELS: [&str; 1] = ["sine"];

/// Inputs of each kernel.
const INPUTS: usize = 256;

/// There is no such kernel.
pub struct Unknown<'l>(pub &'l str);

/// Measures the kernels of a name, or all.
///
/// # Errors
/// When there is none of this name.
pub fn run<'l>(terminal: &mut Terminal, kernel: Option<&'l str>) -> Result<(), Unknown<'l>> {
    match kernel {
        None | Some("sine") => sine(terminal),
        Some(name) => return Err(Unknown(name)),
    }
    Ok(())
}

fn sine(terminal: &mut Terminal) {
    measure(terminal, "sin_cos_q14", Turns, sin_cos_q14);
    measure(terminal, "sin_cos_q30", Turns, sin_cos_q30);
    #[cfg(feature = "peers")]
    peers::sine(terminal);
}

/// Measures `kernel` for the inputs that `input` makes of phases all around the circle, and prints a line.
fn measure<I, O>(terminal: &mut Terminal, name: &str, input: impl Fn(u32) -> I, kernel: impl Fn(I) -> O) {
    let mut places = [
        Cycles::measure::<0, _, _>(&input, &kernel),
        Cycles::measure::<1, _, _>(&input, &kernel),
        Cycles::measure::<2, _, _>(&input, &kernel),
        Cycles::measure::<3, _, _>(&input, &kernel),
    ];
    places.sort_unstable_by_key(|cycles| cycles.median);
    let [Cycles { min, median, max }, ..] = places;
    terminal.print(format_args!("bench {name} min {min} median {median} max {max} cycles\n"));
}

/// Clock cycles of a kernel over its inputs.
struct Cycles {
    min: u32,
    median: u32,
    max: u32,
}

impl Cycles {
    fn measure<const PLACE: usize, I, O>(input: impl Fn(u32) -> I, kernel: impl Fn(I) -> O) -> Self {
        // Multiples of the golden section of 2^32 fill the circle evenly, in an order without a pattern.
        let input = |index: usize| input((index as u32).wrapping_mul(0x9e37_79b9));
        let mut cycles = [0; INPUTS];
        // The first pass brings code and tables into the caches.
        for _ in 0..2 {
            for (index, cycles) in cycles.iter_mut().enumerate() {
                *cycles = timed::<PLACE, _, _>(&kernel, input(index));
            }
        }
        let overhead = (0..INPUTS).map(|index| timed::<PLACE, _, _>(|input| input, input(index))).min();
        let net = |cycles: u32| cycles.saturating_sub(overhead.unwrap_or(0));
        cycles.sort_unstable();
        let [min, .., max] = cycles;
        Self { min: net(min), median: net(cycles[INPUTS / 2]), max: net(max) }
    }
}

/// Clock cycles of a call, with those of asking for the time. Each `PLACE` has code of its own, 1 KiB further on in
/// the cache.
#[inline(never)]
#[allow(unsafe_code)]
fn timed<const PLACE: usize, I, O>(kernel: impl Fn(I) -> O, input: I) -> u32 {
    // SAFETY: jumps over some space; nothing else.
    unsafe { asm!("j 1f", ".space {}", "1:", const PLACE * 1024 + 4, options(nomem, nostack, preserves_flags)) };
    riscv::interrupt::free(|| {
        let start = cpu::cycles_low();
        black_box(kernel(black_box(input)));
        cpu::cycles_low().wrapping_sub(start)
    })
}
