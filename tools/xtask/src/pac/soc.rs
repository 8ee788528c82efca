//! The SoC, joined from three descriptions: the two of LiteX are matched by address, that of Glint by name.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail, ensure};
use roxmltree::{Document, Node};
use serde_json::Value;

use super::description::{self, Block, Constant, Description, NamedValue};

/// Name of the constant with the CRC-32 of the register map that `gateware/glint_soc/register_map.py` fixes.
const BUILD_ID: &str = "build_id";

/// The parts of the SoC that the generated files list, each sorted by address or by name.
#[derive(Debug)]
pub struct Soc {
    /// CRC-32 of the register map that `gateware/glint_soc/register_map.py` fixes.
    pub build_id: u32,
    /// Peripherals in the order of their base addresses.
    pub peripherals: Vec<Peripheral>,
    /// Memories in the order of their base addresses, without `csr`, the window of the registers.
    pub memories: Vec<Memory>,
    /// Numeric constants that firmware may rely on, sorted by name.
    pub constants: Vec<(String, u32)>,
}

/// A peripheral: a block of registers in the CPU's address space.
#[derive(Debug)]
pub struct Peripheral {
    pub name: String,
    pub base: u32,
    /// First paragraph of the description in the gateware; may be empty.
    pub description: String,
    pub interrupt: Option<u32>,
    /// Registers in the order of their offsets.
    pub registers: Vec<Register>,
    /// Names of the registers that are free-running counters, in the order in which software lists them.
    pub counters: Vec<String>,
    /// Properties of the block that software relies on, each a named number.
    pub constants: Vec<Constant>,
}

impl Peripheral {
    /// The registers of the counters, in the order of `counters`.
    pub fn counters(&self) -> Vec<&Register> {
        let register = |name: &String| self.registers.iter().find(|r| r.name == *name);
        self.counters.iter().filter_map(register).collect()
    }
}

/// A register of one 32-bit word, or of two with the high word first.
#[derive(Debug)]
pub struct Register {
    pub name: String,
    pub offset: u32,
    pub words: u32,
    pub access: Access,
    pub reset: u64,
    /// Width in bits.
    pub width: u32,
    pub description: String,
    /// Fields in the order of their lowest bits; empty for a register that is one plain number.
    pub fields: Vec<Field>,
}

/// Whether the bus may write a register. LiteX has no write-only registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    ReadOnly,
    ReadWrite,
}

/// A named range of bits in a register.
#[derive(Debug)]
pub struct Field {
    pub name: String,
    pub lsb: u32,
    pub width: u32,
    pub description: String,
    /// Named values of the field; empty for a field that is a number or a flag.
    pub values: Vec<NamedValue>,
}

/// A memory on the bus.
#[derive(Debug)]
pub struct Memory {
    pub name: String,
    pub base: u32,
    pub size: u32,
}

impl Soc {
    /// Joins the texts of `soc.svd`, `csr.json` and `description.json`.
    ///
    /// # Errors
    /// When a text cannot be parsed or two texts disagree; the error names the register and both statements.
    pub fn read(svd: &str, csr_json: &str, description_json: &str) -> Result<Self> {
        let document = Document::parse(svd).context("soc.svd is not XML")?;
        let csr: Value = serde_json::from_str(csr_json).context("csr.json is not JSON")?;
        let mut description = Description::read(description_json)?;
        let mut constants = constants(&csr)?;
        let build_id = constants
            .remove(BUILD_ID)
            .with_context(|| format!("csr.json has no constant `{BUILD_ID}`"))?;
        let peripherals = peripherals(&document, &csr, &mut description)?;
        description.finish()?;
        Ok(Self {
            build_id,
            peripherals,
            memories: memories(&csr)?,
            constants: constants.into_iter().collect(),
        })
    }
}

fn peripherals(
    document: &Document,
    csr: &Value,
    description: &mut Description,
) -> Result<Vec<Peripheral>> {
    let mut declared = declared_registers(csr)?;
    let bases = object(csr, "csr_bases")?;
    let mut peripherals = Vec::new();
    for node in document
        .descendants()
        .filter(|node| node.has_tag_name("peripheral"))
    {
        let name = child_text(node, "name")?.to_lowercase();
        let base = number(child_text(node, "baseAddress")?)?;
        let json_base = bases
            .get(&name)
            .with_context(|| format!("soc.svd has the peripheral `{name}`, csr.json has not"))?;
        let json_base =
            u32_of(json_base).with_context(|| format!("base of `{name}` in csr.json"))?;
        ensure!(
            base == json_base,
            "`{name}` lies at {base:#010x} in soc.svd and at {json_base:#010x} in csr.json"
        );
        let mut registers = registers(node, &name, base, &mut declared)?;
        // The SoC's identifier text is a memory behind the register bus, and has no registers in csr.json.
        if !registers.is_empty() {
            let Block {
                registers: described,
                counters,
                constants,
            } = description.take(&name)?;
            join_fields(&name, &mut registers, described)?;
            peripherals.push(Peripheral {
                description: first_paragraph(
                    child(node, "description")
                        .and_then(|n| n.text())
                        .unwrap_or_default(),
                ),
                interrupt: child(node, "interrupt")
                    .map(|n| number(child_text(n, "value")?))
                    .transpose()?,
                name,
                base,
                registers,
                counters,
                constants,
            });
        }
    }
    if let Some((address, register)) = declared.first_key_value() {
        bail!(
            "csr.json has the register `{}` at {address:#010x}, soc.svd has not",
            register.name
        );
    }
    peripherals.sort_by_key(|peripheral| peripheral.base);
    Ok(peripherals)
}

