//! Programs in binary form, and the checks of programs.

use super::error::{Expected, Found, Location, ProgramError, Violation};
use super::format::{MAX_SEGMENTS, Opcode, Point, Segment, WORD_BYTES, Window};
use super::instruction::Instruction;
use crate::fixed::Q5_11;

/// The viewing parameters of a program: the eye's z is at least 0 and above that of the view plane, and
/// the window is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Viewing {
    /// Position of the eye.
    pub eye: Point,
    /// The z of the view plane.
    pub plane: Q5_11,
    /// The window, in the view plane.
    pub window: Window,
}

/// Checks the instructions of a program one after the other.
///
/// A program has one eye, one view plane and one window, in any order and anywhere before the end, because all segments are drawn
/// together at the end.
#[derive(Clone, Debug, Default)]
pub struct Checker {
    eye: Option<Point>,
    plane: Option<Q5_11>,
    window: Option<Window>,
    segments: u32,
}

impl Checker {
    /// Takes the next instruction. Returns the viewing parameters at the end of the program; the checker must not be used
    /// afterwards.
    ///
    /// # Errors
    /// The first deviation from the format.
    pub fn take(
        &mut self,
        instruction: Instruction,
    ) -> Result<Option<Viewing>, Violation<'static>> {
        match instruction {
            Instruction::Eye(eye) => {
                set(&mut self.eye, eye, Opcode::Eye)?;
                let [_, _, z] = eye;
                if z < 0 {
                    return Err(Violation::new(Expected::EyeNotNegative, Found::Number(z)));
                }
                self.check_eye()?;
            }
            Instruction::Plane(plane) => {
                set(&mut self.plane, plane, Opcode::Plane)?;
                self.check_eye()?;
            }
            Instruction::Window(window) => {
                set(&mut self.window, window, Opcode::Window)?;
                for (vertical, (low, high)) in [false, true]
                    .into_iter()
                    .zip(window.low.into_iter().zip(window.high))
                {
                    if low >= high {
                        return Err(Violation::new(
                            Expected::Below { vertical, high },
                            Found::Number(low),
                        ));
                    }
                }
            }
            Instruction::Segment(_) => {
                if self.segments == MAX_SEGMENTS {
                    return Err(Violation::new(Expected::AtMostSegments, Found::More));
                }
                self.segments += 1;
            }
            Instruction::End => return self.viewing().map(Some),
        }
        Ok(None)
    }

    /// Number of segments so far.
    pub const fn segments(&self) -> u32 {
        self.segments
    }

    fn check_eye(&self) -> Result<(), Violation<'static>> {
        match (self.eye, self.plane) {
            (Some([_, _, z]), Some(plane)) if z <= plane => Err(Violation::new(
                Expected::EyeAbove { plane },
                Found::Number(z),
            )),
            _ => Ok(()),
        }
    }

    fn viewing(&self) -> Result<Viewing, Violation<'static>> {
        Ok(Viewing {
            eye: present(self.eye, Opcode::Eye)?,
            plane: present(self.plane, Opcode::Plane)?,
            window: present(self.window, Opcode::Window)?,
        })
    }
}

fn set<T>(slot: &mut Option<T>, value: T, opcode: Opcode) -> Result<(), Violation<'static>> {
    match slot.replace(value) {
        None => Ok(()),
        Some(_) => Err(Violation::new(Expected::One(opcode), Found::Second)),
    }
}

fn present<T>(value: Option<T>, opcode: Opcode) -> Result<T, Violation<'static>> {
    value.ok_or(Violation::new(Expected::One(opcode), Found::None))
}

/// A checked program in its binary form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program<'a> {
    viewing: Viewing,
    segments: u32,
    words: &'a [[u8; WORD_BYTES]],
    /// Number of bytes after the end.
    ignored: usize,
}

impl<'a> Program<'a> {
    /// Checks every word of a program up to its end. Data after the end is ignored, as in the original design.
    ///
    /// # Errors
    /// The first deviation from the format, with the number of its word.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, ProgramError<'static>> {
        let (words, rest) = bytes.as_chunks();
        let mut checker = Checker::default();
        for (index, word) in words.iter().enumerate() {
            let at = |violation: Violation<'static>| violation.at(Location::Word(index + 1));
            let instruction = Instruction::decode(word).map_err(at)?;
            let Some(viewing) = checker.take(instruction).map_err(at)? else {
                continue;
            };
            let words = words.get(..=index).unwrap_or_default();
            return Ok(Self {
                viewing,
                segments: checker.segments(),
                words,
                ignored: bytes.len() - words.as_flattened().len(),
            });
        }
        let violation = if rest.is_empty() {
            Violation::new(Expected::End, Found::Exhausted)
        } else {
            Violation::new(Expected::WholeWord, Found::Bytes(rest.len()))
        };
        Err(violation.at(Location::Word(words.len() + 1)))
    }

    /// The eye, the view plane and the window.
    pub const fn viewing(&self) -> &Viewing {
        &self.viewing
    }

    /// Number of segments.
    pub const fn segment_count(&self) -> u32 {
        self.segments
    }

    /// Number of bytes that followed the end of the program, and were ignored.
    pub const fn ignored(&self) -> usize {
        self.ignored
    }

    /// All bytes of the program, up to its end.
    pub const fn bytes(&self) -> &'a [u8] {
        self.words.as_flattened()
    }

    /// Number of words, including the end instruction.
    pub const fn word_count(&self) -> usize {
        self.words.len()
    }

    /// The segment in a word; `None` if the word is another instruction, or beyond the program.
    pub fn segment(&self, word: usize) -> Option<Segment> {
        Instruction::decode(self.words.get(word)?).ok()?.segment()
    }

    /// The instructions, including the end instruction.
    pub fn instructions(&self) -> impl Iterator<Item = Instruction> + use<'a> {
        // Every word of a checked program is an instruction.
        self.words
            .iter()
            .filter_map(|word| Instruction::decode(word).ok())
    }

    /// The segments, in the program's order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + use<'a> {
        self.instructions().filter_map(Instruction::segment)
    }
}
