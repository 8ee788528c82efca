//! Converts rectangles of the screen (docs/formats/texture.md, "Rectangles") to input of the walker.

use glint_core::picture::{Samples, Window};
use glint_core::rectangle::Rectangle;

use crate::triangle::setup::{Bounds, Edge, Plane, Setup};
use crate::triangle::textured::{Axis, Textured, flat_light, weight};
use crate::triangle::vertex::LARGEST_DEPTH;

/// Base-2 logarithm of the range of a coordinate. The coordinate 1, at which a part may end, requires the range of two repeats.
const RANGE_LOG2: u32 = 1;
/// Base-2 logarithm of an accumulator's value at the end of the range.
const ACCUMULATOR_LOG2: u32 = 31;

/// The visible part of a rectangle in a window of a picture with this number of samples per pixel, as the setup of a triangle. Two edges
/// are the left and the right side of the rectangle, all samples are inside the third edge, and the bounds limit the rows. `None` if no
/// sample is visible.
pub fn set_up<'a>(
    rectangle: &Rectangle<'a>,
    window: Window,
    samples: Samples,
) -> Option<(Setup, Textured<'a>)> {
    let [x, y] = [0, 1].map(|axis: usize| {
        let [origin, size] = [window.origin(), window.size.pixels()].map(|pair| pair[axis]);
        Span::new(rectangle, axis, [origin, size], samples.across())
    });
    let ([x, y], white) = ([x?, y?], [1 << 8; 3]);
    let edge = |start: i32, step_x| Edge {
        start: start.into(),
        step_x,
        step_y: 0,
    };
    let setup = Setup {
        bounds: Bounds {
            left: x.first,
            right: x.end,
            top: y.first,
            bottom: y.end,
        },
        start_column: x.first,
        edges: [edge(0, 1), edge(x.end - 1 - x.first, -1), edge(0, 0)],
        depth: Plane {
            start: LARGEST_DEPTH << 8,
            ..Plane::default()
        },
        light: None,
        weight: None,
        narrow: true,
    };
    let axis = |start, step_x, step_y| Axis {
        plane: Plane {
            start,
            step_x,
            step_y,
        },
        range_log2: RANGE_LOG2,
        periods: 0,
    };
    let textured = Textured {
        texture: rectangle.texture,
        axes: [axis(x.start, x.step, 0), axis(y.start, 0, y.step)],
        light: flat_light(rectangle.colour, white),
        weight: weight(true),
    };
    Some((setup, textured))
}

/// The visible columns or rows of samples of a rectangle, and the accumulator of the texture coordinate along them.
struct Span {
    /// The first visible column or row; `end` is one past the last one.
    first: i32,
    end: i32,
    /// The value of the accumulator at the first visible sample.
    start: u32,
    /// The change of the accumulator from a sample to the next.
    step: u32,
}

impl Span {
    /// The span along one axis, in a window of `window` samples that begins at the sample `origin`. A pixel has `samples` samples along the
    /// axis.
    fn new(
        rectangle: &Rectangle,
        axis: usize,
        [origin, window]: [u32; 2],
        samples: u32,
    ) -> Option<Self> {
        let place = i32::from(rectangle.place[axis]) * samples as i32 - origin as i32;
        let size = u32::from(rectangle.size[axis]) * samples;
        let (first, end) = (place.max(0), (place + size as i32).min(window as i32));
        let side_log2 = rectangle.texture.size_log2()[axis];
        let from = u32::from(rectangle.part.place[axis]);
        let to = from + u32::from(rectangle.part.size[axis]);
        if first >= end || from == to || to > 1 << side_log2 {
            return None;
        }
        let [low, high] = [from, to].map(|texel| side(texel, side_log2));
        // Rounded down, so that no sample is beyond the end of the part.
        let step = (high - low) / size;
        let passed = step * (first - place) as u32 + step / 2;
        let (start, step) = if rectangle.is_mirrored[axis] {
            (high - passed, step.wrapping_neg())
        } else {
            (low + passed, step)
        };
        Some(Self {
            first,
            end,
            start,
            step,
        })
    }
}

/// The smallest accumulator with a position at or after the left or upper side of a texel. It exceeds the exact value, because the inverse
/// of the weight is 1 − 2^−18, and the lowest eight bits of an accumulator are not used.
const fn side(texel: u32, side_log2: u32) -> u32 {
    let exact = texel << (ACCUMULATOR_LOG2 - RANGE_LOG2 - side_log2);
    exact + (((exact >> 26) + 1) << 8)
}
