//! Tests of rates: for times of up to a year, angles equal the results of exact arithmetic.

use glint_core::animation::Rate;
use glint_core::fixed::{Q32_32, U32_32};
use proptest::prelude::*;

/// The angle in units of 2^-32 turns, rounded down, modulo one turn.
fn exact(rate: Q32_32, time: U32_32) -> u32 {
    let product = i128::from(rate.to_bits()) * i128::from(time.to_bits());
    // The product has 64 fraction bits and is in degrees.
    product.div_euclid(360 << 32) as u32
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn an_angle_is_exact_for_a_year(rate in -(360_i64 << 32)..=360 << 32, time in 0..=(365_u64 * 86_400) << 32) {
        let [rate, time] = [Q32_32::from_bits(rate), Q32_32::from_bits(time as i64)];
        let time = U32_32::from_num(time);
        let found = Rate::new(rate).expect("in range").angle(time);
        prop_assert!(found.0.wrapping_sub(exact(rate, time)) <= 1, "{} {}", rate, time);
    }
}

#[test]
fn rates_have_a_limit() {
    let rate = |text| Rate::new(Q32_32::lit(text));
    assert!(rate("360").is_some() && rate("-360").is_some());
    assert!(rate("360.0001").is_none() && rate("-361").is_none());
    assert!(rate("0").is_some_and(Rate::is_zero));
    let turn = rate("-360").expect("in range").angle(U32_32::lit("0.25"));
    assert_eq!(turn.to_degrees(), 270);
}
