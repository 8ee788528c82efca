//! A model of the bus for tests: registers that keep written values, and a record of all writes.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::vec::Vec;

use crate::bus::{self, Bus};

/// Values of registers by address, and all writes in order.
#[derive(Default)]
pub struct Block {
    /// Values by address; other registers are 0.
    pub values: BTreeMap<usize, u32>,
    /// All writes: address and value.
    pub writes: Vec<(usize, u32)>,
}

struct Registers(Rc<RefCell<Block>>);

impl Bus for Registers {
    fn read(&mut self, address: usize) -> u32 {
        self.0.borrow().values.get(&address).copied().unwrap_or(0)
    }

    fn write(&mut self, address: usize, value: u32) {
        let mut block = self.0.borrow_mut();
        block.values.insert(address, value);
        block.writes.push((address, value));
    }
}

/// Connects registers with these initial values to the bus of this thread.
pub fn connect<const N: usize>(values: [(usize, u32); N]) -> Rc<RefCell<Block>> {
    let block = Rc::new(RefCell::new(Block {
        values: values.into(),
        writes: Vec::new(),
    }));
    bus::connect(Registers(block.clone()));
    block
}
