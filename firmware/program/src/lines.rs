//! Segments in space, which the line engine draws in green on black. They form a program of the wireframe simulator.

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
    /// Number of words that are not segments.
    const FIXED: usize = 4;

    /// An empty list with these viewing parameters.
    ///
    /// ```
    /// use glint_program::core::fixed::Q5_11;
    /// use glint_program::core::wireframe::{Viewing, Window};
    /// use glint_program::lines::Lines;
    ///
    /// /// An eye on the z axis, and a window with the shape of a picture.
    /// const VIEWING: Viewing = Viewing {
    ///     eye: [Q5_11::ZERO, Q5_11::ZERO, Q5_11::lit("8")],
    ///     plane: Q5_11::lit("4"),
    ///     window: Window {
    ///         low: [Q5_11::lit("-4"), Q5_11::lit("-2.25")],
    ///         high: [Q5_11::lit("4"), Q5_11::lit("2.25")],
    ///     },
    /// };
    /// let lines = Lines::<64>::new(VIEWING);
    /// assert_eq!(*lines.program().unwrap().viewing(), VIEWING);
    /// ```
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
            // The list holds more than four words, so the push does not fail.
            let _ = words.push(instruction.encode());
        }
        Self { words }
    }

    /// Removes all segments.
    ///
    /// ```
    /// # use glint_program::core::{fixed::Q5_11, wireframe::{CUBE, Program}};
    /// # let viewing = *Program::new_checked(CUBE.as_flattened()).unwrap().viewing();
    /// # let segment = [[Q5_11::ZERO; 3], [Q5_11::ONE; 3]];
    /// use glint_program::lines::Lines;
    ///
    /// let mut lines = Lines::<16>::new(viewing);
    /// lines.add(segment);
    /// lines.clear();
    /// assert_eq!(lines.program().unwrap().segment_count(), 0);
    /// ```
    pub fn clear(&mut self) {
        self.words.truncate(Self::FIXED);
        self.put_last(Instruction::End);
    }

    /// Adds a segment. Returns `false` if the list is full.
    ///
    /// ```
    /// # use glint_program::core::{fixed::Q5_11, wireframe::{CUBE, Program}};
    /// # let viewing = *Program::new_checked(CUBE.as_flattened()).unwrap().viewing();
    /// # let segment = [[Q5_11::ZERO; 3], [Q5_11::ONE; 3]];
    /// use glint_program::lines::Lines;
    ///
    /// let mut lines = Lines::<6>::new(viewing);
    /// assert!(lines.add(segment) && lines.add(segment));
    /// assert!(!lines.add(segment), "the list is full");
    /// ```
    pub fn add(&mut self, segment: Segment) -> bool {
        if self.words.is_full() {
            return false;
        }
        self.put_last(Instruction::Segment(segment));
        // The list is not full, so the push does not fail.
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
    /// ```
    /// use glint_program::core::fixed::Q5_11;
    /// use glint_program::core::wireframe::{Viewing, Window};
    /// use glint_program::lines::Lines;
    ///
    /// let [zero, one] = [Q5_11::ZERO, Q5_11::ONE];
    /// let window = Window { low: [-one; 2], high: [one; 2] };
    /// let seen_from = |z| Lines::<8>::new(Viewing { eye: [zero, zero, z], plane: one, window });
    /// assert!(seen_from(one + one).program().is_ok());
    /// assert!(seen_from(zero).program().is_err(), "the eye is behind the view plane");
    /// ```
    ///
    /// # Errors
    /// [`ProgramError`] for an eye that is not in front of the view plane, or for a window without area.
    pub fn program(&self) -> Result<Program<'_>, ProgramError<'static>> {
        Program::new_checked(self.words.as_flattened())
    }
}
