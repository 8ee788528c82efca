//! A module under test.

use std::path::Path;

use crate::library::Instance;
use crate::{Bits, Layout, Record};

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
        for port in 0..module.instance.description().ports.len() {
            if !module.instance.port(port).output {
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
    /// When there is none; lists the names.
    #[must_use]
    pub fn port(&self, name: &str) -> Port {
        let ports = &self.instance.description().ports;
        let found = ports.iter().position(|port| port.name == name);
        Port(found.unwrap_or_else(|| {
            let names: Vec<_> = ports.iter().map(|port| port.name.as_str()).collect();
            panic!("no port {name:?}; the ports: {}", names.join(", "))
        }))
    }

    /// The type of a port.
    #[must_use]
    pub fn layout(&self, port: Port) -> &Layout {
        &self.instance.port(port.0).layout
    }

    /// A type of a package by its name, as `raymarch_pkg::end_t`.
    ///
    /// # Panics
    /// When there is none; lists the names.
    #[must_use]
    pub fn packed_type(&self, name: &str) -> &Layout {
        let types = &self.instance.description().types;
        types.get(name).unwrap_or_else(|| {
            let names: Vec<_> = types.keys().map(String::as_str).collect();
            panic!("no type {name:?}; the types: {}", names.join(", "))
        })
    }

    /// A record of the type of a port by its name, all zero.
    ///
    /// # Panics
    /// When there is no such port.
    #[must_use]
    pub fn record(&self, name: &str) -> Record {
        self.layout(self.port(name)).record()
    }

    /// Drives an input, or a part of one, with a number: `stereo`, `solid.levels`, `origins[0][2]`. See [`Record`] for paths.
    ///
    /// # Panics
    /// When there is no such part, or the number does not fit.
    pub fn drive(&mut self, path: &str, value: impl Into<i128>) {
        self.change(path, |record, rest| record.set(rest, value));
    }

    /// Drives an array with numbers, the lowest index first.
    ///
    /// # Panics
    /// When there is no such array, or one of another length, or a number does not fit.
    pub fn drive_all(&mut self, path: &str, values: impl IntoIterator<Item: Into<i128>>) {
        self.change(path, |record, rest| record.set_all(rest, values));
    }

    /// Drives an input, or a part of one, with bits, such as those of a record.
    ///
    /// # Panics
    /// When there is no such part, or the bits do not fit.
    pub fn drive_bits(&mut self, path: &str, bits: impl Into<Bits>) {
        self.change(path, |record, rest| record.set_bits(rest, bits));
    }

    /// The number on a port or a part of one, as unsigned.
    ///
    /// # Panics
    /// When there is no such part, or one of more than 64 bits.
    #[must_use]
    pub fn read(&self, path: &str) -> u64 {
        let (name, rest) = split(path);
        self.read_record(name).get(rest)
    }

    /// A port as a record of its type.
    ///
    /// # Panics
    /// When there is no such port.
    #[must_use]
    pub fn read_record(&self, name: &str) -> Record {
        let port = self.port(name);
        self.layout(port).record_of(self.get(port))
    }

    fn change(&mut self, path: &str, change: impl FnOnce(&mut Record, &str)) {
        let (name, rest) = split(path);
        let port = self.port(name);
        let mut record = self.layout(port).record_of(self.get(port));
        change(&mut record, rest);
        self.set(port, record);
    }

    /// Drives an input with the lowest bits of a value.
    ///
    /// # Panics
    /// When it is an output, or the value does not fit.
    pub fn set(&mut self, port: Port, value: impl Into<Bits>) {
        let value = value.into();
        let description = self.instance.port(port.0);
        assert!(!description.output, "{} is an output", description.name);
        assert!(
            value.fits(description.layout.width()),
            "{value:?} in the {} bits of {}",
            description.layout.width(),
            description.name
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
        self.get(port).field(0, self.layout(port).width())
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

/// A path's port and the rest of it.
fn split(path: &str) -> (&str, &str) {
    path.split_at(path.find(['.', '[']).unwrap_or(path.len()))
}
