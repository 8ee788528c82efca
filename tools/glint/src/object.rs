//! Objects on the command line: a model with its model matrix and its colour.

use crate::error::{FormatError, quote};
use glint_core::object::{Place, PlaceError};
use glint_core::words::Words;

/// An object on the command line: `MODEL` and the operations of a [`Place`].
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// A mesh file or a generator's name.
    pub model: String,
    /// Model matrix and colour.
    pub place: Place,
}

impl Description {
    /// Parses an object.
    ///
    /// # Errors
    /// The text has another form, or a matrix is out of range or singular; the error names the matrix row.
    pub fn parse(text: &str) -> Result<Self, FormatError> {
        let mut words = Words::new(text);
        let model = words.next();
        let model = model.ok_or_else(|| FormatError::whole("a model", quote(b"")))?;
        let place = Place::parse(&mut words).map_err(|error| match error {
            PlaceError::Word { expected, found } => {
                let found = found.map_or("", |word| word.text);
                FormatError::whole(expected, quote(found.as_bytes()))
            }
            PlaceError::Matrix(error) => FormatError::whole("a model matrix", error.to_string()),
        })?;
        Ok(Self {
            model: model.text.to_owned(),
            place,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glint_core::colour::Rgb565;
    use glint_core::fixed::Q8_24;

    #[test]
    fn operations_apply_in_their_order() {
        let object = Description::parse("cube scale 0.5 rotate z 90 move 1,0,-2 colour ff8000");
        let object = object.unwrap();
        assert_eq!(object.model, "cube");
        assert_eq!(object.place.colour, Some(Rgb565(0xFC00)));
        let rows = object.place.matrix.linear();
        let rows = rows.map(|row| row.map(Q8_24::to_num::<f64>));
        let expected = [[0.0, -0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5]];
        assert_eq!(rows, expected);
        let matrix = Description::parse("cube matrix 0,-0.5,0,0.5,0,0,0,0,0.5,1,0,-2").unwrap();
        assert_eq!(matrix.place.matrix, object.place.matrix);
        let moved = Description::parse("cube move 1,0,0 scale 2").unwrap();
        let place = moved.place.matrix.place().map(Q8_24::to_num::<f64>);
        assert_eq!(place, [2.0, 0.0, 0.0]);
    }

    #[test]
    fn refused_objects() {
        let cases = "
            → expected a model
            cube scale → a scale S or X,Y,Z
            cube scale 0 → matrix row 1: (0, 0, 0): expected a length of at least 0.001
            cube scale 1,1,17 → matrix row 3: (0, 0, 17): expected entries within ±16
            cube scale nan → a scale S or X,Y,Z, found 'nan'
            cube matrix 1,0,0,0,inf,0,0,0,1 → 9 or 12 numbers
            cube matrix 1,0,0,0,1,0,1,1,0 → matrix row 3: singular
            cube matrix 1,0,0 → 9 or 12 numbers
            cube move 33,0,0 → matrix row 1: translation 33
            cube rotate w 3 → an axis x, y or z
            cube colour red → a colour RRGGBB
            cube spin 3 → scale, rotate, move, matrix or colour
        ";
        for case in cases.lines().filter_map(|case| case.split_once('→')) {
            let (text, expected) = (case.0.trim(), case.1.trim());
            let message = Description::parse(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
