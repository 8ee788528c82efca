//! Bit fields of records in 32-bit words.

/// A bit field of a record: an array of elements of `width` bits, whose first bits are `every` bits apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits {
    at: usize,
    width: usize,
    every: usize,
}

impl Bits {
    /// The field whose first element begins at bit `at` of the record. A field that is read or set as a number has 1 to 34 bits.
    pub const fn new(at: usize, width: usize, every: usize) -> Self {
        Self { at, width, every }
    }

    /// This field in a record that begins at bit `start`.
    #[must_use]
    pub const fn from(self, start: usize) -> Self {
        Self {
            at: self.at + start,
            ..self
        }
    }

    /// The element of the array with the index `number`.
    #[must_use]
    pub const fn element(self, number: usize) -> Self {
        self.from(self.every * number)
    }

    /// Number of the word in which the field begins.
    pub const fn word(self) -> usize {
        self.at / 32
    }

    /// Reads the field as an unsigned number. Bits beyond the end of `words` are 0.
    #[inline]
    pub fn get(self, words: &[u32]) -> u64 {
        let word = |number| u64::from(words.get(number).copied().unwrap_or(0));
        let (first, shift) = (self.at / 32, self.at % 32);
        let low = word(first) | word(first + 1) << 32;
        // A field of 34 bits may span three words.
        let high = (word(first + 2) << 1) << (63 - shift);
        (low >> shift | high) & ((1 << self.width) - 1)
    }

    /// Reads the field as a two's complement number.
    #[inline]
    pub fn signed(self, words: &[u32]) -> i64 {
        let unused = 64 - self.width;
        (self.get(words) << unused) as i64 >> unused
    }

    /// Sets the field, which must contain 0, to the lowest bits of `value`. Bits beyond the end of `words` are dropped.
    // Inlined, because little code remains where the field is a constant.
    #[inline(always)]
    pub fn put(self, words: &mut [u32], value: i64) {
        let value = value as u64 & ((1 << self.width) - 1);
        let (first, shift) = (self.at / 32, self.at % 32);
        // A field of 34 bits may span three words.
        let parts = [
            value << shift,
            value >> 1 >> (31 - shift),
            value >> 1 >> (63 - shift),
        ];
        for (number, part) in parts.into_iter().enumerate() {
            if let Some(word) = words.get_mut(first + number) {
                *word |= part as u32;
            }
        }
    }
}
