//! Fields as they are typed.

use glint_core::field::{Field, FieldError, KINDS, MAX_SPHERES, Sphere};
use glint_core::fixed::{Q32_32, Turns};
use proptest::prelude::*;

fn number(least: &str, most: &str) -> impl Strategy<Value = Q32_32> + Clone {
    let [least, most] = [least, most].map(|x| x.parse::<Q32_32>().expect("a number").to_bits());
    (least..=most).prop_map(Q32_32::from_bits)
}

fn flat() -> impl Strategy<Value = Field> {
    prop_oneof![
        (1..=6_u8).prop_map(|depth| Field::Menger { depth }),
        [
            number("0.01", "12"),
            number("0.01", "12"),
            number("0.01", "12")
        ]
        .prop_map(|half| Field::Box { half }),
    ]
}

fn spheres() -> impl Strategy<Value = Field> {
    let place = number("-6", "6");
    let sphere = ([place.clone(), place.clone(), place], number("0.01", "6"))
        .prop_map(|(centre, radius)| Sphere { centre, radius });
    prop::collection::vec(sphere, 1..=MAX_SPHERES)
        .prop_map(|spheres| Field::spheres(&spheres).expect("all of them are within the extent"))
}

fn round() -> impl Strategy<Value = Field> {
    prop_oneof![
        number("0.01", "12").prop_map(|radius| Field::Sphere { radius }),
        spheres(),
        (number("0.01", "6"), number("0", "6"), any::<u32>()).prop_map(|(radius, orbit, angle)| {
            Field::Moving {
                radius,
                orbit,
                angle: Turns(angle),
            }
        }),
    ]
}

fn fields() -> impl Strategy<Value = Field> {
    prop_oneof![
        flat(),
        round(),
        (number("0.25", "16"), number("0.01", "0.12"))
            .prop_map(|(period, half)| Field::Cubes { period, half }),
        number("0.01", "12").prop_map(|half| Field::Planes { half }),
        (number("0.25", "16"), number("0.01", "0.12"))
            .prop_map(|(period, radius)| Field::Lattice { period, radius }),
        (flat(), round()).prop_map(|(flat, round)| {
            Field::parse(&format!("union:{flat}+{round}")).expect("one of each")
        }),
        (number("0.01", "0.5"), flat(), round()).prop_map(|(blend, flat, round)| {
            Field::parse(&format!("smooth:{blend},{flat}+{round}")).expect("one of each")
        }),
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
    fn no_text_upsets_the_parser(
        text in "(menger|box|cubes|planes|spheres?|lattice|moving|union|smooth)?:?[-+0-9.,:;a-z]{0,30}"
    ) {
        let _ = Field::parse(&text).map_err(|error| error.to_string());
    }
}

#[test]
fn spheres_are_checked_one_by_one() {
    let sphere = |centre: i32, radius: i32| Sphere {
        centre: [Q32_32::from_num(centre); 3],
        radius: Q32_32::from_num(radius),
    };
    let all = [sphere(-4, 2); MAX_SPHERES + 1];
    assert!(Field::spheres(&all[1..]).is_ok());
    assert_eq!(Field::spheres(&all), Err(FieldError::Spheres));
    assert_eq!(Field::spheres(&[]), Err(FieldError::Spheres));
    assert_eq!(Field::parse("spheres"), Err(FieldError::Spheres));
    assert!(Field::spheres(&[sphere(0, 12)]).is_ok());
    let beyond = Field::spheres(&[sphere(0, 1), sphere(1, 12)]).unwrap_err();
    assert_eq!(beyond.to_string(), "centre: expected 0 to 0");
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
        ("sphere", "sphere needs one more number: radius"),
        ("sphere:0", "radius: expected 0.01 to 12"),
        ("spheres:0,0,0", "spheres needs one more number: radius"),
        ("spheres:0,0,0,1;0,x,0,1", "y x: expected a number"),
        ("lattice:2,1", "radius: expected 0.01 to 0.9999999998"),
        ("moving:11,1.5", "orbit: expected 0 to 1"),
        (
            "union:cubes:1,0.1+sphere:1",
            "union: expected menger or box, +, and sphere, spheres or moving",
        ),
        ("union:menger:7+sphere:1", "depth: expected 1 to 6"),
        ("smooth:0.6,box:1,1,1+sphere:1", "k: expected 0.01 to 0.5"),
        (
            "smooth:0.1",
            "union: expected menger or box, +, and sphere, spheres or moving",
        ),
    ] {
        let error = Field::parse(text).expect_err(text);
        assert_eq!(error.to_string(), expected);
    }
}
