//! How a line is cut into words, and words become values.

use core::fmt;

use heapless::Vec;

use super::ParseError;
use super::command::find;
use super::error::Fault;
use crate::field::KINDS;
use crate::fixed::{Q2_23, Q32_32, Turns, U4_28};
use crate::light::{self, Rgb, parse_rgb};
use crate::stereo;

/// What takes something away.
pub const OFF: &str = "off";
/// What goes back to how it was.
pub const DEFAULT: &str = "default";

/// The most arguments a command has.
pub const MAX_ARGUMENTS: usize = 14;

/// A command, as parser and help see it.
#[derive(Debug)]
pub struct Syntax {
    /// What it is called by.
    pub name: &'static str,
    /// What follows.
    pub arguments: &'static [Argument],
    /// Whether the arguments may be left out, all together.
    pub optional: bool,
    /// How many of them may be left out at the end where the others are there.
    pub spare: usize,
    /// What it does.
    pub summary: &'static str,
}

/// An argument of a command: what it is called in the help, and what it can be.
pub type Argument = (&'static str, Kind);

/// What an argument can be.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A decimal in Q32.32.
    Length,
    /// A decimal in Q2.23.
    Basis,
    /// A decimal in U4.28.
    Scale,
    /// An angle in degrees.
    Degrees,
    /// An angle in degrees, from 0 to 180.
    HalfTurn,
    /// A whole number from 0 to a limit, decimal or hexadecimal with `0x`.
    Number(u32),
    /// Up to 8 hexadecimal digits.
    Hexadecimal,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// The name of a command.
    Command,
    /// Any word.
    Name,
    /// A distance field, or `off`: any word.
    Field,
    /// Two eyes, or `off`: any word.
    Stereo,
    /// A light, or `default`: any word.
    Light,
    /// A colour, or `default`.
    Colour,
    /// The density of fog, a decimal in U4.28, or `off`.
    Fog,
}

/// The value of an argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// Of [`Kind::Length`].
    Length(Q32_32),
    /// Of [`Kind::Basis`].
    Basis(Q2_23),
    /// Of [`Kind::Scale`], and [`Kind::Fog`]: 0 is off.
    Scale(U4_28),
    /// Of [`Kind::Degrees`] and [`Kind::HalfTurn`].
    Angle(Turns),
    /// Of [`Kind::Number`] and [`Kind::Hexadecimal`].
    Number(u32),
    /// Of [`Kind::Choice`]: which one.
    Choice(usize),
    /// Of [`Kind::Colour`]: nothing is the default.
    Colour(Option<Rgb>),
    /// Of [`Kind::Command`], [`Kind::Name`], [`Kind::Field`], [`Kind::Stereo`] and [`Kind::Light`].
    Name(&'a str),
}

/// The values of a command's arguments, in their order.
pub type Values<'a> = Vec<Value<'a>, MAX_ARGUMENTS>;

impl Syntax {
    /// A command without arguments.
    pub const fn new(name: &'static str, summary: &'static str) -> Self {
        Self {
            name,
            arguments: &[],
            optional: false,
            spare: 0,
            summary,
        }
    }

    /// With arguments.
    pub const fn with(self, arguments: &'static [Argument]) -> Self {
        Self { arguments, ..self }
    }

    /// With arguments that may be left out, all together.
    pub const fn with_optional(self, arguments: &'static [Argument]) -> Self {
        Self {
            arguments,
            optional: true,
            ..self
        }
    }

    /// Of which so many may be left out at the end.
    pub const fn with_spare(self, spare: usize) -> Self {
        Self { spare, ..self }
    }

    /// Reads the arguments, all of them or as many as there have to be; or, where that is allowed, none.
    pub fn parse<'a>(&'static self, mut words: Words<'a>) -> Result<Values<'a>, ParseError<'a>> {
        let mut values = Values::new();
        for argument in self.arguments {
            let Some(word) = words.next() else {
                let is_enough = values.len() + self.spare >= self.arguments.len();
                if is_enough || self.optional && values.is_empty() {
                    break;
                }
                return Err(ParseError(Fault::Missing {
                    syntax: self,
                    argument,
                }));
            };
            let value = argument.1.parse(word.text).ok_or(ParseError(Fault::Wrong {
                syntax: self,
                argument,
                word,
            }))?;
            // A test holds every command to the limit.
            let _ = values.push(value);
        }
        match words.next() {
            Some(word) => Err(ParseError(Fault::Surplus { syntax: self, word })),
            None => Ok(values),
        }
    }
}

