//! `octahedron:S`: the solid |x| + |y| + |z| ≤ S.

use core::fmt;

use crate::field::argument::Arguments;
use crate::field::error::FieldError;
use crate::field::limits::{MAX_EXTENT, SMALLEST};
use crate::field::shape::{FieldKind, FlatConstants, FlatSolid, Placed, SCALE};
use crate::field::surface::{FieldSample, Surface, magnitude, units};
use crate::fixed::Q32_32;

/// A regular octahedron about the origin, with corners on the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Octahedron {
    /// Distance from the origin to a corner, in world units.
    pub size: Q32_32,
}

impl FieldKind for Octahedron {
    type Solid = FixedOctahedron;

    const NAME: &'static str = "octahedron";
    const FORM: &'static str = "octahedron:S";
    const ABOUT: &'static str =
        "a regular octahedron about the origin with corners at the distance S";
    const EXAMPLE: &'static str = "octahedron:1";
    const OCTANTS: bool = true;

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let size = numbers.number("size", [SMALLEST, MAX_EXTENT])?;
        Ok(Self { size })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.size)
    }

    fn placed(&self) -> Placed<FixedOctahedron> {
        let size = units(self.size, SCALE) as i32;
        Placed::bounded(FixedOctahedron { size }, [self.size; 3])
    }
}

/// The octahedron with lengths in field units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedOctahedron {
    /// Distance from the origin to a corner, u10.12.
    size: i32,
}

impl FlatSolid for FixedOctahedron {
    const CODE: u8 = 2;

    /// Computes the distance in the maximum norm. Within a cube of half side r about the point, |x| + |y| + |z| changes by at
    /// most 3r, so the distance is (|x| + |y| + |z| − size)/3. The product with 85/256, rounded down, approximates this
    /// third from below outside the solid.
    #[inline]
    fn sample(&self, point: [i32; 3]) -> FieldSample {
        let sum: u32 = point.map(magnitude).iter().sum();
        let positive = |i: usize| u8::from(point[i] >= 0) << i;
        FieldSample {
            distance: ((sum as i32 - self.size) * 85) >> 8,
            surface: Surface::Octant {
                signs: positive(0) | positive(1) | positive(2),
            },
        }
    }

    fn constants(&self) -> FlatConstants {
        FlatConstants {
            kind: Self::CODE,
            half: [self.size as u32, 0, 0],
            ..FlatConstants::default()
        }
    }

    fn of(constants: &FlatConstants) -> Self {
        let [size, ..] = constants.half;
        Self { size: size as i32 }
    }
}
