//! A small picture of a frame of the image sensor.

use glint_core::colour::Rgb565;

/// Number of words in the engine's memory for a small picture.
pub const SNAPSHOT_WORDS: usize = 2048;

/// A small picture: every 2^step-th pixel of every 2^step-th line, as marks or colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    step: u8,
    is_colour: bool,
    words: heapless::Vec<u16, SNAPSHOT_WORDS>,
    marks: u16,
    bits: u8,
    pub(super) frame: u32,
}

impl Snapshot {
    /// Creates an empty picture. `step` is at most 5.
    pub const fn new(step: u8, is_colour: bool) -> Self {
        Self {
            step,
            is_colour,
            words: heapless::Vec::new(),
            marks: 0,
            bits: 0,
            frame: 0,
        }
    }

    /// The words: RGB565 colours, or marks packed 16 per word, the first mark in the highest bit.
    pub fn words(&self) -> &[u16] {
        &self.words
    }

    /// The number of the frame that the picture shows; whole frames are counted from 1.
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Removes all pixels from the picture.
    pub(super) fn clear(&mut self) {
        *self = Self::new(self.step, self.is_colour);
    }

    /// Adds the pixel at (`x`, `y`) if the picture samples it.
    pub(super) fn take(&mut self, [x, y]: [u16; 2], colour: Rgb565, is_marked: bool) {
        let between = (1 << self.step) - 1;
        if (x | y) & between != 0 {
            return;
        }
        self.marks = self.marks << 1 | u16::from(is_marked);
        self.bits = (self.bits + 1) % 16;
        // Words beyond the end of the memory are dropped.
        if self.is_colour {
            let _ = self.words.push(colour.0);
        } else if self.bits == 0 {
            let _ = self.words.push(self.marks);
        }
    }
}
