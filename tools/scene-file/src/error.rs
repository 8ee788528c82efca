//! Errors in scene files.

use std::fmt;
use std::ops::Range;

/// A scene file that violates the format. `Display` prints a line for each violation, with the name of the file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", lines(file, violations))]
pub struct SceneError {
    /// Name of the file.
    pub file: String,
    /// All violations in the order of the file; violations that concern the whole file come first.
    pub violations: Vec<Violation>,
}

/// A violation of the format. `Display` prints one line: the line number, the key, its value, and
/// the allowed values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Line number, counted from 1; `None` for a violation that concerns the whole file.
    pub line: Option<usize>,
    /// The key with its value, and the allowed values.
    pub message: String,
}

fn lines(file: &str, violations: &[Violation]) -> String {
    let lines = violations
        .iter()
        .map(|violation| format!("{file}: {violation}"));
    lines.collect::<Vec<_>>().join("\n")
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl Violation {
    fn new(line: Option<usize>, message: impl Into<String>) -> Self {
        // The message may quote control characters from the file.
        let message: String = message.into();
        let message = message.replace(char::is_control, " ");
        Self { line, message }
    }
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
    /// Line number at a byte offset, counted from 1.
    pub fn line(self, offset: usize) -> usize {
        let before = self.text.as_bytes().iter().take(offset);
        1 + before.filter(|&&byte| byte == b'\n').count()
    }

    /// A violation at a position of the file, or of the whole file.
    pub fn violation(self, span: Option<&Range<usize>>, message: impl Into<String>) -> Violation {
        Violation::new(span.map(|span| self.line(span.start)), message)
    }

    /// An error that applies to the whole file.
    pub fn whole(self, message: impl Into<String>) -> SceneError {
        SceneError {
            file: self.file.to_owned(),
            violations: vec![self.violation(None, message)],
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

/// Returns the known name that is most similar to a misspelt name; `None` if none is similar
/// enough.
pub fn resembled<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    /// Minimum similarity of the names, from 0 to 1.
    const LEAST: f64 = 0.75;
    let known = known
        .into_iter()
        .map(|known| (strsim::jaro(name, known), known));
    let near = known.filter(|(similarity, _)| *similarity >= LEAST);
    let nearest = near.max_by(|(one, _), (other, _)| one.total_cmp(other));
    nearest.map(|(_, known)| known)
}

/// Returns the message for an unknown name. It states the expected kind of name, and the most
/// similar known name or, if none is similar, all known names.
pub fn unknown<'n>(
    name: &str,
    expected: &str,
    known: impl IntoIterator<Item = &'n str> + Clone,
) -> String {
    let name_of = quote(name);
    match resembled(name, known.clone()) {
        Some(known) => format!("{name_of}: expected {expected}, did you mean `{known}`?"),
        None => {
            let known: Vec<_> = known.into_iter().collect();
            let known = known.join(", ");
            format!("{name_of}: expected {expected}, one of {known}")
        }
    }
}