/// Adds the named values of `described` to the fields of `registers`. For a register that was declared without fields, LiteX adds
/// fields to soc.svd; these are dropped.
fn join_fields(
    peripheral: &str,
    registers: &mut [Register],
    described: Vec<description::Register>,
) -> Result<()> {
    ensure!(
        registers.len() == described.len(),
        "`{peripheral}` has {} registers in soc.svd and {} in description.json",
        registers.len(),
        described.len()
    );
    for (register, described) in registers.iter_mut().zip(described) {
        let name = format!("{peripheral}_{}", register.name);
        ensure!(
            register.name == described.name && register.width == described.width,
            "`{name}` of {} bits in soc.svd is `{peripheral}_{}` of {} bits in description.json",
            register.width,
            described.name,
            described.width
        );
        if described.fields.is_empty() {
            register.fields.clear();
        }
        ensure!(
            register.fields.len() == described.fields.len(),
            "`{name}` has {} fields in soc.svd and {} in description.json",
            register.fields.len(),
            described.fields.len()
        );
        for (field, described) in register.fields.iter_mut().zip(described.fields) {
            let reset = register.reset as u32 >> field.lsb & u32::MAX >> (32 - field.width);
            ensure!(
                (&field.name, field.lsb, field.width, reset)
                    == (
                        &described.name,
                        described.lsb,
                        described.width,
                        described.reset
                    ),
                "`{name}` has the field `{}` from bit {} of {} bits, reset to {reset}, in soc.svd, and `{}` from bit {} of {} bits, reset \
                 to {}, in description.json",
                field.name,
                field.lsb,
                field.width,
                described.name,
                described.lsb,
                described.width,
                described.reset
            );
            field.values = described.values;
        }
    }
    Ok(())
}

/// A register as csr.json declares it.
struct Declared {
    /// Name in csr.json, of the form `peripheral_register`.
    name: String,
    words: u32,
    access: Access,
}

fn declared_registers(csr: &Value) -> Result<BTreeMap<u32, Declared>> {
    let mut declared = BTreeMap::new();
    for (name, entry) in object(csr, "csr_registers")? {
        let at = || format!("register `{name}` in csr.json");
        let address = u32_of(&entry["addr"]).with_context(at)?;
        let words = u32_of(&entry["size"]).with_context(at)?;
        ensure!(
            (1..=2).contains(&words),
            "{} is {words} words wide, expected 1 or 2",
            at()
        );
        let access = match entry["type"].as_str() {
            Some("ro") => Access::ReadOnly,
            Some("rw") => Access::ReadWrite,
            other => bail!(
                "{} has the access {other:?}, expected \"ro\" or \"rw\"",
                at()
            ),
        };
        let register = Declared {
            name: name.clone(),
            words,
            access,
        };
        if let Some(other) = declared.insert(address, register) {
            bail!(
                "{} has the address of `{}`, {address:#010x}",
                at(),
                other.name
            );
        }
    }
    Ok(declared)
}

/// Reads the registers of one peripheral from soc.svd, and takes each of them out of `declared`.
fn registers(
    peripheral: Node,
    peripheral_name: &str,
    base: u32,
    declared: &mut BTreeMap<u32, Declared>,
) -> Result<Vec<Register>> {
    let mut words = BTreeMap::new();
    for node in peripheral
        .descendants()
        .filter(|node| node.has_tag_name("register"))
    {
        words.insert(number(child_text(node, "addressOffset")?)?, node);
    }
    let mut registers = Vec::new();
    while let Some((offset, first)) = words.pop_first() {
        let svd_name = child_text(first, "name")?.to_lowercase();
        let address = base + offset;
        let Some(Declared {
            name,
            words: count,
            access,
        }) = declared.remove(&address)
        else {
            ensure!(
                !declared
                    .values()
                    .any(|register| register.name.starts_with(&format!("{peripheral_name}_"))),
                "soc.svd has `{peripheral_name}_{svd_name}` at {address:#010x}, csr.json has nothing there"
            );
            continue;
        };
        let short = name
            .strip_prefix(&format!("{peripheral_name}_"))
            .with_context(|| {
                format!("`{name}` at {address:#010x} is not of the peripheral `{peripheral_name}`")
            })?;
        let expected = if count == 1 {
            short.to_owned()
        } else {
            format!("{short}{}", count - 1)
        };
        ensure!(
            svd_name == expected,
            "{address:#010x} is `{svd_name}` in soc.svd and `{expected}` in csr.json"
        );
        let mut register = register(first, short, offset, access)?;
        for below in (0..count - 1).rev() {
            let (low_offset, low) = words.pop_first().with_context(|| {
                format!("`{name}` has {count} words in csr.json, fewer in soc.svd")
            })?;
            let low_name = child_text(low, "name")?.to_lowercase();
            ensure!(
                low_offset == offset + 4 * register.words && low_name == format!("{short}{below}"),
                "word {below} of `{name}` is expected beside its other words, soc.svd has `{low_name}` there"
            );
            let low = self::register(low, short, low_offset, access)?;
            register.words += 1;
            register.width += 32;
            register.reset = register.reset << 32 | low.reset;
        }
        registers.push(register);
    }
    Ok(registers)
}

