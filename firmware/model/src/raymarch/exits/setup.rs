//! The constants of a frame of a field, computed once from the field, the camera and the picture's size.

use glint_core::camera::View;
use glint_core::feature::SPHERES;
use glint_core::field::{
    FRACTION, Field, FixedSphere, FixedSpheres, MAX_SPHERES, Placed, Primitive, Solid as Kind,
    cropped, units,
};
use glint_core::fixed::Q32_32;
use glint_core::picture::Window;
use glint_core::stereo::Stereo;

use super::cones::{Cone, Cones, Sight};
use super::intervals::{AXES, Border, Exit, PERIOD, Place, Rule, Solid};
use super::narrow::floor;
use super::rectangle::{FAR, Rectangle, Screen};
use super::sun::Sun;
use super::words::Words;
use crate::error::{RenderError, whole_picture};
use crate::raymarch::directions::{Directions, check};

/// Largest number of spheres of a list, for which rays are tested with cones.
const SEEN_SPHERES: usize = if SPHERES.is_built { MAX_SPHERES } else { 0 };

// These are constants, so that the compiler parses the decimals. The soft core would take 6,000 cycles for each decimal, in every frame.
/// Field units per world unit of a sponge of five or six levels: the side of the smallest cells of six levels is 1/8 field unit.
const DEEP_SPONGE: Q32_32 = Q32_32::lit("45.5625");
/// Field units per world unit of an octahedron.
const OCTAHEDRON: Q32_32 = Q32_32::lit("81");

/// Position of an eye, direction of its first ray, and the empty prism around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Eye {
    /// Position in field units, s13.12: in x, y and z, or along the first three diagonals of an octahedron.
    pub origin: [i32; 3],
    /// Position relative to the solid's lower corner, s13.12: along each axis, then along each mirrored axis. For a repeated solid, the
    /// position in the cell around the origin.
    pub corners: [[i64; AXES]; 2],
    /// Direction D of the first pixel's ray along each axis, s2.30. The fourth number is not used: a ray's component along the fourth axis
    /// is the sum of the three others.
    pub first: [i32; AXES],
    /// The empty prism around the eye.
    pub start: Start,
}

/// The empty prism around an eye, which all rays leave first. The prism has no borders if the eye is not in an empty prism, or if the eye
/// is on a border, because the prism is then not the same for all rays. Without borders, the rays start at the near plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Start {
    /// Which of the exits along the axes leaves the prism.
    pub exit: Exit,
    /// The sides of the prism: along each axis, then along each mirrored axis.
    pub sides: [[Side; AXES]; 2],
}

/// A side of the empty prism around an eye, at which rays leave the prism along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Side {
    /// Whether the prism has a border on this side.
    pub is_bounded: bool,
    /// Distance from the eye to the border, 25 bits, of which 12 are fraction bits; 0 without a border.
    pub distance: i64,
    /// The interval beyond the border; 0 without a border.
    pub next: i32,
    /// Whether a ray in the direction of this side points away from the solid.
    pub is_away: bool,
    /// Whether the interval beyond the border is above the solid.
    pub is_last: bool,
}

impl Eye {
    /// An eye at a position in field units, s13.12. Does not set the direction of the first ray and the prism.
    pub fn at(origin: [i32; 3], solid: &Option<Solid>) -> Self {
        Self::placed(along(solid, origin.map(i64::from)), solid)
    }

    /// As [`at`](Self::at), but `place` is the position along the axes of the solid.
    pub fn placed(place: [i64; AXES], solid: &Option<Solid>) -> Self {
        let half = solid.map_or([0; AXES], |solid| solid.side.map(|side| side / 2));
        let [x, y, z, _] = place.map(|part| part as i32);
        let within = match solid.map(|solid| solid.rule) {
            Some(Rule::Repeated { .. }) => [x, y, z, 0].map(|part| cropped(part, PERIOD).into()),
            _ => place,
        };
        Self {
            origin: [x, y, z],
            corners: [1, -1].map(|sign| [0, 1, 2, 3].map(|i: usize| half[i] + sign * within[i])),
            ..Self::default()
        }
    }

