//! `union:A+B`, `smooth:K,A+B` and `bent:N,A+B`: the union of a field and of spheres or a cone, sharp, with a fillet (a rounded
//! transition), or bent: with the distance to the field multiplied by a power of two.

use core::fmt;

use super::argument::{Arguments, NumberText, check};
use super::error::FieldError;
use super::limits::{MAX_RADIUS, MAX_SPHERES, SMALLEST};
use super::primitive::Primitive;
use super::shape::Member;
use super::surface::FRACTION;
use crate::fixed::Q32_32;

/// Smallest and largest accepted width of a fillet, in world units.
const BLEND: [Q32_32; 2] = [Q32_32::lit("0.01"), Q32_32::lit("0.5")];

/// Largest exponent of the factor 2^N of a bent union.
const MOST_BEND: u8 = 6;

/// The union of a field with flat faces, or a lattice, and of spheres or a cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Union {
    first: Primitive,
    spheres: Primitive,
    blend: Q32_32,
    bend: u8,
}

impl Union {
    /// Text forms and descriptions of the sharp, the smooth and the bent union.
    pub(super) const KINDS: [(&str, &str); 3] = [
        (
            "union:A+B",
            "A is menger, box, cubes, boxes, planes or lattice; B is sphere, spheres, moving or cone; both form one solid",
        ),
        (
            "smooth:K,A+B",
            "A is menger or box; a fillet of the width K joins A and B",
        ),
        (
            "bent:N,A+B",
            "A is menger or box; the distance to A is multiplied by 2^N, N from 1 to 6, so that faces of A bend about B",
        ),
    ];

    /// An example of the sharp, of the smooth and of the bent union.
    pub(super) const EXAMPLES: [&str; 3] = [
        "union:box:1.2,1.2,0.15+sphere:0.7",
        "smooth:0.3,box:1.2,1.2,0.15+sphere:0.7",
        "bent:4,box:3,3,0.5+spheres:0,0,1.3,0.4;1.2,-1,1,0.25",
    ];

    /// The console commands that set camera and appearance for pictures of the examples.
    pub(super) const LOOK: &[&str] = &["camera 4 30 60"];

