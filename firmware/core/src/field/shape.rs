//! The definition of a kind of field: its name, its numbers, and the solid that the raymarcher evaluates.

use core::fmt;

use super::argument::Arguments;
use super::error::FieldError;
use super::primitive::FixedSpheres;
use super::surface::FieldSample;
use crate::fixed::Q32_32;

/// A kind of field, and its text form.
pub trait FieldKind: Sized {
    /// The type of the solid with lengths in field units, which the raymarcher evaluates.
    type Solid;
    /// The name of the kind: the word before the colon of the text form.
    const NAME: &'static str;
    /// The text form with names instead of numbers, for the help.
    const FORM: &'static str;
    /// Description of the kind, for the help.
    const ABOUT: &'static str;
    /// An example of this kind in text form, for tests of pictures and for the live page.
    const EXAMPLE: &'static str;
    /// The console commands that set camera and appearance for a picture of the example.
    const LOOK: &'static [&'static str] = &["camera 3.2 30 60"];
    /// Which member of a union the kind can be, if any.
    const MEMBER: Option<Member> = None;
    /// Whether the kind has spheres.
    const ROUND: bool = false;
    /// Whether the faces are perpendicular to the diagonals instead of the axes.
    const OCTANTS: bool = false;

    /// Reads the parameters of a field of this kind from `numbers`, which parses a text or generates random numbers.
    ///
    /// # Errors
    /// A number is missing, malformed or out of range.
    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>>;

    /// Writes the parameters of the field as in the text form.
    ///
    /// # Errors
    /// The formatter reports an error.
    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result;

    /// Converts the field to its solid in field units.
    fn placed(&self) -> Placed<Self::Solid>;

    /// The field's spheres in field units, with `scale` field units per world unit; `None` for a kind of field that cannot be the second
    /// member of a union.
    fn spheres(&self, scale: Q32_32) -> Option<FixedSpheres> {
        let _ = scale;
        None
    }
}

/// Which of the two members of a union a field can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    /// The first: a solid with flat faces, or a lattice.
    First,
    /// The second: one or several spheres.
    Second,
}

/// A solid with lengths in field units, with its scale and its bounding box in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed<S> {
    /// The solid, with lengths in field units.
    pub solid: S,
    /// Field units per world unit: 4 to 256.
    pub scale: Q32_32,
    /// Half the sides of the solid's bounding box, whose centre is the origin, in world units; `None` for an unbounded solid.
    pub extent: Option<[Q32_32; 3]>,
}

/// The scale, in field units per world unit, of a field without a period. With this scale the cubes of the Menger sponge's first
/// four levels have the sides 27, 9, 3 and 1.
pub const SCALE: Q32_32 = Q32_32::lit("40.5");

/// Computes the scale, in field units per world unit, of a field with the given period in world units. With this scale the period
/// is 64 field units.
pub fn scale_of(period: Q32_32) -> Q32_32 {
    const PERIOD: Q32_32 = Q32_32::lit("64");
    Q32_32::from_bits(((PERIOD.to_bits() << 16) / (period.to_bits() >> 8).max(1)) << 8)
}

impl<S> Placed<S> {
    /// Adds the scale of a field without a period, and half the sides of the bounding box in world units, to a solid.
    pub const fn bounded(solid: S, extent: [Q32_32; 3]) -> Self {
        Self {
            solid,
            scale: SCALE,
            extent: Some(extent),
        }
    }

    /// Adds the scale of a field without a period to an unbounded solid.
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
pub trait FlatSolid: Sized {
    /// The solid's number in the raymarcher's register field `solid.kind`, and the number of its bit in `caps.flat`.
    const CODE: u8;

    /// Computes the distance of a point from the solid, and the surface nearest to the point. Coordinates
    /// are in field units, s10.12.
    fn sample(&self, point: [i32; 3]) -> FieldSample;

    /// Computes only the distance of [`sample`](Self::sample), which is faster for some solids.
    fn distance(&self, point: [i32; 3]) -> i32 {
        self.sample(point).distance
    }

    /// Returns the solid's constants in the form of the gateware's registers.
    fn constants(&self) -> FlatConstants;

    /// Returns the solid with these constants, as the gateware takes them from its registers; constants of other solids have no effect.
    fn of(constants: &FlatConstants) -> Self;
}

/// The constants of a flat solid. Each constant has the name of its register or register field in the raymarcher, and is 0 if the
/// solid does not use it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlatConstants {
    /// The solid's number, [`FlatSolid::CODE`].
    pub kind: u8,
    /// Levels of the sponge to evaluate, one bit per level, the first level in bit 0.
    pub levels: u8,
    /// Axes along which the box has faces, one bit per axis, x in bit 0.
    pub has: u8,
    /// Whether the solid is outside the box.
    pub room: bool,
    /// Whether the solid is periodic with 64 field units along each axis.
    pub repeated: bool,
    /// Half the sides of a box along x, y and z, u10.12, or of a sponge's smallest cubes. For an octahedron, the first number is its size.
    pub half: [u32; 3],
}
