//! Formatting of values in replies.

use core::fmt::{self, Display};

use glint_core::fixed::Q32_32;

/// Displays a value, or `off` for `None`.
pub struct OrOff<T>(pub Option<T>);

impl<T: Display> Display for OrOff<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.0 {
            Some(value) => value.fmt(f),
            None => f.write_str("off"),
        }
    }
}

/// Displays the three numbers of a vector with six decimals each.
pub struct Vector(pub [Q32_32; 3]);

impl Display for Vector {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "{x:.6} {y:.6} {z:.6}")
    }
}
