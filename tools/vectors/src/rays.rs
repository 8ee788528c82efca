//! Single rays by exits, with an exact origin and direction.

use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, U4_28};
use glint_model::raymarch::exits::{Exits, Words};

/// The largest value that a component of a direction can have, just below 1, in units of 2^−27.
pub const ONE: i32 = (1 << 27) - 1;

/// A frame in which all rays start at `eye`, in units of 2^−12 field units, and have one direction, in units of 2^−27. The near plane is at
/// the eye.
///
/// # Panics
/// If the text is not a field, or the eye is beyond a camera's range.
pub fn frame(field: &str, eye: [i32; 3], direction: [i32; 3]) -> Exits {
    let field = Field::parse(field).expect("a field");
    let old = View::spherical(Q32_32::from_num(4), Default::default(), Default::default())
        .expect("a camera");
    let exits =
        |view: &View| Exits::new(&field, view, (320, 180), None, Words::CHOSEN).expect("a frame");
    let scale = exits(&old).scale.to_num::<f64>();
    let place = eye.map(|x| Q32_32::from_num(f64::from(x) / 4096.0 / scale));
    let near = U4_28::from_num(0.01);
    let view = View::new_checked(place, old.u(), old.v(), old.n(), old.half_width(), near);
    let mut exits = exits(&view.expect("an eye within its range"));
    exits.near = 0;
    exits.aim(direction.map(|part| part << 3));
    exits
}
