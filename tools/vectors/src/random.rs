//! Random numbers, reproducible on every machine.

use crate::math::{dot, normalised};

/// The random number generator SplitMix64. Its field is the state, initially the seed.
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    /// One random bit.
    pub fn coin(&mut self) -> bool {
        self.bits() & 1 == 0
    }

    /// An integer from `low` to `high`, inclusive.
    pub fn integer(&mut self, low: i64, high: i64) -> i64 {
        low + (self.bits() % (high - low + 1) as u64) as i64
    }

    /// A number in `low..high`.
    pub fn real(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in `low..high` whose logarithm is uniformly distributed.
    pub fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        self.real(low.ln(), high.ln()).exp()
    }

    /// A unit vector, uniformly distributed on the sphere.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [0; 3].map(|_| self.real(-1.0, 1.0));
            if (0.01..1.0).contains(&dot(v, v)) {
                return normalised(v);
            }
        }
    }
}
