//! Text form of objects on the console and the command line: operations that compose the model matrix of a mesh.

use core::fmt;

use crate::choice::{Choice, choices};
use crate::colour::Rgb565;
use crate::fixed::{Q8_24, Q32_32, Turns, parse_i32};
use crate::light::parse_rgb;
use crate::matrix::{Axis, Matrix, MatrixError};
use crate::words::{Word, Words};

/// The placement of an object: its model matrix and its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Model matrix from the coordinates of the mesh to those of the world.
    pub matrix: Matrix,
    /// Colour that replaces the colours of the mesh.
    pub colour: Option<Rgb565>,
}

/// An operation on a placement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// `scale S` or `scale X,Y,Z`.
    Scale,
    /// `rotate AXIS DEGREES`.
    Rotate,
    /// `move X,Y,Z`.
    Move,
    /// `matrix NUMBERS`: the three rows of the 3×3 matrix, and the translation if there are twelve numbers.
    Matrix,
    /// `colour RRGGBB`.
    Colour,
}

choices!(Operation {
    Scale: "scale",
    Rotate: "rotate",
    Move: "move",
    Matrix: "matrix",
    Colour: "colour",
});

/// Largest number of objects in a scene.
pub const MAX_OBJECTS: usize = 16;

const AXIS: &str = "an axis x, y or z";
const COLOUR: &str = "a colour RRGGBB";
const DEGREES: &str = "degrees";
const NUMBERS: &str = "9 or 12 numbers from -128 to 128, separated by commas";
const OPERATION: &str = "scale, rotate, move, matrix or colour";
const SCALE: &str = "a scale S or X,Y,Z";
const VECTOR: &str = "a vector X,Y,Z";

impl Default for Place {
    /// The identity matrix, with the colours of the mesh.
    fn default() -> Self {
        Self {
            matrix: Matrix::IDENTITY,
            colour: None,
        }
    }
}

impl Place {
    /// Parses operations up to the end of `words`. Each operation applies to the result of the operations before it.
    ///
    /// # Errors
    /// The text has another form, or a matrix is out of range or singular (the error names its row).
    pub fn parse<'a>(words: &mut Words<'a>) -> Result<Self, PlaceError<'a>> {
        let mut place = Self::default();
        while let Some(word) = words.next() {
            let operation = Operation::from_word(word.text).ok_or(PlaceError::Word {
                expected: OPERATION,
                found: Some(word),
            })?;
            let next = Self::of(operation, words)?;
            place = place.then(&next).map_err(PlaceError::Matrix)?;
        }
        Ok(place)
    }

    /// Parses the arguments of one operation, and applies the operation to the default placement.
    ///
    /// # Errors
    /// The errors of [`parse`](Self::parse).
    // Not inlined, so that the firmware contains one copy.
    #[inline(never)]
    pub fn of<'a>(operation: Operation, words: &mut Words<'a>) -> Result<Self, PlaceError<'a>> {
        let mut place = Self::default();
        place.matrix = match operation {
            Operation::Scale => {
                let factors = read(words, SCALE, |text| {
                    let factor = || parse_i32(text).map(|factor| [factor; 3]);
                    numbers(text).or_else(factor)
                })?;
                Matrix::scale(factors)
            }
            Operation::Rotate => {
                let axis = read(words, AXIS, Axis::from_word)?;
                let degrees = read(words, DEGREES, |text| text.parse::<Q32_32>().ok())?;
                Ok(Matrix::rotation(axis, Turns::from_degrees(degrees)))
            }
            Operation::Move => Matrix::translation(read(words, VECTOR, numbers)?),
            Operation::Matrix => {
                let (entries, by) = read(words, NUMBERS, |text| {
                    let rows = numbers(text).map(|rows: [_; 9]| (rows, [Q8_24::ZERO; 3]));
                    let all = || {
                        let [a, b, c, d, e, f, g, h, i, x, y, z] = numbers(text)?;
                        Some(([a, b, c, d, e, f, g, h, i], [x, y, z]))
                    };
                    rows.or_else(all)
                })?;
                let [a, b, c, d, e, f, g, h, i] = entries;
                Matrix::new_checked([[a, b, c], [d, e, f], [g, h, i]], by)
            }
            Operation::Colour => {
                let rgb = read(words, COLOUR, parse_rgb)?;
                place.colour = Some(Rgb565::from_rgb888(rgb));
                Ok(place.matrix)
            }
        }
        .map_err(PlaceError::Matrix)?;
        Ok(place)
    }

    /// Composes two placements: this placement is applied first, `next` second. The colour of `next` replaces the current colour,
    /// if set.
    ///
    /// # Errors
    /// The matrix is out of range or singular.
    pub fn then(&self, next: &Self) -> Result<Self, MatrixError> {
        Ok(Self {
            matrix: self.matrix.then(&next.matrix)?,
            colour: next.colour.or(self.colour),
        })
    }
}

/// Writes the placement as operations that [`Place::parse`] reads back.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("matrix ")?;
        let (rows, by) = (self.matrix.linear(), self.matrix.place());
        let numbers = rows.as_flattened().iter().chain(&by);
        for (i, number) in numbers.enumerate() {
            write!(f, "{}{number}", if i == 0 { "" } else { "," })?;
        }
        match self.colour {
            Some(colour) => {
                let [r, g, b] = colour.to_rgb888();
                write!(f, " colour {r:02x}{g:02x}{b:02x}")
            }
            None => Ok(()),
        }
    }
}

/// Takes the next word and parses it.
fn read<'a, T>(
    words: &mut Words<'a>,
    expected: &'static str,
    parse: impl Fn(&'a str) -> Option<T>,
) -> Result<T, PlaceError<'a>> {
    let found = words.next();
    found
        .and_then(|word| parse(word.text))
        .ok_or(PlaceError::Word { expected, found })
}

/// Parses exactly `N` numbers, separated by commas.
fn numbers<const N: usize>(text: &str) -> Option<[Q8_24; N]> {
    let mut words = text.split(',');
    let mut numbers = [Q8_24::ZERO; N];
    for number in &mut numbers {
        *number = parse_i32(words.next()?)?;
    }
    words.next().is_none().then_some(numbers)
}

/// Reason why words do not describe the placement of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceError<'a> {
    /// Another word was expected.
    Word {
        /// Description of the expected word.
        expected: &'static str,
        /// The word; `None` for the end of the line.
        found: Option<Word<'a>>,
    },
    /// The model matrix is out of range or singular.
    Matrix(MatrixError),
}

impl fmt::Display for PlaceError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Word {
                expected,
                found: Some(word),
            } => write!(f, "{word}: expected {expected}"),
            Self::Word {
                expected,
                found: None,
            } => write!(f, "end of the line: expected {expected}"),
            Self::Matrix(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for PlaceError<'_> {}
