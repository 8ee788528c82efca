//! The registers `cone_address` and `cone_value`: the constants of the cones in which the eyes see the spheres.

use glint_core::field::MAX_SPHERES;
use glint_model::raymarch::exits::{Cone, Cones};
use litex_pac::raymarch::Solid;

/// Number of words for the constants of a cone.
const PLACES: usize = Cone::WORDS;

/// The constants that writes to the registers have set, by eye and cone.
#[derive(Default)]
pub struct ConeWords {
    words: [[[u32; PLACES]; 2 * MAX_SPHERES]; 2],
    address: u32,
}

impl ConeWords {
    /// Sets the address of the next constant.
    pub fn address(&mut self, address: u32) {
        self.address = address;
    }

    /// Sets the next constant.
    pub fn set(&mut self, value: u32) {
        let words = self.words.as_flattened_mut().as_flattened_mut();
        let place = self.address as usize % words.len();
        words[place] = value;
        self.address = self.address.wrapping_add(1);
    }

    /// The cones of each eye. The register `solid` contains the number of the last cone of each
    /// eye.
    pub fn of(&self, solid: Solid) -> [Cones; 2] {
        let last = [solid.last_cone_left(), solid.last_cone_right()];
        [0, 1].map(|eye: usize| {
            let cones = self.words[eye].iter().take(usize::from(last[eye]) + 1);
            Cones::of(cones.map(Cone::of_words))
        })
    }
}
