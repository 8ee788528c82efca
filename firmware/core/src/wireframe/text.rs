//! The text form of a program: one instruction per line.
//!
//! ```text
//! # a comment to the end of the line
//! eye     0 0 8
//! plane   4
//! window  -4 -2.25 4 2.25
//! segment -1 -1 1   1 -1 1
//! end
//! ```
//!
//! Numbers are decimals, rounded to the nearest Q5.11. Blank lines have no meaning. The conversion of a program to the text form
//! and back is exact.

use core::fmt;

use super::error::{Expected, Found, Violation};
use super::format::Opcode;
use super::instruction::Instruction;
use crate::choice::Choice;
use crate::fixed::Q5_11;
use crate::words::Words;

/// Parses a line. The result of a blank line or of a comment is `None`.
///
/// # Errors
/// The line is not an instruction.
pub fn parse_line(line: &str) -> Result<Option<Instruction>, Violation<'_>> {
    let code = line.split('#').next().unwrap_or_default();
    let mut words = Words::new(code);
    let Some(keyword) = words.next() else {
        return Ok(None);
    };
    let opcode = Opcode::from_word(keyword.text)
        .ok_or(Violation::new(Expected::Keyword, Found::Word(keyword)))?;
    let mut fields = [Q5_11::ZERO; 6];
    for (count, field) in fields.iter_mut().take(opcode.fields()).enumerate() {
        let word = words.next().ok_or(Violation::new(
            Expected::Numbers(opcode),
            Found::Count(count),
        ))?;
        *field = Q5_11::from_str(word.text)
            .map_err(|_| Violation::new(Expected::Number, Found::Word(word)))?;
    }
    match words.next() {
        Some(word) => Err(Violation::new(Expected::EndOfLine, Found::Word(word))),
        None => Ok(Some(Instruction::new(opcode, fields))),
    }
}

/// Writes the instruction as a line of the text form.
impl fmt::Display for Instruction {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (opcode, fields) = self.parts();
        write!(f, "{opcode}")?;
        fields
            .iter()
            .take(opcode.fields())
            .try_for_each(|field| write!(f, " {field}"))
    }
}

/// Translates a whole program from its text form to its binary form. Text after the end is ignored, as in the original design.
///
/// # Errors
/// The first deviation from the format, with the number of its line.
#[cfg(feature = "alloc")]
pub fn assemble(text: &str) -> Result<alloc::vec::Vec<u8>, super::ProgramError<'_>> {
    use super::error::Location;

    let mut checker = super::Checker::default();
    let mut bytes = alloc::vec::Vec::new();
    let mut last = 0;
    for (number, line) in text.lines().enumerate().map(|(i, line)| (i + 1, line)) {
        last = number;
        let at = |violation: Violation<'static>| violation.at(Location::Line(number));
        let parsed = parse_line(line).map_err(|violation| violation.at(Location::Line(number)))?;
        let Some(instruction) = parsed else {
            continue;
        };
        bytes.extend(instruction.encode());
        if checker.take(instruction).map_err(at)?.is_some() {
            return Ok(bytes);
        }
    }
    Err(Violation::new(Expected::End, Found::Exhausted).at(Location::Line(last + 1)))
}

/// Number of lines after the first end, without blank lines and comments.
pub fn lines_after_end(text: &str) -> usize {
    let mut lines = text.lines().map(parse_line);
    let _ = lines.find(|line| matches!(line, Ok(Some(Instruction::End))));
    lines.filter(|line| !matches!(line, Ok(None))).count()
}
