//! The marker of the hand's position, in the lower right corner of a picture.

use glint_core::fixed::U20_12;
use glint_core::picture::Size;

/// Colour of the background, in RGB565.
const GROUND: u16 = 0x18e3;
/// Colour of a hand that steers the camera, in RGB565.
const STEERS: u16 = 0x07e0;
/// Colour of a hand that does not steer the camera, in RGB565.
const STANDS: u16 = 0xad55;

/// Width of the picture divided by the width of the marker.
const PARTS: u32 = 8;

/// The marker of the hand's position in a frame of the image sensor.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Marker {
    /// Coordinates x and y of the hand's centre in 1/256 of the frame; `None` without a hand.
    place: Option<[u8; 2]>,
    steers: bool,
}

impl Marker {
    /// Creates the marker for a hand with this centre in a frame of `size` pixels; `steers` states whether the hand steers the camera.
    pub fn new(centre: Option<[U20_12; 2]>, size: [u16; 2], steers: bool) -> Self {
        let part = |axis: usize, centre: [U20_12; 2]| {
            let place = centre[axis].to_num::<u32>();
            // The centre is in the frame, so the quotient is below 256.
            ((place << 8) / u32::from(size[axis].max(1))) as u8
        };
        Self {
            place: centre.map(|centre| [part(0, centre), part(1, centre)]),
            steers,
        }
    }

    /// Draws the marker into a picture: a dark rectangle with the frame's aspect ratio, and the hand in it.
    pub fn draw(self, colours: &mut [u16], size: Size) {
        let [columns, rows] = size.pixels();
        let (width, height) = (columns / PARTS, columns / PARTS * 3 / 4);
        let [left, top] = [columns - width - width / 8, rows - height - width / 8];
        // The hand is a square, a tenth of the marker wide.
        let half = (width / 20).max(1);
        let hand = self
            .place
            .map(|[x, y]| [(u32::from(x) * width) >> 8, (u32::from(y) * height) >> 8]);
        for y in 0..height {
            let start = ((top + y) * columns + left) as usize;
            let line = colours.get_mut(start..start + width as usize);
            for (x, pixel) in (0_u32..).zip(line.unwrap_or_default()) {
                let is_hand =
                    hand.is_some_and(|[u, v]| x.abs_diff(u) <= half && y.abs_diff(v) <= half);
                *pixel = match (is_hand, self.steers) {
                    (false, _) => GROUND,
                    (true, true) => STEERS,
                    (true, false) => STANDS,
                };
            }
        }
    }
}
