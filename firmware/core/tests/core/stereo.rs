//! Tests of the text form of stereo settings.

use glint_core::fixed::Q32_32;
use glint_core::stereo::{Stereo, Tint};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// The printed text form reads back as the same bits.
    #[test]
    fn eyes_come_back_bit_for_bit(
        half_separation in 0..=1_i64 << 32,
        beyond in 0..1_i64 << 40,
        tint in proptest::sample::select(&Tint::ALL[..]),
    ) {
        let least = Q32_32::lit("0.1").to_bits();
        let stereo = Stereo {
            half_separation: Q32_32::from_bits(half_separation),
            zero_parallax: Q32_32::from_bits(half_separation.max(least) + beyond),
            tint,
        };
        prop_assert_eq!(stereo.checked(), Ok(stereo));
        let text = stereo.to_string();
        prop_assert_eq!(Stereo::parse(&text), Ok(stereo));
    }

    #[test]
    fn no_text_upsets_the_parser(text in "[-+0-9.,a-z]{0,30}") {
        let _ = Stereo::parse(&text).map_err(|error| error.to_string());
    }
}

#[test]
fn mistakes_say_what_was_expected() {
    for (text, expected) in [
        ("", ": expected E,ZERO[,red-blue|red-cyan]"),
        ("0.05", "0.05: expected E,ZERO[,red-blue|red-cyan]"),
        ("x,3", "x,3: expected E,ZERO[,red-blue|red-cyan]"),
        (
            "0.05,3,red-blue,",
            "0.05,3,red-blue,: expected E,ZERO[,red-blue|red-cyan]",
        ),
        ("0,0", "ZERO 0: expected at least 0.1"),
    ] {
        let error = Stereo::parse(text).expect_err(text);
        assert_eq!(error.to_string(), expected);
    }
}
