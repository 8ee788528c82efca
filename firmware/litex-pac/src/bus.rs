//! Access to registers over the CPU's bus on the board, or over a model of the bus on a host.

#[cfg(target_os = "none")]
pub(crate) use board::{read, write};
#[cfg(not(target_os = "none"))]
pub use host::{Bus, connect};
#[cfg(not(target_os = "none"))]
pub(crate) use host::{read, write};

#[cfg(target_os = "none")]
mod board {
    use core::ptr;

    /// Reads the word at `address`.
    ///
    /// # Safety
    /// `address` must be the address of a register.
    #[inline]
    pub unsafe fn read(address: usize) -> u32 {
        // SAFETY: the caller guarantees the address of a register, which is aligned to a word.
        unsafe { ptr::read_volatile(ptr::with_exposed_provenance(address)) }
    }

    /// Writes the word at `address`.
    ///
    /// # Safety
    /// `address` must be the address of a writable register.
    #[inline]
    pub unsafe fn write(address: usize, value: u32) {
        // SAFETY: the caller guarantees the address of a register, which is aligned to a word.
        unsafe { ptr::write_volatile(ptr::with_exposed_provenance_mut(address), value) }
    }
}

#[cfg(not(target_os = "none"))]
mod host {
    use core::cell::RefCell;
    use std::boxed::Box;
    use std::thread_local;

    /// A model of the bus, which answers all accesses on a host.
    pub trait Bus {
        /// Reads the word at `address`.
        fn read(&mut self, address: usize) -> u32;
        /// Writes the word at `address`.
        fn write(&mut self, address: usize, value: u32);
    }

    /// A bus without devices: every read returns 0, as for a block that the gateware lacks.
    struct Empty;

    impl Bus for Empty {
        fn read(&mut self, _: usize) -> u32 {
            0
        }

        fn write(&mut self, _: usize, _: u32) {}
    }

    thread_local! {
        static BUS: RefCell<Box<dyn Bus>> = RefCell::new(Box::new(Empty));
    }

    /// Uses `bus` as the bus of all registers in this thread.
    pub fn connect(bus: impl Bus + 'static) {
        BUS.replace(Box::new(bus));
    }

    /// Reads the word at `address`.
    ///
    /// # Safety
    /// No condition on a host; `unsafe` matches the signature of the board's function.
    pub unsafe fn read(address: usize) -> u32 {
        BUS.with_borrow_mut(|bus| bus.read(address))
    }

    /// Writes the word at `address`.
    ///
    /// # Safety
    /// No condition on a host; `unsafe` matches the signature of the board's function.
    pub unsafe fn write(address: usize, value: u32) {
        BUS.with_borrow_mut(|bus| bus.write(address, value));
    }
}
