//! The demo: a board without a host shows the scenes of a list in turn.

use glint_core::demo::{Demo as Turns, Move};
use glint_core::deviation::Deviation;
use glint_core::feature::DEMO;

use crate::job::Orbit;
use crate::scenes::{Library, List, built_in_list};

/// Button 0: the next scene.
const NEXT: u8 = 1 << 0;
/// Button 1: the previous scene.
const PREVIOUS: u8 = 1 << 1;
/// Button 2: hold the scene, or continue; not used if the motion sensor steers the camera.
const HOLD: u8 = 1 << 2;

/// Error number for damaged contents of the flash (docs/boards.md).
const CONTENTS: u8 = 1;
/// Error number for a damaged list of the flash.
const ITEM: u8 = 2;

/// The list of scenes, the current scene, and the last error.
pub struct Demo {
    /// The position in the list, and the time of the next scene.
    pub turns: Turns,
    list: List,
    /// The orbit of the camera in the shown scene.
    pub orbit: Option<Orbit>,
    error: Option<u8>,
}

impl Default for Demo {
    fn default() -> Self {
        Self {
            turns: Turns::default(),
            list: List::BuiltIn(&[]),
            orbit: None,
            error: None,
        }
    }
}

impl Demo {
    /// Starts the demo after reset, if the flash has a list or damaged contents. Returns the error of damaged contents or of a damaged
    /// list, and the name of the damaged part.
    pub fn power_up(&mut self, library: &Library) -> Option<(&'static str, Deviation)> {
        if let Some(error) = library.error() {
            self.start(library);
            self.error = Some(CONTENTS);
            return Some(("flash", error));
        }
        let list = library.first_list()?;
        self.start(library);
        let error = list.text().err()?;
        self.error = Some(ITEM);
        Some((list.name, error))
    }

    /// Starts the demo with the first scene of the first list of the flash, or of the built-in list.
    pub fn start(&mut self, library: &Library) {
        let list = library.first_list().and_then(|list| list.text().ok());
        self.list = list.map_or_else(built_in_list, List::Flash);
        self.turns.start(self.list.len());
        self.orbit = None;
        self.error = None;
    }

    /// Stops the demo. The current scene is still shown.
    pub fn stop(&mut self) {
        self.turns.stop();
        self.orbit = None;
    }

    /// Whether the demo is on.
    pub const fn is_on(&self) -> bool {
        DEMO.is_built && self.turns.is_on()
    }

    /// The name of the current scene.
    pub fn scene(&self) -> Option<&'static str> {
        self.list.name(self.turns.number()?)
    }

    /// The number of the last error since the demo was started.
    pub const fn error(&self) -> Option<u8> {
        self.error
    }

    /// Stores an error number. Returns whether it differs from the stored number.
    pub fn set_error(&mut self, number: u8) -> bool {
        self.error.replace(number) != Some(number)
    }

    /// Handles pressed buttons, one bit each. `steers` states whether the motion sensor steers the camera, which then reserves buttons 2
    /// and 3.
    pub fn press(&mut self, pressed: u8, steers: bool, now: u64) {
        if pressed & NEXT != 0 {
            self.turns.go(Move::Next);
        }
        if pressed & PREVIOUS != 0 {
            self.turns.go(Move::Previous);
        }
        if pressed & HOLD != 0 && !steers {
            self.turns.hold(now, !self.turns.is_held());
        }
    }
}
