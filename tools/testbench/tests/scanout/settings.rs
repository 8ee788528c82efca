//! Settings and error codes of the scan-out registers.

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Settings of scan-out, requested by software or latched by the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    pub enable: bool,
    pub scale: u64,
    /// Address of the frame, in memory words.
    pub base: u64,
}

impl Settings {
    /// The settings at reset.
    pub const RESET: Self = Self {
        enable: false,
        scale: 4,
        base: 0,
    };

    /// Settings that show the frame at `base` at a scale.
    pub const fn shown(scale: u64, base: u64) -> Self {
        Self {
            enable: true,
            scale,
            base,
        }
    }

    /// Makes random valid settings.
    pub fn random(random: &mut Pcg64Mcg) -> Self {
        Self {
            enable: random.random_range(0..8) != 0,
            scale: 1 << random.random_range(0..3),
            base: random.random_range(0..0x70_0000),
        }
    }
}

/// Values of the module's output `error`, the result of the last frame.
pub mod error {
    pub const NONE: u64 = 0;
    pub const SCALE: u64 = 1;
    pub const UNDERFLOW: u64 = 2;
}
