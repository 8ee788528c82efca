//! Two lists: [`Primitive`] lists all kinds of fields except unions, and [`Flat`] lists the solids with flat faces
//! that the gateware evaluates.

use core::fmt;

mod boxes;
mod cone;
mod cuboid;
mod fixed_cone;
mod fixed_sphere;
mod menger;
mod octahedron;
mod sphere;

use super::argument::{Arguments, NumberText, Random};
use super::error::FieldError;
use super::shape::{FieldKind, FlatConstants, FlatSolid, Member, Placed};
use super::surface::FieldSample;
use crate::feature::SPHERES;
use crate::fixed::Q32_32;

pub use boxes::{Boxes, Cubes};
pub use cone::Cone;
pub use cuboid::{Cuboid, FixedBox, Planes};
pub use fixed_cone::FixedCone;
pub use fixed_sphere::{FixedSphere, FixedSpheres, length, normalised_root};
pub use menger::{FixedSponge, MAX_DEPTH, Menger};
pub use octahedron::{FixedOctahedron, Octahedron};
pub use sphere::{CentredSphere, Lattice, MovingSphere, Sphere, Spheres};

/// Whether this build contains the kind of field `S`.
const fn is_built<S: FieldKind>() -> bool {
    SPHERES.is_built || !S::ROUND
}

/// Defines [`Primitive`] from the list of the kinds of fields, which is in the order of the help.
macro_rules! primitives {
    ($($kind:ident($shape:ty)),* $(,)?) => {
        /// A field that is not a union.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[expect(
            clippy::large_enum_variant,
            reason = "there is no heap for the spheres"
        )]
        pub enum Primitive {
            $(#[doc = concat!("[`", stringify!($shape), "`].")] $kind($shape),)*
        }

        impl Primitive {
            /// The names of all kinds of fields except unions.
            pub const NAMES: [&str; [$(stringify!($kind)),*].len()] = [$(<$shape>::NAME),*];

            /// An example of each kind in text form, in the order of [`NAMES`](Self::NAMES).
            pub const EXAMPLES: [&str; Self::NAMES.len()] = [$(<$shape>::EXAMPLE),*];

            pub(super) const LOOKS: [&[&str]; Self::NAMES.len()] = [$(<$shape>::LOOK),*];

            pub(super) const FORMS: [(&str, &str); Self::NAMES.len()] = [$((<$shape>::FORM, <$shape>::ABOUT)),*];

            /// Reads the numbers of a field of the kind with the name `kind`; `None` for an unknown name.
            fn read<'a>(kind: &str, numbers: &mut impl Arguments<'a>) -> Option<Result<Self, FieldError<'a>>> {
                match kind {
                    $(<$shape>::NAME if is_built::<$shape>() => Some(<$shape>::read(numbers).map(Self::$kind)),)*
                    $(<$shape>::NAME => Some(Err(FieldError::LeftOut { kind: <$shape>::NAME, feature: SPHERES })),)*
                    _ => None,
                }
            }

            /// Whether the field has spheres.
            pub const fn is_round(&self) -> bool {
                match self {
                    $(Self::$kind(_) => <$shape>::ROUND && SPHERES.is_built,)*
                }
            }

            /// Whether the field's faces are perpendicular to the diagonals instead of the axes.
            pub const fn has_octants(&self) -> bool {
                match self {
                    $(Self::$kind(_) => <$shape>::OCTANTS,)*
                }
            }

            /// Which member of a union the field can be, if any.
            pub const fn member(&self) -> Option<Member> {
                match self {
                    $(Self::$kind(_) => <$shape>::MEMBER,)*
                }
            }

            /// The spheres of a list in field units, with `scale` field units per world unit; `None` for other fields.
            pub fn spheres(&self, scale: Q32_32) -> Option<FixedSpheres> {
                match self {
                    $(Self::$kind(shape) if is_built::<$shape>() => shape.spheres(scale),)*
                    _ => None,
                }
            }

            /// Converts the field to its solid in field units, in which the raymarcher computes.
            pub fn placed(&self) -> Placed<Solid> {
                match self {
                    $(Self::$kind(shape) if is_built::<$shape>() => shape.placed().map(Into::into),)*
                    // The parser rejects the kinds that this build lacks, so this branch is not reached.
                    _ => Placed::endless(FixedBox::of(&FlatConstants::default()).into()),
                }
            }
        }

        impl fmt::Display for Primitive {
            fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                match self {
                    $(Self::$kind(shape) if is_built::<$shape>() => {
                        write!(f, "{}:", <$shape>::NAME)?;
                        shape.write(f)
                    })*
                    _ => Ok(()),
                }
            }
        }

        $(impl From<$shape> for Primitive {
            fn from(shape: $shape) -> Self {
                Self::$kind(shape)
            }
        })*
    };
}