/// How the command is used: its name and its arguments.
impl fmt::Display for Syntax {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)?;
        let spare_from = self.arguments.len() - self.spare;
        let mut open = 0;
        for (i, (name, _)) in self.arguments.iter().enumerate() {
            let opens = i == 0 && self.optional || i >= spare_from;
            open += usize::from(opens);
            f.write_str(if opens { " [" } else { " " })?;
            f.write_str(name)?;
        }
        (0..open).try_for_each(|_| f.write_str("]"))
    }
}

impl Kind {
    fn parse(self, word: &str) -> Option<Value<'_>> {
        Some(match self {
            Self::Length => Value::Length(word.parse().ok()?),
            Self::Basis => Value::Basis(word.parse().ok().filter(|x: &Q2_23| (-2..2).contains(x))?),
            Self::Scale => Value::Scale(word.parse().ok()?),
            Self::Degrees => Value::Angle(Turns::from_degrees(word.parse().ok()?)),
            Self::HalfTurn => {
                let degrees: Q32_32 = word.parse().ok()?;
                (0..=180)
                    .contains(&degrees)
                    .then(|| Value::Angle(Turns::from_degrees(degrees)))?
            }
            Self::Number(limit) => Value::Number(number(word).filter(|&number| number <= limit)?),
            Self::Hexadecimal => {
                Value::Number(hexadecimal(word.strip_prefix("0x").unwrap_or(word))?)
            }
            Self::Choice(choices) => {
                Value::Choice(choices.iter().position(|&choice| choice == word)?)
            }
            Self::Command => Value::Name(find(word).map(|_| word)?),
            Self::Colour if word == DEFAULT => Value::Colour(None),
            Self::Colour => Value::Colour(Some(parse_rgb(word)?)),
            Self::Fog if word == OFF => Value::Scale(U4_28::ZERO),
            Self::Fog => Value::Scale(word.parse().ok()?),
            Self::Name | Self::Field | Self::Stereo | Self::Light => Value::Name(word),
        })
    }
}

/// What is expected.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Length => f.write_str("a number"),
            Self::Basis => f.write_str("a number from -2 to 2"),
            Self::Scale => f.write_str("a number from 0 to 16"),
            Self::Degrees => f.write_str("a number of degrees"),
            Self::HalfTurn => f.write_str("a number of degrees from 0 to 180"),
            Self::Number(limit) => write!(f, "a whole number from 0 to {limit}"),
            Self::Hexadecimal => f.write_str("up to 8 hexadecimal digits"),
            Self::Choice(choices) => {
                for (i, choice) in choices.iter().enumerate() {
                    write!(f, "{}{choice}", if i == 0 { "" } else { " or " })?;
                }
                Ok(())
            }
            Self::Command => f.write_str("a command, `help` lists them"),
            Self::Name => f.write_str("a name"),
            Self::Field => {
                f.write_str(OFF)?;
                KINDS
                    .iter()
                    .try_for_each(|(form, _)| write!(f, " or {form}"))
            }
            Self::Stereo => write!(f, "{OFF} or {}", stereo::FORM),
            Self::Light => write!(f, "{DEFAULT} or {}", light::FORM),
            Self::Colour => write!(f, "{DEFAULT} or a colour RRGGBB"),
            Self::Fog => write!(f, "{OFF} or a number from 0 to below 16"),
        }
    }
}

fn number(word: &str) -> Option<u32> {
    word.strip_prefix("0x")
        .map_or_else(|| digits(word, 10), hexadecimal)
}

fn hexadecimal(word: &str) -> Option<u32> {
    digits(word, 16)
}

/// Digits only: no sign.
fn digits(word: &str, radix: u32) -> Option<u32> {
    let digits = word.bytes().all(|byte| byte.is_ascii_hexdigit());
    u32::from_str_radix(word, radix).ok().filter(|_| digits)
}

/// A word and where it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word<'a> {
    /// The word.
    pub text: &'a str,
    /// Its first column, from 1.
    pub column: usize,
}

/// The words of a line.
#[derive(Clone)]
pub struct Words<'a> {
    line: &'a str,
    offset: usize,
}

impl<'a> Words<'a> {
    /// Cuts a line at its blanks.
    pub const fn new(line: &'a str) -> Self {
        Self { line, offset: 0 }
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.line.get(self.offset..)?;
        let text = rest.trim_ascii_start();
        let start = self.offset + (rest.len() - text.len());
        let text = text.split_ascii_whitespace().next()?;
        self.offset = start + text.len();
        Some(Word {
            text,
            column: start + 1,
        })
    }
}