    /// The position relative to the solid's centre along the first three axes, s13.12: along x, y and z, or along diagonals of an
    /// octahedron. In a repeated solid, the position in the cell around the origin.
    pub fn place(&self) -> [i32; 3] {
        let [up, down] = &self.corners;
        [0, 1, 2].map(|axis: usize| ((up[axis] - down[axis]) / 2) as i32)
    }

    /// The position relative to the solid's lower corner. `down` states which axes are mirrored.
    pub(super) fn corner(&self, down: &[bool; AXES]) -> [i64; AXES] {
        [0, 1, 2, 3].map(|axis: usize| self.corners[usize::from(down[axis])][axis])
    }
}

/// The frame constants of a field that is drawn with rays by exits (docs/raymarch-exits.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exits {
    /// Word lengths of the numbers in a ray.
    pub words: Words,
    /// Width of the window in pixels.
    pub width: u32,
    /// Height of the window in pixels.
    pub height: u32,
    /// Field units per world unit.
    pub scale: Q32_32,
    /// Exponent e, 0 to 3: D is 2^−e times the direction whose component along the camera's forward axis n is 1.
    pub exponent: u32,
    /// The left and the right eye; equal without stereo.
    pub eyes: [Eye; 2],
    /// Change of D per pixel to the right and per pixel down, s2.30; the fourth numbers are not used.
    pub steps: [[i32; AXES]; 2],
    /// Parameter T of the near plane.
    pub near: i64,
    /// Largest parameter T of a hit.
    pub far: i64,
    /// The flat solid or the lattice; `None` if there is only a list of spheres.
    pub solid: Option<Solid>,
    /// The shadow rays to the first light; `None` without shadows.
    pub sun: Option<Sun>,
    /// The spheres: first the sphere of a lattice, if any, then the spheres of a list.
    pub spheres: FixedSpheres,
    /// For each eye, a rectangle around the pixels that see each sphere of the list in `spheres`; empty for the right eye without stereo.
    pub rectangles: [[Rectangle; SEEN_SPHERES]; 2],
}

impl Exits {
    /// Whether a field is drawn with rays by exits. All other fields are drawn with marching rays.
    pub fn draws(field: &Field) -> bool {
        match field {
            Field::Primitive(_) => true,
            Field::Union(union) => union.blend() == Q32_32::ZERO && !field.is_bent(),
        }
    }

    /// Computes the constants for a field, a camera and one of the [`SIZES`](crate::SIZES). A smooth union becomes a sharp union.
    ///
    /// # Errors
    /// [`RenderError::Size`] for another size, [`RenderError::Orthographic`], and [`RenderError::HalfWidth`] for a camera that is too
    /// narrow or too wide.
    pub fn new(
        field: &Field,
        view: &View,
        size: (u32, u32),
        stereo: Option<Stereo>,
        words: Words,
    ) -> Result<Self, RenderError> {
        Self::in_window(field, view, whole_picture(size)?, stereo, words)
    }

