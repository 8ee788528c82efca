//! Values of a PLY's body, ASCII or binary.

use super::header::Scalar;
use crate::error::{FormatError, Location, quote};
use crate::formats::text::{Lines, Words, any_number};

/// The values of a PLY's elements in file order.
pub trait Source {
    /// Starts the next instance of an element, which is a row of its table.
    fn start(&mut self) -> Result<(), FormatError>;
    /// Reads the next value of the instance.
    fn value(&mut self, scalar: Scalar) -> Result<f64, FormatError>;
    /// Ends the instance. In an ASCII file the line must end here.
    fn end(&mut self) -> Result<(), FormatError>;
    /// The position of the next value.
    fn place(&self) -> Location;
}

/// Values as decimal words, with one line per instance of an element. A line may have any length,
/// because a triangle strip is one line.
pub struct AsciiSource<'a> {
    words: Words<'a>,
    /// The line of the instance.
    number: usize,
}

impl<'a> AsciiSource<'a> {
    /// Creates the source from the lines after the header.
    pub fn new(lines: Lines<'a>) -> Self {
        Self {
            words: Words::after(lines),
            number: 0,
        }
    }
}

impl Source for AsciiSource<'_> {
    fn start(&mut self) -> Result<(), FormatError> {
        if !self.words.skip_blank_lines() {
            return Err(FormatError::new(
                self.place(),
                "as many elements as the header declares",
                "the end of the file",
            ));
        }
        self.number = self.words.line();
        Ok(())
    }

    fn value(&mut self, scalar: Scalar) -> Result<f64, FormatError> {
        let place = self.place();
        let word = self.words.next_on_line();
        let word =
            word.ok_or_else(|| FormatError::new(place, scalar.describe(), "the end of the line"))?;
        any_number(word)
            .filter(|value| scalar.holds(*value))
            .ok_or_else(|| FormatError::new(place, scalar.describe(), quote(word)))
    }

    fn end(&mut self) -> Result<(), FormatError> {
        match self.words.next_on_line() {
            None => Ok(()),
            Some(word) => Err(FormatError::new(
                self.place(),
                "the end of the line",
                quote(word),
            )),
        }
    }

    fn place(&self) -> Location {
        Location::Line(self.number)
    }
}

/// Values as bytes, without padding.
pub struct BinarySource<'a> {
    file: &'a [u8],
    offset: usize,
    big_endian: bool,
}

impl<'a> BinarySource<'a> {
    /// Creates the source from the bytes of `file` from `offset` on.
    pub fn new(file: &'a [u8], offset: usize, big_endian: bool) -> Self {
        Self {
            file,
            offset,
            big_endian,
        }
    }
}

impl Source for BinarySource<'_> {
    fn start(&mut self) -> Result<(), FormatError> {
        Ok(())
    }

    fn value(&mut self, scalar: Scalar) -> Result<f64, FormatError> {
        let size = scalar.size();
        let bytes = self
            .file
            .get(self.offset..self.offset + size)
            .ok_or_else(|| {
                FormatError::new(self.place(), scalar.describe(), "the end of the file")
            })?;
        self.offset += size;
        let mut raw = [0; 8];
        raw[..size].copy_from_slice(bytes);
        if self.big_endian {
            raw[..size].reverse();
        }
        Ok(scalar.decode(raw))
    }

    fn end(&mut self) -> Result<(), FormatError> {
        Ok(())
    }

    fn place(&self) -> Location {
        Location::Byte(self.offset)
    }
}
