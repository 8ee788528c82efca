//! Bounding rectangles of spheres on the screen.

use glint_core::camera::View;
use glint_core::field::{FRACTION, units};
use glint_core::fixed::Q32_32;
use glint_core::picture::Window;

use super::vectors::{Scaled, product};

/// Number of columns of a group. Rectangles consist of whole groups, because the gateware finds the spheres for all columns of a group at
/// once.
const GROUP: u32 = 8;

/// Base-2 logarithm of the far limit's depth in field units.
pub(super) const FAR: u32 = 11;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rectangle {
    /// First and last column, at the borders of groups. The first column exceeds the last one in an empty rectangle.
    pub columns: [u32; 2],
    /// First and last row.
    pub rows: [u32; 2],
}

impl Rectangle {
    /// The empty rectangle.
    pub(super) const NONE: Self = Self {
        columns: [1, 0],
        rows: [1, 0],
    };

    /// Whether a pixel is in the rectangle.
    pub const fn holds(&self, column: u32, row: u32) -> bool {
        let Self { columns, rows } = self;
        columns[0] <= column && column <= columns[1] && rows[0] <= row && row <= rows[1]
    }

    /// Whether the rectangle contains no pixel.
    pub const fn is_empty(&self) -> bool {
        self.columns[0] > self.columns[1] || self.rows[0] > self.rows[1]
    }

    /// Column and row of the pixel in the middle.
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
}

/// The projection of an eye to the pixels of a window.
pub(super) struct Screen {
    /// Position of the eye in field units, s13.12.
    eye: [i32; 3],
    /// The camera's axes u, v and n, s2.23.
    axes: [[i32; 3]; 3],
    /// Across and down: a number of pixels, and their total length at distance 1, u7.12.
    scales: [(u32, i32); 2],
    /// Middle of the picture along u and v at distance 1, s3.12.
    centre: [i32; 2],
    /// The part of the picture that is drawn.
    window: Window,
}

impl Screen {
    /// The projection of a camera to a window of a picture. `scale` is the number of field units per world unit.
    pub(super) fn new(view: &View, scale: Q32_32, window: Window) -> Self {
        let axes = [view.u(), view.v(), view.n()];
        Self {
            eye: view.eye().map(|x| units(x, scale) as i32),
            axes: axes.map(|axis| axis.map(|part| part.to_bits())),
            scales: (view.lens().scales(window.picture()))
                .map(|(pixels, length)| (pixels, ((length.to_bits() >> 16) as i32).max(1))),
            centre: view.lens().middle().map(|x| x.to_bits() >> 16),
            window,
        }
    }

    /// A rectangle that contains all pixels that see a sphere. `centre` and `radius` are in field units with 12 fraction bits.
    pub(super) fn around(&self, centre: [i32; 3], radius: i32) -> Rectangle {
        // The length of a camera axis may be up to 1 + 10^−4, so the radius is enlarged.
        let radius = radius + (radius >> 10) + 4;
        let place = [0, 1, 2].map(|i: usize| centre[i] - self.eye[i]);
        // Each of the three coordinates has at most 27 bits.
        let [right, down, depth] = self.axes.map(|axis| (product(&axis, &place) >> 23) as i32);
        if depth - radius >= 1 << (FAR + FRACTION) {
            return Rectangle::NONE;
        }
        if depth <= radius {
            // The sphere reaches the plane of the eye, or is behind it.
            return match depth < -radius {
                true => Rectangle::NONE,
                false => Rectangle::all(self.window.size.pixels()),
            };
        }
        // Slopes of the two planes through the eye that touch the sphere, 12 fraction bits.
        let wide = |a: i32, b: i32| i64::from(a) * i64::from(b);
        let divisor = wide(depth, depth) - wide(radius, radius);
        let reciprocal = |square: i64| Scaled::inverse_root(square.cast_unsigned(), 0);
        let inverse_root = reciprocal(divisor);
        let inverse = inverse_root.by(inverse_root);
        let slopes = |side: i32| {
            let square = wide(side, side) + divisor;
            let root = Scaled::new(square.cast_unsigned(), 0).by(reciprocal(square));
            // The addend covers the rounding of the root.
            let reach = wide(radius, root.fixed(0) as i32 + 2);
            [-reach, reach].map(|reach| {
                let dividend = wide(side, depth) + reach;
                let slope = Scaled::new(dividend.unsigned_abs(), 0)
                    .by(inverse)
                    .fixed(12);
                // A slope of 2^8 is far beyond the widest camera.
                let slope = slope.min(1 << 20) as i32;
                if dividend < 0 { -slope } else { slope }
            })
        };
        let range = |axis: usize, side: i32, count: u32, middle: u32| {
            let (pixels, length) = self.scales[axis];
            let pixel = |slope: i32| {
                ((slope - self.centre[axis]) * pixels as i32).div_euclid(length) + middle as i32
            };
            // The margin covers the rounding of the slopes and of the camera's axes.
            let margin = 2 + 2 * pixels as i32 / length;
            let [first, last] = slopes(side).map(pixel);
            let most = count as i32 - 1;
            let (first, last) = (first - margin, last + margin);
            match first > most || last < 0 {
                true => [1, 0],
                false => [first.clamp(0, most) as u32, last.clamp(0, most) as u32],
            }
        };
        let ([width, height], [column, row]) = (self.window.size.pixels(), self.window.middle());
        let [first, last] = range(0, right, width, column);
        Rectangle {
            columns: [first / GROUP * GROUP, last | (GROUP - 1)],
            rows: range(1, down, height, row),
        }
    }
}
