//! Keys, their requests for motion, and the suppression of contact bounce.

use super::motion::Step;
use crate::choice::choices;

/// A key of the wireframe simulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Pans up, or rotates the near side up.
    Up,
    /// Pans down, or rotates the near side down.
    Down,
    /// Pans to the left, or rotates the near side to the left.
    Left,
    /// Pans to the right, or rotates the near side to the right.
    Right,
    /// Moves the segments towards the viewer.
    ZoomIn,
    /// Moves the segments away from the viewer.
    ZoomOut,
}

choices!(Key {
    Up: "up",
    Down: "down",
    Left: "left",
    Right: "right",
    ZoomIn: "zoom-in",
    ZoomOut: "zoom-out",
});

impl Key {
    /// The step that the key requests. The four arrows pan, or rotate if `rotate` (switch 0) is set.
    pub const fn step(self, rotate: bool) -> Step {
        match (self, rotate) {
            (Self::Up, false) => Step::Pan([0, 1, 0]),
            (Self::Down, false) => Step::Pan([0, -1, 0]),
            (Self::Left, false) => Step::Pan([-1, 0, 0]),
            (Self::Right, false) => Step::Pan([1, 0, 0]),
            (Self::Up, true) => Step::AboutX { forwards: false },
            (Self::Down, true) => Step::AboutX { forwards: true },
            (Self::Left, true) => Step::AboutY { forwards: false },
            (Self::Right, true) => Step::AboutY { forwards: true },
            (Self::ZoomIn, _) => Step::Pan([0, 0, 2]),
            (Self::ZoomOut, _) => Step::Pan([0, 0, -2]),
        }
    }
}

/// Pending requests of pressed keys that have not yet moved the segments: at most one request per key.
///
/// Each frame takes one request. Keys are served in rotation, so a request waits for at most the five other keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Requests {
    /// Pending requests, one bit per key.
    pending: u8,
    /// Number of the key that is served next.
    next: u8,
}

impl Requests {
    /// Adds the request of a key. A second request of a key with a pending request has no effect.
    pub const fn press(&mut self, key: Key) {
        self.pending |= 1 << key as u8;
    }

    /// Takes the request for the next frame.
    pub fn take(&mut self) -> Option<Key> {
        let mut order = Key::ALL.into_iter().cycle().skip(self.next.into());
        let key = order
            .by_ref()
            .take(Key::ALL.len())
            .find(|&key| self.pending >> key as u8 & 1 != 0)?;
        self.pending &= !(1 << key as u8);
        self.next = (key as u8 + 1) % Key::ALL.len() as u8;
        Some(key)
    }

    /// Whether no request is pending.
    pub const fn is_empty(&self) -> bool {
        self.pending == 0
    }
}

/// Time in milliseconds for which all samples of a button must agree before its new level is accepted.
pub const DEBOUNCE_MS: u32 = 5;

/// Suppresses the contact bounce of up to eight buttons, from samples at irregular times.
///
/// A new level of a button is accepted at the first sample at least [`DEBOUNCE_MS`] after the first sample of this level, if all
/// samples between them agree. Therefore a single sample never counts, and bounces shorter than this time are ignored.
#[derive(Clone, Copy, Debug, Default)]
pub struct Debouncer {
    /// The debounced levels.
    levels: u8,
    /// Buttons whose last sample differs from the debounced level.
    changing: u8,
    /// For each button, the time of the first sample of the new level.
    since_ms: [u32; 8],
}

impl Debouncer {
    /// Takes a sample of all buttons, 1 for a pressed one, at a time in milliseconds that may wrap. Returns the buttons that are
    /// newly pressed after debouncing.
    pub fn sample(&mut self, now_ms: u32, sample: u8) -> u8 {
        let different = sample ^ self.levels;
        let mut settled = 0;
        for (button, since_ms) in self.since_ms.iter_mut().enumerate() {
            let bit = 1 << button;
            if self.changing & bit == 0 {
                *since_ms = now_ms;
            } else if different & bit != 0 && now_ms.wrapping_sub(*since_ms) >= DEBOUNCE_MS {
                settled |= bit;
            }
        }
        self.levels ^= settled;
        self.changing = different & !settled;
        settled & self.levels
    }

    /// The debounced levels, 1 for a pressed button.
    pub const fn levels(&self) -> u8 {
        self.levels
    }

    /// Whether a level is changing, so the next sample should follow soon.
    pub const fn is_changing(&self) -> bool {
        self.changing != 0
    }
}
