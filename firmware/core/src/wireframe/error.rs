//! Errors in programs: the position, the expected input, and the found input.

use core::fmt;

use super::format::{MAX_SEGMENTS, Opcode, WORD_BYTES};
use crate::fixed::Q5_11;
use crate::words::Word;

/// A deviation of a program from its format, with its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramError<'a> {
    /// Position of the deviation.
    pub place: Location,
    /// The expected input and the input that was found.
    pub violation: Violation<'a>,
}

/// The position of an error in a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// A line of the text form, counted from 1.
    Line(usize),
    /// A word of the binary form, counted from 1.
    Word(usize),
}

/// A deviation from the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation<'a> {
    /// Expected input.
    pub expected: Expected,
    /// Found input.
    pub found: Found<'a>,
}

impl<'a> Violation<'a> {
    pub(super) const fn new(expected: Expected, found: Found<'a>) -> Self {
        Self { expected, found }
    }

    /// Adds the position to the error.
    pub(super) const fn at(self, place: Location) -> ProgramError<'a> {
        ProgramError {
            place,
            violation: self,
        }
    }
}

/// The expected input at the position of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// One of the opcodes.
    Opcode,
    /// One of the keywords.
    Keyword,
    /// Zeros in the bits above bit 98.
    ZerosAbove,
    /// Zeros in an unused field of the instruction.
    Unused {
        /// The kind of the instruction.
        opcode: Opcode,
        /// Number of the field, from 0.
        field: u8,
    },
    /// A word of 16 bytes.
    WholeWord,
    /// The end of the program.
    End,
    /// Exactly one instruction of this kind.
    One(Opcode),
    /// A z of the eye of at least 0.
    EyeNotNegative,
    /// A z of the eye above that of the view plane.
    EyeAbove {
        /// The z of the view plane.
        plane: Q5_11,
    },
    /// A lower corner of the window below its upper corner.
    Below {
        /// Whether the coordinate is y.
        vertical: bool,
        /// The coordinate of the upper corner.
        high: Q5_11,
    },
    /// At most [`MAX_SEGMENTS`] segments.
    AtMostSegments,
    /// A number in Q5.11.
    Number,
    /// The numbers of an instruction.
    Numbers(Opcode),
    /// The end of the line.
    EndOfLine,
}

/// The input found in place of the expected input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found<'a> {
    /// The three bits of an opcode.
    Opcode(u8),
    /// Bits that should be 0.
    Bits(u32),
    /// This count of bytes.
    Bytes(usize),
    /// A number in Q5.11.
    Number(Q5_11),
    /// This count of numbers.
    Count(usize),
    /// This word of a line.
    Word(Word<'a>),
    /// A second instruction.
    Second,
    /// No such instruction.
    None,
    /// More than expected.
    More,
    /// The end of the text or of the bytes.
    Exhausted,
}

impl fmt::Display for ProgramError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { place, violation } = self;
        write!(f, "wireframe program, {place}: {violation}")
    }
}

impl core::error::Error for ProgramError<'_> {}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Line(number) => write!(f, "line {number}"),
            Self::Word(number) => write!(f, "word {number}"),
        }
    }
}

impl fmt::Display for Violation<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "expected {}, found {}", self.expected, self.found)
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::Opcode => f.write_str("an opcode (bits 98 to 96) of 000, 001, 010, 100 or 111"),
            Self::Keyword => f.write_str("eye, plane, window, segment or end"),
            Self::ZerosAbove => f.write_str("zeros in bits 127 to 99"),
            Self::Unused { opcode, field } => {
                let low = 80 - 16 * u32::from(field);
                let ones = if opcode == Opcode::End {
                    ", or ones in bits 95 to 0"
                } else {
                    ""
                };
                write!(
                    f,
                    "zeros in the unused bits {} to {low} of {opcode}{ones}",
                    low + 15
                )
            }
            Self::WholeWord => write!(f, "a word of {WORD_BYTES} bytes"),
            Self::End => f.write_str("end"),
            Self::One(opcode) => write!(f, "one {opcode} in the program"),
            Self::EyeNotNegative => f.write_str("a z of the eye of at least 0"),
            Self::EyeAbove { plane } => {
                write!(f, "a z of the eye above that of the view plane, {plane}")
            }
            Self::Below { vertical, high } => {
                let axis = if vertical { 'y' } else { 'x' };
                write!(f, "{axis} of the window's lower corner below {high}")
            }
            Self::AtMostSegments => write!(f, "at most {MAX_SEGMENTS} segments"),
            Self::Number => write!(f, "a number from {} to {}", Q5_11::MIN, Q5_11::MAX),
            Self::Numbers(opcode) => {
                let count = opcode.fields();
                let plural = if count == 1 { "" } else { "s" };
                write!(f, "{count} number{plural} after {opcode}")
            }
            Self::EndOfLine => f.write_str("the end of the line"),
        }
    }
}

impl fmt::Display for Found<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Opcode(bits) => write!(f, "{:03b}", bits & 7),
            Self::Bits(bits) => write!(f, "{bits:#x}"),
            Self::Bytes(count) => write!(f, "{count} bytes"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Count(count) => write!(f, "{count}"),
            Self::Word(word) => write!(f, "{word}"),
            Self::Second => f.write_str("a second one"),
            Self::None => f.write_str("none"),
            Self::More => f.write_str("more"),
            Self::Exhausted => f.write_str("the end of the input"),
        }
    }
}
