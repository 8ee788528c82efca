//! The interrupt handler, and a function that sleeps until the next interrupt.

use core::sync::atomic::{AtomicU32, Ordering};

use glint_core::feature::{GESTURE, IMU};
use glint_hal::{gesture as engine, i2c, interrupt, raymarch, scanout, timer, triangle};
use litex_pac::{Interrupt, cpu};

use crate::gesture;
use crate::sensor;
use crate::serial::UART;
use crate::supervision;

/// Parts of the SoC that are present, and that this build supports.
pub struct Present {
    /// Whether the I2C bus and the timer are present.
    pub devices: bool,
    /// Whether scan-out is present.
    pub scanout: bool,
    /// Whether the triangle engine is present.
    pub triangle: bool,
    /// Whether the gesture engine is present.
    pub gesture: bool,
}

/// Enables the interrupts of the UART, and of the parts of the SoC that are present. Call this once, after the start of all
/// devices that the handler accesses.
pub fn start(present: Present) {
    // SAFETY: `handle` is ready, and no critical section is open.
    unsafe {
        interrupt::enable(Interrupt::Uart);
        if present.devices && IMU.is_built {
            interrupt::enable(Interrupt::I2c);
            interrupt::enable(Interrupt::Timer0);
        }
        if present.scanout {
            interrupt::enable(Interrupt::Scanout);
        }
        if present.triangle {
            interrupt::enable(Interrupt::Triangle);
        }
        if present.gesture {
            interrupt::enable(Interrupt::Gesture);
        }
        riscv::register::mie::set_mext();
        riscv::interrupt::enable();
    }
}

/// Number of interrupts so far, modulo 2^32. Only the handler writes it, so its increment may be a separate load and store.
static COUNT: AtomicU32 = AtomicU32::new(0);

/// Number of interrupts so far, modulo 2^32.
pub fn count() -> u32 {
    COUNT.load(Ordering::Relaxed)
}

/// Sleeps until the next interrupt, unless an interrupt has been handled since [`count`] returned `before`.
pub fn sleep(before: u32) {
    // An interrupt handled between the comparison and the sleep would not end the sleep. Interrupts are therefore masked: a
    // pending interrupt ends the sleep and is handled afterwards.
    riscv::interrupt::free(|| {
        if count() == before {
            riscv::asm::wfi();
        }
    });
}

#[riscv_rt::core_interrupt(riscv::interrupt::Interrupt::MachineExternal)]
fn handle() {
    let start = cpu::cycles_low();
    COUNT.store(count().wrapping_add(1), Ordering::Relaxed);
    let unexpected = interrupt::dispatch(cpu::interrupts_pending(), |interrupt| match interrupt {
        Interrupt::Uart => UART.on_interrupt(),
        Interrupt::Scanout => {
            scanout::acknowledge_vblank();
            supervision::on_blanking();
        }
        Interrupt::Triangle => triangle::acknowledge(),
        Interrupt::Raymarch => raymarch::acknowledge(),
        Interrupt::Gesture if GESTURE.is_built => {
            engine::acknowledge();
            gesture::on_interrupt();
        }
        Interrupt::I2c if IMU.is_built => {
            i2c::acknowledge();
            sensor::advance(start);
        }
        Interrupt::Timer0 if IMU.is_built => {
            timer::acknowledge();
            sensor::advance(start);
        }
        // The interrupts of the buttons, and of parts that this build does not support, are never enabled. If such an interrupt still
        // occurs, its line is disabled.
        Interrupt::Buttons | Interrupt::Gesture | Interrupt::I2c | Interrupt::Timer0 => {
            interrupt::disable(interrupt.bit())
        }
    });
    interrupt::disable(unexpected);
}
