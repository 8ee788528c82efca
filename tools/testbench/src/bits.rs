//! Bit vectors for the values of a module's ports.

use std::{fmt, iter};

/// Number of 32-bit words of the widest port.
const WORDS: usize = 16;

/// A value of up to 512 bits. The value of a narrower port is in the lowest bits.
///
/// Methods panic when a field is not within the 512 bits, a value does not fit its field, or a
/// number does not fit the result.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Bits([u32; WORDS]);

impl Bits {
    /// Makes a value from 32-bit words, lowest first; missing words are 0.
    #[must_use]
    pub fn from_words(words: &[u32]) -> Self {
        let mut bits = Self::default();
        assert!(words.len() <= WORDS);
        for (to, &from) in bits.0.iter_mut().zip(words) {
            *to = from;
        }
        bits
    }

    /// Makes a value from at most 64 bytes in whole words, lowest first; missing bytes are 0.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Self {
        let mut bits = Self::default();
        let (words, rest) = bytes.as_chunks();
        for (to, &from) in bits.0.iter_mut().zip(words) {
            *to = u32::from_le_bytes(from);
        }
        assert!(rest.is_empty());
        bits
    }

    /// Returns the value as 32-bit words, lowest first.
    #[must_use]
    pub fn words(&self) -> &[u32; WORDS] {
        &self.0
    }

    /// Mutable 32-bit words of the value, lowest first.
    pub(crate) fn words_mut(&mut self) -> &mut [u32; WORDS] {
        &mut self.0
    }

    /// Whether all bits above the lowest `width` bits are 0.
    #[must_use]
    pub(crate) fn fits(&self, width: usize) -> bool {
        let mut above = self.0.iter().skip(width / 32);
        let cut = above.next().is_none_or(|word| word >> (width % 32) == 0);
        cut && above.all(|&word| word == 0)
    }

    /// Returns the field of `width` bits from bit `low` up as a number; `width` is at most 64.
    #[must_use]
    pub(crate) fn field(&self, low: usize, width: usize) -> u64 {
        assert!(width <= 64 && low + width <= 32 * WORDS);
        parts(low, width).fold(0, |value, part| {
            let found = self.0[part.word] >> part.shift & part.mask;
            value | u64::from(found) << part.done
        })
    }

    /// Returns the field of `width` bits from bit `low` up, shifted to bit 0; `width` may be above 64.
    #[must_use]
    pub fn slice(&self, low: usize, width: usize) -> Self {
        Self::default().with_words(0, self, low, width)
    }

    /// Replaces the field of `width` bits from bit `low` up by the lowest `width` bits of `bits`.
    #[must_use]
    pub fn with_slice(self, low: usize, width: usize, bits: Self) -> Self {
        self.with_words(low, &bits, 0, width)
    }

    /// Replaces the field of `width` bits from bit `low` up by the field of `source` from its bit `from` up.
    fn with_words(mut self, low: usize, source: &Self, from: usize, width: usize) -> Self {
        let mut done = 0;
        while done < width {
            let count = (width - done).min(32);
            let part = source.field(from + done, count);
            self = self.with(low + done, count, part);
            done += count;
        }
        self
    }

    /// Returns the whole value as one number.
    #[must_use]
    pub fn number(&self) -> u64 {
        assert!(self.fits(64), "{self:?} in 64 bits");
        self.field(0, 64)
    }

    /// Returns field `index` of a value that [`pack`](Self::pack) made from fields of `width` bits.
    #[must_use]
    pub fn element(&self, width: usize, index: usize) -> u64 {
        self.field(width * index, width)
    }

    /// Concatenates fields of `width` bits each, the first in the lowest bits.
    #[must_use]
    pub fn pack(width: usize, values: impl IntoIterator<Item: Into<i128>>) -> Self {
        let lows = (0..).step_by(width);
        lows.zip(values)
            .fold(Self::default(), |bits, (low, value)| {
                bits.with(low, width, value)
            })
    }

    /// Returns the field of `width` bits from bit `low` up as a two's complement number.
    #[must_use]
    pub(crate) fn signed(&self, low: usize, width: usize) -> i64 {
        let unused = 64 - width;
        (self.field(low, width) << unused) as i64 >> unused
    }

    /// Replaces the field of `width` bits from bit `low` up by `value`, in two's complement if `value` is negative.
    #[must_use]
    pub(crate) fn with(mut self, low: usize, width: usize, value: impl Into<i128>) -> Self {
        let value = value.into();
        assert!(holds(width, value), "{value} in {width} bits");
        for part in parts(low, width) {
            let kept = self.0[part.word] & !(part.mask << part.shift);
            let set = (value >> part.done) as u32 & part.mask;
            self.0[part.word] = kept | set << part.shift;
        }
        self
    }
}

/// Part of a field that is within one word of 32 bits.
pub(crate) struct Part {
    /// Index of the word.
    pub word: usize,
    /// Lowest bit of the part within the word.
    pub shift: usize,
    /// As many ones as the part has bits.
    pub mask: u32,
    /// Number of bits of the field below the part.
    pub done: usize,
}

/// Returns the parts of the field of `width` bits from bit `low` up, the lowest first.
pub(crate) fn parts(low: usize, width: usize) -> impl Iterator<Item = Part> {
    let mut done = 0;
    iter::from_fn(move || {
        let (at, left) = (low + done, width - done);
        let shift = at % 32;
        let count = left.min(32 - shift);
        let part = (count > 0).then(|| Part {
            word: at / 32,
            shift,
            mask: u32::MAX >> (32 - count),
            done,
        });
        done += count;
        part
    })
}

/// Whether `width` bits can hold the number `value`, either as a signed or as an unsigned number.
pub(crate) fn holds(width: usize, value: i128) -> bool {
    width > 126 || value >= -(1 << (width - 1)) && value < 1 << width
}

impl From<u64> for Bits {
    fn from(value: u64) -> Self {
        Self::from_words(&[value as u32, (value >> 32) as u32])
    }
}

impl fmt::Debug for Bits {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let used = WORDS - self.0.iter().rev().take_while(|&&word| word == 0).count();
        write!(f, "0x")?;
        match self.0[..used].split_last() {
            None => write!(f, "0"),
            Some((highest, rest)) => {
                write!(f, "{highest:x}")?;
                rest.iter()
                    .rev()
                    .try_for_each(|word| write!(f, "_{word:08x}"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Bits;

    #[test]
    fn fields_across_words() {
        let bits = Bits::default().with(20, 34, -5_i64).with(60, 8, 0xa5_i64);
        assert_eq!((bits.signed(20, 34), bits.field(60, 8)), (-5, 0xa5));
        assert_eq!(bits.field(0, 20), 0);
        assert!(bits.fits(68) && !bits.fits(67) && bits.fits(512));
        assert_eq!(format!("{:?}", Bits::from(0x1_0000_0002)), "0x1_00000002");
    }

    #[test]
    #[should_panic(expected = "8 in 3 bits")]
    fn a_value_that_does_not_fit() {
        let _ = Bits::default().with(0, 3, 8_i64);
    }
}
