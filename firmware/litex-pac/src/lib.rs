//! Access to the registers of Glint's SoC, and the only crate that touches them.
//!
//! The peripherals' modules are generated from the SoC's own description (`cargo xtask pac` joins its `soc.svd` and
//! `csr.json`); the module `cpu`, which only the board has, is written by hand, because the CPU's registers are in
//! neither.
//!
//! A peripheral is a zero-sized handle that exists once ([`Peripherals::take`]). Its methods name registers, and a
//! [`Register`](register::Register) is read or written as a number or as a type with one getter and one `with_…`
//! setter a field:
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
//! On a host there is no bus: [`bus::connect`] puts a model of one behind the same addresses, so that drivers are
//! tested unchanged.
//!
//! # Limits
//! A register of two words is read word by word; a counter is consistent ([`register::WideRegister::read`]), another
//! value need not be.

#![no_std]

#[cfg(not(target_os = "none"))]
extern crate std;

pub mod bus;
#[cfg(target_arch = "riscv32")]
pub mod cpu;
#[rustfmt::skip]
mod generated;
pub mod register;

use core::cell::Cell;

use critical_section::Mutex;

pub use generated::*;

/// A memory on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Address of its first byte.
    pub base: u32,
    /// Its size in bytes.
    pub size: u32,
}

impl Interrupt {
    /// Its bit in the CPU's mask and pending registers.
    #[must_use]
    pub const fn bit(self) -> u32 {
        1 << self as u8
    }
}

/// Whether [`Peripherals::take`] has been answered.
static TAKEN: Mutex<Cell<bool>> = Mutex::new(Cell::new(false));

impl Peripherals {
    /// Every peripheral, the first time; nothing after that.
    #[must_use]
    pub fn take() -> Option<Self> {
        let taken = critical_section::with(|token| TAKEN.borrow(token).replace(true));
        // SAFETY: nobody was given these handles before, and nobody will be again.
        (!taken).then(|| unsafe { Self::steal() })
    }
}
