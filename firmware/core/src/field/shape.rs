//! What a kind of field defines: its name, its numbers, and the solid that the engine evaluates.

use core::fmt;

use super::argument::Arguments;
use super::error::FieldError;
use super::surface::Sample;
use crate::fixed::Q32_32;

/// A kind of field as it is typed.
pub trait Shape: Sized {
    /// Its solid in field units.
    type Solid;
    /// The word before the colon.
    const NAME: &'static str;
    /// Name and numbers, for help.
    const FORM: &'static str;
    /// Description, for help.
    const ABOUT: &'static str;
    /// A field of this kind for tests of pictures.
    const EXAMPLE: &'static str;
    /// Whether a union can have it: as its first member where it is flat, as its second where it is round.
    const JOINS: bool = false;
    /// Whether it has spheres.
    const ROUND: bool = false;
    /// Whether its faces are perpendicular to the diagonals, and not to the axes.
    const OCTANTS: bool = false;

    /// Reads the numbers.
    ///
    /// # Errors
    /// Those of the numbers.
    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>>;

    /// Writes the numbers as they are typed.
    ///
    /// # Errors
    /// Those of the formatter.
    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result;

    /// The solid in field units.
    fn placed(&self) -> Placed<Self::Solid>;
}

/// A solid in field units, and its place in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed<S> {
    /// The solid.
    pub solid: S,
    /// Field units in a world unit: 2 to 256.
    pub scale: Q32_32,
    /// Half the sides of the box about the origin that holds it, in world units; none where it has no end.
    pub extent: Option<[Q32_32; 3]>,
}

/// Field units in a world unit of a field without a period: S of the sponge's levels is then 27, 9, 3, 1.
pub const SCALE: Q32_32 = Q32_32::lit("40.5");

/// Field units in a world unit of a field with a period, given in world units: 64 to the period.
pub fn scale_of(period: Q32_32) -> Q32_32 {
    const PERIOD: Q32_32 = Q32_32::lit("64");
    Q32_32::from_bits(((PERIOD.to_bits() << 16) / (period.to_bits() >> 8).max(1)) << 8)
}

impl<S> Placed<S> {
    /// A solid without a period, in a box.
    pub const fn bounded(solid: S, extent: [Q32_32; 3]) -> Self {
        Self {
            solid,
            scale: SCALE,
            extent: Some(extent),
        }
    }

    /// A solid without a period and without end.
    pub const fn endless(solid: S) -> Self {
        Self {
            solid,
            scale: SCALE,
            extent: None,
        }
    }

    /// The same place of another type of solid.
    pub fn map<T>(self, into: impl FnOnce(S) -> T) -> Placed<T> {
        Placed {
            solid: into(self.solid),
            scale: self.scale,
            extent: self.extent,
        }
    }
}

/// A flat solid of the engine: one module of gateware.
pub trait FlatSolid {
    /// Its number in `solid.kind`, and its bit in `caps.flat`.
    const CODE: u8;

    /// The distance of a point, each coordinate s10.12.
    fn sample(&self, point: [i32; 3]) -> Sample;

    /// The constants that the gateware needs.
    fn constants(&self) -> FlatConstants;
}

/// The constants of a flat solid by the names of their registers; 0 where a solid has no such constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlatConstants {
    /// [`FlatSolid::CODE`].
    pub kind: u8,
    /// Levels of the sponge that count, the first one in bit 0.
    pub levels: u8,
    /// Axes along which the box has an end, x in bit 0.
    pub has: u8,
    /// The solid is outside the box.
    pub room: bool,
    /// The solid repeats itself every 64 units along each axis.
    pub repeated: bool,
    /// Half the side of the cubes that a sponge leaves, u10.12.
    pub cube_half: u32,
    /// Half the sides of a box along x, y and z, or other lengths of a solid, u10.12.
    pub half: [u32; 3],
}
