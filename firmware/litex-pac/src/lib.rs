//! Access to the registers of Glint's SoC. No other crate accesses registers.
//!
//! The modules of the peripherals are generated from the SoC's own description (`cargo xtask pac`, docs/pac.md). The
//! module `cpu`, on the board only, is written by hand, because the CPU's registers are not part of that description.
//!
//! A peripheral is a zero-sized handle that exists once ([`Peripherals::take`]), and its methods name its
//! registers. The value of a [`Register`](register::Register) is a number, or a type with a getter and a `with_…` setter for each field. A
//! field with named values is an enumeration. The `Counters` of a block are a snapshot of all its free-running counters.
//!
//! ```
//! use litex_pac::{bus, uart};
//! # struct Ready;
//! # impl bus::Bus for Ready {
//! #     fn read(&mut self, _: usize) -> u32 { 0 }
//! #     fn write(&mut self, _: usize, _: u32) {}
//! # }
//! # bus::connect(Ready);
//! let uart = litex_pac::Peripherals::take().unwrap().uart;
//! uart.ev_enable().write(uart::EvEnable::default().with_rx(true));
//! if !uart.txfull().read() {
//!     uart.rxtx().write(b'!');
//! }
//! ```
//!
//! On a host the registers do not exist: [`bus::connect`] connects a model at the same addresses, so that tests
//! run the same drivers. The module `recording` has a simple model.
//!
//! # Limits
//! A register of two words is read word by word. The result is consistent for counters only ([`register::WideRegister::read`]).

#![no_std]

#[cfg(not(target_os = "none"))]
extern crate std;

pub mod bus;
#[cfg(target_arch = "riscv32")]
pub mod cpu;
#[rustfmt::skip]
mod generated;
mod interrupt;
mod memory;
#[cfg(not(target_os = "none"))]
pub mod recording;
pub mod register;
pub mod variant;

use core::cell::Cell;

use critical_section::Mutex;

pub use generated::*;
pub use memory::Memory;
pub use riscv_types::{ExternalInterruptNumber, InterruptNumber};

/// Value of the CPU's register `mimpid` on the emulated board, `EMUL` in ASCII. VexRiscv has 33.
pub const EMULATED: u32 = u32::from_be_bytes(*b"EMUL");

/// Whether [`Peripherals::take`] has returned the handles.
static TAKEN: Mutex<Cell<bool>> = Mutex::new(Cell::new(false));

impl Peripherals {
    /// All peripherals at the first call, `None` at later calls.
    #[must_use]
    pub fn take() -> Option<Self> {
        let taken = critical_section::with(|token| TAKEN.borrow(token).replace(true));
        // SAFETY: `TAKEN` ensures that the handles are returned only once.
        (!taken).then(|| unsafe { Self::steal() })
    }
}
