//! The keys of the wireframe simulator on the board's buttons.

use glint_core::wireframe::{Debouncer, Key, Requests};
use glint_hal::timer::Clock;

/// Switch 0: the arrow keys rotate instead of pan.
const ROTATE: u16 = 1 << 0;
/// Switch 1: the buttons up and down act as the keys zoom-in and zoom-out.
const ZOOM: u16 = 1 << 1;

/// The keys of buttons 0 to 3.
const ARROWS: [Key; 4] = [Key::Up, Key::Down, Key::Left, Key::Right];

/// The debounced buttons, and the pending requests of the keys.
#[derive(Default)]
pub struct Keypad {
    debouncer: Debouncer,
    requests: Requests,
}

impl Keypad {
    /// Processes a sample of all buttons, one bit each. Returns the buttons that are newly pressed after debouncing, one bit each.
    pub fn sample(&mut self, buttons: u8, clock: Clock) -> u8 {
        // The time wraps after 49 days, which the debouncer can handle.
        let now_ms = clock.milliseconds() as u32;
        self.debouncer.sample(now_ms, buttons)
    }

    /// Adds the requests of pressed buttons.
    pub fn press(&mut self, pressed: u8, switches: u16) {
        let zoom = switches & ZOOM != 0;
        for (button, key) in ARROWS.into_iter().enumerate() {
            let key = match key {
                Key::Up if zoom => Key::ZoomIn,
                Key::Down if zoom => Key::ZoomOut,
                key => key,
            };
            if pressed >> button & 1 != 0 {
                self.requests.press(key);
            }
        }
    }

    /// Removes and returns the request for the next frame.
    pub fn take(&mut self) -> Option<Key> {
        self.requests.take()
    }

    /// Whether a key request waits for a frame.
    pub const fn has_request(&self) -> bool {
        !self.requests.is_empty()
    }

    /// Whether a button's level is changing, so that the next sample should follow soon.
    pub const fn is_changing(&self) -> bool {
        self.debouncer.is_changing()
    }
}

/// Whether switch 0 selects rotation.
pub const fn rotates(switches: u16) -> bool {
    switches & ROTATE != 0
}
