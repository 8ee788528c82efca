//! The keys of the wireframe simulator on the board's buttons.

use core::mem;

use glint_core::wireframe::{Debouncer, Key, Requests};
use glint_hal::timer::Clock;

/// Switch 0: the arrow keys rotate instead of pan.
const ROTATE: u16 = 1 << 0;
/// Switch 1: the buttons up and down act as the keys zoom-in and zoom-out.
const ZOOM: u16 = 1 << 1;

/// Buttons 2 and 3, left and right, which together read the program again.
const RESET: u8 = 0b1100;

/// The keys of buttons 0 to 3.
const ARROWS: [Key; 4] = [Key::Up, Key::Down, Key::Left, Key::Right];

/// The debounced buttons, and the pending requests of the keys.
#[derive(Default)]
pub struct Keypad {
    debouncer: Debouncer,
    requests: Requests,
    /// Whether the program must be read again before the next frame.
    must_reset: bool,
}

impl Keypad {
    /// Processes a sample of all buttons, one bit each. Returns the buttons that are newly pressed after debouncing, one bit each.
    pub fn sample(&mut self, buttons: u8, clock: Clock) -> u8 {
        // The time wraps after 49 days, which the debouncer can handle.
        let now_ms = clock.milliseconds() as u32;
        self.debouncer.sample(now_ms, buttons)
    }

    /// Adds the requests of pressed buttons. Buttons 2 and 3 together request that the program is read again, which replaces all pending
    /// keys. The button that is pressed first may move the segments by a step before, and the new start undoes this step.
    pub fn press(&mut self, pressed: u8, switches: u16) {
        if pressed & RESET != 0 && self.debouncer.levels() & RESET == RESET {
            self.requests = Requests::default();
            self.must_reset = true;
            return;
        }
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

    /// Removes the request to read the program again, and returns whether there was one.
    pub const fn take_reset(&mut self) -> bool {
        mem::replace(&mut self.must_reset, false)
    }

    /// Whether a request waits for a frame.
    pub const fn has_request(&self) -> bool {
        self.must_reset || !self.requests.is_empty()
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
