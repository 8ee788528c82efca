//! Errors in image files.

/// An image file that cannot be used. `Display` prints one line with the expected and the found
/// content.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}, found {found}")]
pub struct PictureError {
    /// The requirement that the file violates.
    pub expected: String,
    /// The content of the file.
    pub found: String,
}

impl PictureError {
    /// Creates an error.
    pub fn new(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            expected: expected.into(),
            found: found.into(),
        }
    }
}
