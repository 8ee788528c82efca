//! What is wrong with an input, where, what was expected and what came: always one line.

use std::fmt;

/// The largest file that is read, in bytes. An ASCII STL as large as this holds about as many triangles as a board's mesh
/// memory.
pub const MAX_FILE: usize = 512 << 20;
/// The longest line of a text file, in bytes (a polygon of [`MAX_POLYGON`] corners fits).
pub const MAX_LINE: usize = 64 << 10;
/// The most points a mesh may have: three for each of [`MAX_TRIANGLES`].
pub const MAX_POINTS: usize = 3 * MAX_TRIANGLES;
/// The most triangles a mesh may have: as many 16-byte records as a board's 32 MiB of mesh memory holds.
pub const MAX_TRIANGLES: usize = 1 << 21;
/// The most corners one polygon may have; ear clipping takes a time of this squared.
pub const MAX_POLYGON: usize = 8192;
/// The largest magnitude of a coordinate. Larger ones are read as damage: no unit makes a thing this large.
pub const MAX_COORDINATE: f64 = 1e15;

/// Where in an input something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    Whole,
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A cell of a table: its line, counted from 1, and the name of its column.
    Cell(usize, &'static str),
    /// An offset in bytes from the file's start.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Whole => Ok(()),
            Place::Line(number) => write!(f, "line {number}: "),
            Place::Cell(line, column) => write!(f, "line {line}, column {column}: "),
            Place::Byte(offset) => write!(f, "byte {offset}: "),
        }
    }
}

/// An input that is not what its format says.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}expected {expected}, found {found}")]
pub struct FormatError {
    /// Where it is.
    pub place: Place,
    /// What should have been there.
    pub expected: String,
    /// What was there.
    pub found: String,
}

impl FormatError {
    /// Makes an error for a place.
    pub fn new(place: Place, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            place,
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// Makes an error that concerns the file as a whole.
    pub fn whole(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(Place::Whole, expected, found)
    }

    /// Names the file it is in.
    pub fn in_file(self, file: impl Into<String>) -> InputError {
        InputError {
            file: file.into(),
            error: self,
        }
    }
}

/// A [`FormatError`] with the name of its file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {error}")]
pub struct InputError {
    /// The file's name as the user gave it.
    pub file: String,
    /// What is wrong with it.
    pub error: FormatError,
}

/// Quotes a piece of input for a message: printable, on one line, and short.
pub fn quote(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    match bytes.get(..SHOWN) {
        Some(start) if bytes.len() > SHOWN => {
            format!("'{}…' ({} bytes)", start.escape_ascii(), bytes.len())
        }
        _ => format!("'{}'", bytes.escape_ascii()),
    }
}
