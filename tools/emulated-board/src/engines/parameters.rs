//! The parameters of a block: registers that only the block reads.

/// Number of words in a block's register window.
const WORDS: usize = 512;

/// The parameters of a block; software may write them at any time. Reads return 0.
#[derive(Clone, Debug)]
pub struct Parameters {
    words: [u32; WORDS],
}

impl Parameters {
    /// Parameters that are all 0.
    pub const fn new() -> Self {
        Self { words: [0; WORDS] }
    }

    /// Writes the register at `offset` bytes from the start of the window. A write beyond the window has no effect.
    pub fn set(&mut self, offset: u32, value: u32) {
        if let Some(word) = self.words.get_mut(offset as usize / 4) {
            *word = value;
        }
    }

    /// The content of the register at `offset`.
    pub fn word(&self, offset: u32) -> u32 {
        self.words.get(offset as usize / 4).copied().unwrap_or(0)
    }

    /// The lowest `bits` bits of the register at `offset`.
    pub fn unsigned(&self, offset: u32, bits: u32) -> u32 {
        self.word(offset) & (u32::MAX >> (32 - bits))
    }

    /// The lowest `bits` bits of the register at `offset`, in two's complement.
    pub fn signed(&self, offset: u32, bits: u32) -> i32 {
        let unused = 32 - bits;
        (self.word(offset) << unused) as i32 >> unused
    }

    /// Three consecutive registers from `offset` on, each in two's complement with `bits` bits.
    pub fn row(&self, offset: u32, bits: u32) -> [i32; 3] {
        [0, 4, 8].map(|place| self.signed(offset + place, bits))
    }

    /// A number in two's complement in two registers: the register at `high` contains the `bits` bits from bit 32 on.
    pub fn wide(&self, low: u32, high: u32, bits: u32) -> i64 {
        i64::from(self.signed(high, bits)) << 32 | i64::from(self.word(low))
    }
}

#[cfg(test)]
mod tests {
    use super::Parameters;

    #[test]
    fn numbers_have_their_widths() {
        let mut parameters = Parameters::new();
        for (place, value) in [u32::MAX, 0x0100_0000, 0x00FF_FFFF].into_iter().enumerate() {
            parameters.set(4 * place as u32, value);
        }
        assert_eq!(parameters.row(0, 25), [-1, -(1 << 24), 0xFF_FFFF]);
        assert_eq!(parameters.unsigned(0, 5), 31);
        parameters.set(12, 0x800);
        assert_eq!(parameters.wide(8, 12, 12), -(1 << 43) + 0xFF_FFFF);
        parameters.set(1 << 20, 1);
        assert_eq!(parameters.word(1 << 20), 0);
    }
}
