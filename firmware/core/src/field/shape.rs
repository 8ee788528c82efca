//! The definition of a kind of field: its name, its numbers, and the solid that the engine evaluates.

use core::fmt;

use super::argument::Arguments;
use super::error::FieldError;
use super::surface::Sample;
use crate::fixed::Q32_32;

/// A kind of field with its text form.
pub trait Shape: Sized {
    /// The solid type in field units.
    type Solid;
    /// The word before the colon.
    const NAME: &'static str;
    /// Text form with the names of the numbers, for the help.
    const FORM: &'static str;
    /// Description, for the help.
    const ABOUT: &'static str;
    /// An example of this kind, for tests of pictures.
    const EXAMPLE: &'static str;
    /// Whether the kind can be a member of a union: a flat kind is the first member, a round kind the second.
    const JOINS: bool = false;
    /// Whether the kind has spheres.
    const ROUND: bool = false;
    /// Whether the faces are perpendicular to the diagonals instead of the axes.
    const OCTANTS: bool = false;

    /// Reads the numbers of a field of this kind, from a text or at random.
    ///
    /// # Errors
    /// A number is missing, malformed or out of range.
    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>>;

    /// Writes the numbers in text form.
    ///
    /// # Errors
    /// The formatter reports an error.
    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result;

    /// The solid in field units.
    fn placed(&self) -> Placed<Self::Solid>;
}

/// A solid in field units, with its scale and bounding box in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed<S> {
    /// The solid.
    pub solid: S,
    /// Field units per world unit: 2 to 256.
    pub scale: Q32_32,
    /// Half the sides of the bounding box about the origin, in world units; `None` for an unbounded solid.
    pub extent: Option<[Q32_32; 3]>,
}

/// Field units per world unit for a field without a period. With this scale the cubes of the Menger sponge's first four levels
/// have the sides 27, 9, 3 and 1.
pub const SCALE: Q32_32 = Q32_32::lit("40.5");

/// Field units per world unit for a field with the given period in world units, so that the period is 64 field units.
pub fn scale_of(period: Q32_32) -> Q32_32 {
    const PERIOD: Q32_32 = Q32_32::lit("64");
    Q32_32::from_bits(((PERIOD.to_bits() << 16) / (period.to_bits() >> 8).max(1)) << 8)
}

impl<S> Placed<S> {
    /// A solid without a period, in a bounding box.
    pub const fn bounded(solid: S, extent: [Q32_32; 3]) -> Self {
        Self {
            solid,
            scale: SCALE,
            extent: Some(extent),
        }
    }

    /// An unbounded solid without a period.
    pub const fn endless(solid: S) -> Self {
        Self {
            solid,
            scale: SCALE,
            extent: None,
        }
    }

    /// Converts the solid, and keeps scale and bounding box.
    pub fn map<T>(self, into: impl FnOnce(S) -> T) -> Placed<T> {
        Placed {
            solid: into(self.solid),
            scale: self.scale,
            extent: self.extent,
        }
    }
}

/// A solid with flat faces, which one module of the gateware evaluates.
pub trait FlatSolid {
    /// The solid's number in the raymarcher's register field `solid.kind`, and the number of its bit in `caps.flat`.
    const CODE: u8;

    /// Distance and nearest surface at a point with coordinates in s10.12, in field units.
    fn sample(&self, point: [i32; 3]) -> Sample;

    /// The solid's constants, as the gateware's registers hold them.
    fn constants(&self) -> FlatConstants;
}

/// The constants of a flat solid, by the names of their registers. A constant that the solid does not use is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlatConstants {
    /// [`FlatSolid::CODE`].
    pub kind: u8,
    /// Which levels of the sponge are evaluated, the first level in bit 0.
    pub levels: u8,
    /// Axes along which the box has faces, x in bit 0.
    pub has: u8,
    /// Whether the solid is outside the box.
    pub room: bool,
    /// Whether the solid is periodic with 64 units along each axis.
    pub repeated: bool,
    /// Half the side of a sponge's smallest cubes, u10.12.
    pub cube_half: u32,
    /// Half the sides of a box along x, y and z, u10.12; other solids keep their lengths here.
    pub half: [u32; 3],
}
