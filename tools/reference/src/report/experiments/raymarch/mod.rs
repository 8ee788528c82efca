//! Experiments on the raymarcher: errors of its pictures, its speed on the whole SoC, word lengths, and thresholds of fillets.

pub mod fillet;
pub mod pictures;
pub mod rates;
pub mod requirements;
pub mod words;
