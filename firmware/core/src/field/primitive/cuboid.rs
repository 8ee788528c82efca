//! `box:X,Y,Z` and `planes:HALF`: a box, and the space between a floor and a ceiling. Lattices of
//! boxes use the same solid.

use core::fmt;

use crate::field::argument::Arguments;
use crate::field::error::FieldError;
use crate::field::folded::{Folded, largest};
use crate::field::limits::{MAX_EXTENT, SMALLEST};
use crate::field::shape::{FieldKind, FlatConstants, FlatSolid, Member, Placed, SCALE};
use crate::field::surface::{FRACTION, FieldSample, cropped, units};
use crate::fixed::Q32_32;

/// A box about the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cuboid {
    /// Half the length of each side, in world units.
    pub half: [Q32_32; 3],
}

/// An infinite floor and an infinite ceiling, perpendicular to the z axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planes {
    /// Distance of the ceiling and of the floor from the origin, in world units.
    pub half: Q32_32,
}

impl FieldKind for Cuboid {
    type Solid = FixedBox;

    const NAME: &'static str = "box";
    const FORM: &'static str = "box:X,Y,Z";
    const ABOUT: &'static str = "a box about the origin with the half sides X, Y, Z";
    const EXAMPLE: &'static str = "box:1,0.5,0.25";
    const MEMBER: Option<Member> = Some(Member::First);

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let mut side = |name| numbers.number(name, [SMALLEST, MAX_EXTENT]);
        let half = [side("x")?, side("y")?, side("z")?];
        Ok(Self { half })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.half;
        write!(f, "{x},{y},{z}")
    }

    fn placed(&self) -> Placed<FixedBox> {
        let solid = FixedBox {
            half: self.half.map(|x| Some(units(x, SCALE) as i32)),
            room: false,
            repeated: false,
        };
        Placed::bounded(solid, self.half)
    }
}

impl FieldKind for Planes {
    type Solid = FixedBox;

    const NAME: &'static str = "planes";
    const FORM: &'static str = "planes:HALF";
    const ABOUT: &'static str = "a floor and a ceiling at +-HALF";
    const EXAMPLE: &'static str = "planes:0.9";
    const LOOK: &'static [&'static str] = &[
        "lookat 0 0 0.3 0.5 1 -0.2",
        "material jade",
        "light 1,1,2,ffe0c0",
        "light 1,1,-2,6080c0",
        "background sky",
        "fog 0.2",
    ];
    const MEMBER: Option<Member> = Some(Member::First);

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let half = numbers.number("half", [SMALLEST, MAX_EXTENT])?;
        Ok(Self { half })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.half)
    }

    fn placed(&self) -> Placed<FixedBox> {
        let half = units(self.half, SCALE) as i32;
        Placed::endless(FixedBox {
            half: [None, None, Some(half)],
            room: true,
            repeated: false,
        })
    }
}

/// A box, a lattice of boxes, or a room (the space inside a box, with the solid around it), in field units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedBox {
    /// Half the length of each side, u10.12; `None` along an axis on which the box is unbounded. Repeated boxes with the half side
    /// 2^17 touch along this axis, because every coordinate in a cell is below 2^17.
    half: [Option<i32>; 3],
    /// Whether the box is a room, with the solid outside the box.
    room: bool,
    /// Whether the solid is periodic with 64 field units along each axis.
    repeated: bool,
}

impl FixedBox {
    /// A lattice of boxes with these half sides, at most 2^17.
    pub(super) fn repeated(half: [i32; 3]) -> Self {
        Self {
            half: half.map(Some),
            room: false,
            repeated: true,
        }
    }
}

impl FlatSolid for FixedBox {
    const CODE: u8 = 1;

    /// Computes the distance as the maximum of |x| − half over the axes, with the opposite sign in a room.
    #[inline]
    fn sample(&self, point: [i32; 3]) -> FieldSample {
        // A period of 64 field units is 2^18 in s10.12, so the lowest 18 bits of a coordinate, as a signed number, are the
        // coordinate relative to the centre of its cell.
        let wrap = |x: i32| {
            if self.repeated {
                cropped(x, 6 + FRACTION)
            } else {
                x
            }
        };
        let p = Folded::of(point.map(wrap)).map(|x| x.negated_if(x.value < 0));
        // The distance along an axis on which the box is unbounded: less than every distance to a face, so the maximum ignores
        // this number. The number fits 23 bits.
        let nowhere = -1 << (10 + FRACTION);
        let outside =
            [0, 1, 2].map(|i: usize| self.half[i].map_or(nowhere, |half| p[i].value - half));
        let big = largest(outside);
        let nearest = p[big].with(outside[big]).negated_if(self.room);
        FieldSample {
            distance: nearest.value,
            surface: nearest.face(),
        }
    }

    fn constants(&self) -> FlatConstants {
        let [x, y, z] = self.half.map(|half| u8::from(half.is_some()));
        FlatConstants {
            kind: Self::CODE,
            has: x | y << 1 | z << 2,
            room: self.room,
            repeated: self.repeated,
            half: self.half.map(|half| half.unwrap_or(0) as u32),
            ..FlatConstants::default()
        }
    }

    fn of(constants: &FlatConstants) -> Self {
        let has = |axis: usize| constants.has >> axis & 1 == 1;
        Self {
            half: [0, 1, 2].map(|axis: usize| has(axis).then_some(constants.half[axis] as i32)),
            room: constants.room,
            repeated: constants.repeated,
        }
    }
}
