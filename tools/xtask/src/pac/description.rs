//! The SoC's `description.json`: enumerated values, counters and constants, which LiteX's own exports lack.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

/// The contents of `description.json`.
#[derive(Deserialize)]
pub struct Description {
    blocks: BTreeMap<String, Block>,
}

/// A block's registers, counters and constants.
#[derive(Deserialize)]
pub struct Block {
    /// Registers in the order of their addresses.
    pub registers: Vec<Register>,
    /// Names of the registers that are free-running counters, in the order in which software lists them.
    pub counters: Vec<String>,
    pub constants: Vec<Constant>,
}

/// A register as the gateware declares it.
#[derive(Deserialize)]
pub struct Register {
    pub name: String,
    /// Width in bits.
    pub width: u32,
    /// Fields in the order of their lowest bits; empty for a register that is one plain number.
    pub fields: Vec<Field>,
}

/// A named range of bits in a register.
#[derive(Deserialize)]
pub struct Field {
    pub name: String,
    pub lsb: u32,
    pub width: u32,
    pub reset: u32,
    pub values: Vec<NamedValue>,
}

/// A named value of a field.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
pub struct NamedValue {
    pub value: u32,
    pub name: String,
    pub text: String,
}

/// A property of the block that software relies on: a named number with its description.
#[derive(Debug, Deserialize, PartialEq, Eq)]
pub struct Constant {
    pub name: String,
    pub value: u32,
    pub text: String,
}

impl Description {
    /// Reads the text of `description.json`.
    ///
    /// # Errors
    /// When the text is not of the form that `gateware/glint_soc/description.py` writes.
    pub fn read(text: &str) -> Result<Self> {
        serde_json::from_str(text).context("description.json is not of the expected form")
    }

    /// Removes the block `name` from the description and returns it.
    ///
    /// # Errors
    /// When the description has no such block, or the block contradicts itself.
    pub fn take(&mut self, name: &str) -> Result<Block> {
        let block = self.blocks.remove(name).with_context(|| {
            format!("soc.svd has the peripheral `{name}`, description.json has not")
        })?;
        for counter in &block.counters {
            let register = block.registers.iter().find(|r| r.name == *counter);
            ensure!(
                register.is_some_and(|r| r.width == 32 && r.fields.is_empty()),
                "description.json has the counter `{counter}` of `{name}`, expected a plain register of 32 bits by that name"
            );
        }
        for field in block.registers.iter().flat_map(|r| &r.fields) {
            let limit = 1_u64 << field.width;
            ensure!(
                field.values.iter().all(|v| u64::from(v.value) < limit),
                "description.json has values of the field `{}` of `{name}` beyond its {} bits",
                field.name,
                field.width
            );
        }
        Ok(block)
    }

    /// Checks that all blocks have been taken out.
    ///
    /// # Errors
    /// A block has not been taken out; the error names the first one.
    pub fn finish(self) -> Result<()> {
        let left = self.blocks.keys().next();
        ensure!(
            left.is_none(),
            "description.json has the block `{}`, soc.svd has not",
            left.map_or("", String::as_str)
        );
        Ok(())
    }
}
