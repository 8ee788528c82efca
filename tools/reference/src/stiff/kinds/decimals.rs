//! Decimals parsed as numbers of the named formats.

use anyhow::{Result, bail};
use glint_core::fixed::{Q2_14, Q2_23, Q2_30, Q5_11, Q8_24, Q32_32, U4_28, U8_28};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("decimal", decimal)]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Decimal {
    format: String,
    text: String,
}

/// Reads a decimal. States the number's shortest decimal and bits.
fn decimal(Decimal { format, text }: Decimal) -> Result<Outcome> {
    macro_rules! read {
        ($type:ty) => {
            Outcome::of(text.parse::<$type>(), |number| {
                format!("{number}, bits {}", number.to_bits())
            })
        };
    }
    Ok(match format.as_str() {
        "Q2.14" => read!(Q2_14),
        "Q2.23" => read!(Q2_23),
        "Q2.30" => read!(Q2_30),
        "Q5.11" => read!(Q5_11),
        "Q8.24" => read!(Q8_24),
        "Q32.32" => read!(Q32_32),
        "U4.28" => read!(U4_28),
        "U8.28" => read!(U8_28),
        _ => bail!("no format {format:?}"),
    })
}
