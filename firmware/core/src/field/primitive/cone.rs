//! `cone:R,H`: a solid cone about the z axis.

use core::fmt;

use super::fixed_cone::FixedCone;
use super::fixed_sphere::{FixedSphere, FixedSpheres};
use crate::division::quotient;
use crate::field::argument::Arguments;
use crate::field::error::FieldError;
use crate::field::limits::{MAX_EXTENT, MAX_SPHERES, SMALLEST};
use crate::field::shape::{FieldKind, Member, Placed, SCALE};
use crate::field::surface::units;
use crate::fixed::Q32_32;

/// A solid cone about the z axis, with the origin half-way between its apex, which is above, and its base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cone {
    /// Radius of the base, in world units.
    pub radius: Q32_32,
    /// Height from the base to the apex, in world units.
    pub height: Q32_32,
}

impl FieldKind for Cone {
    type Solid = FixedSpheres;

    const NAME: &'static str = "cone";
    const FORM: &'static str = "cone:R,H";
    const ABOUT: &'static str =
        "a cone about the z axis with the radius R of its base and the height H";
    const EXAMPLE: &'static str = "cone:0.8,1.6";
    const MEMBER: Option<Member> = Some(Member::Second);
    const ROUND: bool = true;

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let radius = numbers.number("radius", [SMALLEST, MAX_EXTENT])?;
        let height = numbers.number("height", [SMALLEST, MAX_EXTENT])?;
        Ok(Self { radius, height })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{},{}", self.radius, self.height)
    }

    fn placed(&self) -> Placed<FixedSpheres> {
        let extent = [self.radius, self.radius, self.height / 2];
        Placed::bounded(self.fixed(SCALE), extent)
    }

    fn spheres(&self, scale: Q32_32) -> Option<FixedSpheres> {
        Some(self.fixed(scale))
    }
}

impl Cone {
    /// Converts the cone from world units to field units.
    fn fixed(&self, scale: Q32_32) -> FixedSpheres {
        let [radius, half] = [self.radius, self.height / 2].map(|x| units(x, scale) as i32);
        let cone = FixedCone::new(radius, half);
        let mut list = [FixedSphere::default(); MAX_SPHERES];
        list[0] = around(&cone);
        FixedSpheres {
            list,
            count: 1,
            repeated: false,
            cone: Some(cone),
        }
    }
}

/// The sphere around a cone: through apex and base, or about the base if the cone is wider than high.
fn around(cone: &FixedCone) -> FixedSphere {
    let (radius, height) = (i64::from(cone.radius), 2 * i64::from(cone.half));
    let (z, size) = match radius > height {
        true => (-cone.half, cone.radius),
        false => {
            // Rounded up.
            let square = (radius * radius + height * height) as u64;
            let size = quotient(square, 2 * height as u64) as i32 + 1;
            (cone.half - size, size)
        }
    };
    FixedSphere::new([0, 0, z], size)
}
