//! The contents of descriptors, as the raster pass reads them from memory.

use core::ops::Range;

use glint_core::bits::Bits;
use glint_core::colour::Rgb565;
use glint_core::records::{PIECE_MARK, descriptor, piece, stored_piece};

use super::{DEPTH, Descriptor, GROUP, HALF_A_CODE, LOW_WORDS, PlaneFields, SMOOTH, light};
use crate::line::{Line, Piece};
use crate::triangle::setup::{Bounds, Edge, Plane, Setup};

/// Primitive that a descriptor in memory represents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contents {
    /// A triangle, with its colour under flat shading. The left and right bounds are rounded to groups.
    Triangle(Setup, Rgb565),
    /// A piece of a line.
    Piece(Piece),
    /// A damaged triangle, whose groups are not in the picture; it is not drawn.
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

    /// Unpacks the descriptor for a picture of this width. Never fails: any words are valid contents.
    pub fn contents(&self, width: u32) -> Contents {
        let words = &self.words;
        let colour = Rgb565(descriptor::COLOUR.get(words) as u16);
        if stored_piece::MARK.get(words) == PIECE_MARK {
            return Contents::Piece(Piece {
                line: self.line(),
                colour,
            });
        }
        let number = |field: Bits| field.get(words) as i32;
        let [left, right, start] = [
            descriptor::GROUP_LEFT,
            descriptor::GROUP_RIGHT,
            descriptor::GROUP_START,
        ]
        .map(number);
        if !(left <= start && start <= right && right < width as i32 / GROUP) {
            return Contents::Stray;
        }
        let [top, bottom] = [descriptor::TOP, descriptor::BOTTOM].map(number);
        let edges = [0, 1, 2].map(|k| Edge {
            start: descriptor::START.element(k).signed(words),
            step_x: descriptor::STEPS_X.element(k).signed(words) as i32,
            step_y: descriptor::STEPS_Y.element(k).signed(words) as i32,
        });
        let light = [0, 1, 2].map(|channel| self.plane(light(channel)));
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
            depth: self.plane(DEPTH),
            light: (SMOOTH.get(words) != 0).then_some(light),
            weight: None,
            narrow: edges.iter().all(|edge| {
                let [across, down] = [edge.step_x, edge.step_y].map(|x| i64::from(x).abs());
                edge.start.abs() + columns * across + rows.abs() * down < 1 << 31
            }),
        };
        Contents::Triangle(setup, colour)
    }

    fn line(&self) -> Line {
        let low = self.words.iter().skip(stored_piece::LOW.word());
        let high = self.words.iter().skip(stored_piece::HIGH.word());
        let mut fields = [0; piece::BITS.div_ceil(32)];
        for (to, word) in fields.iter_mut().zip(low.take(LOW_WORDS).chain(high)) {
            *to = *word;
        }
        let words = &fields;
        let [x_major, left, up] =
            [piece::X_MAJOR, piece::LEFT, piece::UP].map(|field| field.get(words) != 0);
        let [column, row, minor, count] = [piece::COLUMN, piece::ROW, piece::MINOR, piece::COUNT]
            .map(|field| field.get(words) as i32);
        let [error, fall] = [piece::ERROR, piece::FALL].map(|field| field.signed(words) as i32);
        let mirrored = |place: i32, backward: bool| if backward { !place } else { place };
        let (start, backward) = ([mirrored(column, left), mirrored(row, up)], [left, up]);
        let by_axis = |[x, y]: [i32; 2]| if x_major { [x, y] } else { [y, x] };
        Line {
            x_major,
            backward: if x_major { backward } else { [up, left] },
            start: by_axis(start),
            count,
            span: [minor - fall, minor],
            error: error - minor,
            depth: piece::DEPTH.signed(words) - HALF_A_CODE,
            depth_step: piece::DEPTH_STEP.signed(words),
        }
    }

    fn plane(&self, fields: PlaneFields) -> Plane {
        let [start, step_x, step_y] = fields.map(|field| field.get(&self.words) as u32);
        Plane {
            start,
            step_x,
            step_y,
        }
    }
}

impl Setup {
    /// The part of the triangle in these rows of the picture; `None` if it covers none of these rows.
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
