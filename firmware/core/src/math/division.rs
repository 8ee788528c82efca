//! Quotients of 64-bit numbers, computed by 32-bit divisions, for which the soft core has an instruction. The division of the compiler's
//! library takes longer, because it subtracts bit by bit.
//!
//! After D. E. Knuth, The Art of Computer Programming, volume 2, 4.3.1, algorithm D, with digits of 16 bits.

/// The quotient, rounded down. A divisor of 0 is replaced by 1.
#[inline(never)]
pub fn quotient(number: u64, divisor: u64) -> u64 {
    let (high, low) = ((divisor >> 32) as u32, divisor as u32);
    let number_high = (number >> 32) as u32;
    if high == 0 {
        let divisor = low.max(1);
        let (first, rest) = if number_high < divisor {
            (0, number_high)
        } else {
            (number_high / divisor, number_high % divisor)
        };
        let shift = divisor.leading_zeros();
        let rest = u64::from(rest) << 32 | u64::from(number as u32);
        let second = normalised_quotient(rest << shift, divisor << shift);
        return u64::from(first) << 32 | u64::from(second);
    }
    // With the first 32 bits of the divisor, the quotient is too large by at most 1.
    let shift = high.leading_zeros();
    let first = normalised_quotient(number >> 1, (divisor << shift >> 32) as u32);
    let least = (u64::from(first) << shift >> 31).saturating_sub(1);
    least + u64::from(number - least * divisor >= divisor)
}

/// The quotient with this number of fraction bits, at most 32, rounded down. The whole part saturates at 2^31 − 1. A divisor of 0 is replaced
/// by 1, and a divisor has at most 63 bits.
#[inline(never)]
pub fn quotient_with_fraction(number: u64, divisor: u64, fraction: u32) -> u64 {
    const LARGEST: u64 = (1 << 31) - 1;
    let divisor = divisor.clamp(1, (1 << 63) - 1);
    let whole = quotient(number, divisor);
    let (mut all, mut rest) = (whole.min(LARGEST), number - whole * divisor);
    for _ in 0..fraction {
        // Below 2^64, because the rest is below the divisor.
        rest *= 2;
        let bit = rest >= divisor;
        all = 2 * all + u64::from(bit);
        rest -= if bit { divisor } else { 0 };
    }
    all
}

/// The quotient, rounded down, of a number and a divisor of at least 2^31. The number must be below the divisor times 2^32.
// Not inlined, so that the callers' code takes few lines of the instruction cache.
#[inline(never)]
fn normalised_quotient(number: u64, divisor: u32) -> u32 {
    let mut all = 0;
    let mut rest = (number >> 32) as u32;
    for next in [(number >> 16) as u16, number as u16] {
        let number = u64::from(rest) << 16 | u64::from(next);
        // This estimate of the digit is too large by at most 2.
        let mut digit = (rest / (divisor >> 16).max(1)).min(0xFFFF);
        let mut product = u64::from(digit) * u64::from(divisor);
        while product > number {
            digit -= 1;
            product -= u64::from(divisor);
        }
        rest = (number - product) as u32;
        all = all << 16 | digit;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::lengths;

    #[test]
    fn quotients_are_rounded_down() {
        let mut random = lengths(1);
        for _ in 0..1_000_000 {
            let (number, divisor) = (random(), random().max(1));
            assert_eq!(quotient(number, divisor), number / divisor);
            for number in [number / divisor * divisor, number | 0xFFFF_FFFF] {
                assert_eq!(quotient(number, divisor), number / divisor);
                let product = divisor.wrapping_mul(number / divisor);
                let below = product.wrapping_sub(1);
                assert_eq!(quotient(below, divisor), below / divisor);
            }
        }
        for number in [0, 1, u64::MAX - 1, u64::MAX] {
            for divisor in [1, 2, 0xFFFF_FFFF, 1 << 32, 1 << 63, u64::MAX] {
                assert_eq!(quotient(number, divisor), number / divisor);
            }
        }
        assert_eq!(quotient(7, 0), 7);
    }

    #[test]
    fn fractions_are_rounded_down() {
        let mut random = lengths(2);
        for _ in 0..200_000 {
            let (number, divisor) = (random(), (random() >> 1).max(1));
            for fraction in [0, 28, 32] {
                let whole = (number / divisor).min((1 << 31) - 1);
                let rest = u128::from(number % divisor) << fraction;
                let expected = (u128::from(whole) << fraction) + rest / u128::from(divisor);
                let found = quotient_with_fraction(number, divisor, fraction);
                assert_eq!(u128::from(found), expected, "{number}/{divisor}");
            }
        }
        assert_eq!(quotient_with_fraction(3, 0, 1), 6);
    }
}
