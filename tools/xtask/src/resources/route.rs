//! Clock rates of blocks by place and route on an ECP5, beside the soft core's.

use std::collections::VecDeque;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::blocks::sort_by_row;
use super::measure::{measured_line, two_at_a_time};

/// The soft core, in `gateware/tests/route.py`: every ratio is to its rate.
pub const REFERENCE: &str = "vexriscv";

/// The clock rate of a block, from a line of output of `gateware/tests/run.py --route`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Rate {
    /// Name of the block.
    pub name: String,
    /// Version of nextpnr.
    pub nextpnr: String,
    /// Rate with each seed of the placer, in MHz.
    pub seeds: Vec<f64>,
    /// Median of these.
    pub mhz: f64,
    /// The path that limits the median rate.
    pub path: WorstPath,
}

/// A path between two registers.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct WorstPath {
    /// Register at its start.
    pub from: String,
    /// Register at its end.
    pub to: String,
    /// Number of LUTs and carry chains.
    pub levels: u32,
    /// Delay of these and of the registers, in ns.
    pub logic: f64,
    /// Delay between them, in ns.
    pub wire: f64,
    /// Nets of the path, without those of carry chains.
    pub nets: Vec<String>,
}

impl Rate {
    /// Parses a line of JSON.
    ///
    /// # Errors
    /// The line is not a rate.
    pub fn parse(line: &str) -> Result<Self> {
        serde_json::from_str(line).with_context(|| format!("not a clock rate: `{line}`"))
    }
}

/// The clock rates of one run.
#[derive(Clone, Debug)]
pub struct Rates {
    /// Rate of the soft core.
    pub reference: Rate,
    /// Rates of the blocks.
    pub blocks: Vec<Rate>,
}

impl Rates {
    /// Returns the ratio of a rate to the soft core's.
    pub fn ratio(&self, rate: &Rate) -> f64 {
        rate.mhz / self.reference.mhz
    }

    /// Lists the soft core's rate, then the rates of the blocks.
    pub fn all(&self) -> impl Iterator<Item = &Rate> {
        std::iter::once(&self.reference).chain(&self.blocks)
    }

    /// Returns the rate of a block, if it was measured.
    pub fn of(&self, block: &str) -> Option<&Rate> {
        self.all().find(|rate| rate.name == block)
    }
}

/// Seeds of the placer. A seed takes some 25 s of CPU time for the soft core.
#[derive(Clone, Copy, Debug)]
pub enum Seeds {
    /// All: the rate of a block is their median.
    All,
    /// The first one alone.
    First,
}

impl Seeds {
    /// Options of `gateware/tests/run.py`.
    fn options(self) -> &'static [&'static str] {
        match self {
            Self::All => &["--route"],
            Self::First => &["--seeds", "1", "--route"],
        }
    }
}

/// Places and routes blocks, two at a time.
///
/// # Errors
/// A block cannot be measured.
pub fn measure_blocks(names: VecDeque<String>, seeds: Seeds) -> Result<Vec<Rate>> {
    let mut rates = two_at_a_time(names, |name| {
        Rate::parse(&measured_line("clock rate", seeds.options(), name)?)
    })?;
    sort_by_row(&mut rates, |rate| &rate.name);
    Ok(rates)
}

/// Places and routes the soft core and blocks with all seeds.
///
/// # Errors
/// A block cannot be measured.
pub fn measure(blocks: VecDeque<String>) -> Result<Rates> {
    let mut names = blocks;
    names.retain(|name| name != REFERENCE);
    names.push_front(REFERENCE.to_owned());
    let mut rates = measure_blocks(names, Seeds::All)?;
    let at = rates.iter().position(|rate| rate.name == REFERENCE);
    let reference = rates.remove(at.context("the soft core was not measured")?);
    Ok(Rates {
        reference,
        blocks: rates,
    })
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A block at `mhz`.
    pub fn rate(name: &str, mhz: f64) -> Rate {
        let line = r#"{"name": "NAME", "nextpnr": "0.11", "seeds": [90.0, 70.5, 81.0], "mhz": 0, "path": {"from": "port a",
            "to": "part.sum[1]", "levels": 2, "logic": 2.0, "wire": 7.25, "nets": ["a", "wide"]}}"#;
        Rate {
            mhz,
            ..Rate::parse(&line.replace("NAME", name)).unwrap()
        }
    }

    /// The setup at 1.25 times the soft core's rate.
    pub fn rates() -> Rates {
        Rates {
            reference: rate(REFERENCE, 80.0),
            blocks: vec![rate("setup", 100.0)],
        }
    }

    #[test]
    fn a_ratio_is_to_the_soft_core() {
        let rates = rates();
        let ratios: Vec<_> = rates.all().map(|rate| rates.ratio(rate)).collect();
        assert_eq!(ratios, [1.0, 1.25]);
        assert!(rates.of("setup").is_some() && rates.of("scanout").is_none());
    }

    #[test]
    fn rejects_malformed_rates() {
        let message = Rate::parse(r#"{"name": "a", "seeds": []}"#).unwrap_err();
        assert!(format!("{message:#}").contains("missing field `nextpnr`"));
    }
}
