//! `cubes:PERIOD,HALF` and `boxes:PERIOD,X,Y,Z`: lattices of cubes and of boxes.

use core::fmt;

use super::cuboid::FixedBox;
use crate::field::argument::Arguments;
use crate::field::error::FieldError;
use crate::field::limits::{PERIOD, SMALLEST, largest_half};
use crate::field::shape::{FieldKind, Member, Placed, scale_of};
use crate::field::surface::units;
use crate::fixed::Q32_32;

/// A lattice of cubes, whose centres are at all multiples of the period along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cubes {
    /// Distance between the centres of neighbouring cubes, in world units.
    pub period: Q32_32,
    /// Half the side of a cube in world units; less than half the period by at least one unit of coordinates.
    pub half: Q32_32,
}

/// A lattice of boxes, whose centres are at all multiples of the period along each axis.
///
/// Boxes with half the period as half side along an axis touch along this axis, so the solid is unbounded there: with two such axes the
/// solid consists of parallel plates, and with one such axis of pillars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Boxes {
    /// Distance between the centres of neighbouring boxes along each axis, in world units.
    pub period: Q32_32,
    /// Half the sides of a box in world units, at most half the period.
    pub half: [Q32_32; 3],
}

impl FieldKind for Cubes {
    type Solid = FixedBox;

    const NAME: &'static str = "cubes";
    const FORM: &'static str = "cubes:PERIOD,HALF";
    const ABOUT: &'static str = "a lattice of cubes with the half side HALF";
    const EXAMPLE: &'static str = "cubes:2,0.8";
    const LOOK: &'static [&'static str] = &[
        "lookat 1 -1 1 -1 1.2 -1.5",
        "fov 66",
        "background sky",
        "fog 0.15",
    ];
    const MEMBER: Option<Member> = Some(Member::First);

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let period = numbers.number("period", PERIOD)?;
        let half = numbers.number("half", [SMALLEST, largest_half(period)])?;
        Ok(Self { period, half })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{},{}", self.period, self.half)
    }

    fn placed(&self) -> Placed<FixedBox> {
        Boxes {
            period: self.period,
            half: [self.half; 3],
        }
        .placed()
    }
}

impl FieldKind for Boxes {
    type Solid = FixedBox;

    const NAME: &'static str = "boxes";
    const FORM: &'static str = "boxes:PERIOD,X,Y,Z";
    const ABOUT: &'static str =
        "a lattice of boxes with the half sides X, Y, Z; boxes with a half side of PERIOD/2 touch";
    const EXAMPLE: &'static str = "boxes:2,0.7,0.3,0.12";
    const LOOK: &'static [&'static str] = &[
        "lookat 1 -1 0.9 -0.7 1.5 -0.35",
        "fov 70",
        "background sky",
        "fog 0.1",
    ];
    const MEMBER: Option<Member> = Some(Member::First);

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let period = numbers.number("period", PERIOD)?;
        let mut side = |name| numbers.number(name, [SMALLEST, period / 2]);
        let half = [side("x")?, side("y")?, side("z")?];
        Ok(Self { period, half })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.half;
        write!(f, "{},{x},{y},{z}", self.period)
    }

    fn placed(&self) -> Placed<FixedBox> {
        let scale = scale_of(self.period);
        let half = self.half.map(|x| units(x, scale) as i32);
        Placed {
            scale,
            ..Placed::endless(FixedBox::repeated(half))
        }
    }
}
