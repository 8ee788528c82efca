//! The digit displays. The SoC multiplexes the digits: it drives one digit of each display at a
//! time.

/// Number of cycles for which a digit still appears lit after it was driven: two refresh cycles of
/// the digits.
const SEEN: u64 = 2 << 16;

/// The digits as a viewer sees them, without flicker.
#[derive(Default)]
pub(crate) struct Digits {
    /// Segments of each digit from left to right when it was last lit, and the cycle after which it appears dark.
    digits: [(u8, u64); 8],
}

impl Digits {
    /// Processes the pins of both displays in a cycle: for each display its lit digits, one bit each, and its lit segments.
    pub fn update(&mut self, cycle: u64, displays: [[u8; 2]; 2]) {
        for (digits, [lit, segments]) in self.digits.chunks_mut(4).zip(displays) {
            for (place, digit) in digits.iter_mut().enumerate() {
                if lit >> place & 1 != 0 {
                    *digit = (segments, cycle + SEEN);
                }
            }
        }
    }

    /// Lit segments of the digits from left to right in a cycle.
    pub fn seen(&self, cycle: u64) -> [u8; 8] {
        self.digits
            .map(|(segments, end)| if cycle < end { segments } else { 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digit_is_seen_until_it_was_dark_for_two_turns() {
        let mut digits = Digits::default();
        digits.update(5, [[0b0001, 0x06], [0, 0x06]]);
        digits.update(7, [[0, 0xff], [0b1000, 0xff]]);
        assert_eq!(digits.seen(8), [0x06, 0, 0, 0, 0, 0, 0, 0xff]);
        assert_eq!(digits.seen(5 + SEEN), [0, 0, 0, 0, 0, 0, 0, 0xff]);
        assert_eq!(digits.seen(7 + SEEN), [0; 8]);
    }
}
