//! `sphere:R`, `spheres:X,Y,Z,R;...`, `lattice:PERIOD,R` and `moving:R,ORBIT[,DEGREES]`: one sphere,
//! several spheres, a lattice of spheres, or a sphere on an orbit.

use core::fmt;

use super::fixed_sphere::{FixedSphere, FixedSpheres};
use crate::field::argument::{Arguments, check};
use crate::field::error::FieldError;
use crate::field::limits::{MAX_EXTENT, MAX_SPHERES, PERIOD, SMALLEST, largest_half};
use crate::field::shape::{FieldKind, Member, Placed, SCALE, scale_of};
use crate::field::surface::units;
use crate::fixed::{Q2_30, Q32_32, Turns};
use crate::trig::sin_cos_q30;

/// A sphere of the list [`Spheres`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sphere {
    /// Centre, in world units.
    pub centre: [Q32_32; 3],
    /// Radius, in world units.
    pub radius: Q32_32,
}

impl Sphere {
    /// Checks that the radius is in its range, and that no coordinate of the sphere exceeds [`MAX_EXTENT`] in magnitude.
    fn checked(self) -> Result<Self, FieldError<'static>> {
        check("radius", self.radius, [SMALLEST, MAX_EXTENT])?;
        let room = MAX_EXTENT - self.radius;
        for coordinate in self.centre {
            check("centre", coordinate, [-room, room])?;
        }
        Ok(self)
    }
}

/// A sphere about the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CentredSphere {
    /// Radius, in world units.
    pub radius: Q32_32,
}

/// Up to [`MAX_SPHERES`] spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spheres {
    list: [Sphere; MAX_SPHERES],
    count: usize,
}

impl Spheres {
    /// Makes a field from 1 to [`MAX_SPHERES`] spheres, after checking them.
    ///
    /// # Errors
    /// The number of spheres is out of range, or the radius or a coordinate of a sphere is out of range. The error names the
    /// first such number.
    pub fn new(spheres: &[Sphere]) -> Result<Self, FieldError<'static>> {
        let mut list = [Sphere::default(); MAX_SPHERES];
        let count = spheres.len();
        if count == 0 || count > MAX_SPHERES {
            return Err(FieldError::Spheres(MAX_SPHERES));
        }
        for (place, sphere) in list.iter_mut().zip(spheres) {
            *place = sphere.checked()?;
        }
        Ok(Self { list, count })
    }

    /// The spheres in order.
    pub fn iter(&self) -> impl Iterator<Item = &Sphere> {
        self.list.iter().take(self.count)
    }
}

/// A lattice of spheres, whose centres are at all multiples of the period along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// Distance between the centres of neighbouring spheres, in world units.
    pub period: Q32_32,
    /// Radius of each sphere in world units; less than half the period by at least one unit of coordinates.
    pub radius: Q32_32,
}

/// A sphere whose centre is on a circular orbit about the z axis, in the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovingSphere {
    /// Radius, in world units.
    pub radius: Q32_32,
    /// Distance from the origin to the centre, in world units.
    pub orbit: Q32_32,
    /// Angle of the centre on the orbit, from the x axis towards the y axis.
    pub angle: Turns,
}

impl CentredSphere {
    fn sphere(&self) -> Sphere {
        Sphere {
            radius: self.radius,
            ..Sphere::default()
        }
    }
}

impl MovingSphere {
    fn sphere(&self) -> Sphere {
        let (sine, cosine) = sin_cos_q30(self.angle);
        // The orbit's radius is at most 12 and is used with 20 fraction bits; sine and cosine have 30 fraction bits.
        let along = |part: Q2_30| {
            Q32_32::from_bits(((self.orbit.to_bits() >> 12) * i64::from(part.to_bits())) >> 18)
        };
        Sphere {
            centre: [along(cosine), along(sine), Q32_32::ZERO],
            radius: self.radius,
        }
    }
}

impl FieldKind for CentredSphere {
    type Solid = FixedSpheres;

    const NAME: &'static str = "sphere";
    const FORM: &'static str = "sphere:R";
    const ABOUT: &'static str = "a sphere about the origin";
    const EXAMPLE: &'static str = "sphere:1";
    const MEMBER: Option<Member> = Some(Member::Second);
    const ROUND: bool = true;

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let radius = numbers.number("radius", [SMALLEST, MAX_EXTENT])?;
        Ok(Self { radius })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.radius)
    }

    fn placed(&self) -> Placed<FixedSpheres> {
        Placed::bounded(fixed(&[self.sphere()], SCALE), [self.radius; 3])
    }

    fn spheres(&self, scale: Q32_32) -> Option<FixedSpheres> {
        Some(fixed(&[self.sphere()], scale))
    }
}

impl FieldKind for Spheres {
    type Solid = FixedSpheres;

