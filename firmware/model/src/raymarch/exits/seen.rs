//! Computes what the colour and the depth code of a pixel need from the end of a ray.

use super::follow::End;
use super::narrow::floor;
use super::ray::Beam;
use super::setup::Exits;
use crate::raymarch::{RayEnd, State};

impl Exits {
    /// The end of a ray, with all that the colour and the depth code of a pixel need.
    pub fn seen(&self, beam: &Beam, end: &End) -> RayEnd {
        let (shadow, further) = match self.sun {
            Some(_) => self.shadow(beam, end),
            None => (false, 0),
        };
        RayEnd {
            state: end.state,
            depth: self.depth_of(end.t),
            steps: end.steps,
            evaluations: end.steps + further,
            shadow,
            height: beam.height(),
            normal: self.normal(beam, end),
        }
    }

    /// The vector from the centre of a sphere, or from the apex of a cone, to the hit on its surface, in field units with 12 fraction bits;
    /// `None` for any other end. For a sphere, the length of the vector is about the radius. Computed from T with 10 fraction bits.
    pub fn normal(&self, beam: &Beam, end: &End) -> Option<[i32; 3]> {
        let State::Hit(surface) = end.state else {
            return None;
        };
        let number = surface.number()?;
        let t = floor(end.t, self.words.parameter as i32 - 10);
        let direction = beam.direction();
        let origin = &self.eyes[beam.eye].origin;
        let place =
            [0, 1, 2].map(|i: usize| origin[i] + floor(t * i64::from(direction[i]), 15) as i32);
        Some(self.spheres.from(number, place))
    }
}
