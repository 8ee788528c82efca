//! The contents of descriptors, as the raster pass reads them from memory.

use core::ops::Range;

use glint_core::bits::Bits;
use glint_core::colour::Rgb565;
use glint_core::records::{PIECE_MARK, descriptor, piece, stored_piece, texture_planes};

use super::{
    DEPTH, Descriptor, GROUP, HALF_A_CODE, LOW_WORDS, Layout, PlaneFields, SMOOTH, coordinate,
    in_texture, light,
};
use crate::line::{Line, Piece};
use crate::triangle::setup::{Bounds, Edge, Plane, Setup};
use crate::triangle::textured::{Axis, OfTexture, weight};

/// The primitive that a descriptor in memory describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contents {
    /// A triangle, the triangle's colour under flat shading, and the texture if the triangle has one. The left and right bounds are rounded
    /// to groups.
    Triangle(Setup, Rgb565, Option<OfTexture>),
    /// A piece of a line, which has one band.
    Piece(Piece),
    /// A damaged triangle, whose groups are not in the picture, and which is not drawn.
    Stray,
}

impl OfTexture {
    /// The texture for the part of the triangle that begins `rows` rows below the triangle's top.
    pub fn moved(&self, rows: i32) -> Self {
        let axes = self.axes.map(|axis| Axis {
            plane: axis.plane.moved_down(rows),
            ..axis
        });
        Self { axes, ..*self }
    }
}

impl Descriptor {
    /// The descriptor with these words in memory, for gateware with this layout; missing words are 0.
    pub fn from_words(words: impl IntoIterator<Item = u32>, layout: Layout) -> Self {
        let mut descriptor = Self::default();
        let mut words = words.into_iter();
        for part in layout.parts() {
            let to = descriptor.words.get_mut(part).unwrap_or_default();
            to.iter_mut()
                .zip(&mut words)
                .for_each(|(to, word)| *to = word);
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
        Contents::Triangle(setup, colour, self.texture())
    }

    fn texture(&self) -> Option<OfTexture> {
        let words = &self.words;
        let number = in_texture(texture_planes::TEXTURE).get(words) as u8;
        let axis = |axis: usize| Axis {
            plane: self.plane(coordinate(axis)),
            range_log2: in_texture(texture_planes::RANGE).element(axis).get(words) as u32,
            periods: (in_texture(texture_planes::PERIODS).element(axis)).signed(words) as i32,
        };
        (number != 0).then(|| OfTexture {
            number,
            axes: [axis(0), axis(1)],
            light: [0, 1, 2].map(|channel| {
                (in_texture(texture_planes::LIGHT).element(channel)).get(words) as u8
            }),
            weight: weight(in_texture(texture_planes::LINEAR).get(words) != 0),
        })
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

impl Plane {
    fn moved_down(self, rows: i32) -> Self {
        let start = self
            .start
            .wrapping_add(self.step_y.wrapping_mul(rows as u32));
        Self { start, ..self }
    }
}

impl Setup {
    /// The part of the triangle in these rows of the picture; `None` if it covers none of these rows.
    pub fn in_rows(&self, rows: Range<i32>) -> Option<Self> {
        let Bounds { top, bottom, .. } = self.bounds;
        let (first, end) = (top.max(rows.start), bottom.min(rows.end));
        let below = first - top;
        let moved = |plane: Plane| plane.moved_down(below);
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
