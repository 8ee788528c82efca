//! Model of an image sensor: pictures, and its pin states for each picture, with and without faults.

use glint_model::gesture::{Pins, Polarity};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// The lines of a frame as bytes; a pixel's high byte comes first.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    pub lines: Vec<Vec<u8>>,
}

impl Picture {
    /// Makes a picture of `columns` times `lines` pixels from a function of their coordinates.
    pub fn new([columns, lines]: [u16; 2], mut pixel: impl FnMut(u16, u16) -> u16) -> Self {
        let line = |y| {
            (0..columns)
                .flat_map(|x| pixel(x, y).to_be_bytes())
                .collect()
        };
        Self {
            lines: (0..lines).map(line).collect(),
        }
    }
}

/// The end of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// VSYNC follows the last line.
    Vsync,
    /// VSYNC is missing: the next frame follows immediately.
    Lost,
    /// VSYNC begins within the last line.
    Cut,
}

/// Timing and polarity of an image sensor.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub polarity: Polarity,
    /// Number of clocks before and after each line, and after VSYNC.
    pub blank: usize,
    /// Length of VSYNC in clocks.
    pub between: usize,
    /// Whether HREF changes at random during VSYNC.
    pub is_noisy: bool,
}

impl Camera {
    /// Returns the pin states of a frame, from its first line to the start of the next frame. Data outside of lines are random.
    pub fn send(&self, random: &mut Pcg64Mcg, picture: &Picture, end: End) -> Vec<Pins> {
        let mut sent = Vec::new();
        let mut blank = |sent: &mut Vec<Pins>, count, is_between: bool| {
            for _ in 0..count {
                let is_in_line = is_between && self.is_noisy && random.random();
                sent.push(self.pins(is_between, is_in_line, random.random()));
            }
        };
        for (number, line) in picture.lines.iter().enumerate() {
            blank(&mut sent, self.blank, false);
            let is_last = number + 1 == picture.lines.len();
            for pair in line.chunks(2) {
                let is_swapped = self.polarity.swap && pair.len() == 2;
                let ordered = if is_swapped {
                    [pair[1], pair[0]]
                } else {
                    [pair[0], *pair.last().unwrap()]
                };
                sent.extend(
                    ordered[..pair.len()]
                        .iter()
                        .map(|&byte| self.pins(false, true, byte)),
                );
            }
            if !(is_last && end == End::Cut) {
                blank(&mut sent, self.blank, false);
            }
        }
        if end != End::Lost {
            // HREF may stay high, as it does when VSYNC cuts a line.
            blank(&mut sent, self.between, true);
        }
        blank(&mut sent, self.blank, false);
        sent
    }

    /// Returns a pin state in the sensor's polarity.
    pub fn pins(&self, is_between: bool, is_in_line: bool, data: u8) -> Pins {
        Pins {
            vsync: is_between != self.polarity.vsync_low,
            href: is_in_line != self.polarity.href_low,
            data,
        }
    }
}
