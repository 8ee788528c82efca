//! Centre, width and confidence of the hand in one camera frame.

use core::fmt;

use crate::fixed::{U0_16, U20_12};
use crate::root::root;

/// A rectangle of pixels of a camera frame. The corners belong to the rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Coordinates x and y of the top left pixel.
    pub first: [u16; 2],
    /// Coordinates x and y of the bottom right pixel.
    pub last: [u16; 2],
}

impl Region {
    /// The whole frame, of any size.
    pub const WHOLE: Self = Self {
        first: [0; 2],
        last: [u16::MAX; 2],
    };

    /// Width and height in pixels. Both are 0 if the corners are exchanged.
    pub const fn size(&self) -> [u32; 2] {
        let [left, top] = self.first;
        let [right, bottom] = self.last;
        [
            (right as u32 + 1).saturating_sub(left as u32),
            (bottom as u32 + 1).saturating_sub(top as u32),
        ]
    }

    /// Number of pixels in the rectangle; saturates.
    pub const fn area(&self) -> u32 {
        let [columns, rows] = self.size();
        columns.saturating_mul(rows)
    }

    /// Returns the rectangle enlarged on each side by `margin` columns and rows. The start is clamped to the frame; the end may
    /// be outside.
    #[must_use]
    pub const fn grown(&self, margin: [u16; 2]) -> Self {
        let [left, top] = self.first;
        let [right, bottom] = self.last;
        let [columns, rows] = margin;
        Self {
            first: [left.saturating_sub(columns), top.saturating_sub(rows)],
            last: [right.saturating_add(columns), bottom.saturating_add(rows)],
        }
    }
}

/// Statistics of one camera frame, as counted by the gesture engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Statistics {
    /// Number of columns and rows of the received frame.
    pub size: [u16; 2],
    /// Number of pixels of the hand's colour.
    pub count: u32,
    /// Sums of the x and of the y coordinates of these pixels. The top left pixel of the frame is (0, 0).
    pub sums: [u32; 2],
    /// Bounding box of these pixels. Without such pixels the box has no meaning.
    pub bounds: Region,
    /// Whether the frame was received without an error.
    pub is_whole: bool,
}

/// Reason why a camera frame does not show a hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// No frame has been received yet.
    Missing,
    /// The frame was received with an error.
    Faulty,
    /// Fewer pixels than 1/1024 of the frame have the hand's colour.
    Few,
    /// More pixels than 7/8 of the frame have the hand's colour.
    Most,
    /// The statistics contradict themselves: the centre is outside the bounds, or the number of pixels exceeds the area of the
    /// bounds.
    Contradiction,
    /// The pixels fill only a small part of their bounds, so they are several blobs or noise.
    Scattered,
    /// The area changed by more than a factor of 1.5 since the last frame.
    Jump,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Missing => "no camera frame received yet",
            Self::Faulty => "the camera frame is faulty",
            Self::Few => "no hand: too few pixels have its colour",
            Self::Most => "no hand: most pixels of the frame have its colour",
            Self::Contradiction => "the statistics of the frame contradict themselves",
            Self::Scattered => "no single hand: the pixels of its colour are scattered",
            Self::Jump => "the area of the hand jumped by more than a factor of 1.5",
        })
    }
}

/// Smallest part of the frame's pixels that a hand must have: 2^−10. The constant is the exponent.
const LEAST_AREA: u32 = 10;
/// Area for full confidence, as a multiple of the smallest area: 2^2. The constant is the exponent.
const FULL_AREA: u32 = 2;
/// Filled parts of the bounds, in 1/256, at which the confidence starts to rise and at which it is full: 1/8 and 3/8. A hand
/// fills about half of its bounds.
const FILL: [u32; 2] = [32, 96];
/// Smallest [`Blob::confidence`] with which a hand is accepted, in units of 1/256.
pub const LEAST_CONFIDENCE: u8 = 64;

