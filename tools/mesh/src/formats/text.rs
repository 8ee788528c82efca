//! Lines, words and numbers of text files, with their positions.

use crate::error::{FormatError, Location, MAX_LINE, quote};

/// The byte order mark of UTF-8.
pub const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The lines of a text, which end in LF, CR LF or CR.
pub struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

/// One line, without its end.
#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    /// Number of the line, counted from 1.
    pub number: usize,
    /// Bytes of the line, not necessarily UTF-8.
    pub text: &'a [u8],
}

impl<'a> Lines<'a> {
    /// The lines of a whole text, without the byte order mark that some programs write at its start.
    pub fn new(text: &'a [u8]) -> Self {
        Self {
            rest: text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text),
            number: 0,
        }
    }

    /// The next line, or `None` after the last.
    ///
    /// # Errors
    /// The line is longer than [`MAX_LINE`].
    pub fn next_line(&mut self) -> Result<Option<Line<'a>>, FormatError> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        self.number += 1;
        let window = &self.rest[..self.rest.len().min(MAX_LINE + 1)];
        let length = window
            .iter()
            .position(|&b| b == b'\n' || b == b'\r')
            .unwrap_or(window.len());
        if length > MAX_LINE {
            return Err(FormatError::new(
                Location::Line(self.number),
                format!("a line of at most {MAX_LINE} bytes"),
                "a longer one",
            ));
        }
        let (text, rest) = self.rest.split_at(length);
        self.rest = rest
            .strip_prefix(b"\r\n")
            .or(rest.get(1..))
            .unwrap_or_default();
        Ok(Some(Line {
            number: self.number,
            text,
        }))
    }

    /// The unread rest of the text.
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }
}

impl<'a> Line<'a> {
    /// Words of the line, separated by white space.
    pub fn words(self) -> impl Iterator<Item = &'a [u8]> {
        self.text
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty())
    }

    /// The line's position.
    pub fn place(self) -> Location {
        Location::Line(self.number)
    }
}

/// Words of a text, separated by white space and line ends, without a limit on a line's length.
#[derive(Clone)]
pub struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    /// The words of a whole text, without its byte order mark.
    pub fn new(text: &'a [u8]) -> Self {
        Self {
            rest: text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text),
            line: 1,
        }
    }

    /// The words after the lines that are already read.
    pub fn after(lines: Lines<'a>) -> Self {
        Self {
            rest: lines.rest,
            line: lines.number + 1,
        }
    }

    /// The number of the line of the last word, counted from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The position of the last word.
    pub fn place(&self) -> Location {
        Location::Line(self.line)
    }

    /// Advances to the next line with a word, unless the current line has a further word. Returns
    /// false if no word is left.
    pub fn skip_blank_lines(&mut self) -> bool {
        while !self.has_more_on_line() {
            self.rest = match self.rest {
                [] => return false,
                [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => rest,
            };
            // The end of the text counts as a part of the last line.
            if !self.rest.is_empty() {
                self.line += 1;
            }
        }
        true
    }

    /// The next word on the current line, if any.
    pub fn next_on_line(&mut self) -> Option<&'a [u8]> {
        if !self.has_more_on_line() {
            return None;
        }
        let is_end = |b: &u8| b.is_ascii_whitespace();
        let length = self.rest.iter().position(is_end);
        let (word, rest) = self.rest.split_at(length.unwrap_or(self.rest.len()));
        self.rest = rest;
        Some(word)
    }

    /// Skips white space on the current line. Returns whether the line has a further word.
    pub fn has_more_on_line(&mut self) -> bool {
        while let [b' ' | b'\t' | b'\x0c', rest @ ..] = self.rest {
            self.rest = rest;
        }
        !matches!(self.rest, [] | [b'\n' | b'\r', ..])
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_blank_lines();
        self.next_on_line()
    }
}

/// Parses a number, including infinity and NaN in the spellings of C libraries: `-nan`, `-nan(ind)`, `1.#QNAN`, `-1.#IND00`, `1.#INF`.
pub fn any_number(word: &[u8]) -> Option<f64> {
    let word = std::str::from_utf8(word).ok()?;
    word.parse().ok().or_else(|| {
        let word = word.trim_start_matches(['+', '-']).to_ascii_uppercase();
        let is_no_number = match word.strip_prefix("NAN") {
            Some(rest) => rest.starts_with('(') && rest.ends_with(')'),
            None => ["1.#QNAN", "1.#SNAN", "1.#IND", "1.#INF"]
                .iter()
                .any(|start| word.starts_with(start)),
        };
        is_no_number.then_some(f64::NAN)
    })
}

