//! Prints a peripheral's free-running counters as one type.

use std::fmt::{self, Write};

use super::super::soc::{Peripheral, Register};
use super::text::{camel, documented, identifier};

/// Prints the type `Counters` of `peripheral`, if it has any counters.
pub fn write(out: &mut String, peripheral: &Peripheral) -> fmt::Result {
    let counters = peripheral.counters();
    if counters.is_empty() {
        return Ok(());
    }
    let lines = |line: &dyn Fn(&Register, String) -> String| -> String {
        counters
            .iter()
            .map(|register| line(register, identifier(&register.name)))
            .collect()
    };
    write!(
        out,
        "
    /// A reading of the free-running counters of `{peripheral}`.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Counters {{
{fields}    }}

    impl Counters {{
        /// Reads every counter, one after the other.
        #[must_use]
        pub fn read(registers: &{handle}) -> Self {{
            Self {{
{reads}            }}
        }}

        /// The counts since the reading `earlier`, modulo 2^32.
        #[must_use]
        pub const fn since(&self, earlier: &Self) -> Self {{
            Self {{
{differences}            }}
        }}

        /// The counts of both readings together, modulo 2^32.
        #[must_use]
        pub const fn plus(&self, other: &Self) -> Self {{
            Self {{
{sums}            }}
        }}

        /// Name and value of each counter.
        pub fn iter(&self) -> impl Iterator<Item = (&'static str, u32)> {{
            [
{pairs}            ]
            .into_iter()
        }}
    }}
",
        peripheral = peripheral.name,
        handle = camel(&peripheral.name),
        fields = lines(&|register, name| format!(
            "        /// {}\n        pub {name}: u32,\n",
            documented(&register.description)
        )),
        reads = lines(&|_, name| format!("                {name}: registers.{name}().read(),\n")),
        differences = lines(&|_, name| format!(
            "                {name}: self.{name}.wrapping_sub(earlier.{name}),\n"
        )),
        sums = lines(&|_, name| format!(
            "                {name}: self.{name}.wrapping_add(other.{name}),\n"
        )),
        pairs = lines(&|register, name| format!(
            "                ({:?}, self.{name}),\n",
            register.name
        )),
    )
}