/// The hand in one camera frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blob {
    /// Number of the hand's pixels.
    pub count: u32,
    /// Coordinates x and y of the hand's centre of mass, rounded down to 2^−12 pixels; the centre of the frame's top left pixel
    /// is (0, 0).
    pub centre: [U20_12; 2],
    /// Width of the hand: the square root of the ratio of the hand's area to the frame's area. Rounded to nearest.
    pub width: U0_16,
    /// Bounding box of the hand's pixels.
    pub bounds: Region,
}

impl Blob {
    /// Confidence that the blob is a single hand in a frame of `size` columns and rows, in units of 1/256. The confidence grows with
    /// the area, from the smallest area to four times this area, and with the part of the bounds that the pixels fill, from 1/8 to
    /// 3/8.
    pub fn confidence(&self, size: [u16; 2]) -> u8 {
        let least = least_area(u32::from(size[0]) * u32::from(size[1]));
        let certain = ramp(self.count / (least >> 2).max(1), [4, 4 << FULL_AREA]);
        // The pixels fill less than 1/16 of a rectangle of more than 2^24 pixels, because a frame has fewer than 2^20 pixels.
        let within = self.bounds.area().clamp(1, 1 << 24);
        let filled = ramp((self.count << 8) / within, FILL);
        ((certain * filled) >> 8) as u8
    }
}

impl Statistics {
    /// Computes centre and width. Each quotient is a long division of 32-bit numbers in two steps.
    ///
    /// # Errors
    /// The frame is faulty, has too few or too many pixels of the hand's colour, or the statistics contradict themselves.
    #[inline]
    pub fn blob(&self) -> Result<Blob, Doubt> {
        if !self.is_whole {
            return Err(Doubt::Faulty);
        }
        let count = self.count;
        let area = u32::from(self.size[0]) * u32::from(self.size[1]);
        // The counts below are shifted by up to 12 bits. No supported frame has 2^20 pixels.
        if area >= 1 << 20 || count > area {
            return Err(Doubt::Contradiction);
        }
        if count < least_area(area) {
            return Err(Doubt::Few);
        }
        if count > area - area / 8 {
            return Err(Doubt::Most);
        }
        let centre = self.sums.map(|sum| U20_12::from_bits(quotient(sum, count)));
        let outside = [0, 1].iter().any(|&axis| {
            let place = centre[axis].to_num::<u32>();
            place < u32::from(self.bounds.first[axis]) || place > u32::from(self.bounds.last[axis])
        });
        if outside || count > self.bounds.area() {
            return Err(Doubt::Contradiction);
        }
        // The quotient has 24 fraction bits and is below 1; the root of 32 fraction bits has 16.
        let upper = (count << 12) / area;
        let part = upper << 12 | fraction((count << 12) - upper * area, area);
        Ok(Blob {
            count,
            centre,
            width: U0_16::from_bits(root(part << 8)),
            bounds: self.bounds,
        })
    }
}

/// Smallest number of a hand's pixels in a frame of `area` pixels.
const fn least_area(area: u32) -> u32 {
    let least = area >> LEAST_AREA;
    if least == 0 { 1 } else { least }
}

/// Computes the quotient of `number` and `divisor` with 12 fraction bits, rounded down. The divisor is from 1 to 2^20 − 1. A
/// quotient of 2^20 or more saturates.
#[inline(never)]
pub fn quotient(number: u32, divisor: u32) -> u32 {
    if number < 1 << 20 {
        return (number << 12) / divisor;
    }
    let whole = number / divisor;
    if whole >= 1 << 20 {
        return u32::MAX;
    }
    // A product and a difference take less time than the remainder, which is a second division.
    whole << 12 | fraction(number - whole * divisor, divisor)
}

/// Computes 12 fraction bits of the quotient of `rest` and `divisor`, where `rest` < `divisor` < 2^20.
const fn fraction(rest: u32, divisor: u32) -> u32 {
    (rest << 12) / divisor
}

/// Returns 0 below the first limit, 255 from the second limit on, and a linear interpolation between the limits. Limits are below
/// 2^24.
fn ramp(number: u32, [low, high]: [u32; 2]) -> u32 {
    (number.clamp(low, high) - low) * 255 / (high - low)
}