/// Parses a coordinate: a finite number.
///
/// # Errors
/// The word is not a number, or not finite.
pub fn coordinate(word: &[u8], place: Location) -> Result<f64, FormatError> {
    any_number(word)
        .filter(|value| value.is_finite())
        .ok_or_else(|| FormatError::new(place, FINITE, quote(word)))
}

/// The requirement on a coordinate.
const FINITE: &str = "a finite number";

/// Checks a coordinate that is not text.
///
/// # Errors
/// The value is not finite.
pub fn finite(value: f64, place: Location) -> Result<f64, FormatError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(FormatError::new(place, FINITE, format!("{value:e}")))
    }
}

/// Parses a word as a number that may be infinite or NaN, such as a component of a normal or a colour.
///
/// # Errors
/// The word is not a number.
pub fn component(word: &[u8], place: Location) -> Result<f64, FormatError> {
    any_number(word).ok_or_else(|| FormatError::new(place, "a number", quote(word)))
}

/// Parses the next three words of a line, each with `number`: [`coordinate`] or [`component`].
///
/// # Errors
/// The line has fewer than three more words, or `number` refuses a word.
pub fn vector<'a>(
    words: &mut impl Iterator<Item = &'a [u8]>,
    what: &str,
    place: Location,
    number: impl Fn(&[u8], Location) -> Result<f64, FormatError>,
) -> Result<[f64; 3], FormatError> {
    let mut vector = [0.0; 3];
    for (i, c) in vector.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| {
            FormatError::new(place, format!("three numbers of a {what}"), format!("{i}"))
        })?;
        *c = number(word, place)?;
    }
    Ok(vector)
}

/// The rows of a table of test cases; `→` separates the `N` cells of a row.
#[cfg(test)]
pub fn rows<const N: usize>(table: &str) -> impl Iterator<Item = [&str; N]> {
    let rows = table.lines().filter(|row| !row.trim().is_empty());
    rows.map(|row| {
        let cells: Vec<_> = row.split('→').map(str::trim).collect();
        cells.try_into().unwrap_or_else(|_| panic!("{row}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_end() {
        let mut lines = Lines::new(b"a\nb\r\n\r\rc d \n");
        let mut seen = Vec::new();
        while let Some(line) = lines.next_line().unwrap() {
            seen.push((line.number, line.text));
        }
        assert_eq!(
            seen,
            [(1, &b"a"[..]), (2, b"b"), (3, b""), (4, b""), (5, b"c d ")]
        );
    }

    #[test]
    fn words_and_their_lines() {
        let mut words = Words::new(b"\xef\xbb\xbfa b\r\n\r\tc\n d\n");
        let mut seen = Vec::new();
        while let Some(word) = words.next() {
            seen.push((word, words.place()));
        }
        let lines = [1, 1, 3, 4].map(Location::Line);
        let expected = [&b"a"[..], b"b", b"c", b"d"].into_iter().zip(lines);
        assert_eq!(seen, expected.collect::<Vec<_>>());
        assert_eq!(words.place(), Location::Line(4));
    }

    #[test]
    fn long_lines() {
        let mut text = vec![b'x'; MAX_LINE];
        assert!(Lines::new(&text).next_line().is_ok());
        text.push(b'x');
        assert_eq!(
            Lines::new(&text).next_line().unwrap_err().place,
            Location::Line(1)
        );
    }

    #[test]
    fn absurd_numbers() {
        let words = "nan inf -infinity 1e309 -1e309 x 1,5 0x10 -nan(ind) 1.#INF".split(' ');
        for word in words.chain([""]) {
            let number = coordinate(word.as_bytes(), Location::Whole);
            assert!(number.is_err(), "{word}");
        }
        for word in "nan -nan(ind) NaN(0x1) -1.#IND -1.#IND00 1.#QNAN 1.#INF".split(' ') {
            assert!(any_number(word.as_bytes()).unwrap().is_nan(), "{word}");
        }
        for word in ["nano", "nan(", "1.#", "1.#X", "-", ""] {
            assert_eq!(any_number(word.as_bytes()), None, "{word}");
        }
        for (word, value) in [
            ("1", 1.0),
            ("-.5", -0.5),
            ("+2.", 2.0),
            ("1e-300", 1e-300),
            ("1e308", 1e308),
        ] {
            assert_eq!(coordinate(word.as_bytes(), Location::Whole).unwrap(), value);
        }
    }
}