    /// Computes the constants for a window of a picture.
    ///
    /// # Errors
    /// As [`new`](Self::new), but for the size.
    pub(in crate::raymarch) fn in_window(
        field: &Field,
        view: &View,
        window: Window,
        stereo: Option<Stereo>,
        words: Words,
    ) -> Result<Self, RenderError> {
        check(view)?;
        let [width, height] = window.size.pixels();
        let member = match field {
            Field::Primitive(primitive) => primitive,
            Field::Union(union) => union.first(),
        };
        let world = member.placed();
        let (solid, scale) = placed(member, &world);
        let views = stereo.map_or([*view; 2], |stereo| stereo.eyes(view));
        let rays = Directions::new(&views, window);
        let narrow = |direction: [i64; 3]| along(&solid, direction).map(|x| rays.narrow(x));
        let steps = [narrow(rays.across), narrow(rays.down)];
        let eye = |i: usize| {
            let eye = Eye::at(views[i].eye().map(|x| units(x, scale) as i32), &solid);
            Eye {
                // Only spheres of a list need the position in the world, so only gateware with such spheres reduces the position to a cell.
                origin: match field.is_repeated_union() {
                    true => eye.origin,
                    false => eye.place(),
                },
                first: first(&rays, i, [width / 2, height / 2], &steps, narrow),
                start: solid.map_or_else(Start::away, |solid| Start::new(&solid, &eye.corners)),
                ..eye
            }
        };
        let left = eye(0);
        let eyes = [left, if stereo.is_some() { eye(1) } else { left }];
        let near = units(
            Q32_32::from_bits(i64::from(view.near().to_bits()) << 4),
            scale,
        );
        let fraction = words.parameter;
        let mut exits = Self {
            words,
            width,
            height,
            scale,
            exponent: rays.exponent,
            eyes,
            steps,
            near: (near << rays.exponent << fraction) >> FRACTION,
            // A saturated parameter is beyond the far limit.
            far: (1 << (FAR + rays.exponent + fraction)) - 2,
            solid,
            sun: None,
            spheres: FixedSpheres {
                list: [FixedSphere::default(); MAX_SPHERES],
                count: 0,
                repeated: false,
                cone: None,
            },
            rectangles: [[Rectangle::NONE; SEEN_SPHERES]; 2],
        };
        let eyes = if stereo.is_some() { 2 } else { 1 };
        if SPHERES.is_built {
            if let Kind::Spheres(spheres) = &world.solid {
                exits.spheres = *spheres;
            }
            if let Field::Union(union) = field
                && let Some(list) = union.spheres().spheres(scale)
            {
                exits.spheres.add(&list);
            }
            exits.place_rectangles(&views[..eyes], window);
        }
        Ok(exits)
    }

    /// Adds shadows to the faces that are turned to the first light, if the solid casts shadows. `direction` is the unit vector to the
    /// light, s1.14.
    #[must_use]
    pub fn with_shadows(self, direction: [i16; 3]) -> Self {
        let has_shadows = self.solid.is_some_and(|solid| solid.rule.has_shadows());
        Self {
            sun: has_shadows.then(|| Sun::new(direction, &self.words)),
            ..self
        }
    }

    /// The direction D of pixel (x, y) along each of the first three axes, s2.30.
    pub(super) fn direction(&self, eye: usize, column: u32, row: u32) -> [i32; 3] {
        [0, 1, 2].map(|axis: usize| {
            let across = self.steps[0][axis].wrapping_mul(column as i32);
            let down = self.steps[1][axis].wrapping_mul(row as i32);
            self.eyes[eye].first[axis]
                .wrapping_add(across)
                .wrapping_add(down)
        })
    }

    /// Computes the rectangles of the spheres of a list. `views` are the cameras of the eyes.
    // Not inlined, so that a frame without spheres takes fewer lines of the instruction cache.
    #[inline(never)]
    fn place_rectangles(&mut self, views: &[View], window: Window) {
        let lattice = usize::from(self.spheres.repeated);
        for (rectangles, view) in self.rectangles.iter_mut().zip(views) {
            let screen = Screen::new(view, self.scale, window);
            let seen = rectangles.iter_mut().zip(&self.spheres.list);
            for (rectangle, sphere) in seen.take(self.spheres.count).skip(lattice) {
                *rectangle = screen.around(sphere.centre, sphere.radius);
            }
        }
    }

    /// Makes the rays of all pixels equal, with the direction D, s2.30.
    pub fn aim(&mut self, direction: [i32; 3]) {
        self.steps = Default::default();
        let direction = along(&self.solid, direction.map(i64::from)).map(|part| part as i32);
        for eye in &mut self.eyes {
            eye.first = direction;
        }
        let size = [self.width, self.height];
        self.rectangles = [[Rectangle::all(size); SEEN_SPHERES]; 2];
    }

    /// The cones in which each eye sees the spheres of a list.
    pub fn cones(&self) -> [Cones; 2] {
        [0, 1].map(|eye| {
            let mut cones = Cones::default();
            self.each_cone(eye, &mut |cone| cones.push(*cone));
            cones
        })
    }

