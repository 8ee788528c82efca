//! An instance of a module under test, with ports by name.

use std::path::Path;

use crate::library::Instance;
use crate::{Bits, Layout, Record};

/// A port of a [`Module`], or part of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    index: usize,
    pub(crate) low: usize,
    pub(crate) width: usize,
}

/// One instance of a module, with a clock `clk` and a reset `rst`.
///
/// Methods panic when there is no port, part or type of the given name; the message lists the valid
/// names. Methods that drive inputs panic when the port is an output or the value does not fit, and
/// methods that read panic when the port does not fit the result.
pub struct Module {
    instance: Instance,
    /// The port `clk`; `None` for a module whose clocks the test bench drives.
    clock: Option<Port>,
    /// Whether the module has been evaluated for the current inputs with the clock low.
    settled: bool,
    cycles: u64,
}

impl Module {
    /// Loads the module `name`, or a variant of it, and resets it with all inputs low. Registers without a reset start with
    /// random values from `seed`.
    ///
    /// # Panics
    /// When the module has not been built.
    #[must_use]
    pub fn new(name: &str, seed: u32) -> Self {
        let mut module = Self::load(name, seed);
        module.clock = Some(module.port("clk"));
        let rst = module.port("rst");
        module.set_value(rst, 1);
        module.clock();
        module.clock();
        module.set_value(rst, 0);
        module.settle();
        module
    }

    /// Loads the module `name` with all inputs low, without evaluating it, for a test bench that
    /// drives clocks and resets itself. The first [`settle`](Self::settle) evaluates the module.
    ///
    /// # Panics
    /// When the module has not been built.
    #[must_use]
    pub fn load(name: &str, seed: u32) -> Self {
        let folder = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../target/gateware/models"
        ));
        let mut instance = Instance::load(&folder.join(name).with_extension("so"), seed)
            .unwrap_or_else(|error| {
                panic!("{error}; run `.venv/bin/pytest gateware/tests/test_modules.py` to build it")
            });
        for port in 0..instance.description().ports.len() {
            let described = instance.port(port);
            if !described.output {
                let width = described.layout.width();
                instance.set_bits(port, 0, width, Bits::default());
            }
        }
        Self {
            instance,
            clock: None,
            settled: false,
            cycles: 0,
        }
    }

    /// Finds a port, or part of a port, by its path: `busy`, `status.busy`, `origins[2]`. See [`Record`] for paths.
    #[must_use]
    pub fn port(&self, path: &str) -> Port {
        self.part(path).0
    }

    /// Finds a port, or part of a port, and its type.
    fn part(&self, path: &str) -> (Port, &Layout) {
        let (name, rest) = split(path);
        let index = self.instance.find(name);
        let part = self.instance.port(index).layout.find(rest);
        let part = part.unwrap_or_else(|error| panic!("{name}: {error}"));
        let port = Port {
            index,
            low: part.low,
            width: part.layout.width(),
        };
        (port, part.layout)
    }

    /// Finds a type of a SystemVerilog package by its name, such as `raymarch_pkg::end_t`.
    #[must_use]
    pub fn packed_type(&self, name: &str) -> &Layout {
        let types = &self.instance.description().types;
        types.get(name).unwrap_or_else(|| {
            let names: Vec<_> = types.keys().map(String::as_str).collect();
            panic!("no type {name:?}; the types: {}", names.join(", "))
        })
    }

    /// Makes an all-zero record of the type of a port, or of a part of a port.
    #[must_use]
    pub fn record(&self, path: &str) -> Record {
        self.part(path).1.record()
    }

    /// Drives an input, or part of an input, with a number: `stereo`, `solid.levels`, `origins[0][2]`. See [`Record`] for paths.
    pub fn drive(&mut self, path: &str, value: impl Into<i128>) {
        self.change(path, |record| record.set("", value));
    }

    /// Drives an array with numbers in the order of its indices, one for each element.
    pub fn drive_all(&mut self, path: &str, values: impl IntoIterator<Item: Into<i128>>) {
        self.change(path, |record| record.set_all("", values));
    }

    /// Drives an input, or part of an input, with bits, such as those of a record.
    pub fn drive_bits(&mut self, path: &str, bits: impl Into<Bits>) {
        self.set(self.port(path), bits);
    }

    /// Reads a port, or part of a port, as an unsigned number.
    #[must_use]
    pub fn read(&self, path: &str) -> u64 {
        self.value(self.port(path))
    }

    /// Reads a port, or part of a port, as a record of its type.
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

    /// Drives an input, or part of an input, with a value.
    pub fn set(&mut self, port: Port, value: impl Into<Bits>) {
        self.settled = false;
        self.instance
            .set_bits(port.index, port.low, port.width, value.into());
    }

    /// Drives an input, or part of an input, of at most 64 bits.
    pub fn set_value(&mut self, port: Port, value: u64) {
        self.settled = false;
        self.instance
            .set_field(port.index, port.low, port.width, value);
    }

    /// Returns the bits of a port after the last [`settle`](Self::settle) or [`clock`](Self::clock).
    #[must_use]
    pub fn get(&self, port: Port) -> Bits {
        self.instance.bits(port.index, port.low, port.width)
    }

    /// Returns the value of a port of at most 64 bits.
    #[must_use]
    pub fn value(&self, port: Port) -> u64 {
        self.instance.field(port.index, port.low, port.width)
    }

    /// Whether a one-bit port is high.
    #[must_use]
    pub fn is_high(&self, port: Port) -> bool {
        self.value(port) != 0
    }

    /// Evaluates the module for its current inputs, without a clock edge.
    pub fn settle(&mut self) {
        if !self.settled {
            self.eval_with_clock(0);
            self.settled = true;
        }
    }

    /// Advances by one clock: the rising edge samples the current inputs, and the outputs are updated. The clock falls at the next
    /// [`settle`](Self::settle) or clock, because each evaluation computes all combinational logic, which takes time.
    pub fn clock(&mut self) {
        self.settle();
        self.eval_with_clock(1);
        self.settled = false;
        self.cycles += 1;
    }

    fn eval_with_clock(&mut self, level: u64) {
        if let Some(clock) = self.clock {
            self.instance.set_value(clock.index, level);
        }
        self.instance.eval();
    }

    /// Number of clocks so far.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.cycles
    }
}

/// Splits a path into the name of the port and the path within the port.
fn split(path: &str) -> (&str, &str) {
    path.split_at(path.find(['.', '[']).unwrap_or(path.len()))
}
