//! The walker: finds the pixels of a triangle row by row, tests their depth and writes them.
//!
//! A triangle is convex, so each row has one span. The span starts where all edges of the left side are passed and ends
//! where an edge of the right side fails; from one row to the next both ends move along their edges, and the walker
//! follows them pixel by pixel instead of looking through the row. Horizontal edges need no test: the bounds hold the
//! rows at or below a top edge and above a bottom edge.

use core::ops::{Add, BitOr, Sub};

use glint_core::colour::Rgb565;

use crate::render::Target;
use crate::setup::{Edge, Setup};

/// What drawing one triangle took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Pixels that the walker came to: those covered, and those where it found that a span has ended.
    pub tested: u32,
    /// Pixels covered.
    pub covered: u32,
    /// Pixels covered that passed the depth test and were written.
    pub drawn: u32,
}

/// Draws a triangle in one colour.
pub fn draw(setup: &Setup, colour: Rgb565, target: &mut Target) -> Coverage {
    if setup.narrow {
        walk::<i32>(setup, colour, target)
    } else {
        walk::<i64>(setup, colour, target)
    }
}

/// An accumulator of E': `i32` where the setup has proven that it fits, else `i64`.
trait Accumulator:
    Copy
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + BitOr<Output = Self>
    + From<i32>
    + TryFrom<i64>
{
}
impl Accumulator for i32 {}
impl Accumulator for i64 {}

fn walk<A: Accumulator>(setup: &Setup, colour: Rgb565, target: &mut Target) -> Coverage {
    let bounds = setup.bounds;
    let mut left = End::<A>::new(
        setup,
        |edge| edge.step_x > 0,
        -1,
        [bounds.left, bounds.right],
    );
    let mut right = End::<A>::new(
        setup,
        |edge| edge.step_x < 0,
        1,
        [bounds.right - 1, bounds.left - 1],
    );
    let mut row_depth = setup.depth.start.wrapping_add(1 << 13);
    let mut coverage = Coverage::default();
    for row in bounds.top..bounds.bottom {
        coverage.tested += left.settle() + right.settle();
        if left.column <= right.column {
            let offset = (left.column - setup.start_column) as u32;
            let depth = row_depth.wrapping_add(setup.depth.step_x.wrapping_mul(offset));
            coverage.drawn += fill(
                target,
                row,
                left.column,
                right.column,
                depth,
                setup.depth.step_x,
                colour,
            );
            coverage.covered += (right.column - left.column + 1) as u32;
        }
        left.go_down();
        right.go_down();
        row_depth = row_depth.wrapping_add(setup.depth.step_y);
    }
    coverage.tested += coverage.covered;
    coverage
}

/// Fills the columns `from` to `to` of a row where the depth test passes; the depth has half a code added, so that cutting
/// it rounds to nearest. Returns how many pixels were written.
fn fill(
    target: &mut Target,
    row: i32,
    from: i32,
    to: i32,
    mut depth: u32,
    step: u32,
    colour: Rgb565,
) -> u32 {
    let start = row as usize * target.width as usize;
    let span = start + from as usize..start + to as usize + 1;
    // The bounds are in the picture, so both spans are there.
    let colours = target.colour.get_mut(span.clone()).unwrap_or_default();
    let depths = target.depth.get_mut(span).unwrap_or_default();
    let mut drawn = 0;
    for (pixel, stored) in colours.iter_mut().zip(depths) {
        let code = (depth >> 14).max(1);
        if code >= *stored {
            *stored = code;
            *pixel = colour.0;
            drawn += 1;
        }
        depth = depth.wrapping_add(step);
    }
    drawn
}

/// One end of the row's span: the outermost column that passes the one or two edges of its side.
///
/// Outwards, E' of these edges falls by |dy| a pixel. Where a side has only one edge the other is 0 everywhere, which passes.
struct End<A> {
    value: [A; 2],
    inwards: [A; 2],
    down: [A; 2],
    column: i32,
    outwards: i32,
    /// The outermost column in the bounds.
    outermost: i32,
    /// The column next to the innermost: no column passes.
    nowhere: i32,
}

impl<A: Accumulator> End<A> {
    fn new(
        setup: &Setup,
        on_this_side: impl Fn(&Edge) -> bool,
        outwards: i32,
        [outermost, nowhere]: [i32; 2],
    ) -> Self {
        let zero = A::default();
        let mut end = Self {
            value: [zero; 2],
            inwards: [zero; 2],
            down: [zero; 2],
            column: setup.start_column,
            outwards,
            outermost,
            nowhere,
        };
        let slots = end
            .value
            .iter_mut()
            .zip(&mut end.inwards)
            .zip(&mut end.down);
        for (((value, inwards), down), edge) in
            slots.zip(setup.edges.iter().filter(|edge| on_this_side(edge)))
        {
            // A narrow triangle's values fit.
            *value = A::try_from(edge.start).unwrap_or_default();
            *inwards = A::from(edge.step_x.abs());
            *down = A::from(edge.step_y);
        }
        end
    }

    /// Moves to the end of this row's span; returns how many pixels outside of the edges it came to.
    fn settle(&mut self) -> u32 {
        let mut missed = 0;
        if passes(self.value) {
            while self.column != self.outermost {
                let next = pairwise(self.value, self.inwards, A::sub);
                if !passes(next) {
                    return 1;
                }
                self.value = next;
                self.column += self.outwards;
            }
        } else {
            while self.column != self.nowhere && !passes(self.value) {
                self.value = pairwise(self.value, self.inwards, A::add);
                self.column -= self.outwards;
                missed += 1;
            }
        }
        missed
    }

    fn go_down(&mut self) {
        self.value = pairwise(self.value, self.down, A::add);
    }
}

/// The sign of the bitwise or is set when one of the signs is.
fn passes<A: Accumulator>([a, b]: [A; 2]) -> bool {
    a | b >= A::default()
}

fn pairwise<A: Copy>([a, b]: [A; 2], [c, d]: [A; 2], operation: impl Fn(A, A) -> A) -> [A; 2] {
    [operation(a, c), operation(b, d)]
}
