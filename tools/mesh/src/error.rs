//! Errors in input files, and limits of input files. An error is one line with the position, the
//! expected content and the found content.

use std::fmt;
use std::path::Path;

/// Maximum size of a file in bytes. An ASCII STL of this size has about as many triangles as a
/// board's mesh memory can hold.
pub const MAX_FILE: usize = 512 << 20;
/// Maximum length of a line in bytes. A line with a polygon of [`MAX_POLYGON`] corners fits.
pub const MAX_LINE: usize = 64 << 10;
/// Maximum number of points in a mesh: three for each of [`MAX_TRIANGLES`].
pub const MAX_POINTS: usize = 3 * MAX_TRIANGLES;
/// Maximum number of triangles in a mesh. At 16 bytes each they fill the 32 MiB that a board has
/// for a mesh.
pub const MAX_TRIANGLES: usize = 1 << 21;
/// Maximum number of corners of a polygon.
pub const MAX_POLYGON: usize = 8192;
/// Magnitude of a coordinate above which a remark warns that the file may be damaged.
pub const USUAL_COORDINATE: f64 = 1e15;
/// Maximum number of remarks on a file; further remarks are dropped.
pub const MAX_REMARKS: usize = 8;

/// Position of an error in an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// The file as a whole.
    Whole,
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A cell of a table: its line, counted from 1, and its column's name.
    Cell(usize, &'static str),
    /// An offset in bytes from the file's start.
    Byte(usize),
    /// A word of a wireframe program, counted from 1.
    Word(usize),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Location::Whole => Ok(()),
            Location::Line(number) => write!(f, "line {number}: "),
            Location::Cell(line, column) => write!(f, "line {line}, column {column}: "),
            Location::Byte(offset) => write!(f, "byte {offset}: "),
            Location::Word(number) => write!(f, "word {number}: "),
        }
    }
}

/// Input that violates its format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}expected {expected}, found {found}")]
pub struct FormatError {
    /// Position of the violation.
    pub place: Location,
    /// The requirement of the format at this position.
    pub expected: String,
    /// The content of the input at this position.
    pub found: String,
}

impl FormatError {
    /// Creates an error at a position.
    pub fn new(place: Location, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            place,
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// Creates an error that concerns the whole file.
    pub fn whole(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(Location::Whole, expected, found)
    }

    /// Adds the name of the file to the error.
    pub fn in_file(self, file: impl Into<String>) -> InputError {
        InputError {
            file: file.into(),
            error: self,
        }
    }

    /// Adds the path of the file to the error, with control characters escaped, so that the error
    /// stays one line.
    pub fn in_path(self, path: &Path) -> InputError {
        self.in_file(path.display().to_string().escape_debug().to_string())
    }
}

/// A [`FormatError`] with the name of its file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {error}")]
pub struct InputError {
    /// Name of the file as given by the user.
    pub file: String,
    /// The violation of the format.
    pub error: FormatError,
}

/// Quotes input for a message, in shortened and printable form on one line.
pub fn quote(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    match bytes.get(..SHOWN) {
        Some(start) if bytes.len() > SHOWN => {
            format!("'{}…' ({} bytes)", start.escape_ascii(), bytes.len())
        }
        _ => format!("'{}'", bytes.escape_ascii()),
    }
}
