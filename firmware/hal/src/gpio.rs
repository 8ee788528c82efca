//! Buttons and switches as input pins, LEDs as output pins.
//!
//! A port contains all pins of one register; [`InputPort::pin`] and [`OutputPort::pin`] return single pins. All pins of an output
//! port share its register. The main program and interrupt handlers may change them, because each change is a critical section.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin, StatefulOutputPin};
use litex_pac::register::{ReadOnly, ReadWrite, Register, Value};

/// The pins of an input register.
pub struct InputPort<T> {
    register: Register<T, ReadOnly>,
}

impl<T: Value> InputPort<T> {
    /// Returns the port whose pin levels are the bits of `register`; bit 0 is pin 0.
    #[must_use]
    pub const fn new(register: Register<T, ReadOnly>) -> Self {
        Self { register }
    }

    /// Reads the levels of all pins at once; bit 0 is pin 0.
    #[must_use]
    pub fn read(&self) -> T {
        self.register.read()
    }

    /// Returns the input pin `index`, which reads as low if the register has no such bit.
    #[must_use]
    pub const fn pin(&self, index: u8) -> Input<'_, T> {
        Input { port: self, index }
    }
}

/// A single pin of an [`InputPort`].
pub struct Input<'p, T> {
    port: &'p InputPort<T>,
    index: u8,
}

impl<T> ErrorType for Input<'_, T> {
    type Error = Infallible;
}

impl<T: Value> InputPin for Input<'_, T> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.port.read().bits() & bit(self.index) != 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

/// The pins of an output register.
pub struct OutputPort<T> {
    register: Register<T, ReadWrite>,
}

impl<T: Value> OutputPort<T> {
    /// Returns the port whose pins are driven by the bits of `register`; bit 0 drives pin 0.
    #[must_use]
    pub const fn new(register: Register<T, ReadWrite>) -> Self {
        Self { register }
    }

    /// Reads the levels to which all pins are driven; bit 0 is pin 0.
    #[must_use]
    pub fn get(&self) -> T {
        self.register.read()
    }

    /// Drives all pins at once to the bits of `value`; bit 0 drives pin 0.
    pub fn set(&self, value: T) {
        critical_section::with(|_| self.register.write(value));
    }

    /// Returns the output pin `index`. Changes of the pin have no effect if the register has no such bit.
    #[must_use]
    pub const fn pin(&self, index: u8) -> Output<'_, T> {
        Output { port: self, index }
    }
}

/// A single pin of an [`OutputPort`].
pub struct Output<'p, T> {
    port: &'p OutputPort<T>,
    index: u8,
}

impl<T: Value> Output<'_, T> {
    fn change(&self, change: impl FnOnce(u32) -> u32) {
        critical_section::with(|_| {
            self.port
                .register
                .modify(|value| T::from_bits(change(value.bits())))
        });
    }
}

impl<T> ErrorType for Output<'_, T> {
    type Error = Infallible;
}

impl<T: Value> OutputPin for Output<'_, T> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.change(|pins| pins & !bit(self.index));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.change(|pins| pins | bit(self.index));
        Ok(())
    }
}

impl<T: Value> StatefulOutputPin for Output<'_, T> {
    fn is_set_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.port.get().bits() & bit(self.index) != 0)
    }

    fn is_set_low(&mut self) -> Result<bool, Infallible> {
        self.is_set_high().map(|high| !high)
    }

    fn toggle(&mut self) -> Result<(), Infallible> {
        self.change(|pins| pins ^ bit(self.index));
        Ok(())
    }
}

/// Mask of the bit of pin `index` in a register; 0 if `index` is 32 or more.
const fn bit(index: u8) -> u32 {
    if index < 32 { 1 << index } else { 0 }
}

#[cfg(test)]
mod tests {
    use litex_pac::bus::{self, Bus};
    use litex_pac::{Peripherals, leds::Leds, switches::Switches};

    use super::*;

    /// Model of a board: switches 0 and 15 are on, and the LED register keeps the written value.
    struct Board {
        leds: u32,
    }

    impl Bus for Board {
        fn read(&mut self, address: usize) -> u32 {
            match address {
                Switches::BASE => 0x8001,
                Leds::BASE => self.leds,
                _ => panic!("read of {address:#x}"),
            }
        }

        fn write(&mut self, address: usize, value: u32) {
            assert_eq!(address, Leds::BASE);
            self.leds = value;
        }
    }

    #[test]
    fn inputs() {
        bus::connect(Board { leds: 0 });
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        let port = InputPort::new(unsafe { Peripherals::steal() }.switches.in_());
        assert_eq!(port.read(), 0x8001);
        assert!(port.pin(15).is_high().unwrap() && port.pin(14).is_low().unwrap());
        assert!(port.pin(16).is_low().unwrap() && port.pin(255).is_low().unwrap());
    }

    #[test]
    fn outputs() {
        bus::connect(Board { leds: 0b100 });
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        let port = OutputPort::new(unsafe { Peripherals::steal() }.leds.out());
        let (mut first, mut third) = (port.pin(0), port.pin(2));
        first.set_high().unwrap();
        assert_eq!(port.get(), 0b101);
        third.toggle().unwrap();
        assert!(third.is_set_low().unwrap() && first.is_set_high().unwrap());
        first.set_low().unwrap();
        port.pin(16).set_high().unwrap();
        assert_eq!(port.get(), 0);
        port.set(0xffff);
        assert_eq!(port.get(), 0xffff);
    }
}
