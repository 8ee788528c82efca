//! Fields as they are typed.

use glint_core::field::{Field, KINDS};
use glint_core::fixed::Q32_32;
use proptest::prelude::*;

fn number(least: &str, most: &str) -> impl Strategy<Value = Q32_32> {
    let [least, most] = [least, most].map(|x| x.parse::<Q32_32>().expect("a number").to_bits());
    (least..=most).prop_map(Q32_32::from_bits)
}

fn fields() -> impl Strategy<Value = Field> {
    prop_oneof![
        (1..=6_u8).prop_map(|depth| Field::Menger { depth }),
        [
            number("0.01", "12"),
            number("0.01", "12"),
            number("0.01", "12")
        ]
        .prop_map(|half| Field::Box { half }),
        (number("0.25", "16"), number("0.01", "0.12"))
            .prop_map(|(period, half)| Field::Cubes { period, half }),
        number("0.01", "12").prop_map(|half| Field::Planes { half }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// What is printed is read as the same bits.
    #[test]
    fn fields_come_back_bit_for_bit(field in fields()) {
        prop_assert_eq!(field.checked(), Ok(field));
        let text = field.to_string();
        prop_assert_eq!(Field::parse(&text), Ok(field));
    }

    #[test]
    fn no_text_upsets_the_parser(text in "(menger|box|cubes|planes)?:?[-+0-9.,a-z]{0,30}") {
        let _ = Field::parse(&text).map_err(|error| error.to_string());
    }
}

#[test]
fn mistakes_say_what_was_expected() {
    let error = Field::parse("ball:1").expect_err("no kind").to_string();
    assert!(
        error.starts_with("no field is named ball: expected menger:DEPTH, "),
        "{error}"
    );
    assert!(KINDS.iter().all(|(form, _)| error.contains(form)));
    for (text, expected) in [
        ("menger", "menger needs one more number: depth"),
        ("box:1,2", "box needs one more number: z"),
        ("menger:4,4", "menger has one number too many: 4"),
        ("menger:x", "depth x: expected a number"),
        ("menger:0", "depth: expected 1 to 6"),
        ("menger:2.5", "depth: expected 1 to 6"),
        ("planes:13", "half: expected 0.01 to 12"),
    ] {
        let error = Field::parse(text).expect_err(text);
        assert_eq!(error.to_string(), expected);
    }
}