    /// Makes a union of two fields (its members) with a fillet of the width `blend` in world units; 0 means no fillet.
    ///
    /// # Errors
    /// `first` or `spheres` is of a kind that unions do not accept, or that unions with fillets do not accept. The width is out of range.
    /// In a field with a period, a radius exceeds its number format, or a lattice has too many spheres.
    pub fn new(
        first: Primitive,
        spheres: Primitive,
        blend: Q32_32,
    ) -> Result<Self, FieldError<'static>> {
        if first.member() != Some(Member::First) || spheres.member() != Some(Member::Second) {
            return Err(kind_error(blend));
        }
        let place = first.placed();
        if blend != Q32_32::ZERO {
            check("k", blend, BLEND)?;
            place.extent.ok_or(FieldError::Smooth)?;
            if matches!(spheres, Primitive::Cone(_)) {
                return Err(FieldError::Smooth);
            }
        }
        if let Some(list) = spheres.spheres(place.scale) {
            // The sphere of a lattice occupies an entry of the list.
            let most = MAX_SPHERES - usize::from(first.is_round());
            if list.count > most {
                return Err(FieldError::Spheres(most));
            }
            let height = list.cone.map(|cone| 2 * cone.half);
            let largest = (list.list.iter().take(list.count))
                .map(|sphere| sphere.radius)
                .chain(height)
                .max();
            if largest > Some(MAX_RADIUS << FRACTION) {
                return Err(FieldError::Range {
                    name: "radius",
                    least: SMALLEST,
                    most: Q32_32::from_num(MAX_RADIUS) / place.scale,
                });
            }
        }
        Ok(Self {
            first,
            spheres,
            blend,
            bend: 0,
        })
    }

    /// Makes a union in which the distance to the first member is multiplied by 2^`bend`, 1 to 6.
    ///
    /// # Errors
    /// `first` or `spheres` is of a kind that bent unions do not accept.
    fn bent(first: Primitive, spheres: Primitive, bend: u8) -> Result<Self, FieldError<'static>> {
        let union = Self::new(first, spheres, Q32_32::ZERO).map_err(|_| FieldError::Bent)?;
        if first.placed().extent.is_none() || matches!(spheres, Primitive::Cone(_)) {
            return Err(FieldError::Bent);
        }
        Ok(Self { bend, ..union })
    }

    /// The first member of the union: a field with flat faces, or a lattice.
    pub const fn first(&self) -> &Primitive {
        &self.first
    }

    /// The second member of the union: the spheres.
    pub const fn spheres(&self) -> &Primitive {
        &self.spheres
    }

    /// The second member of the union, for motion: a change must keep its kind and its extent.
    pub(super) const fn spheres_mut(&mut self) -> &mut Primitive {
        &mut self.spheres
    }

    /// Width of the fillet in world units: the fillet covers points whose distances to the two members differ by at most this
    /// width. 0 means no fillet.
    pub const fn blend(&self) -> Q32_32 {
        self.blend
    }

    /// Exponent N of the factor 2^N of the distance to the first member: 1 to 6 in a bent union, 0 in
    /// other unions.
    pub const fn bend(&self) -> u8 {
        self.bend
    }

    /// Parses the members after `union:`.
    pub(super) fn parse_sharp(text: &str) -> Result<Self, FieldError<'_>> {
        Self::parse(text, Q32_32::ZERO)
    }

    /// Parses the width and the members after `smooth:`.
    pub(super) fn parse_smooth(text: &str) -> Result<Self, FieldError<'_>> {
        let (blend, members) = text.split_once(',').ok_or(FieldError::Smooth)?;
        let blend = NumberText::new("smooth", blend).number("k", BLEND)?;
        Self::parse(members, blend)
    }

    /// Parses the exponent and the members after `bent:`.
    pub(super) fn parse_bent(text: &str) -> Result<Self, FieldError<'_>> {
        let (bend, members) = text.split_once(',').ok_or(FieldError::Bent)?;
        let bend = NumberText::new("bent", bend).integer("n", [1, MOST_BEND])?;
        let (first, spheres) = members.split_once('+').ok_or(FieldError::Bent)?;
        let member = |text| Primitive::parse(text).unwrap_or(Err(FieldError::Bent));
        Self::bent(member(first)?, member(spheres)?, bend)
    }

    fn parse(text: &str, blend: Q32_32) -> Result<Self, FieldError<'_>> {
        let kind = kind_error(blend);
        let (first, spheres) = text.split_once('+').ok_or(kind)?;
        let member = |text| Primitive::parse(text).unwrap_or(Err(kind));
        Self::new(member(first)?, member(spheres)?, blend)
    }

    /// Makes a union of the given members with a random fillet, or without one.
    pub(super) fn draw(
        first: Primitive,
        spheres: Primitive,
        numbers: &mut impl Arguments<'static>,
    ) -> Result<Self, FieldError<'static>> {
        let blend = match numbers.integer("fillet", [0, 1])? {
            0 => Q32_32::ZERO,
            _ => numbers.number("k", BLEND)?,
        };
        Self::new(first, spheres, blend)
    }
}

/// The error for members that a union with a fillet of this width does not accept.
fn kind_error(blend: Q32_32) -> FieldError<'static> {
    match blend == Q32_32::ZERO {
        true => FieldError::Union,
        false => FieldError::Smooth,
    }
}

impl fmt::Display for Union {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.bend != 0 {
            write!(f, "bent:{},", self.bend)?;
        } else if self.blend == Q32_32::ZERO {
            f.write_str("union:")?;
        } else {
            write!(f, "smooth:{},", self.blend)?;
        }
        write!(f, "{}+{}", self.first, self.spheres)
    }
}
