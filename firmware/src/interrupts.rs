//! The interrupt handler, and sleeping until the next interrupt.

use glint_hal::{i2c, interrupt, raymarch, scanout, timer, triangle};
use litex_pac::{Interrupt, cpu};

use crate::sensor;
use crate::terminal::ConsoleUart;

/// The UART, shared by its interrupt and the program.
pub static UART: ConsoleUart = ConsoleUart::new();

/// Enables the interrupts of the UART, and of the parts of the SoC for which an argument is true. Call this once, after
/// the start of all devices that the handler accesses.
pub fn start(with_devices: bool, with_scanout: bool, with_triangle: bool) {
    // SAFETY: `handle` is ready, and no critical section is open.
    unsafe {
        interrupt::enable(Interrupt::Uart);
        if with_devices {
            interrupt::enable(Interrupt::I2c);
            interrupt::enable(Interrupt::Timer0);
        }
        if with_scanout {
            interrupt::enable(Interrupt::Scanout);
        }
        if with_triangle {
            interrupt::enable(Interrupt::Triangle);
        }
        riscv::register::mie::set_mext();
        riscv::interrupt::enable();
    }
}

/// Sleeps until the next interrupt, unless `awake` returns true because there is work.
pub fn sleep_unless(awake: impl FnOnce() -> bool) {
    // An interrupt handled between `awake` and the sleep would not end the sleep. Interrupts are therefore masked: a
    // pending interrupt ends the sleep and is handled afterwards.
    riscv::interrupt::free(|| {
        if !awake() {
            riscv::asm::wfi();
        }
    });
}

#[riscv_rt::core_interrupt(riscv::interrupt::Interrupt::MachineExternal)]
fn handle() {
    let start = cpu::cycles_low();
    let unexpected = interrupt::dispatch(cpu::interrupts_pending(), |interrupt| match interrupt {
        Interrupt::Uart => UART.on_interrupt(),
        Interrupt::Scanout => scanout::acknowledge_vblank(),
        Interrupt::Triangle => triangle::acknowledge(),
        Interrupt::Raymarch => raymarch::acknowledge(),
        Interrupt::I2c => {
            i2c::acknowledge();
            sensor::advance(start);
        }
        Interrupt::Timer0 => {
            timer::acknowledge();
            sensor::advance(start);
        }
        // The interrupts of the buttons and of the gesture engine are never enabled; if one comes nevertheless, its line is disabled.
        Interrupt::Buttons | Interrupt::Gesture => interrupt::disable(interrupt.bit()),
    });
    interrupt::disable(unexpected);
}
