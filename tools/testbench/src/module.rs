//! A module under test.

use std::path::Path;

use crate::Bits;
use crate::library::Instance;

/// A port of a [`Module`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port(usize);

/// One instance of a module, with a clock `clk` and a reset `rst`.
pub struct Module {
    instance: Instance,
    cycles: u64,
}

impl Module {
    /// The module `name`, or a variant of one, just out of reset, with all inputs low. Registers without a reset start with
    /// noise that follows from `seed`.
    ///
    /// # Panics
    /// When it has not been built.
    #[must_use]
    pub fn new(name: &str, seed: u32) -> Self {
        let folder = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../target/gateware/models"
        ));
        let instance = Instance::load(&folder.join(name).with_extension("so"), seed)
            .unwrap_or_else(|error| {
                panic!("{error}; `.venv/bin/python gateware/tests/run.py --models` builds it")
            });
        let mut module = Self {
            instance,
            cycles: 0,
        };
        for port in 0..module.instance.shapes().len() {
            if !module.instance.shapes()[port].is_output {
                module.set(Port(port), 0);
            }
        }
        let rst = module.port("rst");
        module.set(rst, 1);
        module.clock();
        module.clock();
        module.set(rst, 0);
        module.settle();
        module
    }

    /// The port of a name.
    ///
    /// # Panics
    /// When there is none.
    #[must_use]
    pub fn port(&self, name: &str) -> Port {
        let shapes = self.instance.shapes();
        let found = shapes.iter().position(|shape| shape.name == name);
        Port(found.unwrap_or_else(|| panic!("no port {name:?} among {shapes:?}")))
    }

    /// Drives an input with the lowest bits of a value.
    ///
    /// # Panics
    /// When it is an output, or the value does not fit.
    pub fn set(&mut self, port: Port, value: impl Into<Bits>) {
        let value = value.into();
        let shape = &self.instance.shapes()[port.0];
        assert!(!shape.is_output, "{} is an output", shape.name);
        assert!(
            value.fits(shape.width),
            "{value:?} in the {} bits of {}",
            shape.width,
            shape.name
        );
        let target = self.instance.bytes_mut(port.0);
        let bytes = value.words().iter().flat_map(|word| word.to_le_bytes());
        target
            .iter_mut()
            .zip(bytes)
            .for_each(|(to, from)| *to = from);
    }

    /// What is on a port, as of the last [`settle`](Self::settle) or [`clock`](Self::clock).
    #[must_use]
    pub fn get(&self, port: Port) -> Bits {
        let mut words = [0; 16];
        for (i, &byte) in self.instance.bytes(port.0).iter().enumerate() {
            words[i / 4] |= u32::from(byte) << (8 * (i % 4));
        }
        Bits::from_words(&words)
    }

    /// A port of at most 64 bits.
    ///
    /// # Panics
    /// When it is wider.
    #[must_use]
    pub fn value(&self, port: Port) -> u64 {
        self.get(port)
            .field(0, self.instance.shapes()[port.0].width)
    }

    /// Whether a port of one bit is high.
    #[must_use]
    pub fn is_high(&self, port: Port) -> bool {
        self.value(port) != 0
    }

    /// Lets the outputs follow the inputs, without a clock edge.
    pub fn settle(&mut self) {
        self.instance.settle();
    }

    /// One clock edge, which takes the inputs as they are. Outputs are those after it.
    pub fn clock(&mut self) {
        self.instance.clock();
        self.cycles += 1;
    }

    /// Clock edges so far.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.cycles
    }
}
