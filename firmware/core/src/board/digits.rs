//! Characters on seven-segment displays.
//!
//! ```text
//!   aaa
//!  f   b
//!   ggg
//!  e   c
//!   ddd
//! ```

use core::fmt;

/// Number of digits of a display.
pub const COUNT: usize = 4;

/// The lit segments of a character: bits 0 to 6 for a to g. A character that is not defined here lights no segment.
pub const fn segments(character: char) -> u8 {
    const fn lit(names: &str) -> u8 {
        let (names, mut segments, mut place) = (names.as_bytes(), 0, 0);
        while place < names.len() {
            segments |= 1 << (names[place] - b'a');
            place += 1;
        }
        segments
    }
    match character {
        '0' => const { lit("abcdef") },
        '1' => const { lit("bc") },
        '2' => const { lit("abdeg") },
        '3' => const { lit("abcdg") },
        '4' => const { lit("bcfg") },
        '5' => const { lit("acdfg") },
        '6' => const { lit("acdefg") },
        '7' => const { lit("abc") },
        '8' => const { lit("abcdefg") },
        '9' => const { lit("abcdfg") },
        'A' => const { lit("abcefg") },
        'C' => const { lit("adef") },
        'E' => const { lit("adefg") },
        'L' => const { lit("def") },
        '-' => const { lit("g") },
        _ => 0,
    }
}

/// A display of [`COUNT`] digits, as the segments of each digit from left to right. Text is written from the left; characters
/// that do not fit are dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Display {
    digits: [u8; COUNT],
    written: usize,
}

impl Display {
    /// A display with this text.
    pub fn of(text: fmt::Arguments) -> Self {
        let mut display = Self::default();
        // Writing to the display does not fail.
        let _ = fmt::write(&mut display, text);
        display
    }

    /// A right-aligned whole number, limited to the largest number that fits.
    pub fn number(number: u64) -> Self {
        Self::of(format_args!("{:4}", number.min(9999)))
    }

    /// `E` at the left, and a right-aligned error number.
    pub fn error(number: u8) -> Self {
        Self::of(format_args!("E{number:3}"))
    }

    /// The segments of the digits from left to right.
    pub const fn digits(&self) -> [u8; COUNT] {
        self.digits
    }
}

impl fmt::Write for Display {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for character in text.chars() {
            if let Some(digit) = self.digits.get_mut(self.written) {
                *digit = segments(character);
                self.written += 1;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::ToOwned;
    use std::string::String;
    use std::vec::Vec;

    use super::*;

    /// The three text rows that draw a character.
    fn drawn(character: char) -> [String; 3] {
        let lit = |segment: char, drawn| {
            let is_lit = segments(character) >> (segment as u8 - b'a') & 1 != 0;
            if is_lit { drawn } else { ' ' }
        };
        [
            [' ', lit('a', '_'), ' '],
            [lit('f', '|'), lit('g', '_'), lit('b', '|')],
            [lit('e', '|'), lit('d', '_'), lit('c', '|')],
        ]
        .map(|row| row.iter().collect())
    }

    #[test]
    fn characters_look_like_themselves() {
        let picture = [
            " _     _  _     _  _  _  _  _  _  _  _       ",
            "| |  | _| _||_||_ |_   ||_||_||_||  |_ |   _ ",
            "|_|  ||_  _|  | _||_|  ||_| _|| ||_ |_ |_    ",
        ];
        for (place, character) in "0123456789ACEL-".chars().enumerate() {
            let rows = picture.map(|row: &str| row[3 * place..3 * place + 3].to_owned());
            assert_eq!(drawn(character), rows, "{character}");
        }
    }

    #[test]
    fn every_character_has_segments_of_its_own() {
        let all: Vec<u8> = "0123456789ACEL- ".chars().map(segments).collect();
        for (place, segments) in all.iter().enumerate() {
            assert!(!all[..place].contains(segments));
            assert!(*segments < 0x80, "the decimal point is off");
        }
        assert_eq!(segments('x'), segments(' '));
    }

    #[test]
    fn numbers_are_at_the_right_and_errors_have_an_e() {
        let text = |text: &str| text.chars().map(segments).collect::<Vec<u8>>();
        let shown = |display: Display| display.digits().to_vec();
        assert_eq!(shown(Display::number(0)), text("   0"));
        assert_eq!(shown(Display::number(60)), text("  60"));
        assert_eq!(shown(Display::number(9999)), text("9999"));
        assert_eq!(shown(Display::number(10_000)), text("9999"));
        assert_eq!(shown(Display::number(u64::MAX)), text("9999"));
        assert_eq!(shown(Display::error(3)), text("E  3"));
        assert_eq!(shown(Display::error(255)), text("E255"));
        assert_eq!(shown(Display::of(format_args!("12345"))), text("1234"));
        assert_eq!(shown(Display::default()), text("    "));
    }
}
