//! Words of a line.

use core::fmt::{self, Write as _};

/// A word and its position in the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word<'a> {
    /// Text of the word, without blanks.
    pub text: &'a str,
    /// Column of the first byte, from 1.
    pub column: usize,
}

/// Writes the word and its column for error messages. A long word is shortened, and characters other than visible ASCII become
/// `?`.
impl fmt::Display for Word<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        const LONGEST: usize = 24;
        let mut rest = self.text.chars();
        f.write_str("\"")?;
        for c in rest.by_ref().take(LONGEST) {
            f.write_char(if c.is_ascii_graphic() { c } else { '?' })?;
        }
        f.write_str(if rest.next().is_some() { "...\"" } else { "\"" })?;
        write!(f, " (column {})", self.column)
    }
}

/// The words of a line, separated by blanks.
#[derive(Clone, Debug)]
pub struct Words<'a> {
    line: &'a str,
    offset: usize,
}

impl<'a> Words<'a> {
    /// Makes an iterator over the words of `line`.
    pub const fn new(line: &'a str) -> Self {
        Self { line, offset: 0 }
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    // Not inlined, because many callers share one copy.
    #[inline(never)]
    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.line.get(self.offset..)?;
        let text = rest.trim_ascii_start();
        let start = self.offset + (rest.len() - text.len());
        let text = text.split_ascii_whitespace().next()?;
        self.offset = start + text.len();
        Some(Word {
            text,
            column: start + 1,
        })
    }
}
