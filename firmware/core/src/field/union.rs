//! `union:A+B` and `smooth:K,A+B`: the union of a flat field and a round field, without or with a fillet (a rounded transition).

use core::fmt;

use super::argument::{Arguments, NumberText, check};
use super::error::FieldError;
use super::primitive::Primitive;
use crate::fixed::Q32_32;

/// Smallest and largest accepted width of a fillet, in world units.
const BLEND: [Q32_32; 2] = [Q32_32::lit("0.01"), Q32_32::lit("0.5")];

/// The union of a flat field and a round field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Union {
    flat: Primitive,
    round: Primitive,
    blend: Q32_32,
}

impl Union {
    /// Text forms and descriptions of the sharp and the smooth union.
    pub(super) const KINDS: [(&str, &str); 2] = [
        (
            "union:A+B",
            "A menger or box, B sphere, spheres or moving, both together",
        ),
        (
            "smooth:K,A+B",
            "the same with a fillet of the width K between them",
        ),
    ];

    /// An example of the sharp and of the smooth union.
    pub(super) const EXAMPLES: [&str; 2] = [
        "union:box:1.2,1.2,0.15+sphere:0.7",
        "smooth:0.3,box:1.2,1.2,0.15+sphere:0.7",
    ];

    /// The console commands that set camera and appearance for pictures of the examples.
    pub(super) const LOOK: &[&str] = &["camera 4 30 60"];

    /// Makes a union of two fields (its members) with a fillet of the width `blend` in world units; 0 means no fillet.
    ///
    /// # Errors `flat` or `round` is of a kind that unions do not accept, or the width is out of range.
    pub fn new(
        flat: Primitive,
        round: Primitive,
        blend: Q32_32,
    ) -> Result<Self, FieldError<'static>> {
        if blend != Q32_32::ZERO {
            check("k", blend, BLEND)?;
        }
        if flat.joins() && !flat.is_round() && round.joins() && round.is_round() {
            Ok(Self { flat, round, blend })
        } else {
            Err(FieldError::Union)
        }
    }

    /// The flat member of the union.
    pub const fn flat(&self) -> &Primitive {
        &self.flat
    }

    /// The round member of the union.
    pub const fn round(&self) -> &Primitive {
        &self.round
    }

    /// The round member of the union, for motion: a change must keep its kind and its extent.
    pub(super) const fn round_mut(&mut self) -> &mut Primitive {
        &mut self.round
    }

    /// Width of the fillet in world units: the fillet covers points whose distances to the two members differ by at most this
    /// width. 0 means no fillet.
    pub const fn blend(&self) -> Q32_32 {
        self.blend
    }

    /// Parses the members after `union:`.
    pub(super) fn parse_sharp(text: &str) -> Result<Self, FieldError<'_>> {
        Self::parse(text, Q32_32::ZERO)
    }

    /// Parses the width and the members after `smooth:`.
    pub(super) fn parse_smooth(text: &str) -> Result<Self, FieldError<'_>> {
        let (blend, members) = text.split_once(',').ok_or(FieldError::Union)?;
        let blend = NumberText::new("smooth", blend).number("k", BLEND)?;
        Self::parse(members, blend)
    }

    fn parse(text: &str, blend: Q32_32) -> Result<Self, FieldError<'_>> {
        let (flat, round) = text.split_once('+').ok_or(FieldError::Union)?;
        let member = |text| Primitive::parse(text).unwrap_or(Err(FieldError::Union));
        Self::new(member(flat)?, member(round)?, blend)
    }

    /// Makes a union of the given members with a random fillet, or without one.
    pub(super) fn draw(
        flat: Primitive,
        round: Primitive,
        numbers: &mut impl Arguments<'static>,
    ) -> Result<Self, FieldError<'static>> {
        let blend = match numbers.integer("fillet", [0, 1])? {
            0 => Q32_32::ZERO,
            _ => numbers.number("k", BLEND)?,
        };
        Self::new(flat, round, blend)
    }
}

impl fmt::Display for Union {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.blend == Q32_32::ZERO {
            f.write_str("union:")?;
        } else {
            write!(f, "smooth:{},", self.blend)?;
        }
        write!(f, "{}+{}", self.flat, self.round)
    }
}
