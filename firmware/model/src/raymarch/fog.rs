//! Fog on a field: the fraction of a surface's colour that the fog replaces, as a function of depth.

use glint_core::feature::{FOG, STEREO};
use glint_core::fixed::U4_28;

use super::options::FieldOptions;
use super::palette::Palette;
use super::setup::FieldSetup;

impl FieldOptions {
    /// Returns the palette of these options, with fog if there is any, and in grey for two eyes.
    pub fn palette_for(&self, setup: &FieldSetup) -> Palette {
        let palette = if FOG.is_built && self.fog != U4_28::ZERO {
            self.palette.with_fog(setup, self.fog)
        } else {
            self.palette
        };
        match setup.stereo {
            Some(_) if STEREO.is_built => palette.grey(),
            _ => palette,
        }
    }
}

impl Palette {
    /// Adds fog to the palette: its transmittance is e^(−density·z) at depth z along the camera's forward axis, in world units. An entry
    /// of the table `fog` is the fog factor (1 − transmittance) at the middle of the entry's depth range, in 255ths, within 0.51 of the exact
    /// value. The last entry is also used for all larger depths.
    #[must_use]
    pub fn with_fog(self, setup: &FieldSetup, density: U4_28) -> Self {
        // Selects the smallest range of depths at whose end the transmittance is at most e^−8, or the largest range if there is none.
        const ENOUGH: u64 = 8 << 32;
        let unit = fog_of_unit(setup, density);
        let fog_shift = (0..7).find(|shift| unit << (shift + 8) >= ENOUGH);
        let fog_shift = fog_shift.unwrap_or(7);
        // The transmittances of half a step, which is rounded down to 2^−32, and of a step. The first entry is for the depth of half a step.
        let mut half = faded((unit << fog_shift) >> (FINE_LOG2 + 1));
        let mut whole = product(half, half);
        let (mut left, mut fog) = (FULL, [0; 256]);
        for (part, entries) in fog.chunks_exact_mut(PART).enumerate() {
            if part > 1 {
                (half, whole) = (whole, product(whole, whole));
            }
            left = product(left, half);
            for (number, entry) in entries.iter_mut().enumerate() {
                if number > 0 {
                    left = product(left, whole);
                }
                let hidden = FULL - left;
                *entry = ((u128::from(hidden) * 255 + (1 << 61)) >> 62) as u8;
            }
            left = product(left, half);
        }
        Self {
            fog,
            fog_shift,
            ..self
        }
    }

    /// The entry of the table `fog` for a depth with 21 fraction bits.
    ///
    /// The steps of the first 64 entries are equal. In each further 32 entries they are twice as long as before, because the fog changes
    /// most in front.
    pub fn fog_at(&self, depth: u64) -> u8 {
        let steps = (depth >> (21 - FINE_LOG2 + self.fog_shift)).min((1 << 12) - 1) as usize;
        let octave = (steps / PART).checked_ilog2().unwrap_or(0) as usize;
        let index = PART * octave + (steps >> octave);
        self.fog.get(index).copied().unwrap_or(u8::MAX)
    }
}

/// Number of entries in a part of the table of fog. The steps of a part are equal.
const PART: usize = 32;
/// Base-2 logarithm of the number of first steps of the table of fog in a depth of 2^`fog_shift`.
const FINE_LOG2: u32 = 4;

/// 1.0 with 62 fraction bits.
pub(crate) const FULL: u64 = 1 << 62;

/// The product of two numbers with 62 fraction bits.
pub(crate) const fn product(a: u64, b: u64) -> u64 {
    ((a as u128 * b as u128) >> 62) as u64
}

/// The product density·z for the depth z of one field unit times 2^e, where e is `setup.exponent`: 32 fraction bits, rounded
/// down, below 2^35.
fn fog_of_unit(setup: &FieldSetup, density: U4_28) -> u64 {
    let units = setup.scale.to_bits().max(1) as u128;
    // The dividend has 28 + 36 fraction bits, the divisor and the result have 32.
    (((u128::from(density.to_bits()) << 36) / units) >> setup.exponent) as u64
}

/// Computes e^−x with 62 fraction bits for an x with 32 fraction bits, as (1 − x/2^20)^(2^20). The result is below the exact value by a
/// relative x²/2^21; for x ≥ 16 it is 0.
pub(crate) const fn faded(x: u64) -> u64 {
    if x >= 16 << 32 {
        return 0;
    }
    let mut power = FULL - (x << 10);
    let mut squares = 0;
    while squares < 20 {
        power = product(power, power);
        squares += 1;
    }
    power
}
