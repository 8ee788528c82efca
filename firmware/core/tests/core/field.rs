//! Tests of distance fields: their text form, and distances.

use glint_core::console::Command;
use glint_core::field::{
    EXAMPLES, Field, FieldError, Flat, FlatConstants, KINDS, MAX_SPHERES, Menger, Primitive, Solid,
    Sphere, Spheres,
};
use glint_core::fixed::Q32_32;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// `distance` equals the distance in `sample`, even at points with equal coordinates.
    #[test]
    fn the_distance_alone_is_that_of_the_sample(depth in 1..=6_u8, point in prop::array::uniform3(-1 << 21..1_i32 << 21), same in any::<bool>()) {
        let point = if same { [point[0], !point[0], point[2]] } else { point };
        let solid = Primitive::Menger(Menger { depth }).placed().solid;
        prop_assert_eq!(solid.distance(point), solid.sample(point).distance);
    }

    /// The printed text form of every field reads back as the same field.
    #[test]
    fn fields_come_back_bit_for_bit(seed in any::<u64>()) {
        let mut state = seed;
        let field = Field::draw(|| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as u32
        });
        let text = field.to_string();
        prop_assert_eq!(Field::parse(&text), Ok(field));
    }

    #[test]
    fn no_text_upsets_the_parser(
        kind in prop::sample::select([&Primitive::NAMES[..], &["", "union", "smooth"]].concat()),
        rest in ":?[-+0-9.,:;a-z]{0,30}"
    ) {
        let _ = Field::parse(&format!("{kind}{rest}")).map_err(|error| error.to_string());
    }
}

#[test]
fn spheres_are_checked_one_by_one() {
    let sphere = |centre: i32, radius: i32| Sphere {
        centre: [Q32_32::from_num(centre); 3],
        radius: Q32_32::from_num(radius),
    };
    let all = [sphere(-4, 2); MAX_SPHERES + 1];
    assert!(Spheres::new(&all[1..]).is_ok());
    let wrong_number = FieldError::Spheres(MAX_SPHERES);
    assert_eq!(Spheres::new(&all), Err(wrong_number));
    assert_eq!(Spheres::new(&[]), Err(wrong_number));
    assert_eq!(Field::parse("spheres"), Err(wrong_number));
    assert!(Spheres::new(&[sphere(0, 12)]).is_ok());
    let beyond = Spheres::new(&[sphere(0, 1), sphere(1, 12)]).unwrap_err();
    assert_eq!(beyond.to_string(), "centre: expected 0 to 0");
}

/// Texts that are not fields, and their errors.
const MISTAKES: &str = "\
menger => menger needs one more number: depth
box:1,2 => box needs one more number: z
menger:4,4 => menger has one number too many: 4
menger:x => depth x: expected a number
menger:0 => depth: expected 1 to 6
planes:13 => half: expected 0.01 to 12
boxes:2,1,1 => boxes needs one more number: z
boxes:2,1,1,1.1 => z: expected 0.01 to 1
sphere => sphere needs one more number: radius
sphere:0 => radius: expected 0.01 to 12
spheres:0,0,0 => spheres needs one more number: radius
spheres:0,0,0,1;0,x,0,1 => y x: expected a number
lattice:2,1 => radius: expected 0.01 to 0.9999923704
moving:11,1.5 => orbit: expected 0 to 1
cone:1 => cone needs one more number: height
cone:1,13 => height: expected 0.01 to 12
smooth:0.1 => smooth: expected menger or box, +, and sphere, spheres or moving
union:octahedron:1+sphere:1 => union: expected menger, box, cubes, boxes, planes or lattice, +, and sphere, spheres, moving or cone
bent:5,planes:2+sphere:1 => bent: expected menger or box, +, and sphere, spheres or moving
bent:5,box:1,1,1+cone:1,1 => bent: expected menger or box, +, and sphere, spheres or moving
bent:7,box:1,1,1+sphere:1 => n: expected 1 to 6
smooth:0.1,box:1,1,1+cone:1,1 => smooth: expected menger or box, +, and sphere, spheres or moving
smooth:0.1,cubes:2,0.4+sphere:1 => smooth: expected menger or box, +, and sphere, spheres or moving
union:lattice:1,0.1+spheres:0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1 => spheres: expected 1 to 7
union:cubes:0.25,0.1+sphere:4 => radius: expected 0.01 to 3.99609375
";

#[test]
fn mistakes_say_what_was_expected() {
    let error = Field::parse("ball:1").expect_err("no kind").to_string();
    assert!(KINDS.iter().all(|(form, _)| error.contains(form)));
    for (text, expected) in MISTAKES.lines().filter_map(|line| line.split_once(" => ")) {
        let error = Field::parse(text).expect_err(text);
        assert_eq!(error.to_string(), expected);
    }
}

/// The example of a kind is of that kind, and all its lines are settings.
#[test]
fn every_kind_has_an_example_and_its_look() {
    for ((form, _), example) in KINDS.iter().zip(&EXAMPLES) {
        let kind = |text: &str| text.split(':').next().unwrap().to_owned();
        assert_eq!(kind(form), kind(example.field));
        let field = Field::parse(example.field).expect(example.field);
        assert_eq!(Field::parse(&field.to_string()), Ok(field));
        assert!(!example.look.is_empty());
        for line in example.look {
            let command = Command::parse(line).expect(line);
            assert!(matches!(command, Some(Command::Set(_))), "{line}");
        }
    }
}

/// A flat solid is restored from its constants in the gateware's registers.
#[test]
fn flat_solids_follow_from_their_constants() {
    let mut kinds = vec![];
    for example in Primitive::EXAMPLES
        .into_iter()
        .chain(["menger:1", "menger:6"])
    {
        let Ok(Field::Primitive(primitive)) = Field::parse(example) else {
            panic!("{example}");
        };
        let Solid::Flat(flat) = primitive.placed().solid else {
            continue;
        };
        assert_eq!(Flat::of(&flat.constants()), Some(flat), "{example}");
        kinds.push(flat.constants().kind);
    }
    kinds.dedup();
    assert_eq!(kinds, [0, 1, 2, 0]);
    let unknown = FlatConstants {
        kind: 3,
        ..FlatConstants::default()
    };
    assert_eq!(Flat::of(&unknown), None);
}
