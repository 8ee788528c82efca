//! Sizes, opcodes and geometry of the program format.

use crate::choice::choices;
use crate::fixed::Q5_11;

/// Largest number of segments of a program.
pub const MAX_SEGMENTS: u32 = 65_535;
/// Extensions of program files: of the text form, and of the binary form.
pub const EXTENSIONS: [&str; 2] = ["wft", "wfb"];

/// Whether the name of a file has one of the [`EXTENSIONS`].
pub fn is_program_file(name: &str) -> bool {
    let extension = name.rsplit_once('.').map(|(_, extension)| extension);
    extension.is_some_and(|extension| {
        let mut known = EXTENSIONS.iter();
        known.any(|known| extension.eq_ignore_ascii_case(known))
    })
}

/// Number of bytes of a word in memory: 128 bits, little-endian, of which an instruction uses the lower 99.
pub const WORD_BYTES: usize = 16;

/// A position in space: x to the right, y up, z to the viewer.
pub type Point = [Q5_11; 3];
/// The two end points of a segment.
pub type Segment = [Point; 2];

/// The part of the view plane that fills the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Lower left corner: x and y.
    pub low: [Q5_11; 2],
    /// Upper right corner: x and y.
    pub high: [Q5_11; 2],
}

/// The kinds of instructions. The discriminant is bits 98 to 96 of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opcode {
    /// The eye: x, y, z.
    Eye = 0b000,
    /// The view plane: z.
    Plane = 0b001,
    /// The window: x and y of the lower left corner, then of the upper right corner.
    Window = 0b010,
    /// A segment: x, y, z of both ends.
    Segment = 0b100,
    /// The end of the program.
    End = 0b111,
}

choices!(Opcode {
    Eye: "eye",
    Plane: "plane",
    Window: "window",
    Segment: "segment",
    End: "end",
});

impl Opcode {
    /// Number of fields that an instruction of this kind uses, from the first field on.
    pub const fn fields(self) -> usize {
        match self {
            Self::Eye => 3,
            Self::Plane => 1,
            Self::Window => 4,
            Self::Segment => 6,
            Self::End => 0,
        }
    }
}
