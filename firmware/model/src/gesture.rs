//! Bit-exact model of the gesture engine: from the pins of an image sensor to the statistics of its frames (docs/formats/gesture.md,
//! "Gestures").
//!
//! [`channels`] converts a colour, and [`Settings`] selects the marked pixels. [`Sums`] accumulates the counted pixels of a line, and
//! [`Engine`] processes the state of the pins in each period of the sensor's clock.

mod engine;
mod snapshot;

use glint_core::colour::Rgb565;
use glint_core::gesture::{Region, Window};

pub use engine::{Counts, Engine, Fault, Pins, Polarity, Seen};
pub use snapshot::{SNAPSHOT_WORDS, Snapshot};

/// A channel of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Red, widened to 8 bits.
    Red,
    /// Green, widened to 8 bits.
    Green,
    /// Blue, widened to 8 bits.
    Blue,
    /// Luma: 0.299 red + 0.587 green + 0.114 blue.
    Luma,
    /// Red-difference chroma, 128 for grey.
    Cr,
    /// Blue-difference chroma, 128 for grey.
    Cb,
}

impl Channel {
    /// All channels, in the order of their register values.
    pub const ALL: [Self; 6] = [
        Self::Red,
        Self::Green,
        Self::Blue,
        Self::Luma,
        Self::Cr,
        Self::Cb,
    ];
}

/// The channels of a colour, in the order of [`Channel::ALL`].
///
/// Full-range luma and chroma of ITU-R BT.601, with factors of 10 fraction bits, rounded to nearest, ties down. All channels fit in 8
/// bits, because the factors of luma add up to 1 and the factors of chroma to 0, and a chroma's positive factor is 1/2.
pub const fn channels(colour: Rgb565) -> [u8; 6] {
    let [r, g, b] = colour.to_rgb888();
    let [red, green, blue] = [r as i32, g as i32, b as i32];
    let luma = (306 * red + 601 * green + 117 * blue + 511) >> 10;
    let cr = 128 + ((512 * red - 429 * green - 83 * blue + 511) >> 10);
    let cb = 128 + ((512 * blue - 173 * red - 339 * green + 511) >> 10);
    [r, g, b, luma as u8, cr as u8, cb as u8]
}

/// Settings of the engine for one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Columns and lines of a whole frame, at most [`Settings::MAX_SIZE`].
    pub size: [u16; 2],
    /// A pixel is marked if both channels are in their windows.
    pub windows: [(Channel, Window); 2],
    /// The region in which pixels are counted.
    pub region: Region,
    /// Minimum length of a run of marked pixels in the region whose pixels are counted, at most 15; 0 acts as 1.
    pub least_run: u8,
}

impl Settings {
    /// Columns and lines of the largest frame.
    pub const MAX_SIZE: [u16; 2] = [1280, 720];

    /// Whether a pixel of this colour is marked.
    pub const fn marks(&self, colour: Rgb565) -> bool {
        let channels = channels(colour);
        let [(a, window_a), (b, window_b)] = self.windows;
        window_a.holds(channels[a as usize]) && window_b.holds(channels[b as usize])
    }
}

/// Sums over the counted pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sums {
    /// Number of counted pixels, at most 921,600 (u20).
    pub count: u32,
    /// Sum of the pixels' columns, at most 589,363,200 (u30), and of their lines, at most 331,315,200 (u29).
    pub sums: [u32; 2],
    /// Bounding box of the counted pixels. Without such pixels, `first` is 2047 and `last` 0.
    pub bounds: Region,
    /// Sums of x·x, x·y and y·y over the pixels, each below 2^39 (u40).
    pub products: [u64; 3],
}

impl Sums {
    /// The sums of a frame without counted pixels.
    pub const NONE: Self = Self {
        count: 0,
        sums: [0; 2],
        bounds: Region {
            first: [2047; 2],
            last: [0; 2],
        },
        products: [0; 3],
    };

    /// Adds the counted pixels of line `y`: the runs of at least `settings.least_run` marked pixels in the region. `marks` yields for each
    /// pixel of the line, from the left, whether the pixel is marked.
    pub fn add_line(&mut self, settings: &Settings, y: u16, marks: impl Iterator<Item = bool>) {
        let [left, top] = settings.region.first;
        let [right, bottom] = settings.region.last;
        let is_row_inside = (top..=bottom).contains(&y);
        let mut run = 0;
        // An unmarked pixel after the end of the line ends the last run.
        for (x, is_marked) in (0_u16..).zip(marks.chain([false])) {
            if is_marked && is_row_inside && (left..=right).contains(&x) {
                run += 1;
                continue;
            }
            if run >= u16::from(settings.least_run) {
                (x - run..x).for_each(|x| self.add(x, y));
            }
            run = 0;
        }
    }

    fn add(&mut self, x: u16, y: u16) {
        self.count += 1;
        for (axis, place) in [x, y].into_iter().enumerate() {
            self.sums[axis] += u32::from(place);
            self.bounds.first[axis] = self.bounds.first[axis].min(place);
            self.bounds.last[axis] = self.bounds.last[axis].max(place);
        }
        let [x, y] = [u64::from(x), u64::from(y)];
        for (sum, product) in self.products.iter_mut().zip([x * x, x * y, y * y]) {
            *sum += product;
        }
    }
}
