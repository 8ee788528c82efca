//! Clock cycles of single kernels on the soft core, and of frames on the engine.
//!
//! A kernel of the soft core is called with [`INPUTS`] inputs spread over its range, its code and tables in the caches, with interrupts
//! kept out. What the measurement itself costs is measured the same way and taken off.
//!
//! The instruction cache is direct-mapped, and a miss costs more than a kernel. Where the measuring code happens to share
//! cache lines with the kernel, it would measure their fight; so it exists at two places, and the quieter counts.

use core::arch::asm;
use core::hint::black_box;

use glint_core::fixed::Turns;
use glint_core::trig::{sin_cos_q14, sin_cos_q30};
use litex_pac::cpu;

use crate::commands::{self, Refusal};
use crate::machine::Machine;
use crate::terminal::Terminal;

#[cfg(feature = "peers")]
mod attitude;
#[cfg(feature = "peers")]
mod peers;

/// What can be measured.
#[cfg(not(feature = "peers"))]
pub const KERNELS: [&str; 3] = ["sine", "triangle", "field"];
/// What can be measured.
#[cfg(feature = "peers")]
pub const KERNELS: [&str; 4] = ["sine", "attitude", "triangle", "field"];

/// Inputs of each kernel.
const INPUTS: usize = 256;

/// Inputs that find the quieter place.
const TRIALS: usize = 16;

/// Frames that the engine draws back to back.
const FRAMES: u32 = 8;

/// Measures the kernels of a name, or all that there are here.
///
/// # Errors
/// When there is none of this name, or not here.
pub fn run<'l>(machine: &mut Machine, kernel: Option<&'l str>) -> Result<(), Refusal<'l>> {
    match kernel {
        None => {
            sine(&mut machine.terminal);
            if machine.renderer.gateware.is_some() {
                frames(machine)?;
            }
        }
        Some("sine") => sine(&mut machine.terminal),
        #[cfg(feature = "peers")]
        Some("attitude") => attitude::attitude(&mut machine.terminal),
        Some("triangle" | "field") if machine.renderer.gateware.is_none() => {
            return Err(Refusal::NoEngine);
        }
        // What is shown is measured.
        Some(name @ ("triangle" | "field")) => {
            if (name == "field") != machine.scene.field().is_some() {
                return Err(Refusal::NotShown(name));
            }
            frames(machine)?;
        }
        Some(name) => return Err(Refusal::Kernel(name)),
    }
    Ok(())
}

/// Frames of the scene as it is, back to back: the geometry of one is made while the one before it is rastered. Nothing
/// waits for the screen, and nothing is shown.
fn frames<'l>(machine: &mut Machine) -> Result<(), Refusal<'l>> {
    let Machine {
        terminal,
        scene,
        models,
        renderer,
        ..
    } = machine;
    // The frame before has to leave the screen.
    let rendered = loop {
        if let Some(rendered) = renderer.repeat(models.mesh(), scene, FRAMES) {
            break rendered.map_err(Refusal::Engine)?;
        }
    };
    let rays = rendered.stats.field;
    let kernel = if rays.is_some() { "field" } else { "triangle" };
    terminal.print(format_args!(
        "bench {kernel} frames {FRAMES} cycles {}",
        rendered.cycles
    ));
    if let Some(stats) = rays {
        for (name, value) in commands::ray_values(&stats) {
            terminal.print(format_args!(" {name} {value}"));
        }
    }
    for (name, value) in commands::engine_values(&rendered.counters) {
        terminal.print(format_args!(" {name} {value}"));
    }
    terminal.print(format_args!("\n"));
    Ok(())
}

fn sine(terminal: &mut Terminal) {
    measure(terminal, "sin_cos_q14", Turns, sin_cos_q14);
    measure(terminal, "sin_cos_q30", Turns, sin_cos_q30);
    #[cfg(feature = "peers")]
    peers::sine(terminal);
}

/// Measures `kernel` for the inputs that `input` makes of phases all around the circle, and prints a line.
fn measure<I: Copy, O>(
    terminal: &mut Terminal,
    name: &str,
    input: impl Fn(u32) -> I,
    kernel: impl Fn(I) -> O,
) {
    // Multiples of the golden section of 2^32 fill the circle evenly, in an order without a pattern.
    let input = |index: usize| input((index as u32).wrapping_mul(0x9e37_79b9));
    let timers: [fn(&_, I) -> u32; 2] = [timed::<0, _, I, O>, timed::<1, _, I, O>];
    let noise = |timer: &fn(&_, I) -> u32| {
        let pass = || {
            (0..TRIALS)
                .map(|index| timer(&kernel, input(index)))
                .sum::<u32>()
        };
        // The first pass brings code and tables into the caches.
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
    print(terminal, name, &mut cycles);
}

/// Prints the line of a kernel.
fn print(terminal: &mut Terminal, name: &str, cycles: &mut [u32]) {
    cycles.sort_unstable();
    let [min, .., max] = *cycles else {
        return;
    };
    let median = cycles.get(cycles.len() / 2).unwrap_or(&max);
    terminal.print(format_args!(
        "bench {name} min {min} median {median} max {max} cycles\n"
    ));
}

/// Clock cycles of a call, with those of asking for the time. Each `PLACE` has code of its own, half a cache further on.
#[inline(never)]
#[allow(unsafe_code)]
fn timed<const PLACE: usize, K: Fn(I) -> O, I, O>(kernel: &K, input: I) -> u32 {
    // SAFETY: jumps over some space; nothing else.
    unsafe {
        asm!("j 1f", ".space {}", "1:", const PLACE * 2048 + 4, options(nomem, nostack, preserves_flags))
    };
    riscv::interrupt::free(|| {
        let start = cpu::cycles_low();
        black_box(kernel(black_box(input)));
        cpu::cycles_low().wrapping_sub(start)
    })
}
