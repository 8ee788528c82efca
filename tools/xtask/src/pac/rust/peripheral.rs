//! Prints a peripheral: its handle, an accessor for each register, and a type for the value of each register with fields.

use std::fmt::{self, Write};

use anyhow::Result;

use super::super::soc::{Access, Field, Peripheral, Register};
use super::counters;
use super::enumeration::{self, Enumeration};
use super::text::{camel, decimal, documented, hex, identifier};

/// Prints the module of `peripheral`.
///
/// # Errors
/// When two enumerations of the peripheral would have the same name.
pub fn write(out: &mut String, peripheral: &Peripheral) -> Result<()> {
    let enumerations = enumeration::of(peripheral)?;
    let (name, kind) = (&peripheral.name, camel(&peripheral.name));
    writeln!(out, "\n/// The registers of `{name}`.")?;
    if !peripheral.description.is_empty() {
        writeln!(out, "///\n/// {}", documented(&peripheral.description))?;
    }
    writeln!(out, "pub mod {name} {{")?;
    writeln!(
        out,
        "    use crate::register::{{{}}};\n",
        imports(peripheral).join(", ")
    )?;
    write!(
        out,
        "    /// Access to `{name}`.
    pub struct {kind} {{
        _private: (),
    }}

    impl {kind} {{
        /// Address of the first register.
        pub const BASE: usize = {base};

{constants}        /// Another handle, beside the one that [`Peripherals::take`](crate::Peripherals::take) hands out.
        ///
        /// # Safety
        /// The holders of the handles must tolerate each other's changes to the registers.
        #[must_use]
        pub const unsafe fn steal() -> Self {{
            Self {{ _private: () }}
        }}
",
        base = hex(peripheral.base),
        constants = constants(peripheral),
    )?;
    for register in &peripheral.registers {
        write_accessor(out, peripheral.base, register)?;
    }
    writeln!(out, "    }}")?;
    write_offsets(out, peripheral)?;
    for register in peripheral
        .registers
        .iter()
        .filter(|register| !register.fields.is_empty())
    {
        write_value(out, register, &enumerations)?;
    }
    for enumeration in &enumerations {
        enumeration::write(out, enumeration)?;
    }
    counters::write(out, peripheral)?;
    writeln!(out, "}}")?;
    Ok(())
}

/// Prints the block's identifier and its other constants.
fn constants(peripheral: &Peripheral) -> String {
    let ident = peripheral.registers.iter().find(|r| r.name == "ident");
    let ident = ident.map(|register| {
        (
            "Value of `ident` where the block is present.".to_owned(),
            "IDENT".to_owned(),
            // The register `ident` has one word, so its reset value has 32 bits.
            hex(register.reset as u32),
        )
    });
    let others = peripheral.constants.iter().map(|constant| {
        (
            documented(&constant.text),
            constant.name.to_uppercase(),
            decimal(constant.value),
        )
    });
    ident
        .into_iter()
        .chain(others)
        .map(|(text, name, value)| {
            format!("        /// {text}\n        pub const {name}: u32 = {value};\n\n")
        })
        .collect()
}

/// The items of `crate::register` that the generated module of `peripheral` uses.
fn imports(peripheral: &Peripheral) -> Vec<&'static str> {
    let any = |test: fn(&Register) -> bool| peripheral.registers.iter().any(test);
    let mut names = Vec::new();
    if any(|register| register.access == Access::ReadOnly) {
        names.push("ReadOnly");
    }
    if any(|register| register.access == Access::ReadWrite) {
        names.push("ReadWrite");
    }
    if any(|register| register.words == 1) {
        names.push("Register");
    }
    if any(|register| !register.fields.is_empty()) {
        names.push("Value");
    }
    if any(|register| register.words == 2) {
        names.push("WideRegister");
    }
    names
}

fn write_accessor(out: &mut String, base: u32, register: &Register) -> fmt::Result {
    let access = match register.access {
        Access::ReadOnly => "ReadOnly",
        Access::ReadWrite => "ReadWrite",
    };
    let bits = if register.width == 1 {
        "1 bit".to_owned()
    } else {
        format!("{} bits", register.width)
    };
    let kind = if register.words == 2 {
        format!("WideRegister<{access}>")
    } else if register.fields.is_empty() {
        format!("Register<{}, {access}>", integer(register.width))
    } else {
        format!("Register<{}, {access}>", camel(&register.name))
    };
    writeln!(out)?;
    match register.description.as_str() {
        "" => writeln!(out, "        /// `{}`, {bits}.", register.name)?,
        description => writeln!(
            out,
            "        /// `{}`, {bits}: {}",
            register.name,
            documented(description)
        )?,
    }
    writeln!(out, "        #[inline]")?;
    writeln!(out, "        #[must_use]")?;
    writeln!(
        out,
        "        pub const fn {}(&self) -> {kind} {{",
        identifier(&register.name)
    )?;
    writeln!(
        out,
        "            // SAFETY: the SoC's description has this register, of this width, at this address."
    )?;
    let constructor = kind.split_once('<').map_or(kind.as_str(), |(name, _)| name);
    writeln!(
        out,
        "            unsafe {{ {constructor}::at({}) }}",
        hex(base + register.offset)
    )?;
    writeln!(out, "        }}")
}

/// Prints the offsets of the registers, for a model of the block.
fn write_offsets(out: &mut String, peripheral: &Peripheral) -> fmt::Result {
    write!(
        out,
        "
    /// Offset of each register from the first one in bytes; a register of two words has its high word there.
    pub mod offset {{
"
    )?;
    for register in &peripheral.registers {
        writeln!(out, "        /// `{}`.", register.name)?;
        writeln!(
            out,
            "        pub const {}: u32 = {};",
            register.name.to_uppercase(),
            hex(register.offset)
        )?;
    }
    writeln!(out, "    }}")
}

/// Prints the type for the value of a register with fields. A register that is read-only has setters too: a model of the block sets
/// them.
fn write_value(out: &mut String, register: &Register, enumerations: &[Enumeration]) -> fmt::Result {
    let kind = camel(&register.name);
    writeln!(out, "\n    /// A value of `{}`.", register.name)?;
    writeln!(
        out,
        "    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]"
    )?;
    writeln!(out, "    pub struct {kind}(u32);\n")?;
    writeln!(out, "    impl Value for {kind} {{")?;
    writeln!(out, "        fn from_bits(bits: u32) -> Self {{")?;
    writeln!(out, "            Self(bits)")?;
    writeln!(out, "        }}\n")?;
    writeln!(out, "        fn bits(self) -> u32 {{")?;
    writeln!(out, "            self.0")?;
    writeln!(out, "        }}")?;
    writeln!(out, "    }}\n")?;
    writeln!(out, "    impl {kind} {{")?;
    for (index, field) in register.fields.iter().enumerate() {
        if index > 0 {
            writeln!(out)?;
        }
        let enumeration = enumerations.iter().find(|e| e.is_of(field));
        write_getter(out, field, enumeration)?;
        write_setter(out, field, enumeration)?;
    }
    writeln!(out, "    }}")
}

fn write_getter(out: &mut String, field: &Field, enumeration: Option<&Enumeration>) -> fmt::Result {
    let Field { name, lsb, .. } = field;
    let place = if field.width == 1 {
        format!("bit {lsb}")
    } else {
        format!("bits {} to {lsb}", lsb + field.width - 1)
    };
    match field.description.as_str() {
        "" => writeln!(out, "        /// `{name}`, {place}.")?,
        description => writeln!(
            out,
            "        /// `{name}`, {place}: {}",
            documented(description)
        )?,
    }
    let shifted = match lsb {
        0 => "self.0".to_owned(),
        _ => format!("(self.0 >> {lsb})"),
    };
    let (plain, mask) = (integer(field.width), hex(u32::MAX >> (32 - field.width)));
    let (kind, value) = match (enumeration, plain) {
        (Some(enumeration), _) => (
            match enumeration.is_total() {
                true => enumeration.kind.clone(),
                false => format!("Option<{}>", enumeration.kind),
            },
            format!(
                "{}::from_bits(({shifted} & {mask}) as u8)",
                enumeration.kind
            ),
        ),
        (None, "bool") => (plain.to_owned(), format!("{shifted} & 1 != 0")),
        (None, "u32") => (plain.to_owned(), format!("{shifted} & {mask}")),
        (None, _) => (plain.to_owned(), format!("({shifted} & {mask}) as {plain}")),
    };
    writeln!(out, "        #[inline]")?;
    writeln!(out, "        #[must_use]")?;
    writeln!(
        out,
        "        pub const fn {}(self) -> {kind} {{",
        identifier(name)
    )?;
    writeln!(out, "            {value}")?;
    writeln!(out, "        }}")
}

fn write_setter(out: &mut String, field: &Field, enumeration: Option<&Enumeration>) -> fmt::Result {
    let Field {
        name, lsb, width, ..
    } = field;
    let plain = integer(*width);
    let (kind, kept) = match enumeration {
        Some(enumeration) => (enumeration.kind.as_str(), String::new()),
        None => (plain, kept(*width)),
    };
    let (cast, mask) = (
        if kind == "u32" {
            "value"
        } else {
            "value as u32"
        },
        hex(u32::MAX >> (32 - width)),
    );
    writeln!(out, "\n        /// This value with another `{name}`{kept}.")?;
    writeln!(out, "        #[inline]")?;
    writeln!(out, "        #[must_use]")?;
    writeln!(
        out,
        "        pub const fn with_{name}(self, value: {kind}) -> Self {{"
    )?;
    if *lsb == 0 {
        writeln!(out, "            Self(self.0 & !{mask} | {cast} & {mask})")?;
    } else {
        writeln!(
            out,
            "            Self(self.0 & !({mask} << {lsb}) | ({cast} & {mask}) << {lsb})"
        )?;
    }
    writeln!(out, "        }}")
}

/// The part of a setter's rustdoc that states which bits of the argument are used.
fn kept(width: u32) -> String {
    match width {
        1 | 8 | 16 | 32 => String::new(),
        _ => format!(": the low {width} bits of `value`"),
    }
}

/// The smallest Rust type that holds `width` bits.
fn integer(width: u32) -> &'static str {
    match width {
        1 => "bool",
        2..=8 => "u8",
        9..=16 => "u16",
        _ => "u32",
    }
}
