//! The levels of buttons and switches that the page sets, shared by the threads of the viewers and
//! of the board.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Minimum duration of a press of a button in ms of the board's time, so that a slow board does not
/// miss it.
const PRESSED_MS: u64 = 30;

/// The shared levels of buttons and switches.
#[derive(Debug, Default)]
pub struct Inputs(Mutex<Levels>);

/// Levels of the buttons and switches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Levels {
    /// Whether each of the buttons 0 to 3 is pressed, one bit each.
    pub buttons: u8,
    /// Buttons that were pressed since the last call of [`Inputs::take`].
    pressed: u8,
    /// The 16 switches, one bit each.
    pub switches: u16,
}

impl Inputs {
    fn lock(&self) -> MutexGuard<'_, Levels> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the pressed buttons.
    pub fn press(&self, buttons: u8) {
        let mut levels = self.lock();
        levels.buttons = buttons & 0xf;
        levels.pressed |= levels.buttons;
    }

    /// Sets the switches.
    pub fn switch(&self, on: u16) {
        self.lock().switches = on;
    }

    /// Returns the current levels. Buttons that were pressed and released since the last call count
    /// as pressed.
    pub fn take(&self) -> Levels {
        let mut levels = self.lock();
        let pressed = std::mem::take(&mut levels.pressed);
        Levels {
            buttons: levels.buttons | pressed,
            ..*levels
        }
    }
}

/// Holds each pressed button for the minimum time.
#[derive(Debug, Default)]
pub struct Hold {
    until: [u64; 4],
}

impl Hold {
    /// Returns the buttons that the board sees as pressed at the time `now` in ms; `pressed` are
    /// the buttons that the page presses.
    pub fn held(&mut self, pressed: u8, now: u64) -> u8 {
        let mut held = 0;
        for (button, until) in self.until.iter_mut().enumerate() {
            if pressed >> button & 1 == 1 {
                *until = now + PRESSED_MS;
            }
            held |= u8::from(now < *until) << button;
        }
        held
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_press_is_seen_for_30_ms() {
        let (inputs, mut hold) = (Inputs::default(), Hold::default());
        inputs.press(0b1_0101);
        inputs.press(0);
        inputs.switch(7);
        let levels = inputs.take();
        assert_eq!((levels.buttons, levels.switches), (0b101, 7));
        assert_eq!(hold.held(levels.buttons, 1000), 0b101);
        assert_eq!(hold.held(inputs.take().buttons, 1029), 0b101);
        assert_eq!(hold.held(inputs.take().buttons, 1030), 0);
    }
}