    /// Computes the cones in which an eye sees the spheres of a list, in the order of the list.
    pub fn each_cone(&self, eye: usize, take: &mut dyn FnMut(&Cone)) {
        let lattice = usize::from(self.spheres.repeated);
        if !SPHERES.is_built || self.spheres.count <= lattice {
            return;
        }
        let world = |[x, y, z, _]: [i32; AXES]| [x, y, z];
        let [across, down] = self.steps.map(world);
        let Eye { origin, first, .. } = self.eyes[eye];
        // The cones use 14 fraction bits of the parameter T.
        let near = floor(self.near, self.words.parameter as i32 - 14);
        let sight = Sight::new(origin, [world(first), across, down], near);
        let spheres = self.spheres.list.iter().take(self.spheres.count);
        let seen = (0..).zip(spheres).zip(&self.rectangles[eye]);
        let mut cone = Cone::default();
        for ((number, sphere), rectangle) in seen.skip(lattice) {
            (cone.number, cone.rectangle) = (number, *rectangle);
            match self.spheres.cone(number) {
                Some(shape) if !rectangle.is_empty() => {
                    sight.solid_cone(shape, sight.cuts(sphere), &mut cone, take);
                }
                Some(_) => {}
                None => sight.cones(sphere, &mut cone, take),
            }
        }
    }

    /// Whether an eye is inside a sphere or the flat solid, and not on the surface. Inside means in the solid both for rays that point up
    /// and for rays that point down.
    pub(in crate::raymarch) fn is_inside(&self, eye: usize) -> bool {
        let eye = &self.eyes[eye];
        let in_solid = |solid: &Solid| {
            eye.corners.iter().all(|corner| {
                let intervals = solid.intervals(corner, &[i32::MIN; AXES]);
                solid.place(&intervals) == Place::Solid
            })
        };
        let in_sphere = |(number, sphere): (usize, &FixedSphere)| {
            if let Some(cone) = self.spheres.cone(number as u8) {
                return cone.holds(eye.origin);
            }
            let place = match self.spheres.repeated && number == 0 {
                true => eye.place(),
                false => eye.origin,
            };
            let apart = |i: usize| i64::from(place[i]) - i64::from(sphere.centre[i]);
            let square: i64 = (0..3).map(|i| apart(i).pow(2)).sum();
            square < i64::from(sphere.radius).pow(2)
        };
        let mut spheres = (self.spheres.list.iter().take(self.spheres.count)).enumerate();
        self.solid.as_ref().is_some_and(in_solid) || spheres.any(in_sphere)
    }

    /// Depth along the camera's forward axis n at the parameter `t`, in field units times 2^e, u19.21.
    pub fn depth_of(&self, t: i64) -> u64 {
        (t as u64) << (21 - self.words.parameter)
    }
}

impl Start {
    /// The prism for a field without a flat solid: all rays point away.
    fn away() -> Self {
        let side = Side {
            is_away: true,
            ..Side::default()
        };
        Self {
            exit: Exit::default(),
            sides: [[side; AXES]; 2],
        }
    }

    /// The empty prism around an eye at `corners`, if it is the same for all rays that do not point away from the solid: the border
    /// along an axis may only depend on whether this axis is mirrored, not on the other axes.
    fn new(solid: &Solid, corners: &[[i64; AXES]; 2]) -> Self {
        let intervals = corners.map(|corner| solid.intervals(&corner, &[i32::MIN; AXES]));
        let is_away = intervals
            .map(|sides| [0, 1, 2, 3].map(|axis: usize| solid.is_above(axis, sides[axis])));
        // Only an octahedron has a fourth axis.
        let axes = match solid.rule {
            Rule::Octahedron => AXES,
            _ => AXES - 1,
        };
        let mut exit = None;
        let mut borders = [[None; AXES]; 2];
        for down in 0..1_usize << axes {
            let side = |axis: usize| down >> axis & 1;
            if (0..axes).any(|axis| is_away[side(axis)][axis]) {
                continue;
            }
            let place = solid.place(&[0, 1, 2, 3].map(|axis: usize| intervals[side(axis)][axis]));
            let Place::Empty(prism) = place else {
                return Self::default();
            };
            let mut is_same = *exit.get_or_insert(prism.exit) == prism.exit;
            for axis in 0..axes {
                let border = prism.borders[axis];
                is_same &= *borders[side(axis)][axis].get_or_insert(border) == border;
            }
            if !is_same {
                return Self::default();
            }
        }
        let Some(exit) = exit else {
            return Self::default();
        };
        let side = |down: usize, axis: usize| {
            let border: Option<Border> = borders[down][axis].flatten();
            Side {
                is_bounded: border.is_some(),
                distance: border.map_or(0, |border| border.at - corners[down][axis]),
                next: border.map_or(0, |border| border.next),
                is_away: is_away[down][axis],
                is_last: border.is_some_and(|border| solid.is_above(axis, border.next)),
            }
        };
        Self {
            exit,
            sides: [0, 1].map(|down| [0, 1, 2, 3].map(|axis| side(down, axis))),
        }
    }
}

