//! Errors in the text form of a distance field.

use core::fmt;

use crate::feature::Feature;
use crate::fixed::Q32_32;

/// Reason why a text is not the text form of a distance field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldError<'a> {
    /// The name of the kind is unknown.
    Kind {
        /// The word before the colon.
        kind: &'a str,
        /// Text form and description of every kind.
        kinds: &'static [(&'static str, &'static str)],
    },
    /// This build lacks this kind of field.
    LeftOut {
        /// Name of the kind.
        kind: &'a str,
        /// The feature that contains the kind.
        feature: Feature,
    },
    /// A number is missing.
    Missing {
        /// Name of the kind.
        kind: &'a str,
        /// Name of the number.
        name: &'static str,
    },
    /// A number is surplus.
    Extra {
        /// Name of the kind.
        kind: &'a str,
        /// The first surplus word.
        word: &'a str,
    },
    /// A word is not a number.
    Number {
        /// Name of the number.
        name: &'static str,
        /// The word that was given.
        word: &'a str,
    },
    /// The text of a union does not name two kinds that a union accepts.
    Union,
    /// The text of a smooth union does not name two kinds that a smooth union accepts.
    Smooth,
    /// The text of a bent union does not name two kinds that a bent union accepts.
    Bent,
    /// The number of spheres is 0, or above this number: [`MAX_SPHERES`](super::MAX_SPHERES), or one less
    /// in a union with a lattice.
    Spheres(usize),
    /// A number is out of its range.
    Range {
        /// Name of the number.
        name: &'static str,
        /// Smallest accepted value.
        least: Q32_32,
        /// Largest accepted value.
        most: Q32_32,
    },
}

impl fmt::Display for FieldError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Kind { kind, kinds } => {
                match kind.is_empty() {
                    true => f.write_str("the name of the field is empty: expected")?,
                    false => write!(f, "no field is named {kind}: expected")?,
                }
                kinds.iter().enumerate().try_for_each(|(i, (form, _))| {
                    write!(f, "{} {form}", if i == 0 { "" } else { "," })
                })
            }
            Self::LeftOut { kind, feature } => write!(f, "{kind}: {feature}"),
            Self::Missing { kind, name } => write!(f, "{kind} needs one more number: {name}"),
            Self::Extra { kind, word } => {
                write!(f, "{kind} has one number too many: {word}")
            }
            Self::Number { name, word } => write!(f, "{name} {word}: expected a number"),
            Self::Union => f.write_str(
                "union: expected menger, box, cubes, boxes, planes or lattice, +, and sphere, spheres, moving or cone",
            ),
            Self::Smooth => {
                f.write_str("smooth: expected menger or box, +, and sphere, spheres or moving")
            }
            Self::Bent => f.write_str(
                "bent: expected menger or box, +, and sphere, spheres or moving",
            ),
            Self::Spheres(most) => write!(f, "spheres: expected 1 to {most}"),
            Self::Range { name, least, most } => {
                write!(f, "{name}: expected {least} to {most}")
            }
        }
    }
}

impl core::error::Error for FieldError<'_> {}
