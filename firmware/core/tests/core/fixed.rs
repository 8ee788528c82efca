//! Tests of decimals and angles.

use glint_core::fixed::fixed::traits::Fixed;
use glint_core::fixed::{Q2_14, Q2_23, Q2_30, Q32_32, Turns, U4_28};
use proptest::prelude::*;

/// Checks that the decimal of a number reads back as the same bits, and that no shorter decimal does.
#[track_caller]
fn assert_shortest<T: Fixed + std::str::FromStr>(x: T) {
    let decimal = x.to_string();
    assert!(
        decimal.parse::<T>().is_ok_and(|back| back == x),
        "{decimal}"
    );
    if let Some((whole, fraction)) = decimal.split_once('.') {
        let digits = fraction.len() - 1;
        let shorter = &decimal[..whole.len() + 1 + digits];
        assert!(
            shorter.parse::<T>().is_ok_and(|back| back != x),
            "{decimal}"
        );
        // `shorter` is the decimal without its last digit, so it is rounded towards 0. The decimal of the same length that is
        // rounded away from 0 must not read back as the same bits either.
        let above = format!(
            "{:.digits$}",
            x.to_num::<f64>() + 0.5 * 0.1_f64.powi(digits as i32) * x.to_num::<f64>().signum()
        );
        assert!(above.parse::<T>() != Ok(x), "{decimal} {above}");
    }
}

#[test]
fn every_q2_14_comes_back_from_its_shortest_decimal() {
    (i16::MIN..=i16::MAX)
        .map(Q2_14::from_bits)
        .for_each(assert_shortest);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn numbers_come_back_from_their_shortest_decimals(bits in any::<i64>(), shift in 0..63) {
        let bits = bits >> shift;
        assert_shortest(Q2_23::from_bits(bits as i32 >> 7));
        assert_shortest(Q2_30::from_bits(bits as i32));
        assert_shortest(U4_28::from_bits(bits as u32));
        // `assert_shortest` computes in f64, so the number tested has at most 53 bits.
        assert_shortest(Q32_32::from_bits(bits >> 11));
        prop_assert_eq!(Q32_32::from_bits(bits).to_string().parse(), Ok(Q32_32::from_bits(bits)));
    }

    #[test]
    fn no_text_upsets_the_parser(text in any::<String>(), number in "[-+]?[0-9_]{0,40}[.]?[0-9_]{0,80}([eE][-+]?[0-9]{0,12})?") {
        for text in [text, number] {
            let _ = (text.parse::<Q2_14>(), text.parse::<Q2_23>(), text.parse::<Q32_32>(), text.parse::<U4_28>());
        }
    }
}

#[test]
fn decimals_are_rounded_to_the_nearest_and_ties_to_even() {
    let bits = |decimal: &str| {
        decimal
            .parse::<Q2_14>()
            .map(Q2_14::to_bits)
            .map_err(|error| error.to_string())
    };
    // Half a unit of the format, 2^-15, and three halves: ties are rounded to even.
    assert_eq!(bits("-0.000091552734375"), Ok(-2));
    assert_eq!(bits("-0.000030517578125"), Ok(0));
    assert_eq!(bits("+.5"), Ok(1 << 13));
    assert_eq!(bits("5e-1"), Ok(1 << 13));
    for wrong in ["-", "1.2.3", "0x1", "inf", " 1", "1e", "--1", "٣"] {
        assert!(bits(wrong).is_err(), "{wrong}");
    }
    for too_large in ["2", "1e300", "-99999999999999999999"] {
        assert!(bits(too_large).is_err(), "{too_large}");
    }
}

#[test]
fn angles_are_degrees_without_whole_turns() {
    let turns = |degrees: &str| Turns::from_degrees(degrees.parse().expect("a number"));
    assert_eq!(turns("0"), Turns(0));
    assert_eq!(turns("90"), Turns::QUARTER);
    assert_eq!(turns("-90"), -Turns::QUARTER);
    assert_eq!(turns("180"), Turns::HALF);
    assert_eq!(turns("360"), Turns(0));
    assert_eq!(turns("-810"), -Turns::QUARTER);
    assert_eq!(turns("45"), Turns(1 << 29));
    // One degree is 11930464.71 units of 2^-32 turns.
    assert_eq!(turns("1"), Turns(11_930_465));
    assert_eq!(turns("-1"), -Turns(11_930_465));
    for extreme in [Q32_32::MIN, Q32_32::MAX] {
        let turns = f64::from(Turns::from_degrees(extreme).0) / 2f64.powi(32);
        let exact = (extreme.to_num::<f64>() / 360.0).rem_euclid(1.0);
        assert!((turns - exact).abs() < 1e-6, "{turns} {exact}");
    }
    for angle in (0..1 << 16).map(|k: u32| Turns(k.wrapping_mul(2_654_435_769))) {
        assert_eq!(Turns::from_degrees(angle.to_degrees()), angle);
    }
}
