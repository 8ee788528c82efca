//! Segments in space, drawn by the line engine in green on black: the wireframe simulator's programs, written by a program.

use glint_core::wireframe::{Instruction, Program, ProgramError, Segment, Viewing, WORD_BYTES};

/// A list of at most `N` − 4 segments, in the format of the [wireframe simulator](glint_core::wireframe).
///
/// ```
/// use glint_program::core::fixed::Q5_11;
/// use glint_program::core::wireframe::{CUBE, Program};
/// use glint_program::lines::Lines;
///
/// let viewing = *Program::new_checked(CUBE.as_flattened()).unwrap().viewing();
/// let mut lines = Lines::<16>::new(viewing);
/// let [low, high] = [Q5_11::lit("-1"), Q5_11::lit("1")];
/// assert!(lines.add([[low; 3], [high; 3]]));
/// assert_eq!(lines.program().unwrap().segment_count(), 1);
/// ```
pub struct Lines<const N: usize> {
    words: heapless::Vec<[u8; WORD_BYTES], N>,
}

impl<const N: usize> Lines<N> {
    /// Words other than segments.
    const FIXED: usize = 4;

    /// An empty list, seen by this eye through this window.
    pub fn new(viewing: Viewing) -> Self {
        const { assert!(N > Self::FIXED, "a list of lines needs more than 4 words") };
        let mut words = heapless::Vec::new();
        let Viewing { eye, plane, window } = viewing;
        for instruction in [
            Instruction::Eye(eye),
            Instruction::Plane(plane),
            Instruction::Window(window),
            Instruction::End,
        ] {
            // The list has room for more than four words.
            let _ = words.push(instruction.encode());
        }
        Self { words }
    }

    /// Removes all segments.
    pub fn clear(&mut self) {
        self.words.truncate(Self::FIXED);
        self.put_last(Instruction::End);
    }

    /// Adds a segment. Returns whether there was room for it.
    pub fn add(&mut self, segment: Segment) -> bool {
        if self.words.is_full() {
            return false;
        }
        self.put_last(Instruction::Segment(segment));
        // There is room for another word.
        let _ = self.words.push(Instruction::End.encode());
        true
    }

    /// Replaces the last word.
    fn put_last(&mut self, instruction: Instruction) {
        if let Some(last) = self.words.last_mut() {
            *last = instruction.encode();
        }
    }

    /// The list as a program, for [`Picture::wireframe`](crate::Picture::wireframe).
    ///
    /// # Errors
    /// [`ProgramError`] for an eye that is not before its view plane, or for a window without area.
    pub fn program(&self) -> Result<Program<'_>, ProgramError<'static>> {
        Program::new_checked(self.words.as_flattened())
    }
}
