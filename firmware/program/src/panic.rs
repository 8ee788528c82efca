//! Handlers of traps and panics: they report the reason over the UART without interrupts, and restart on Enter.

use core::fmt::Write;
use core::panic::PanicInfo;

use glint_hal::uart::Direct;
use litex_pac::Peripherals;
use riscv::register::{mcause, mepc, mtval};
use riscv_rt::TrapFrame;

use crate::serial::UART;

/// The handler of all CPU exceptions. All of them are faults of the program.
#[unsafe(export_name = "ExceptionHandler")]
extern "C" fn exception(frame: &TrapFrame) -> ! {
    let code = mcause::read().code();
    report(format_args!(
        "trap: {} (mcause {code}) at {:#010x}, mtval {:#010x}, ra {:#010x}",
        name(code),
        mepc::read(),
        mtval::read(),
        frame.ra,
    ))
}

/// The name of the exception with this `code` in the privileged specification of RISC-V.
const fn name(code: usize) -> &'static str {
    match code {
        0 => "instruction address misaligned",
        1 => "instruction access fault",
        2 => "illegal instruction",
        3 => "breakpoint",
        4 => "load address misaligned",
        5 => "load access fault",
        6 => "store address misaligned",
        7 => "store access fault",
        11 => "environment call",
        _ => "exception",
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    report(format_args!("{info}"))
}

/// Prints `reason` and the build id, and resets the SoC on Enter.
pub fn report(reason: core::fmt::Arguments) -> ! {
    riscv::interrupt::disable();
    UART.drain();
    // SAFETY: the interrupted program never continues, so its output cannot be disturbed.
    let (mut console, peripherals) = unsafe { (Direct::seize(), Peripherals::steal()) };
    // Writing fails only if the serial line accepts no text, so an error is ignored.
    let _ = write!(
        console,
        "\r\n{reason}\r\nGlint {}, build id {:#010x}: halted, press Enter to restart\r\n",
        env!("CARGO_PKG_VERSION"),
        litex_pac::BUILD_ID,
    );
    loop {
        if peripherals.uart.rxempty().read() {
            continue;
        }
        let byte = peripherals.uart.rxtx().read();
        peripherals
            .uart
            .ev_pending()
            .write(litex_pac::uart::EvPending::default().with_rx(true));
        if byte == b'\r' || byte == b'\n' {
            peripherals
                .ctrl
                .reset()
                .write(litex_pac::ctrl::Reset::default().with_soc_rst(true));
        }
    }
}