/// The direction of the first pixel's ray, chosen so that the ray of the pixel `middle` is rounded to nearest. The rounded steps cause an
/// error that grows with the distance from this pixel.
fn first(
    rays: &Directions,
    eye: usize,
    middle: [u32; 2],
    steps: &[[i32; AXES]; 2],
    narrow: impl Fn([i64; 3]) -> [i32; AXES],
) -> [i32; AXES] {
    let [column, row] = middle.map(i64::from);
    let there = narrow(
        [0, 1, 2].map(|i: usize| rays.first[eye][i] + column * rays.across[i] + row * rays.down[i]),
    );
    [0, 1, 2, 3].map(|axis: usize| {
        let [across, down] = steps.map(|step| step[axis]);
        there[axis]
            .wrapping_sub(across.wrapping_mul(middle[0] as i32))
            .wrapping_sub(down.wrapping_mul(middle[1] as i32))
    })
}

/// The components of a vector along the axes of a solid. For an octahedron, the components along its diagonals are divided by 4, so that
/// they do not exceed the range of x, y and z. Other solids have no fourth axis.
fn along(solid: &Option<Solid>, [x, y, z]: [i64; 3]) -> [i64; AXES] {
    match solid.map(|solid| solid.rule) {
        Some(Rule::Octahedron) => {
            [-x + y + z, x - y + z, x + y - z, x + y + z].map(|sum| (sum + 2) >> 2)
        }
        _ => [x, y, z, 0],
    }
}

/// The flat solid or lattice of a field (`None` for a list of spheres), and the field units per world unit. `world` is the representation
/// of the field for marching rays.
fn placed(primitive: &Primitive, world: &Placed<Kind>) -> (Option<Solid>, Q32_32) {
    let constants = match &world.solid {
        Kind::Flat(flat) => Some(flat.constants()),
        Kind::Spheres(_) => None,
    };
    let side = |half: [u32; 3]| {
        let [x, y, z] = half.map(|half| 2 * i64::from(half));
        [x, y, z, 0]
    };
    let (rule, side, scale) = match (primitive, constants) {
        (Primitive::Menger(sponge), _) => {
            let scale = match sponge.depth {
                ..=4 => world.scale,
                _ => DEEP_SPONGE,
            };
            let side = units(Q32_32::from_bits(2 << 32), scale);
            (Rule::sponge(sponge.depth.into()), [side; AXES], scale)
        }
        (Primitive::Octahedron(octahedron), _) => {
            let scale = OCTAHEDRON;
            // A quarter of the sum of three coordinates is at most a quarter of the size.
            let quarter = (units(octahedron.size, scale) + 2) >> 2;
            (Rule::Octahedron, [2 * quarter; AXES], scale)
        }
        (_, Some(flat)) => {
            let rule = match flat {
                _ if flat.room => Rule::Planes,
                _ if flat.repeated => Rule::Repeated { round: false },
                _ => Rule::Box,
            };
            (rule, side(flat.half), world.scale)
        }
        (Primitive::Lattice(lattice), _) => {
            let radius = units(lattice.radius, world.scale) as u32;
            (
                Rule::Repeated { round: true },
                side([radius; 3]),
                world.scale,
            )
        }
        _ => return (None, world.scale),
    };
    (Some(Solid { rule, side }), scale)
}