primitives! {
    Menger(Menger),
    Box(Cuboid),
    Cubes(Cubes),
    Boxes(Boxes),
    Planes(Planes),
    Octahedron(Octahedron),
    Sphere(CentredSphere),
    Spheres(Spheres),
    Lattice(Lattice),
    Moving(MovingSphere),
    Cone(Cone),
}

/// Defines [`Flat`] from the solids with flat faces that the gateware evaluates.
macro_rules! flat_solids {
    ($($solid:ident),* $(,)?) => {
        /// A solid with flat faces, with lengths in field units.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Flat {
            $(#[doc = concat!("[`", stringify!($solid), "`].")] $solid($solid),)*
        }

        impl Flat {
            /// Computes the distance of a point from the solid, and the surface nearest to the point. Coordinates
            /// are in field units, s10.12.
            #[inline]
            pub fn sample(&self, point: [i32; 3]) -> FieldSample {
                match self {
                    $(Self::$solid(solid) => solid.sample(point),)*
                }
            }

            /// Computes only the distance of [`sample`](Self::sample).
            #[inline]
            pub fn distance(&self, point: [i32; 3]) -> i32 {
                match self {
                    $(Self::$solid(solid) => solid.distance(point),)*
                }
            }

            /// The solid's constants, as the gateware's registers hold them.
            pub fn constants(&self) -> FlatConstants {
                match self {
                    $(Self::$solid(solid) => solid.constants(),)*
                }
            }

            /// The solid with these constants; `None` for an unknown kind.
            pub fn of(constants: &FlatConstants) -> Option<Self> {
                match constants.kind {
                    $($solid::CODE => Some(Self::$solid($solid::of(constants))),)*
                    _ => None,
                }
            }
        }

        $(impl From<$solid> for Flat {
            fn from(solid: $solid) -> Self {
                Self::$solid(solid)
            }
        }

        impl From<$solid> for Solid {
            fn from(solid: $solid) -> Self {
                Self::Flat(Flat::$solid(solid))
            }
        })*
    };
}

flat_solids! {
    FixedSponge,
    FixedBox,
    FixedOctahedron,
}

/// A solid with lengths in field units, in which the raymarcher computes (`Placed` states the scale).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    target_pointer_width = "64",
    expect(
        clippy::large_enum_variant,
        reason = "there is no heap for the spheres"
    )
)]
pub enum Solid {
    /// A solid with flat faces.
    Flat(Flat),
    /// One or several spheres, or a cone.
    Spheres(FixedSpheres),
}

impl Solid {
    /// Computes the distance of a point from the solid, and the surface nearest to the point. Coordinates
    /// are in field units, s10.12.
    #[inline]
    pub fn sample(&self, point: [i32; 3]) -> FieldSample {
        match self {
            Self::Flat(flat) => flat.sample(point),
            Self::Spheres(spheres) => spheres.sample(point),
        }
    }

    /// Computes only the distance of [`sample`](Self::sample).
    #[inline]
    pub fn distance(&self, point: [i32; 3]) -> i32 {
        match self {
            Self::Flat(flat) => flat.distance(point),
            Self::Spheres(spheres) => spheres.sample(point).distance,
        }
    }

    /// The solid's spheres; `None` for a solid with flat faces.
    pub const fn spheres(&self) -> Option<&FixedSpheres> {
        match self {
            Self::Flat(_) => None,
            Self::Spheres(spheres) if SPHERES.is_built => Some(spheres),
            Self::Spheres(_) => None,
        }
    }

    /// Whether the solid is periodic with 64 field units along each axis.
    pub fn is_repeated(&self) -> bool {
        match self {
            Self::Flat(flat) => flat.constants().repeated,
            Self::Spheres(spheres) => spheres.repeated,
        }
    }
}

impl From<FixedSpheres> for Solid {
    fn from(spheres: FixedSpheres) -> Self {
        Self::Spheres(spheres)
    }
}

impl Primitive {
    /// Reads the text form of a field; `None` for an unknown kind.
    pub(super) fn parse(text: &str) -> Option<Result<Self, FieldError<'_>>> {
        let (kind, numbers) = text.split_once(':').unwrap_or((text, ""));
        let mut words = NumberText::new(kind, numbers);
        let primitive = Self::read(kind, &mut words)?;
        Some(primitive.and_then(|primitive| words.end().map(|()| primitive)))
    }

    /// Makes a random field for tests and test vectors: a random kind, with random numbers within their ranges.
    pub(super) fn draw<F: FnMut() -> u32>(numbers: &mut Random<F>) -> Self {
        loop {
            let kind = Self::NAMES[numbers.choose(Self::NAMES.len())];
            if let Some(Ok(primitive)) = Self::read(kind, numbers) {
                return primitive;
            }
        }
    }
}