    const NAME: &'static str = "spheres";
    const FORM: &'static str = "spheres:X,Y,Z,R;...";
    const ABOUT: &'static str = "up to 8 spheres";
    const EXAMPLE: &'static str = "spheres:0,0,0,0.75;1,0.25,0.5,0.5;-0.75,-0.5,0.75,0.25";
    const MEMBER: Option<Member> = Some(Member::Second);
    const ROUND: bool = true;

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let mut list = [Sphere::default(); MAX_SPHERES];
        let mut count = 0;
        let room = MAX_EXTENT - SMALLEST;
        while numbers.group()? {
            let mut part = |name| numbers.number(name, [-room, room]);
            let centre = [part("x")?, part("y")?, part("z")?];
            let beside = centre
                .iter()
                .fold(MAX_EXTENT, |left, x| left.min(MAX_EXTENT - x.abs()));
            let radius = numbers.number("radius", [SMALLEST, beside])?;
            *list
                .get_mut(count)
                .ok_or(FieldError::Spheres(MAX_SPHERES))? = Sphere { centre, radius };
            count += 1;
        }
        Self::new(list.get(..count).unwrap_or_default())
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.iter().enumerate().try_for_each(|(i, sphere)| {
            let [x, y, z] = sphere.centre;
            let between = if i == 0 { "" } else { ";" };
            write!(f, "{between}{x},{y},{z},{}", sphere.radius)
        })
    }

    fn placed(&self) -> Placed<FixedSpheres> {
        let extent = self.iter().fold([Q32_32::ZERO; 3], |extent, sphere| {
            [0, 1, 2].map(|i: usize| extent[i].max(sphere.centre[i].abs() + sphere.radius))
        });
        Placed::bounded(fixed(self.iter(), SCALE), extent)
    }

    fn spheres(&self, scale: Q32_32) -> Option<FixedSpheres> {
        Some(fixed(self.iter(), scale))
    }
}

impl FieldKind for Lattice {
    type Solid = FixedSpheres;

    const NAME: &'static str = "lattice";
    const FORM: &'static str = "lattice:PERIOD,R";
    const ABOUT: &'static str = "spheres everywhere";
    const EXAMPLE: &'static str = "lattice:2,0.8";
    const LOOK: &'static [&'static str] = &[
        "lookat 1 -1 1 -1 1.2 -1.5",
        "fov 66",
        "background sky",
        "fog 0.15",
    ];
    const MEMBER: Option<Member> = Some(Member::First);
    const ROUND: bool = true;

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let period = numbers.number("period", PERIOD)?;
        let radius = numbers.number("radius", [SMALLEST, largest_half(period)])?;
        Ok(Self { period, radius })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{},{}", self.period, self.radius)
    }

    fn placed(&self) -> Placed<FixedSpheres> {
        let scale = scale_of(self.period);
        let mut list = [FixedSphere::default(); MAX_SPHERES];
        list[0] = FixedSphere::new([0; 3], units(self.radius, scale) as i32);
        Placed {
            solid: (FixedSpheres {
                list,
                count: 1,
                repeated: true,
                cone: None,
            }),
            scale,
            extent: None,
        }
    }
}

impl FieldKind for MovingSphere {
    type Solid = FixedSpheres;

    const NAME: &'static str = "moving";
    const FORM: &'static str = "moving:R,ORBIT[,DEGREES]";
    const ABOUT: &'static str = "a sphere that circles about the z axis";
    const EXAMPLE: &'static str = "moving:0.5,0.75,-60";
    const MEMBER: Option<Member> = Some(Member::Second);
    const ROUND: bool = true;

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let radius = numbers.number("radius", [SMALLEST, MAX_EXTENT])?;
        Ok(Self {
            radius,
            orbit: numbers.number("orbit", [Q32_32::ZERO, MAX_EXTENT - radius])?,
            angle: numbers.angle("angle")?,
        })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{},{}", self.radius, self.orbit)?;
        match self.angle {
            Turns(0) => Ok(()),
            angle => write!(f, ",{}", angle.to_degrees()),
        }
    }

    fn placed(&self) -> Placed<FixedSpheres> {
        // The bounding box contains the sphere at all angles of the orbit, so the scale is the same in every frame.
        let reach = self.orbit + self.radius;
        let extent = [reach, reach, self.radius];
        Placed::bounded(fixed(&[self.sphere()], SCALE), extent)
    }

    fn spheres(&self, scale: Q32_32) -> Option<FixedSpheres> {
        Some(fixed(&[self.sphere()], scale))
    }
}

/// Converts spheres from world units to field units.
fn fixed<'a>(spheres: impl IntoIterator<Item = &'a Sphere>, scale: Q32_32) -> FixedSpheres {
    let mut list = [FixedSphere::default(); MAX_SPHERES];
    let mut count = 0;
    for (fixed, sphere) in list.iter_mut().zip(spheres) {
        let length = |x: Q32_32| units(x, scale) as i32;
        *fixed = FixedSphere::new(sphere.centre.map(length), length(sphere.radius));
        count += 1;
    }
    FixedSpheres {
        list,
        count,
        repeated: false,
        cone: None,
    }
}
