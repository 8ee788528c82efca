//! Distance fields: scenes defined by the distance of every point from a solid, instead of a mesh.
//!
//! The text form is a kind, a colon and numbers in world units, such as `menger:4` or `cubes:2,0.5`; [`Field::parse`] checks the
//! numbers. The modules of `primitive` define each kind's name and its parameters with their ranges ([`FieldKind`]). They also evaluate
//! distances from the solid in fixed-point arithmetic, bit for bit as the gateware does ([`FlatSolid`], [`FixedSpheres`]). The lists in
//! `primitive` name all kinds except unions (docs/adding-a-field.md).

use core::fmt;

use crate::feature::SPHERES;

mod argument;
mod error;
mod folded;
mod limits;
mod primitive;
mod shape;
mod surface;
mod union;

pub use argument::{Arguments, Random};
pub use error::FieldError;
pub use limits::{MAX_EXTENT, MAX_SPHERES, PERIOD};
pub use primitive::*;
pub use shape::{FieldKind, FlatConstants, FlatSolid, Placed};
pub use surface::{FRACTION, FieldSample, Surface, cropped, magnitude, units};
pub use union::Union;

/// A distance field: one solid, or the union of two solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap for the spheres"
)]
pub enum Field {
    /// A field of one kind.
    Primitive(Primitive),
    /// The union of spheres and another solid: a lattice, or a field with faces.
    Union(Union),
}

impl Field {
    /// Whether the field has spheres; if so, the directions of rays have length 1 in the Euclidean norm, otherwise in the maximum norm.
    pub const fn is_round(&self) -> bool {
        match self {
            Self::Primitive(primitive) => primitive.is_round(),
            Self::Union(_) => SPHERES.is_built,
        }
    }

    /// Whether the field is unbounded along at least one axis.
    pub fn is_endless(&self) -> bool {
        match self {
            Self::Primitive(primitive) => primitive.placed().extent.is_none(),
            Self::Union(union) => union.first().placed().extent.is_none(),
        }
    }

    /// Whether the field is a bent union, which no gateware draws.
    pub const fn is_bent(&self) -> bool {
        match self {
            Self::Primitive(_) => false,
            Self::Union(union) => union.bend() != 0,
        }
    }

    /// Whether the field has a cone.
    pub const fn has_cone(&self) -> bool {
        let member = match self {
            Self::Primitive(primitive) => primitive,
            Self::Union(union) => union.spheres(),
        };
        matches!(member, Primitive::Cone(_))
    }

    /// Whether only the soft core draws the field, because no gateware does: a bent union, or a cone in a
    /// lattice.
    pub fn is_left_to_soft_core(&self) -> bool {
        let has_lattice = match self {
            Self::Primitive(_) => false,
            Self::Union(union) => union.first().is_round(),
        };
        self.is_bent() || self.has_cone() && has_lattice
    }

    /// Whether the field is a union of a periodic field and spheres.
    pub fn is_repeated_union(&self) -> bool {
        match self {
            Self::Primitive(_) => false,
            Self::Union(union) => union.first().placed().solid.is_repeated(),
        }
    }

    /// Whether the field's faces are perpendicular to the diagonals instead of the axes.
    pub const fn has_octants(&self) -> bool {
        match self {
            Self::Primitive(primitive) => primitive.has_octants(),
            Self::Union(_) => false,
        }
    }

    /// The sphere on an orbit, alone or in a union; `None` for other fields.
    pub const fn moving(&mut self) -> Option<&mut MovingSphere> {
        let primitive = match self {
            Self::Primitive(primitive) => primitive,
            Self::Union(union) => union.spheres_mut(),
        };
        match primitive {
            Primitive::Moving(sphere) if SPHERES.is_built => Some(sphere),
            _ => None,
        }
    }

    /// Reads the text form of a field, such as `menger:4`.
    ///
    /// # Errors
    /// The kind is unknown, or left out of this build, or a number is missing, malformed, out of its range, or surplus.
    pub fn parse(text: &str) -> Result<Self, FieldError<'_>> {
        let (kind, numbers) = text.split_once(':').unwrap_or((text, ""));
        match kind {
            "union" | "smooth" | "bent" if !SPHERES.is_built => Err(FieldError::LeftOut {
                kind,
                feature: SPHERES,
            }),
            "union" => Union::parse_sharp(numbers).map(Self::Union),
            "smooth" => Union::parse_smooth(numbers).map(Self::Union),
            "bent" => Union::parse_bent(numbers).map(Self::Union),
            kind => Primitive::parse(text)
                .unwrap_or(Err(FieldError::Kind {
                    kind,
                    kinds: &KINDS,
                }))
                .map(Self::Primitive),
        }
    }

    /// Makes a random field for tests and test vectors: a random kind, with random numbers within their ranges. `random` returns
    /// 32 random bits.
    pub fn draw(mut random: impl FnMut() -> u32) -> Self {
        let mut numbers = Random::new(&mut random);
        let primitive = Primitive::draw(&mut numbers);
        if numbers.choose(4) > 0 {
            return Self::Primitive(primitive);
        }
        let other = Primitive::draw(&mut numbers);
        Union::draw(primitive, other, &mut numbers)
            .or_else(|_| Union::draw(other, primitive, &mut numbers))
            .map_or(Self::Primitive(primitive), Self::Union)
    }
}

impl<P: Into<Primitive>> From<P> for Field {
    fn from(primitive: P) -> Self {
        Self::Primitive(primitive.into())
    }
}

/// Writes the text form of the field, such as `menger:4`.
impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Primitive(primitive) => primitive.fmt(f),
            Self::Union(union) if SPHERES.is_built => union.fmt(f),
            Self::Union(_) => Ok(()),
        }
    }
}

/// Number of kinds of fields.
const KIND_COUNT: usize = Primitive::NAMES.len() + Union::KINDS.len();

/// The text forms of all kinds of fields, with their descriptions.
pub const KINDS: [(&str, &str); KIND_COUNT] = {
    let mut kinds = [("", ""); KIND_COUNT];
    let mut i = 0;
    while i < kinds.len() {
        kinds[i] = if i < Primitive::FORMS.len() {
            Primitive::FORMS[i]
        } else {
            Union::KINDS[i - Primitive::FORMS.len()]
        };
        i += 1;
    }
    kinds
};

/// An example of a kind of field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// The field in text form.
    pub field: &'static str,
    /// The console commands that set camera and appearance for a picture of the field, on top of the default scene.
    pub look: &'static [&'static str],
}

/// An example of each kind of field, in the order of [`KINDS`].
pub const EXAMPLES: [Example; KIND_COUNT] = {
    let mut examples = [Example {
        field: "",
        look: Union::LOOK,
    }; KIND_COUNT];
    let mut i = 0;
    while i < examples.len() {
        if i < Primitive::EXAMPLES.len() {
            examples[i].field = Primitive::EXAMPLES[i];
            examples[i].look = Primitive::LOOKS[i];
        } else {
            examples[i].field = Union::EXAMPLES[i - Primitive::EXAMPLES.len()];
        }
        i += 1;
    }
    examples
};
