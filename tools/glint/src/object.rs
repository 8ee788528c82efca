//! Objects from the command line: a model and its place in the world.

use crate::error::{FormatError, quote};
use glint_core::colour::Rgb565;
use glint_core::fixed::{Q8_24, Q32_32, Turns};
use glint_core::light::parse_rgb;
use glint_core::matrix::{Axis, Matrix, MatrixError};

/// An object as it is written: `MODEL [scale S|X,Y,Z] [rotate AXIS DEGREES] [move X,Y,Z] [matrix NUMBERS] [colour RRGGBB]`.
///
/// The operations apply in their order, each to the result of those before it, and may be repeated. `matrix` has the three
/// rows of the 3×3 matrix, and the translation if there are twelve numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// A mesh file or a generator's name.
    pub model: String,
    /// The model matrix.
    pub matrix: Matrix,
    /// Colour in place of those of the model.
    pub colour: Option<Rgb565>,
}

impl Description {
    /// Parses an object.
    ///
    /// # Errors
    /// The text has another form, or a matrix is out of range or singular, which names its row.
    pub fn parse(text: &str) -> Result<Self, FormatError> {
        let mut words = text.split_whitespace();
        let model = words.next().ok_or_else(|| refuse("a model", ""))?;
        let (mut matrix, mut colour) = (Matrix::IDENTITY, None);
        while let Some(word) = words.next() {
            let mut next = |expected| words.next().ok_or_else(|| refuse(expected, ""));
            let next = match word {
                "scale" => scale(next("a scale S or X,Y,Z")?)?,
                "rotate" => {
                    let (axis, angle) = (next("an axis x, y or z")?, next("degrees")?);
                    rotation(axis, angle)?
                }
                "move" => {
                    let by: [Q8_24; 3] = numbers(next("a vector X,Y,Z")?, "a vector X,Y,Z")?;
                    Matrix::translation(by).map_err(no_matrix)?
                }
                "matrix" => of_numbers(next("9 or 12 numbers")?)?,
                "colour" => {
                    let text = next("a colour RRGGBB")?;
                    let rgb = parse_rgb(text).ok_or_else(|| refuse("a colour RRGGBB", text))?;
                    colour = Some(Rgb565::from_rgb888(rgb));
                    continue;
                }
                other => return Err(refuse("scale, rotate, move, matrix or colour", other)),
            };
            matrix = matrix.then(&next).map_err(no_matrix)?;
        }
        Ok(Self {
            model: model.to_owned(),
            matrix,
            colour,
        })
    }
}

fn scale(text: &str) -> Result<Matrix, FormatError> {
    let factors = if text.contains(',') {
        numbers(text, "a scale S or X,Y,Z")?
    } else {
        let [factor] = numbers(text, "a scale S or X,Y,Z")?;
        [factor; 3]
    };
    Matrix::scale(factors).map_err(no_matrix)
}

fn rotation(axis: &str, angle: &str) -> Result<Matrix, FormatError> {
    let axis = Axis::ALL
        .into_iter()
        .find(|known| known.name() == axis)
        .ok_or_else(|| refuse("an axis x, y or z", axis))?;
    let degrees: Option<Q32_32> = angle.parse().ok();
    let degrees = degrees.ok_or_else(|| refuse("degrees", angle))?;
    Ok(Matrix::rotation(axis, Turns::from_degrees(degrees)))
}

fn of_numbers(text: &str) -> Result<Matrix, FormatError> {
    let expected = "9 or 12 numbers from -128 to 128, separated by commas";
    let zero = Q8_24::ZERO;
    let (entries, place) = if text.split(',').count() == 12 {
        let [a, b, c, d, e, f, g, h, i, x, y, z] = numbers(text, expected)?;
        ([a, b, c, d, e, f, g, h, i], [x, y, z])
    } else {
        (numbers(text, expected)?, [zero; 3])
    };
    let [a, b, c, d, e, f, g, h, i] = entries;
    Matrix::new_checked([[a, b, c], [d, e, f], [g, h, i]], place).map_err(no_matrix)
}

fn numbers<const N: usize>(text: &str, expected: &str) -> Result<[Q8_24; N], FormatError> {
    let numbers: Option<Vec<Q8_24>> = text.split(',').map(|word| word.parse().ok()).collect();
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| refuse(expected, text))
}

fn refuse(expected: &str, text: &str) -> FormatError {
    FormatError::whole(expected, quote(text.as_bytes()))
}

fn no_matrix(error: MatrixError) -> FormatError {
    FormatError::whole("a model matrix", error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_apply_in_their_order() {
        let object = Description::parse("cube scale 0.5 rotate z 90 move 1,0,-2 colour ff8000");
        let object = object.unwrap();
        assert_eq!(
            (object.model.as_str(), object.colour),
            ("cube", Some(Rgb565(0xFC00)))
        );
        let numbers = object
            .matrix
            .linear()
            .map(|row| row.map(Q8_24::to_num::<f64>));
        assert_eq!(
            numbers,
            [[0.0, -0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5]]
        );
        let matrix = Description::parse("cube matrix 0,-0.5,0,0.5,0,0,0,0,0.5,1,0,-2").unwrap();
        assert_eq!(matrix.matrix, object.matrix);
        let moved = Description::parse("cube move 1,0,0 scale 2").unwrap();
        assert_eq!(
            moved.matrix.place().map(Q8_24::to_num::<f64>),
            [2.0, 0.0, 0.0]
        );
    }

    #[test]
    fn refused_objects() {
        for (text, expected) in [
            ("", "expected a model"),
            ("cube scale", "a scale S or X,Y,Z"),
            (
                "cube scale 0",
                "matrix row 1: (0, 0, 0): expected a length of at least 0.001",
            ),
            (
                "cube scale 1,1,17",
                "matrix row 3: (0, 0, 17): expected entries within ±16",
            ),
            ("cube scale nan", "a scale S or X,Y,Z, found 'nan'"),
            ("cube matrix 1,0,0,0,inf,0,0,0,1", "9 or 12 numbers"),
            ("cube matrix 1,0,0,0,1,0,1,1,0", "matrix row 3: singular"),
            ("cube matrix 1,0,0", "9 or 12 numbers"),
            ("cube move 33,0,0", "matrix row 1: translation 33"),
            ("cube rotate w 3", "an axis x, y or z"),
            ("cube colour red", "a colour RRGGBB"),
            ("cube spin 3", "scale, rotate, move, matrix or colour"),
        ] {
            let message = Description::parse(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
