//! Codes of intervals, as the gateware and its registers store them.

use super::intervals::{Rule, Solid};

/// Number of bits of an interval's code ([`Solid::code`]).
pub const CODE_BITS: u32 = 13;

/// Number of bits of a code after its first bit.
const DIGITS: u32 = CODE_BITS - 1;

/// The first bit of a code: 0 below the solid, otherwise 1.
const NOT_BELOW: u32 = 1 << DIGITS;

/// The code above a solid that is not repeated.
const ABOVE: u32 = NOT_BELOW | 3 << (DIGITS - 2);

/// For a repeated solid: the number of bits of a cell's number, and the positions of the cell's number and of the gap's digit in a code.
const CELL_BITS: u32 = 6;
const CELL: u32 = DIGITS - CELL_BITS;
const GAP: u32 = CELL - 2;

impl Solid {
    /// The code of an interval, a number of [`CODE_BITS`] bits. A higher interval has a higher code. The first bit is 0 below the solid.
    /// The next bits depend on the solid:
    /// - Sponge: the ternary digits of the smallest cell, two bits each, the most significant digit first. Above the sponge the first digit
    ///   is 3.
    /// - Repeated solid: the number of the cell modulo 64 in six bits, then a digit of two bits: 0 in the cube, 1 in the gap above it.
    /// - Other solids: one digit of two bits, 0 inside and 3 above.
    ///
    /// All other bits are 0. The lowest interval, and all intervals below a solid that is not repeated, have the code 0.
    pub fn code(&self, interval: i32) -> u32 {
        match self.rule {
            _ if interval == i32::MIN => 0,
            Rule::Repeated { .. } => {
                let cell = (interval >> 1) as u32 & ((1 << CELL_BITS) - 1);
                let first = if interval < 0 { 0 } else { NOT_BELOW };
                first | cell << CELL | (interval as u32 & 1) << GAP
            }
            _ if interval < 0 => 0,
            Rule::Sponge { cells, .. } if interval < cells => places(cells)
                .fold(NOT_BELOW, |code, (shift, cell)| {
                    code | ((interval / cell % 3) as u32) << shift
                }),
            Rule::Box | Rule::Planes | Rule::Octahedron if interval == 0 => NOT_BELOW,
            _ => ABOVE,
        }
    }

    /// The interval with a [`code`](Self::code); the lowest interval for the code 0.
    pub fn interval(&self, code: u32) -> i32 {
        let is_below = code & NOT_BELOW == 0;
        match self.rule {
            _ if code == 0 => i32::MIN,
            Rule::Repeated { .. } => {
                let cell = (code >> CELL & ((1 << CELL_BITS) - 1)) as i32;
                let below = if is_below { 1 << CELL_BITS } else { 0 };
                2 * (cell - below) + (code >> GAP & 3) as i32
            }
            _ if is_below => i32::MIN,
            Rule::Sponge { cells, .. } if code < ABOVE => places(cells)
                .map(|(shift, cell)| (code >> shift & 3) as i32 * cell)
                .sum(),
            Rule::Sponge { cells, .. } => cells,
            Rule::Box | Rule::Planes | Rule::Octahedron => i32::from(code != NOT_BELOW),
        }
    }
}

/// The bit position in a code of each digit of a sponge's cell, and the digit's weight; `cells` is a power of three.
fn places(cells: i32) -> impl Iterator<Item = (u32, i32)> {
    let weights = core::iter::successors(Some(cells / 3), |weight| Some(weight / 3));
    let shifts = (0..DIGITS / 2).map(|digit| DIGITS - 2 - 2 * digit);
    core::iter::zip(shifts, weights.take_while(|&weight| weight > 0))
}
