//! Prints the enumerated values of fields as enumerations.

use std::fmt::{self, Write};

use anyhow::{Result, ensure};

use super::super::description::NamedValue;
use super::super::soc::{Field, Peripheral};
use super::text::{camel, documented, sentence};

/// A set of named values, and the fields that hold one of them.
pub struct Enumeration<'s> {
    /// Name of the enumeration's Rust type.
    pub kind: String,
    /// Width in bits of the fields that hold one of the values.
    width: u32,
    values: &'s [NamedValue],
    /// The fields that hold one of the values, as `register.field`.
    fields: Vec<String>,
}

impl Enumeration<'_> {
    /// Whether every number that fits the field is one of the named values.
    pub fn is_total(&self) -> bool {
        self.values.len() as u64 == 1 << self.width
    }

    /// Whether `field` has the same width and named values as this enumeration.
    pub fn is_of(&self, field: &Field) -> bool {
        !field.values.is_empty() && self.width == field.width && self.values == field.values
    }
}

/// Returns the enumerations of a peripheral. Fields with the same values share an enumeration. Its name is made of the last words
/// that the names of these fields have in common.
///
/// # Errors
/// When the name is taken already, or the names of fields that share an enumeration do not end in the same word.
pub fn of(peripheral: &Peripheral) -> Result<Vec<Enumeration<'_>>> {
    let mut enumerations: Vec<(Enumeration, &str)> = vec![];
    for register in &peripheral.registers {
        for field in register.fields.iter().filter(|f| !f.values.is_empty()) {
            let place = format!("{}.{}", register.name, field.name);
            match enumerations.iter_mut().find(|(e, _)| e.is_of(field)) {
                Some((enumeration, suffix)) => {
                    enumeration.fields.push(place);
                    *suffix = common_suffix(suffix, &field.name);
                }
                None => enumerations.push((
                    Enumeration {
                        kind: String::new(),
                        width: field.width,
                        values: &field.values,
                        fields: vec![place],
                    },
                    &field.name,
                )),
            }
        }
    }
    let mut taken: Vec<_> = peripheral
        .registers
        .iter()
        .map(|register| camel(&register.name))
        .chain(["Counters".to_owned(), camel(&peripheral.name)])
        .collect();
    enumerations
        .into_iter()
        .map(|(enumeration, suffix)| {
            let kind = camel(suffix);
            ensure!(
                !kind.is_empty() && !taken.contains(&kind),
                "the values of {} of `{}` would be the type `{kind}`, expected a name that is not taken",
                enumeration.fields.join(", "),
                peripheral.name
            );
            taken.push(kind.clone());
            Ok(Enumeration { kind, ..enumeration })
        })
        .collect()
}

/// The longest sequence of whole words, separated by `_`, in which both names end.
fn common_suffix<'n>(name: &'n str, other: &str) -> &'n str {
    let words = name.rsplit('_').zip(other.rsplit('_'));
    let letters: usize = words
        .take_while(|(a, b)| a == b)
        .map(|(word, _)| word.len() + 1)
        .sum();
    &name[name.len() - letters.saturating_sub(1)..]
}

/// Prints the type of `enumeration`.
pub fn write(out: &mut String, enumeration: &Enumeration) -> fmt::Result {
    let Enumeration {
        kind,
        values,
        fields,
        ..
    } = enumeration;
    let fields: Vec<_> = fields.iter().map(|field| format!("`{field}`")).collect();
    let count = values.len();
    let list = |item: &dyn Fn(&NamedValue) -> String| -> String {
        values.iter().map(item).collect::<Vec<_>>().join(", ")
    };
    let arms = |arm: &dyn Fn(&NamedValue) -> String| -> String {
        values
            .iter()
            .map(|value| format!("                {},\n", arm(value)))
            .collect()
    };
    let variants: String = values
        .iter()
        .map(|NamedValue { value, name, text }| {
            format!(
                "        /// {}\n        {} = {value},\n",
                sentence(&documented(text)),
                camel(name)
            )
        })
        .collect();
    write!(
        out,
        "\n    /// Values of {}.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u8)]
    pub enum {kind} {{
{variants}    }}

    impl {kind} {{
        /// Every value, in the order of the gateware's description.
        pub const ALL: [Self; {count}] = [{}];
",
        fields.join(" and "),
        list(&|value| format!("Self::{}", camel(&value.name)))
    )?;
    if enumeration.is_total() {
        let (last, others) = values.split_last().expect("an enumeration has values");
        let arms: String = others
            .iter()
            .map(|v| format!("                {} => Self::{},\n", v.value, camel(&v.name)))
            .collect();
        write!(
            out,
            "
        /// Returns the value for a field's `bits`. Bits above the field's width are ignored.
        #[inline]
        #[must_use]
        pub const fn from_bits(bits: u8) -> Self {{
            match bits & {:#x} {{
{arms}                _ => Self::{},
            }}
        }}
",
            (1_u32 << enumeration.width) - 1,
            camel(&last.name)
        )?;
    } else {
        write!(
            out,
            "
        /// The value of a field's `bits`; `None` where the gateware has no name for them.
        #[inline]
        #[must_use]
        pub const fn from_bits(bits: u8) -> Option<Self> {{
            Some(match bits {{
{}                _ => return None,
            }})
        }}
",
            arms(&|v| format!("{} => Self::{}", v.value, camel(&v.name)))
        )?;
    }
    write!(
        out,
        "
        /// Its name in the gateware's description.
        #[must_use]
        pub const fn name(self) -> &'static str {{
            match self {{
{}            }}
        }}

        /// Its text in the gateware's description.
        #[must_use]
        pub const fn text(self) -> &'static str {{
            match self {{
{}            }}
        }}
    }}
",
        arms(&|v| format!("Self::{} => {:?}", camel(&v.name), v.name)),
        arms(&|v| format!("Self::{} => {:?}", camel(&v.name), v.text)),
    )
}

#[cfg(test)]
mod tests {
    use super::common_suffix;

    #[test]
    fn names_share_whole_words_at_their_end() {
        assert_eq!(common_suffix("geometry_error", "raster_error"), "error");
        assert_eq!(common_suffix("size", "size"), "size");
        assert_eq!(common_suffix("frame_size", "size"), "size");
        assert_eq!(common_suffix("mistake", "stake"), "");
    }
}
