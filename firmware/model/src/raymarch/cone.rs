//! The prepass: one cone for each block of pixels, marched before the rays, determines where the block's rays start.
//!
//! A cone is the ray through the middle of a block, with a radius that grows with the ray's parameter t. At the same
//! depth along the camera's forward axis n, points of the block's rays differ from the cone's point by at most t·spread,
//! in the norm of the field's distances. A cone therefore steps by the distance less t·spread, and no ray of its block
//! meets a surface before the end of the cone. The depth of this end replaces the near plane for the block.

use glint_core::field::{FRACTION, magnitude};

use super::options::FARTHEST;
use super::prepass::Cones;
use super::ray::Ray;
use super::setup::FieldSetup;

/// Fraction bits of the depth at the end of a cone, as stored for the rays of its block.
const DEPTH_FRACTION: u32 = 7;

/// Largest number of evaluations of a cone. It is small, because all rays wait for the last cone.
const MOST_STEPS: u32 = 192;

/// Largest number of blocks in a row of a picture: 1280 pixels in blocks of 4.
const ROW: usize = 320;

/// A cone before its first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cone {
    /// The ray through the middle of the block.
    pub ray: Ray,
    /// Growth of the radius per unit of the ray's parameter t, u0.16, rounded up.
    pub spread: u32,
}

impl FieldSetup {
    /// The cone of one block for one eye; `column` and `row` count blocks.
    pub fn cone(&self, cones: &Cones, eye: usize, column: u32, row: u32) -> Cone {
        let direction = [0, 1, 2].map(|i: usize| {
            let across = self.steps[0][i].wrapping_mul((column << cones.block) as i32);
            let down = self.steps[1][i].wrapping_mul((row << cones.block) as i32);
            self.eyes[eye].first[i]
                .wrapping_add(cones.offset[i])
                .wrapping_add(across)
                .wrapping_add(down)
                >> 6
        });
        let middle = self.length(direction.map(magnitude));
        let length = (middle + cones.margin(self.is_round())).min(0x3FF);
        let inverse = self.inverse(length);
        let ray = Ray {
            eye,
            direction: self.scaled(direction, length),
            length,
            start: self.at_depth(self.near, length).min(FARTHEST),
        };
        Cone {
            ray,
            // The factors have 18 and 9 fraction bits, the result 16. One unit is added for the truncation, and one unit
            // for the rounding of directions to 17 bits.
            spread: ((cones.spread * inverse) >> 11) + 2,
        }
    }

    /// Marches a cone until a ray of its block may meet a surface. Returns the parameter t at the end of the cone,
    /// and the number of evaluations.
    pub fn march_cone(&self, cone: &Cone) -> (u32, u32) {
        let Cone { ray, spread } = cone;
        let tuning = &self.tuning;
        // The coordinates of a point are truncated by less than one unit of 2^−12, so the point moves by less than one
        // unit in the maximum norm and less than two units in the Euclidean norm. Each step below is therefore one unit shorter; in round
        // fields, which use the Euclidean norm, `cut` removes one more unit.
        let cut = u32::from(self.is_round());
        let mut t = ray.start;
        let mut steps = 0;
        loop {
            let (distance, gone) = self.evaluate(ray, t);
            let width = ((u64::from(t) * u64::from(*spread)) >> 16) as u32 + cut;
            let wide = width >> (4 + FRACTION) != 0;
            let threshold = i64::from(tuning.threshold + width);
            steps += 1;
            let next = t + (distance - width as i32 - 1).max(0) as u32;
            let ends = gone
                || wide
                || next > tuning.far
                || i64::from(distance) < threshold
                || steps >= self.cap().min(MOST_STEPS);
            if ends {
                return (t, steps);
            }
            t = next;
        }
    }

    /// Depth along the camera's forward axis n of the cone's point at the parameter t, in field units times 2^e
    /// (docs/formats/raymarch.md, "Cones"): u11.7, rounded down.
    pub fn cleared(&self, cone: &Cone, t: u32) -> u32 {
        let depth = (u64::from(t) * u64::from(self.inverse(cone.ray.length))) >> 9;
        depth.min(FARTHEST.into()) as u32 >> (FRACTION - DEPTH_FRACTION)
    }
}

/// The rays of a picture, requested row by row. Without a prepass they equal the rays of [`FieldSetup::ray`]; with a
/// prepass each ray starts at the end of the cone of its block.
pub struct Rays<'a> {
    setup: &'a FieldSetup,
    /// Depths at the ends of the cones in the current row of blocks, for each eye.
    cleared: [[u32; ROW]; 2],
    /// The current row of blocks, for each eye; `None` before the first ray.
    row: [Option<u32>; 2],
    evaluations: u64,
}

impl<'a> Rays<'a> {
    /// The rays of a frame.
    pub const fn new(setup: &'a FieldSetup) -> Self {
        Self {
            setup,
            cleared: [[0; ROW]; 2],
            row: [None; 2],
            evaluations: 0,
        }
    }

    /// The ray of pixel (x, y) for an eye. With a prepass, the first pixel of each row of blocks marches the
    /// cones of the row.
    pub fn ray(&mut self, eye: usize, x: u32, y: u32) -> Ray {
        let setup = self.setup;
        let Some(cones) = &setup.cones else {
            return setup.ray(eye, x, y);
        };
        let row = y >> cones.block;
        let cleared = &mut self.cleared[eye];
        if self.row[eye].replace(row) != Some(row) {
            let columns = 0..setup.width >> cones.block;
            for (column, cleared) in core::iter::zip(columns, cleared.iter_mut()) {
                let cone = setup.cone(cones, eye, column, row);
                let (t, steps) = setup.march_cone(&cone);
                *cleared = setup.cleared(&cone, t);
                self.evaluations += u64::from(steps * setup.passes());
            }
        }
        let cleared = cleared[(x >> cones.block) as usize] << (FRACTION - DEPTH_FRACTION);
        setup.ray_from(eye, x, y, setup.near.max(cleared))
    }

    /// Number of evaluations by all cones so far.
    pub const fn evaluations(&self) -> u64 {
        self.evaluations
    }
}

const _: () = assert!(DEPTH_FRACTION < FRACTION);
