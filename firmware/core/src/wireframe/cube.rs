//! The built-in program.

use super::format::{Opcode, WORD_BYTES};
use crate::fixed::Q5_11;

/// Name of the built-in program.
pub const CUBE_NAME: &str = "cube";

/// The built-in program: a cube of side 4 about the origin, seen from (0, 0, 8) through the window ±4 × ±2.25 at z = 4.
pub static CUBE: [[u8; WORD_BYTES]; 16] = program();

const fn program() -> [[u8; WORD_BYTES]; 16] {
    const fn q(decimal: &str) -> Q5_11 {
        Q5_11::lit(decimal)
    }
    const O: Q5_11 = Q5_11::ZERO;
    let mut words = [[0; WORD_BYTES]; 16];
    words[0] = word(Opcode::Eye, [O, O, q("8"), O, O, O]);
    words[1] = word(Opcode::Plane, [q("4"), O, O, O, O, O]);
    words[2] = word(
        Opcode::Window,
        [q("-4"), q("-2.25"), q("4"), q("2.25"), O, O],
    );
    let sides = [q("-2"), q("2")];
    let mut edge = 0;
    while edge < 12 {
        // Four edges along each axis, one for each combination of signs of the other two coordinates.
        let (axis, corner) = (edge / 4, edge % 4);
        let (first, second) = (sides[corner % 2], sides[corner / 2]);
        let [low, high] = sides;
        words[3 + edge] = word(
            Opcode::Segment,
            match axis {
                0 => [low, first, second, high, first, second],
                1 => [first, low, second, first, high, second],
                _ => [first, second, low, first, second, high],
            },
        );
        edge += 1;
    }
    words[15] = word(Opcode::End, [Q5_11::from_bits(-1); 6]);
    words
}

/// Encodes an instruction at compile time; [`super::Instruction::encode`] does the same at run time.
const fn word(opcode: Opcode, fields: [Q5_11; 6]) -> [u8; WORD_BYTES] {
    let mut bits = opcode as u128;
    let mut field = 0;
    while field < fields.len() {
        bits = bits << 16 | fields[field].to_bits() as u16 as u128;
        field += 1;
    }
    bits.to_le_bytes()
}
