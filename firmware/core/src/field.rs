//! Scenes that are given by a distance field instead of a mesh.
//!
//! A field is named as people type it: a kind, a colon and its numbers in world units, such as `menger:4` or
//! `cubes:2,0.5`. A [`Field`] can only be made through checks, so that what follows may rely on its ranges.

use core::fmt;

use crate::fixed::Q32_32;

/// The farthest from the origin that anything of a bounded field may be, along an axis.
pub const MAX_EXTENT: Q32_32 = Q32_32::lit("12");
/// The periods of a field that repeats itself.
pub const PERIOD: [Q32_32; 2] = [Q32_32::lit("0.25"), Q32_32::lit("16")];
/// The smallest thing.
const SMALLEST: Q32_32 = Q32_32::lit("0.01");
/// The deepest sponge.
pub const MAX_DEPTH: u8 = 6;

/// A solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Field {
    /// The Menger sponge that fills [−1, 1]³.
    Menger {
        /// How often it is hollowed out, 1 to 6.
        depth: u8,
    },
    /// A box about the origin.
    Box {
        /// Half of each side.
        half: [Q32_32; 3],
    },
    /// Cubes at all multiples of the period, in all of space.
    Cubes {
        /// From centre to centre.
        period: Q32_32,
        /// Half of a cube's side, below half the period.
        half: Q32_32,
    },
    /// A floor and a ceiling, which recede to the horizon.
    Planes {
        /// The height of the ceiling above the origin, and the depth of the floor below it.
        half: Q32_32,
    },
}

impl Field {
    /// A field whose numbers are in their ranges.
    ///
    /// # Errors
    /// The first number that is not.
    pub fn checked(self) -> Result<Self, FieldError<'static>> {
        match self {
            Self::Menger { depth } => {
                let depth = Q32_32::from_num(depth);
                check("depth", depth, [Q32_32::ONE, Q32_32::from_num(MAX_DEPTH)])?;
            }
            Self::Box { half } => {
                for side in half {
                    check("half", side, [SMALLEST, MAX_EXTENT])?;
                }
            }
            Self::Cubes { period, half } => {
                check("period", period, PERIOD)?;
                check("half", half, [SMALLEST, period / 2 - Q32_32::DELTA])?;
            }
            Self::Planes { half } => check("half", half, [SMALLEST, MAX_EXTENT])?,
        }
        Ok(self)
    }

    /// Reads a field as it is typed, such as `menger:4`.
    ///
    /// # Errors
    /// The kind is unknown, a number is missing or is none, or one is out of its range.
    pub fn parse(text: &str) -> Result<Self, FieldError<'_>> {
        let (kind, numbers) = text.split_once(':').unwrap_or((text, ""));
        let mut words = numbers.split(',').filter(|word| !word.is_empty());
        let mut next = |name| {
            let word = words.next().ok_or(FieldError::Missing { kind, name })?;
            Q32_32::from_str(word).map_err(|_| FieldError::Number { name, word })
        };
        let field = match kind {
            "menger" => {
                let depth = next("depth")?;
                // What is no such number is beyond the range.
                let whole = depth.checked_to_num().filter(|&whole: &u8| depth == whole);
                Self::Menger {
                    depth: whole.unwrap_or(0),
                }
            }
            "box" => Self::Box {
                half: [next("x")?, next("y")?, next("z")?],
            },
            "cubes" => Self::Cubes {
                period: next("period")?,
                half: next("half")?,
            },
            "planes" => Self::Planes {
                half: next("half")?,
            },
            _ => return Err(FieldError::Kind { kind }),
        };
        if let Some(word) = words.next() {
            return Err(FieldError::Extra { kind, word });
        }
        field.checked()
    }
}

fn check(
    name: &'static str,
    value: Q32_32,
    [least, most]: [Q32_32; 2],
) -> Result<(), FieldError<'static>> {
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(FieldError::Range { name, least, most })
    }
}

/// As it is typed.
impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Menger { depth } => write!(f, "menger:{depth}"),
            Self::Box { half: [x, y, z] } => write!(f, "box:{x},{y},{z}"),
            Self::Cubes { period, half } => write!(f, "cubes:{period},{half}"),
            Self::Planes { half } => write!(f, "planes:{half}"),
        }
    }
}

/// The kinds of fields as they are typed, with what each is.
pub const KINDS: [(&str, &str); 4] = [
    (
        "menger:DEPTH",
        "the Menger sponge in [-1, 1]^3, depth 1 to 6",
    ),
    ("box:X,Y,Z", "a box about the origin, by half its sides"),
    ("cubes:PERIOD,HALF", "cubes everywhere, by half their side"),
    ("planes:HALF", "a floor and a ceiling at +-HALF"),
];

/// Why something is no field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldError<'a> {
    /// No kind has this name.
    Kind {
        /// What was typed.
        kind: &'a str,
    },
    /// A number is missing.
    Missing {
        /// The kind.
        kind: &'a str,
        /// What the number means.
        name: &'static str,
    },
    /// There is a number too many.
    Extra {
        /// The kind.
        kind: &'a str,
        /// The number.
        word: &'a str,
    },
    /// Something is no number.
    Number {
        /// What the number means.
        name: &'static str,
        /// What was typed.
        word: &'a str,
    },
    /// A number is out of its range.
    Range {
        /// What the number means.
        name: &'static str,
        /// The smallest that is accepted.
        least: Q32_32,
        /// The largest.
        most: Q32_32,
    },
}

impl fmt::Display for FieldError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Kind { kind } => {
                write!(f, "no field is named {kind}: expected")?;
                KINDS.iter().enumerate().try_for_each(|(i, (form, _))| {
                    write!(f, "{} {form}", if i == 0 { "" } else { "," })
                })
            }
            Self::Missing { kind, name } => write!(f, "{kind} needs one more number: {name}"),
            Self::Extra { kind, word } => {
                write!(f, "{kind} has one number too many: {word}")
            }
            Self::Number { name, word } => write!(f, "{name} {word}: expected a number"),
            Self::Range { name, least, most } => {
                write!(f, "{name}: expected {least} to {most}")
            }
        }
    }
}

impl core::error::Error for FieldError<'_> {}
