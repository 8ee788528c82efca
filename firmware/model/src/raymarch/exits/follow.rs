//! The path of a ray through the empty prisms of a solid, to its end.

use glint_core::field::Surface;

use super::cones::{Cone, Cones};
use super::intervals::{AXES, Place};
use super::lattice;
use super::ray::Beam;
use super::setup::Exits;
use super::spheres::Met;
use crate::raymarch::State;

/// The end of a ray by exits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct End {
    /// A hit or a miss; no ray is undecided.
    pub state: State,
    /// Parameter T at the end, with 14 integer bits and `Words::parameter` fraction bits; for a miss, T at the last exit.
    pub t: i64,
    /// Number of evaluations of the flat solid or the lattice.
    pub steps: u32,
}

impl Exits {
    /// The end of a ray, with the [cones](Self::cones) of the frame.
    pub fn end(&self, cones: &[Cones; 2], beam: &Beam) -> End {
        let met = self.meet(cones, beam).0;
        let corner = self.eyes[beam.eye].corner(&beam.down);
        self.follow(beam, &corner, met, met.map_or(self.far, |met| met.t))
    }

    /// The surface of the cone with this number.
    const fn surface(&self, number: u8) -> Surface {
        match number == Cone::BASE && self.spheres.cone.is_some() {
            true => Surface::BASE,
            false => Surface::Round { number },
        }
    }

    /// Follows a ray to its end, up to the parameter `limit`. `corner` is the ray's origin relative to the solid's lower corner, along the
    /// mirrored axes. `met` is the sphere of a list that the ray meets at `limit`, if any.
    ///
    /// Each evaluation advances the interval of at least one axis, and no interval ever decreases. A ray therefore always ends.
    // Inlined, so that shadow rays, which few frames have, use their own copy of the code.
    #[inline(always)]
    pub(super) fn follow(
        &self,
        beam: &Beam,
        corner: &[i64; AXES],
        met: Option<Met>,
        limit: i64,
    ) -> End {
        let end = |state, t, steps| End { state, t, steps };
        // The end of a ray that does not meet the solid: a sphere of the list, or a miss.
        let beyond = |t, steps| match met {
            Some(met) => end(State::Hit(self.surface(met.number)), met.t, steps),
            None => end(State::Miss, t, steps),
        };
        let mut way = beam.start;
        let mut steps = 0;
        let Some(solid) = self.solid.as_ref().filter(|_| !beam.is_away) else {
            return beyond(way.t, steps);
        };
        while !way.has_left(solid, limit) {
            steps += 1;
            let point = self.point(beam, corner, way.t);
            let intervals = solid.intervals(&point, &way.reached);
            let prism = match solid.place(&intervals) {
                Place::Solid => {
                    return end(
                        State::Hit(solid.surface(&beam.down, way.face)),
                        way.t,
                        steps,
                    );
                }
                Place::Gone => break,
                Place::Empty(prism) => prism,
                Place::Box(prism) => match lattice::meet(self, solid, beam, way.t, &point) {
                    Some(t) if t <= limit => {
                        return end(State::Hit(Surface::Round { number: 0 }), t, steps);
                    }
                    Some(_) => break,
                    None => prism,
                },
            };
            way.reached = intervals;
            way = self.left(beam, corner, &way, &prism);
        }
        beyond(way.t, steps)
    }
}
