//! Spheres of a list: a ray meets a sphere where its closest approach to the centre is below the radius.
//!
//! With q from a sphere's centre to the eye and a ray's direction D, the ray is at |q×D|/|D| from the centre. Both q×D and q·D are linear
//! in the pixel's column and row, so their coefficients are constants of the frame. With X = q×D/r, the ray meets the sphere at
//! (−q·D − r·√(|D|² − |X|²))/|D|². No difference of nearly equal numbers occurs, unless the ray only just meets the sphere.

use glint_core::field::FRACTION;

use super::balls::{Ball, ROOT};
use super::narrow::{nearest, root, saturated, shifted, squared};
use super::ray::Beam;
use super::setup::Exits;

/// A sphere that a ray meets.
#[derive(Clone, Copy)]
pub(super) struct Met {
    pub t: i64,
    pub number: u8,
}

impl Exits {
    /// The first sphere of the list that a ray meets, the first in the list of several at one parameter, and the number of tested spheres.
    pub(super) fn meet(&self, beam: &Beam) -> (Option<Met>, u32) {
        let mut best: Option<Met> = None;
        let mut tests = 0;
        for (number, ball) in (0..).zip(self.balls.iter().take(self.count)) {
            if !ball.sights[beam.eye].rectangle.holds(beam.column, beam.row) {
                continue;
            }
            tests += 1;
            if let Some(t) = self.meet_ball(beam, ball)
                && best.as_ref().is_none_or(|best| t < best.t)
            {
                best = Some(Met { t, number });
            }
        }
        (best, tests)
    }

    /// The parameter at which a ray meets a sphere: that of the near plane, if the sphere's surface is before it.
    fn meet_ball(&self, beam: &Beam, ball: &Ball) -> Option<i64> {
        let sight = &ball.sights[beam.eye];
        let fraction = self.words.cross as i32;
        // X, narrowed to one integer bit by rounding to nearest, saturated.
        let cross = sight.cross.map(|part| {
            let x = part.at(beam.column, beam.row);
            let bits = sight.cross_fraction - fraction;
            saturated(
                nearest(shifted(x, -bits.min(0), 62), bits.max(0)),
                self.words.cross + 1,
            )
        });
        // |D|² − |X|², with twice the fraction bits of X. The squares are without those of the bits after the first 18.
        let cut = (fraction - 16).max(0) as u32;
        let square: i64 = cross.map(|x| squared(x, cut)).iter().sum();
        let rest = nearest(beam.square, 36 - 2 * fraction) - square;
        if rest <= 0 && !sight.is_inside {
            return None;
        }
        // The half chord times |D|²: the root is narrowed by rounding to nearest, the product by rounding down.
        let root = nearest(root(rest.max(0)), fraction - ROOT as i32);
        let bits = sight.fraction;
        let chord = (i64::from(ball.radius) * root) >> (ROOT + FRACTION - bits);
        let along = nearest(
            sight.along.at(beam.column, beam.row),
            sight.along_fraction - bits as i32,
        );
        let at = |distance| self.words.divided(distance, bits, beam.inverse_square);
        let (enters, leaves) = (-along - chord, at(-along + chord));
        if leaves < self.near || !sight.is_inside && enters < 0 {
            return None;
        }
        Some(match sight.is_inside {
            true => self.near,
            false => at(enters).max(self.near),
        })
    }
}
