//! Types with a fixed list of named values, such as material and backend, and their names.

use core::fmt::{self, Display};

/// A type with a fixed list of values. Each value has a name for the console and the command line of `glint`.
pub trait Choice: Copy + 'static {
    /// All values.
    const VALUES: &'static [Self];
    /// Names of the values in [`VALUES`](Self::VALUES), in the same order.
    const WORDS: &'static [&'static str];

    /// Returns the value with the name `word`; `None` for an unknown name.
    fn from_word(word: &str) -> Option<Self> {
        Self::VALUES.get(position(Self::WORDS, word)?).copied()
    }
}

#[inline(never)]
fn position(words: &[&str], word: &str) -> Option<usize> {
    words.iter().position(|&known| known == word)
}

/// Defines the names of an enumeration's values: `choices!(Type { Variant: "name", … })`.
///
/// Generates the constants `ALL` and `NAMES`, the method `name`, and the implementations of `Display` and [`Choice`].
macro_rules! choices {
    ($type:ident { $($variant:ident: $name:literal),+ $(,)? }) => {
        impl $type {
            /// All values.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];
            /// Names of the values in [`ALL`](Self::ALL), in the same order.
            pub const NAMES: [&'static str; Self::ALL.len()] = [$($name),+];

            /// The value's name on the console and on the command line.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }

        impl ::core::fmt::Display for $type {
            fn fmt(&self, f: &mut ::core::fmt::Formatter) -> ::core::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl $crate::choice::Choice for $type {
            const VALUES: &'static [Self] = &Self::ALL;
            const WORDS: &'static [&'static str] = &Self::NAMES;
        }
    };
}
pub(crate) use choices;

impl Choice for bool {
    const VALUES: &'static [Self] = &[true, false];
    const WORDS: &'static [&'static str] = &["on", "off"];
}

/// Returns the console's word for the state of a switch: `on` or `off`.
pub const fn switch_name(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// Displays a value, or this word for `None`.
#[derive(PartialEq)]
pub struct OrWord<T>(pub Option<T>, pub &'static str);

impl<T: Display> Display for OrWord<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.0 {
            Some(value) => value.fmt(f),
            None => f.write_str(self.1),
        }
    }
}
