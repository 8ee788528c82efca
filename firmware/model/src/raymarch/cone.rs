//! The prepass: one cone before the rays of each block of pixels says where they may begin.
//!
//! A cone is the ray through the middle of a block. Points of the block's rays at the same depth along n differ from its point by at
//! most t·spread in the norm of its rays, so it goes on by the distance less t·spread, and all of them are free up to there. What it
//! comes to is a depth, which takes the place of the near plane for its block.

use glint_core::field::{FRACTION, cropped, magnitude};

use super::options::FARTHEST;
use super::prepass::Cones;
use super::ray::Ray;
use super::setup::FieldSetup;

/// Fraction bits of a depth in the table.
const DEPTH_FRACTION: u32 = 7;

/// The points after which a cone ends at the latest: all rays wait for the last cone.
const MOST_STEPS: u32 = 192;

/// The most blocks in a row of a picture: of 4 pixels, 1280 wide.
const ROW: usize = 320;

/// A cone at its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cone {
    /// The ray in its middle.
    pub ray: Ray,
    /// What it is wider by with each step of t, u0.16, rounded up.
    pub spread: u32,
}

impl FieldSetup {
    /// The cone of a block, by its place among blocks.
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
            // 18 and 9 fraction bits; one for what was cut, and one for directions, which are rounded to 17 bits.
            spread: ((cones.spread * inverse) >> 11) + 2,
        }
    }

    /// Follows a cone as far as all rays of its block are free: the t to which it has come, and the points at which it has asked.
    pub fn march_cone(&self, cone: &Cone) -> (u32, u32) {
        let Cone { ray, spread } = cone;
        let tuning = &self.tuning;
        // A point is cut by less than a step along each axis: by less than two in all.
        let cut = u32::from(self.is_round());
        let mut t = ray.start;
        let mut steps = 0;
        loop {
            let point = self.point(ray, t);
            let sample = self.sample(point.map(|x| cropped(x, 10 + FRACTION)));
            let gone = self.is_gone(ray, &point);
            let width = ((u64::from(t) * u64::from(*spread)) >> 16) as u32 + cut;
            let wide = width >> (4 + FRACTION) != 0;
            let threshold = i64::from(tuning.threshold + width);
            steps += 1;
            let next = t + (sample.distance - width as i32 - 1).max(0) as u32;
            let ends = gone
                || wide
                || next > tuning.far
                || i64::from(sample.distance) < threshold
                || steps >= self.cap().min(MOST_STEPS);
            if ends {
                return (t, steps);
            }
            t = next;
        }
    }

    /// The depth along n at a cone's t as the table has it: times 2^e, u11.7, rounded down.
    pub fn cleared(&self, cone: &Cone, t: u32) -> u32 {
        let depth = (u64::from(t) * u64::from(self.inverse(cone.ray.length))) >> 9;
        depth.min(FARTHEST.into()) as u32 >> (FRACTION - DEPTH_FRACTION)
    }
}

/// The rays of a picture, which it is to be asked for row by row: without a prepass as [`FieldSetup::ray`] has them, or else each
/// begins where the cone of its block has come to.
pub struct Rays<'a> {
    setup: &'a FieldSetup,
    /// What the cones of the row of blocks have cleared for each eye, and the row.
    cleared: [[u32; ROW]; 2],
    row: [Option<u32>; 2],
    evaluations: u64,
}

impl<'a> Rays<'a> {
    /// Those of a frame.
    pub const fn new(setup: &'a FieldSetup) -> Self {
        Self {
            setup,
            cleared: [[0; ROW]; 2],
            row: [None; 2],
            evaluations: 0,
        }
    }

    /// The ray of a pixel.
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

    /// Evaluations of the field that its cones have taken until now.
    pub const fn evaluations(&self) -> u64 {
        self.evaluations
    }
}

const _: () = assert!(DEPTH_FRACTION < FRACTION);
