//! The instructions of a program, and their binary encoding.

use super::error::{Expected, Found, Violation};
use super::format::{Opcode, Point, Segment, WORD_BYTES, Window};
use crate::fixed::Q5_11;

/// An instruction of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instruction {
    /// Sets the eye.
    Eye(Point),
    /// Sets the view plane z = a.
    Plane(Q5_11),
    /// Sets the window.
    Window(Window),
    /// Adds a segment.
    Segment(Segment),
    /// Ends the program.
    End,
}

impl Instruction {
    /// Decodes a word: the opcode in bits 98 to 96, and six fields of 16 bits, the first field in bits 95 to 80.
    ///
    /// Only the opcode distinguishes an end from other instructions, so a segment with all fields ones is an ordinary segment.
    ///
    /// # Errors
    /// The opcode is unknown, a bit above bit 98 is set, or an unused field is not 0. The six unused fields of an end may also be
    /// all ones, as in the original design.
    pub fn decode(word: &[u8; WORD_BYTES]) -> Result<Self, Violation<'static>> {
        let &[f5, f4, f3, f2, f1, f0, ref high @ ..] = word.as_chunks().0 else {
            return Err(Violation::new(
                Expected::WholeWord,
                Found::Bytes(word.len()),
            ));
        };
        let fields = [f0, f1, f2, f3, f4, f5].map(u16::from_le_bytes);
        let high = high.iter().rev().fold(0, |high, &half| {
            high << 16 | u32::from(u16::from_le_bytes(half))
        });
        if high >> 3 != 0 {
            return Err(Violation::new(Expected::ZerosAbove, Found::Bits(high >> 3)));
        }
        let opcode = Opcode::ALL
            .into_iter()
            .find(|&opcode| opcode as u32 == high & 7)
            .ok_or(Violation::new(Expected::Opcode, Found::Opcode(high as u8)))?;
        let unused = fields.iter().enumerate().skip(opcode.fields());
        if let Some((field, &found)) = unused.clone().find(|&(_, &field)| field != 0)
            && !(opcode == Opcode::End && fields == [u16::MAX; 6])
        {
            return Err(Violation::new(
                Expected::Unused {
                    opcode,
                    field: field as u8,
                },
                Found::Bits(found.into()),
            ));
        }
        Ok(Self::new(
            opcode,
            fields.map(|field| Q5_11::from_bits(field as i16)),
        ))
    }

    /// Encodes the instruction as a word. Unused fields are 0, except for the fields of an end, which are all ones.
    pub fn encode(self) -> [u8; WORD_BYTES] {
        let (opcode, fields) = self.parts();
        let mut fields = fields.map(|field| field.to_bits() as u16);
        if opcode == Opcode::End {
            fields = [u16::MAX; 6];
        }
        let halves = fields.into_iter().rev().chain([opcode as u16]);
        let mut word = [0; WORD_BYTES];
        for (bytes, half) in word.as_chunks_mut().0.iter_mut().zip(halves) {
            *bytes = half.to_le_bytes();
        }
        word
    }

    /// The segment that the instruction adds; `None` if it is another instruction.
    pub const fn segment(self) -> Option<Segment> {
        match self {
            Self::Segment(segment) => Some(segment),
            Self::Eye(_) | Self::Plane(_) | Self::Window(_) | Self::End => None,
        }
    }

    /// Makes an instruction from its kind and fields; unused fields are ignored.
    pub(super) const fn new(opcode: Opcode, [a, b, c, d, e, f]: [Q5_11; 6]) -> Self {
        match opcode {
            Opcode::Eye => Self::Eye([a, b, c]),
            Opcode::Plane => Self::Plane(a),
            Opcode::Window => Self::Window(Window {
                low: [a, b],
                high: [c, d],
            }),
            Opcode::Segment => Self::Segment([[a, b, c], [d, e, f]]),
            Opcode::End => Self::End,
        }
    }

    /// The kind and the fields of the instruction; unused fields are 0.
    pub(super) const fn parts(self) -> (Opcode, [Q5_11; 6]) {
        const O: Q5_11 = Q5_11::ZERO;
        match self {
            Self::Eye([x, y, z]) => (Opcode::Eye, [x, y, z, O, O, O]),
            Self::Plane(a) => (Opcode::Plane, [a, O, O, O, O, O]),
            Self::Window(Window {
                low: [xl, yl],
                high: [xh, yh],
            }) => (Opcode::Window, [xl, yl, xh, yh, O, O]),
            Self::Segment([[a, b, c], [d, e, f]]) => (Opcode::Segment, [a, b, c, d, e, f]),
            Self::End => (Opcode::End, [O; 6]),
        }
    }
}
