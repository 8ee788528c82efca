//! Rectangles on the screen around spheres.

use glint_core::camera::View;
use glint_core::field::units;
use glint_core::fixed::{Q2_23, Q32_32};

/// Columns of a group. Rectangles consist of whole groups: the gateware finds the spheres of a group at once.
const GROUP: u32 = 8;

/// Pixels from a first to a last column and row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rectangle {
    /// First and last column, of whole groups of eight; the first exceeds the last if no pixel sees the sphere.
    pub columns: [u32; 2],
    /// First and last row.
    pub rows: [u32; 2],
}

impl Rectangle {
    /// No pixel.
    pub(super) const NONE: Self = Self {
        columns: [1, 0],
        rows: [1, 0],
    };

    /// Whether a pixel is in the rectangle.
    pub const fn holds(&self, column: u32, row: u32) -> bool {
        let Self { columns, rows } = self;
        columns[0] <= column && column <= columns[1] && rows[0] <= row && row <= rows[1]
    }

    /// Whether there is no pixel in the rectangle.
    pub const fn is_empty(&self) -> bool {
        self.columns[0] > self.columns[1] || self.rows[0] > self.rows[1]
    }

    /// Column and row in the middle.
    pub(super) const fn middle(&self) -> [u32; 2] {
        let Self { columns, rows } = self;
        [(columns[0] + columns[1]) / 2, (rows[0] + rows[1]) / 2]
    }

    /// All pixels of a picture of this size.
    pub(super) const fn all([width, height]: [u32; 2]) -> Self {
        Self {
            columns: [0, width - 1],
            rows: [0, height - 1],
        }
    }

    /// A rectangle around the pixels of a picture of this size that may see a sphere. `centre` and `radius` are in field units with 12
    /// fraction bits, `scale` is the number of field units per world unit.
    pub(super) fn around(
        centre: [i32; 3],
        radius: i32,
        view: &View,
        scale: Q32_32,
        [width, height]: [u32; 2],
    ) -> Self {
        // The camera's axes may be longer than 1 by 10^−4.
        let radius = i64::from(radius) + (i64::from(radius) >> 10) + 4;
        let eye = view.eye().map(|x| units(x, scale));
        let along = |axis: [Q2_23; 3]| -> i64 {
            let sum: i64 = (0..3)
                .map(|i| i64::from(axis[i].to_bits()) * (i64::from(centre[i]) - eye[i]))
                .sum();
            sum >> 23
        };
        let depth = along(view.n());
        if depth <= radius {
            // The sphere reaches the plane of the eye, or is behind it.
            return match depth < -radius {
                true => Self::NONE,
                false => Self::all([width, height]),
            };
        }
        // Slopes of the two planes through the eye that touch the sphere, 12 fraction bits. Coordinates have 25 bits at most.
        let divisor = depth * depth - radius * radius;
        let slopes = |side: i64| {
            let root = (side * side + divisor).max(0).isqrt();
            [-1, 1].map(|sign| {
                let dividend = side * depth + sign * radius * (root + 1);
                // A dividend has 48 bits. A slope of 2^8 is far beyond the widest camera.
                ((dividend << 12) / divisor.max(1)).clamp(-1 << 20, 1 << 20)
            })
        };
        let half_width = view.half_width().to_bits() as i64 >> 16;
        let range = |slopes: [i64; 2], count: u32| {
            let pixel = |slope: i64| {
                (slope * i64::from(width) / 2).div_euclid(half_width.max(1)) + i64::from(count) / 2
            };
            // A slope is rounded, and so are the camera's axes.
            let margin = 2 + i64::from(width) / half_width.max(1);
            let [first, last] = slopes.map(pixel);
            let most = i64::from(count) - 1;
            let (first, last) = (first - margin, last + margin);
            match first > most || last < 0 {
                true => [1, 0],
                false => [first.clamp(0, most) as u32, last.clamp(0, most) as u32],
            }
        };
        let shift = i64::from(view.shift().to_bits()) >> 16;
        let [first, last] = range(slopes(along(view.u())).map(|slope| slope - shift), width);
        Self {
            columns: [first / GROUP * GROUP, last | (GROUP - 1)],
            rows: range(slopes(along(view.v())), height),
        }
    }
}