fn register(node: Node, name: &str, offset: u32, access: Access) -> Result<Register> {
    let mut fields = Vec::new();
    for field in node.descendants().filter(|node| node.has_tag_name("field")) {
        let lsb: u32 = number(child_text(field, "lsb")?)?;
        let msb: u32 = number(child_text(field, "msb")?)?;
        let field_name = child_text(field, "name")?.to_lowercase();
        ensure!(
            lsb <= msb && msb < 32,
            "field `{field_name}` of `{name}` has the bits {msb} to {lsb}"
        );
        fields.push(Field {
            name: field_name,
            lsb,
            width: msb - lsb + 1,
            description: field_description(&flowed(
                child(field, "description").and_then(|n| n.text()),
            )),
            values: vec![],
        });
    }
    fields.sort_by_key(|field| field.lsb);
    let width = fields.last().map_or(32, |field| field.lsb + field.width);
    Ok(Register {
        name: name.to_owned(),
        offset,
        words: 1,
        access,
        reset: u64::from(number(child_text(node, "resetValue")?)?),
        width,
        description: register_description(
            name,
            &flowed(child(node, "description").and_then(|n| n.text())),
        ),
        fields,
    })
}

fn memories(csr: &Value) -> Result<Vec<Memory>> {
    let mut memories = Vec::new();
    for (name, entry) in object(csr, "memories")? {
        let at = || format!("memory `{name}` in csr.json");
        memories.push(Memory {
            name: name.clone(),
            base: u32_of(&entry["base"]).with_context(at)?,
            size: u32_of(&entry["size"]).with_context(at)?,
        });
    }
    memories.retain(|memory| memory.name != "csr");
    memories.sort_by_key(|memory| memory.base);
    Ok(memories)
}

/// Reads the numeric constants from csr.json. Interrupt numbers are left out because the peripherals have them, and the settings
/// of the BIOS's memory test because they differ between boards.
fn constants(csr: &Value) -> Result<BTreeMap<String, u32>> {
    let mut constants = BTreeMap::new();
    for (name, value) in object(csr, "constants")? {
        if value.is_number() && !name.ends_with("_interrupt") && !name.starts_with("memtest_") {
            let value = u32_of(value).with_context(|| format!("constant `{name}` in csr.json"))?;
            constants.insert(name.clone(), value);
        }
    }
    Ok(constants)
}

fn object<'a>(csr: &'a Value, name: &str) -> Result<&'a serde_json::Map<String, Value>> {
    csr[name]
        .as_object()
        .with_context(|| format!("csr.json has no object `{name}`"))
}

fn u32_of(value: &Value) -> Result<u32> {
    value
        .as_u64()
        .and_then(|number| u32::try_from(number).ok())
        .with_context(|| format!("expected a number of 32 bits, found {value}"))
}

fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn child_text<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str> {
    child(node, name)
        .and_then(|child| child.text())
        .with_context(|| format!("soc.svd: <{}> has no <{name}>", node.tag_name().name()))
}

fn number(text: &str) -> Result<u32> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.with_context(|| format!("soc.svd: expected a number of 32 bits, found `{text}`"))
}

/// Converts a description to one line, and the code quotes of reStructuredText to those of Markdown.
fn flowed(text: Option<&str>) -> String {
    text.unwrap_or_default()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace("``", "`")
}

fn first_paragraph(text: &str) -> String {
    flowed(text.trim().split("\n\n").next())
}

/// Returns the description of a field without LiteX's sentence on the trigger, which names a falling edge for every event. A
/// missing description, for which LiteX writes `None`, becomes empty.
fn field_description(text: &str) -> String {
    let text = text
        .split(" This Event is triggered")
        .next()
        .unwrap_or_default();
    if text == "None" {
        String::new()
    } else {
        text.to_owned()
    }
}

/// Returns the description of a register. Registers of an event manager get a general description, because LiteX's describes the
/// last event only. From a register of several words, LiteX's note on the bits of one word is removed.
fn register_description(name: &str, text: &str) -> String {
    match (name, text.strip_prefix("Bits ")) {
        ("ev_status", _) => "Level of each event's trigger.".to_owned(),
        ("ev_pending", _) => "Events that have occurred; writing a 1 clears an event.".to_owned(),
        ("ev_enable", _) => "Events that raise the interrupt.".to_owned(),
        (_, Some(rest)) => rest
            .split_once(". ")
            .map_or(String::new(), |(_, description)| description.to_owned()),
        (_, None) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests;
