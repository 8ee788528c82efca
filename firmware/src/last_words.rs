//! Traps and panics: what happened and where, said without anything that may be broken, then a way to start again.

use core::fmt::Write;
use core::panic::PanicInfo;

use glint_hal::uart::Direct;
use litex_pac::Peripherals;
use riscv::register::{mcause, mepc, mtval};
use riscv_rt::TrapFrame;

use crate::interrupts::UART;

/// Every exception ends here; none is expected.
#[unsafe(export_name = "ExceptionHandler")]
extern "C" fn exception(frame: &TrapFrame) -> ! {
    let code = mcause::read().code();
    farewell(format_args!(
        "trap: {} (mcause {code}) at {:#010x}, mtval {:#010x}, ra {:#010x}",
        name(code),
        mepc::read(),
        mtval::read(),
        frame.ra,
    ))
}

/// What the privileged specification calls an exception.
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
    farewell(format_args!("{info}"))
}

/// Says `reason` and the build, and starts the SoC again when somebody answers.
pub fn farewell(reason: core::fmt::Arguments) -> ! {
    riscv::interrupt::disable();
    UART.drain();
    // SAFETY: what was running does not run on.
    let (mut console, peripherals) = unsafe { (Direct::seize(), Peripherals::steal()) };
    // A line that takes nothing has nobody listening.
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
