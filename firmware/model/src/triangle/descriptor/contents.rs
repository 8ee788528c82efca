//! The contents of descriptors, as the raster pass reads them from memory.

use core::ops::Range;

use glint_core::colour::Rgb565;

use super::{Descriptor, GROUP, HALF_A_CODE, PIECE};
use crate::line::{Line, Piece};
use crate::triangle::setup::{Bounds, Edge, Plane, Setup};

/// Primitive that a descriptor in memory represents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contents {
    /// A triangle, with its colour under flat shading. Left and right bounds are those of groups.
    Triangle(Setup, Rgb565),
    /// A piece of a line.
    Piece(Piece),
    /// A damaged triangle, whose groups are not in the picture: it is not drawn.
    Stray,
}

impl Descriptor {
    /// The descriptor with these words in memory; missing words are 0.
    pub fn from_words(words: impl IntoIterator<Item = u32>) -> Self {
        let mut descriptor = Self::default();
        for (to, word) in descriptor.words.iter_mut().zip(words) {
            *to = word;
        }
        descriptor
    }

    /// Unpacks the descriptor for a picture of this width. Any words have contents.
    pub fn contents(&self, width: u32) -> Contents {
        let colour = Rgb565(self.bits(368, 16) as u16);
        if self.bits(366, 2) == PIECE as u64 {
            return Contents::Piece(Piece {
                line: self.line(),
                colour,
            });
        }
        let [left, right, start] = [344, 352, 360].map(|at| self.bits(at, 8) as i32);
        if !(left <= start && start <= right && right < width as i32 / GROUP) {
            return Contents::Stray;
        }
        let [top, bottom] = [324, 334].map(|at| self.bits(at, 10) as i32);
        let edges = [0, 1, 2].map(|k| Edge {
            start: self.signed(34 * k, 34),
            step_x: self.signed(198 + 42 * k, 21) as i32,
            step_y: self.signed(219 + 42 * k, 21) as i32,
        });
        let light = [0, 1, 2].map(|channel| self.plane(384 + 96 * channel));
        let [columns, rows] = [GROUP * (right - left + 2), bottom - top + 2].map(i64::from);
        let setup = Setup {
            bounds: Bounds {
                left: GROUP * left,
                right: GROUP * (right + 1),
                top,
                bottom,
            },
            start_column: GROUP * start,
            edges,
            depth: self.plane(102),
            light: (self.bits(672, 1) != 0).then_some(light),
            weight: None,
            narrow: edges.iter().all(|edge| {
                let [across, down] = [edge.step_x, edge.step_y].map(|x| i64::from(x).abs());
                edge.start.abs() + columns * across + rows.abs() * down < 1 << 31
            }),
        };
        Contents::Triangle(setup, colour)
    }

    fn line(&self) -> Line {
        let [x_major, left, up] = [128, 129, 130].map(|at| self.bits(at, 1) != 0);
        let [column, row] = [(131, 11), (142, 10)].map(|(at, width)| self.bits(at, width) as i32);
        let minor = self.bits(185, 20) as i32;
        let depth = self.bits(226, 30) as i64 | self.signed(320, 4) << 30;
        let mirrored = |place: i32, backward: bool| if backward { !place } else { place };
        let (start, backward) = ([mirrored(column, left), mirrored(row, up)], [left, up]);
        let by_axis = |[x, y]: [i32; 2]| if x_major { [x, y] } else { [y, x] };
        Line {
            x_major,
            backward: if x_major { backward } else { [up, left] },
            start: by_axis(start),
            count: self.bits(152, 12) as i32,
            span: [minor - self.signed(205, 21) as i32, minor],
            error: self.signed(164, 21) as i32 - minor,
            depth: depth - HALF_A_CODE,
            depth_step: self.signed(324, 34),
        }
    }

    fn plane(&self, at: usize) -> Plane {
        let [start, step_x, step_y] = [0, 32, 64].map(|offset| self.bits(at + offset, 32) as u32);
        Plane {
            start,
            step_x,
            step_y,
        }
    }

    /// The field of `width` bits, at most 34, that begins at bit `at`.
    fn bits(&self, at: usize, width: usize) -> u64 {
        let word = |number| u64::from(self.words.get(number).copied().unwrap_or(0));
        let (first, shift) = (at / 32, at % 32);
        let low = word(first) | word(first + 1) << 32;
        // A field of 34 bits has bits in up to three words.
        let high = (word(first + 2) << 1) << (63 - shift);
        (low >> shift | high) & ((1 << width) - 1)
    }

    /// The same as a two's complement number.
    fn signed(&self, at: usize, width: usize) -> i64 {
        let unused = 64 - width;
        (self.bits(at, width) << unused) as i64 >> unused
    }
}

impl Setup {
    /// The part of the triangle in these rows of the picture; `None` if it has no row there.
    pub fn in_rows(&self, rows: Range<i32>) -> Option<Self> {
        let Bounds { top, bottom, .. } = self.bounds;
        let (first, end) = (top.max(rows.start), bottom.min(rows.end));
        let below = first - top;
        let moved = |plane: Plane| Plane {
            start: plane
                .start
                .wrapping_add(plane.step_y.wrapping_mul(below as u32)),
            ..plane
        };
        (first < end).then(|| Self {
            bounds: Bounds {
                top: first,
                bottom: end,
                ..self.bounds
            },
            edges: self.edges.map(|edge| Edge {
                start: edge.start + i64::from(below) * i64::from(edge.step_y),
                ..edge
            }),
            depth: moved(self.depth),
            light: self.light.map(|light| light.map(moved)),
            ..*self
        })
    }
}
