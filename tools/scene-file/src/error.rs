//! Errors in scene files.

use std::ops::Range;

/// A scene file that violates the format. `Display` prints one line: the file, the line, the key, its value, and the allowed
/// values.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {}{message}", place(.line))]
pub struct SceneError {
    /// Name of the file.
    pub file: String,
    /// Number of the line, from 1; `None` for an error that concerns the whole file.
    pub line: Option<usize>,
    /// The key with its value, and the allowed values.
    pub message: String,
}

fn place(line: &Option<usize>) -> String {
    line.map_or(String::new(), |line| format!("line {line}: "))
}

/// A parsed file, for the locations of errors.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// Name of the file, for messages.
    pub file: &'a str,
    /// Text of the file.
    pub text: &'a str,
}

impl Source<'_> {
    /// Number of the line, from 1, at a byte offset.
    pub fn line(self, offset: usize) -> usize {
        let before = self.text.as_bytes().iter().take(offset);
        1 + before.filter(|&&byte| byte == b'\n').count()
    }

    /// An error at a position of the file.
    pub fn error(self, span: &Range<usize>, message: impl Into<String>) -> SceneError {
        SceneError {
            line: Some(self.line(span.start)),
            ..self.whole(message)
        }
    }

    /// An error that applies to the whole file.
    pub fn whole(self, message: impl Into<String>) -> SceneError {
        // The message may quote the file.
        let message: String = message.into();
        SceneError {
            file: self.file.to_owned(),
            line: None,
            message: message
                .chars()
                .map(|c| if c.is_control() { ' ' } else { c })
                .collect(),
        }
    }
}

/// Quotes a value of the file in shortened form, for a message.
pub fn quote(text: &str) -> String {
    const SHOWN: usize = 40;
    let mut rest = text.chars();
    let start: String = rest.by_ref().take(SHOWN).collect();
    let more = if rest.next().is_some() { "…" } else { "" };
    format!("`{start}{more}`")
}
