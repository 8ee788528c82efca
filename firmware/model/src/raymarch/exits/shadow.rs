//! Hard shadows: a shadow ray goes to the first light from a hit on a face that is turned to this light.

use glint_core::field::Surface;

use super::follow::End;
use super::intervals::{AXES, PERIOD, Rule};
use super::ray::{Beam, Way};
use super::setup::Exits;
use crate::raymarch::State;

/// A hit is rounded along the normal of its face to a multiple of 2^`GRID`, in units with 12 fraction bits. This is the side of a sponge's
/// smallest cells. All faces that can be in shadow are at such multiples from the solid's lower corner.
const GRID: u32 = 9;

/// Number of bits of a hit's coordinate relative to the solid's lower corner.
const SPOT: u32 = 19;

impl Exits {
    /// Whether the end of a ray is in shadow: on a face that is turned to the first light, with the solid between the face and the light.
    /// Also returns the number of evaluations of the shadow ray.
    // Not inlined, so that the code for a frame without shadows takes fewer lines of the instruction cache.
    #[inline(never)]
    pub(super) fn shadow(&self, beam: &Beam, end: &End) -> (bool, u32) {
        let Some((ray, corner)) = self.light_ray(beam, end) else {
            return (false, 0);
        };
        // The largest parameter that is not saturated.
        let limit = (1 << (14 + self.words.parameter)) - 2;
        let found = self.follow(&ray, &corner, None, limit);
        (matches!(found.state, State::Hit(_)), found.steps)
    }

    /// The shadow ray from a hit to the first light, and the ray's origin relative to the solid's lower corner. The ray starts on the plane
    /// of the face, in the interval in front of the plane. `None` for an end that cannot be in shadow.
    fn light_ray(&self, beam: &Beam, end: &End) -> Option<(Beam, [i64; AXES])> {
        let sun = self.sun.as_ref()?;
        let solid = self
            .solid
            .as_ref()
            .filter(|solid| solid.rule.has_shadows())?;
        let State::Hit(Surface::Face { axis, positive }) = end.state else {
            return None;
        };
        let face = usize::from(axis);
        if positive == sun.down[face] {
            return None;
        }
        let point = self.point(beam, &self.eyes[beam.eye].corner(&beam.down), end.t);
        let corner = [0, 1, 2].map(|axis: usize| {
            let at = point[axis].max(0);
            let at = match axis == face {
                true => (at + (1 << (GRID - 1))) >> GRID << GRID,
                false => at,
            };
            // A repeated solid looks the same from every cell.
            let bits = match solid.rule {
                Rule::Repeated { .. } => PERIOD,
                _ => SPOT,
            };
            let at = at & ((1 << bits) - 1);
            let side = solid.side[axis];
            if beam.down[axis] == sun.down[axis] {
                at
            } else {
                side - at
            }
        });
        let all = |[x, y, z]: [u32; 3]| [x, y, z, x];
        let [x, y, z] = corner;
        let [down_x, down_y, down_z] = sun.down;
        let [a, b, c] = sun.inverse;
        let ray = Beam {
            down: [down_x, down_y, down_z, false],
            speed: all(sun.speed),
            inverse: [a, b, c, a],
            start: Way {
                t: 0,
                face: AXES - 2,
                reached: [i32::MIN; AXES],
            },
            is_away: false,
            ..*beam
        };
        Some((ray, [x, y, z, 0]))
    }
}
