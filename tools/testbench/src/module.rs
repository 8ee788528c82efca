//! A module under test.

use std::path::Path;

use crate::library::Instance;
use crate::{Bits, Layout, Record};

/// A port of a [`Module`], or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    index: usize,
    pub(crate) low: usize,
    pub(crate) width: usize,
}

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
            let description = module.instance.port(port);
            if !description.output {
                let name = description.name.clone();
                module.drive_bits(&name, Bits::default());
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

    /// A port, or a part of one: `busy`, `status.busy`, `origins[2]`. See [`Record`] for paths.
    ///
    /// # Panics
    /// When there is none; lists the names.
    #[must_use]
    pub fn port(&self, path: &str) -> Port {
        self.part(path).0
    }

    /// A port or a part of one, with its type.
    fn part(&self, path: &str) -> (Port, &Layout) {
        let (name, rest) = split(path);
        let ports = &self.instance.description().ports;
        let found = ports.iter().position(|port| port.name == name);
        let index = found.unwrap_or_else(|| {
            let names: Vec<_> = ports.iter().map(|port| port.name.as_str()).collect();
            panic!("no port {name:?}; the ports: {}", names.join(", "))
        });
        let part = ports[index].layout.find(rest);
        let part = part.unwrap_or_else(|error| panic!("{name}: {error}"));
        let port = Port {
            index,
            low: part.low,
            width: part.layout.width(),
        };
        (port, part.layout)
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

    /// A record of the type of a port or a part of one, all zero.
    ///
    /// # Panics
    /// When there is no such part.
    #[must_use]
    pub fn record(&self, path: &str) -> Record {
        self.part(path).1.record()
    }

    /// Drives an input, or a part of one, with a number: `stereo`, `solid.levels`, `origins[0][2]`. See [`Record`] for paths.
    ///
    /// # Panics
    /// When there is no such part, or the number does not fit.
    pub fn drive(&mut self, path: &str, value: impl Into<i128>) {
        self.change(path, |record| record.set("", value));
    }

    /// Drives an array with numbers, the lowest index first.
    ///
    /// # Panics
    /// When there is no such array, or one of another length, or a number does not fit.
    pub fn drive_all(&mut self, path: &str, values: impl IntoIterator<Item: Into<i128>>) {
        self.change(path, |record| record.set_all("", values));
    }

    /// Drives an input, or a part of one, with bits, such as those of a record.
    ///
    /// # Panics
    /// When there is no such part, or the bits do not fit.
    pub fn drive_bits(&mut self, path: &str, bits: impl Into<Bits>) {
        self.set(self.port(path), bits);
    }

    /// The number on a port or a part of one, as unsigned.
    ///
    /// # Panics
    /// When there is no such part, or one of more than 64 bits.
    #[must_use]
    pub fn read(&self, path: &str) -> u64 {
        self.value(self.port(path))
    }

    /// A port or a part of one as a record of its type.
    ///
    /// # Panics
    /// When there is no such part.
    #[must_use]
    pub fn read_record(&self, path: &str) -> Record {
        let (port, layout) = self.part(path);
        layout.record_of(self.get(port))
    }

    fn change(&mut self, path: &str, change: impl FnOnce(&mut Record)) {
        let mut record = self.read_record(path);
        change(&mut record);
        self.set(self.port(path), record);
    }

    /// Drives an input with the lowest bits of a value.
    ///
    /// # Panics
    /// When it is an output, or the value does not fit.
    pub fn set(&mut self, port: Port, value: impl Into<Bits>) {
        let mut value = value.into();
        let Port { index, low, width } = port;
        let description = self.instance.port(index);
        let name = &description.name;
        assert!(!description.output, "{name} is an output");
        assert!(
            value.fits(width),
            "{value:?} in {width} bits of {name} from bit {low}"
        );
        if width != description.layout.width() {
            value = self.whole(index).with_slice(low, width, value);
        }
        let target = self.instance.bytes_mut(index);
        let bytes = value.words().iter().flat_map(|word| word.to_le_bytes());
        target
            .iter_mut()
            .zip(bytes)
            .for_each(|(to, from)| *to = from);
    }

    /// What is on a port, as of the last [`settle`](Self::settle) or [`clock`](Self::clock).
    #[must_use]
    pub fn get(&self, port: Port) -> Bits {
        let whole = self.whole(port.index);
        if port.width == self.instance.port(port.index).layout.width() {
            return whole;
        }
        whole.slice(port.low, port.width)
    }

    /// All bits of a port.
    fn whole(&self, index: usize) -> Bits {
        let mut words = [0; 16];
        for (i, &byte) in self.instance.bytes(index).iter().enumerate() {
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
        let Port { index, low, width } = port;
        assert!(width <= 64, "{width} bits");
        // 64 bits from anywhere are in nine bytes.
        let bytes = self.instance.bytes(index).iter().skip(low / 8).take(9);
        let nine = bytes
            .rev()
            .fold(0_u128, |all, &byte| all << 8 | u128::from(byte));
        (nine >> (low % 8)) as u64 & ((1_u128 << width) - 1) as u64
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
