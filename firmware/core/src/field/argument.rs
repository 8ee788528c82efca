//! The parameters of a field: parsed from text, or random within the same ranges.

use super::error::FieldError;
use super::limits::MAX_SPHERES;
use crate::fixed::{Q32_32, Turns};

/// A source of a field's parameters. Each kind of field requests its parameters by name and range, so parser, error messages and
/// random tests share one definition of the ranges.
pub trait Arguments<'a> {
    /// Returns the next number, after checking that it is within `range` (both ends included).
    ///
    /// # Errors
    /// The number is missing, malformed or out of range.
    fn number(&mut self, name: &'static str, range: [Q32_32; 2]) -> Result<Q32_32, FieldError<'a>>;

    /// Returns the next number, after checking that it is an integer within `range` (both ends included).
    ///
    /// # Errors
    /// The errors of [`number`](Self::number).
    fn integer(&mut self, name: &'static str, range: [u8; 2]) -> Result<u8, FieldError<'a>>;

    /// Returns the next number as an angle, which is stated in degrees; 0 if the number is missing.
    ///
    /// # Errors
    /// The word is not a number.
    fn angle(&mut self, name: &'static str) -> Result<Turns, FieldError<'a>>;

    /// Moves to the next group of numbers, if any, and returns whether it exists. Semicolons separate groups.
    ///
    /// # Errors
    /// The group before the semicolon has a surplus number.
    fn group(&mut self) -> Result<bool, FieldError<'a>>;
}

/// Returns `value`, after checking that it is within its range (both ends included).
pub(in crate::field) fn check(
    name: &'static str,
    value: Q32_32,
    [least, most]: [Q32_32; 2],
) -> Result<Q32_32, FieldError<'static>> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(FieldError::Range { name, least, most })
    }
}

/// Reads a field's numbers from the text after the kind's name. Commas separate numbers, semicolons separate groups of numbers.
pub(in crate::field) struct NumberText<'a> {
    kind: &'a str,
    words: core::str::Split<'a, char>,
    /// Text of the groups after the current one; `None` after the last group.
    rest: Option<&'a str>,
    in_group: bool,
}

impl<'a> NumberText<'a> {
    pub fn new(kind: &'a str, numbers: &'a str) -> Self {
        Self {
            kind,
            words: numbers.split(','),
            rest: Some(numbers),
            in_group: false,
        }
    }

    fn word(&mut self) -> Option<&'a str> {
        self.words.find(|word| !word.is_empty())
    }

    fn next_if_any(&mut self, name: &'static str) -> Result<Option<Q32_32>, FieldError<'a>> {
        let read = |word| Q32_32::from_str(word).map_err(|_| FieldError::Number { name, word });
        self.word().map(read).transpose()
    }

    fn next(&mut self, name: &'static str) -> Result<Q32_32, FieldError<'a>> {
        let kind = self.kind;
        self.next_if_any(name)?
            .ok_or(FieldError::Missing { kind, name })
    }

    /// Checks that the current group, or the whole text before the first call of `group`, has no further number.
    pub fn end(&mut self) -> Result<(), FieldError<'a>> {
        let kind = self.kind;
        self.word()
            .map_or(Ok(()), |word| Err(FieldError::Extra { kind, word }))
    }
}

impl<'a> Arguments<'a> for NumberText<'a> {
    fn number(&mut self, name: &'static str, range: [Q32_32; 2]) -> Result<Q32_32, FieldError<'a>> {
        check(name, self.next(name)?, range)
    }

    fn integer(
        &mut self,
        name: &'static str,
        [least, most]: [u8; 2],
    ) -> Result<u8, FieldError<'a>> {
        let number = self.next(name)?;
        number
            .checked_to_num::<u8>()
            .filter(|&whole| number == whole && (least..=most).contains(&whole))
            .ok_or(FieldError::Range {
                name,
                least: least.into(),
                most: most.into(),
            })
    }

    fn angle(&mut self, name: &'static str) -> Result<Turns, FieldError<'a>> {
        let degrees = self.next_if_any(name)?;
        Ok(degrees.map_or(Turns::default(), Turns::from_degrees))
    }

    fn group(&mut self) -> Result<bool, FieldError<'a>> {
        if self.in_group {
            self.end()?;
        }
        self.in_group = true;
        while let Some(rest) = self.rest {
            let (group, rest) = rest
                .split_once(';')
                .map_or((rest, None), |(group, rest)| (group, Some(rest)));
            (self.rest, self.words) = (rest, group.split(','));
            if !group.is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// A source of random numbers for tests and test vectors: each number is the minimum, the maximum or an inner value of its range.
#[derive(Debug)]
pub struct Random<F> {
    bits: F,
    groups: u32,
}

impl<F: FnMut() -> u32> Random<F> {
    /// Makes random numbers from the function `bits`, which returns 32 random bits.
    pub fn new(mut bits: F) -> Self {
        let groups = 1 + bits() % MAX_SPHERES as u32;
        Self { bits, groups }
    }

    /// Returns a random index into a list of `count` elements.
    pub(in crate::field) fn choose(&mut self, count: usize) -> usize {
        (self.bits)() as usize % count.max(1)
    }
}

impl<F: FnMut() -> u32> Arguments<'static> for Random<F> {
    fn number(
        &mut self,
        _: &'static str,
        [least, most]: [Q32_32; 2],
    ) -> Result<Q32_32, FieldError<'static>> {
        let span = i128::from(most.to_bits()) - i128::from(least.to_bits());
        Ok(match (self.bits)() % 8 {
            0 => least,
            1 => most,
            _ => {
                let part = (span * i128::from((self.bits)())) >> 32;
                Q32_32::from_bits(least.to_bits() + part as i64)
            }
        })
    }

    fn integer(
        &mut self,
        _: &'static str,
        [least, most]: [u8; 2],
    ) -> Result<u8, FieldError<'static>> {
        Ok(least + self.choose(usize::from(most - least) + 1) as u8)
    }

    fn angle(&mut self, _: &'static str) -> Result<Turns, FieldError<'static>> {
        Ok(Turns((self.bits)()))
    }

    fn group(&mut self) -> Result<bool, FieldError<'static>> {
        let more = self.groups > 0;
        self.groups = self.groups.saturating_sub(1);
        Ok(more)
    }
}
