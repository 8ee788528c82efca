//! Typed access to single registers.

use core::marker::PhantomData;

use crate::bus;

/// Access mode: read only.
pub struct ReadOnly;

/// Access mode: read and write.
pub struct ReadWrite;

/// The value of a register of one word.
pub trait Value: Copy {
    /// Converts from the 32 bits of the register; bits beyond the value are ignored.
    fn from_bits(bits: u32) -> Self;
    /// Converts to the 32 bits of the register; bits beyond the value are 0.
    fn bits(self) -> u32;
}

impl Value for bool {
    fn from_bits(bits: u32) -> Self {
        bits & 1 != 0
    }

    fn bits(self) -> u32 {
        self.into()
    }
}

macro_rules! value_of_integer {
    ($($integer:ty),*) => {
        $(impl Value for $integer {
            fn from_bits(bits: u32) -> Self {
                bits as $integer
            }

            fn bits(self) -> u32 {
                self.into()
            }
        })*
    };
}

value_of_integer!(u8, u16, u32);

/// A register of one word that holds a `T`; `A` is [`ReadOnly`] or [`ReadWrite`].
pub struct Register<T, A> {
    address: usize,
    kind: PhantomData<(T, A)>,
}

impl<T: Value, A> Register<T, A> {
    /// The register at `address`.
    ///
    /// # Safety
    /// `address` must be the address of a register that allows `A`; reading the register must not affect memory.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        Self {
            address,
            kind: PhantomData,
        }
    }

    /// Address of the register on the bus.
    #[must_use]
    pub const fn address(&self) -> usize {
        self.address
    }

    /// Reads the register.
    #[inline]
    #[must_use]
    pub fn read(&self) -> T {
        // SAFETY: the contract of `at` covers the address.
        T::from_bits(unsafe { bus::read(self.address) })
    }
}

impl<T: Value> Register<T, ReadWrite> {
    /// Writes the register.
    #[inline]
    pub fn write(&self, value: T) {
        // SAFETY: the contract of `at` covers the address and write access.
        unsafe { bus::write(self.address, value.bits()) }
    }

    /// Reads the register and writes the changed value; not atomic with respect to interrupts.
    #[inline]
    pub fn modify(&self, change: impl FnOnce(T) -> T) {
        self.write(change(self.read()));
    }
}

/// A register of two words that holds a number of up to 64 bits, its high word first.
pub struct WideRegister<A> {
    address: usize,
    kind: PhantomData<A>,
}

impl<A> WideRegister<A> {
    /// The register whose high word is at `address`.
    ///
    /// # Safety
    /// `address` must be the address of a register of two words that allows `A`; reading the register must not affect memory.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        Self {
            address,
            kind: PhantomData,
        }
    }

    /// Reads both words, and repeats the reads until the high word is unchanged, so that the value of a counter is consistent.
    #[inline]
    #[must_use]
    pub fn read(&self) -> u64 {
        // SAFETY: the contract of `at` covers both words.
        let word = |offset| unsafe { bus::read(self.address + offset) };
        let mut high = word(0);
        loop {
            let low = word(4);
            let again = word(0);
            if again == high {
                return u64::from(high) << 32 | u64::from(low);
            }
            high = again;
        }
    }

    /// Reads the low word.
    #[inline]
    #[must_use]
    pub fn read_low(&self) -> u32 {
        // SAFETY: the contract of `at` covers both words.
        unsafe { bus::read(self.address + 4) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bus::{self, Bus};

    /// A model of a counter whose high word changes after the first read.
    struct Carrying(u64);

    impl Bus for Carrying {
        fn read(&mut self, address: usize) -> u32 {
            let value = self.0;
            self.0 += 1;
            if address == 0x100 {
                (value >> 32) as u32
            } else {
                value as u32
            }
        }

        fn write(&mut self, _: usize, value: u32) {
            self.0 = value.into();
        }
    }

    #[test]
    fn a_wide_counter_is_consistent() {
        bus::connect(Carrying(0xffff_ffff));
        // SAFETY: the model connected above answers at this address.
        let counter = unsafe { WideRegister::<ReadOnly>::at(0x100) };
        assert_eq!(counter.read(), 0x1_0000_0002);
        assert_eq!(counter.read_low(), 4);
    }

    #[test]
    fn values_keep_to_their_width() {
        assert_eq!(u8::from_bits(0x1ff), 0xff);
        assert_eq!(u16::from_bits(0x1_2345), 0x2345);
        assert!(bool::from_bits(3) && !bool::from_bits(2));
    }

    #[test]
    fn modify_reads_then_writes() {
        bus::connect(Carrying(40));
        // SAFETY: the model connected above answers at this address.
        let register = unsafe { Register::<u16, ReadWrite>::at(4) };
        register.modify(|value| value + 2);
        assert_eq!(register.read(), 42);
    }
}
