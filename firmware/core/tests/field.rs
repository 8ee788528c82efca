//! Fields as they are typed.

use glint_core::field::{Field, FieldError, KINDS, MAX_SPHERES, Sphere};
use glint_core::fixed::Q32_32;

const ROUND: [&str; 7] = [
    "sphere:1.5",
    "spheres:0,0.5,-1,0.25",
    "spheres:0,0.5,-1,0.25;11,-11,11,1;0.1,0.2,0.3,11.5",
    "lattice:2,0.5",
    "moving:0.25,0.75",
    "union:menger:4+sphere:1.25",
    "union:box:1,2,0.5+spheres:0,0.5,-1,0.25;1,1,1,0.5",
];

#[test]
fn a_field_prints_as_it_is_typed() {
    for text in ROUND {
        assert_eq!(Field::parse(text).unwrap().to_string(), text);
    }
}

#[test]
fn spheres_are_checked_one_by_one() {
    let sphere = |centre: i32, radius: i32| Sphere {
        centre: [Q32_32::from_num(centre); 3],
        radius: Q32_32::from_num(radius),
    };
    let all = [sphere(-4, 2); MAX_SPHERES + 1];
    let field = Field::spheres(&all[1..]).unwrap();
    assert_eq!(Field::parse(&field.to_string()), Ok(field));
    assert_eq!(Field::spheres(&all), Err(FieldError::Spheres));
    assert_eq!(Field::spheres(&[]), Err(FieldError::Spheres));
    assert_eq!(Field::parse("spheres"), Err(FieldError::Spheres));
    assert!(Field::spheres(&[sphere(0, 12)]).is_ok());
    let beyond = Field::spheres(&[sphere(0, 1), sphere(1, 12)]).unwrap_err();
    assert_eq!(beyond.to_string(), "centre: expected 0 to 0");
}

#[test]
fn what_is_wrong_is_said() {
    for (text, error) in [
        ("sphere", "sphere needs one more number: radius"),
        ("sphere:0", "radius: expected 0.01 to 12"),
        ("sphere:1,2", "sphere has one number too many: 2"),
        ("spheres:0,0,0", "spheres needs one more number: radius"),
        ("spheres:0,0,0,1;0,x,0,1", "y x: expected a number"),
        ("lattice:2,1", "radius: expected 0.01 to 0.9999999998"),
        ("moving:11,1.5", "orbit: expected 0 to 1"),
        (
            "union:cubes:1,0.1+sphere:1",
            "union: expected menger or box, +, and sphere, spheres or moving",
        ),
        ("union:menger:7+sphere:1", "depth: expected 1 to 6"),
    ] {
        assert_eq!(Field::parse(text).unwrap_err().to_string(), error);
    }
    let unknown = Field::parse("torus:1").unwrap_err().to_string();
    assert!(KINDS.iter().all(|(form, _)| unknown.contains(form)));
}
