//! Counts of the gesture engine, and the arithmetic of the control by a hand.

use glint_core::fixed::U16_16;
use glint_core::hand::Step;
use glint_core::hand::{Region, Statistics, low_pass_gain, quotient, root, towards};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("hand", |counts: Counted| {
            Ok(Outcome::of(counts.statistics().blob(), |blob| {
                let [x, y] = blob.centre;
                format!("centre ({x}, {y}), width {}", blob.width)
            }))
        }),
        Kind::new("hand-quotient", |[number, divisor]: [u32; 2]| {
            Ok(Outcome::exact(format!(
                "{}/2^12",
                quotient(number, divisor)
            )))
        }),
        Kind::new("hand-root", |square| {
            Ok(Outcome::exact(root(square).to_string()))
        }),
        Kind::new("hand-gain", |Filtered { cutoff, step }| {
            let gain = low_pass_gain(U16_16::from_bits(cutoff), Step::new(step));
            Ok(Outcome::exact(format!("{gain}/2^16")))
        }),
        Kind::new("hand-step", |Way { from, to, gain }| {
            Ok(Outcome::exact(towards(from, to, gain).to_string()))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Counted {
    size: [u16; 2],
    count: u32,
    sums: [u32; 2],
    /// The first and the last column and row with a pixel.
    bounds: [[u16; 2]; 2],
}

impl Counted {
    fn statistics(&self) -> Statistics {
        let [first, last] = self.bounds;
        Statistics {
            size: self.size,
            count: self.count,
            sums: self.sums,
            bounds: Region { first, last },
            is_whole: true,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Filtered {
    /// Corner frequency in 2^-16 Hz.
    cutoff: u32,
    /// Step in µs.
    step: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Way {
    from: i32,
    to: i32,
    /// Part of the way, in 2^-16.
    gain: u32,
}
