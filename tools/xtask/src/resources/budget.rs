//! Limits of the gateware's resources: `gateware/budget.toml`.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::fs;

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

use super::blocks::{ROWS, SOC};
use super::number::number;
use super::route::{REFERENCE, Rate};
use super::size::{Resource, Size};
use crate::paths;

/// Maximum of each limited resource.
pub type Limits = BTreeMap<Resource, u32>;

/// The contents of `gateware/budget.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Resources of the FPGA, which are the limits of the SoC.
    pub device: Limits,
    /// Default limits for every block except the SoC.
    own: Limits,
    /// Limits of single blocks, by the block's name.
    block: BTreeMap<String, BlockLimits>,
    /// Clock rate of the soft core.
    pub reference: ReferenceRate,
}

/// The clock rate of the soft core with the first seed of the placer, which a version of nextpnr always finds.
#[derive(Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceRate {
    /// The rate in MHz.
    pub mhz: f64,
    /// The version of nextpnr.
    pub nextpnr: String,
}

impl ReferenceRate {
    /// Checks that a rate of a block comes from the same version of nextpnr, without which the two cannot be compared.
    ///
    /// # Errors
    /// The version differs.
    pub fn check_version(&self, rate: &Rate) -> Result<()> {
        ensure!(
            rate.nextpnr == self.nextpnr,
            "{}: routed by nextpnr {}, expected {} as for the reference of gateware/budget.toml; `cargo xtask resources --route \
             {REFERENCE}` measures that again",
            rate.name,
            rate.nextpnr,
            self.nextpnr
        );
        Ok(())
    }

    /// Checks that a measured rate of the soft core is this one.
    ///
    /// # Errors
    /// The rate differs.
    pub fn check(&self, measured: &Rate) -> Result<()> {
        let found = Self {
            mhz: measured.seeds.first().copied().unwrap_or_default(),
            nextpnr: measured.nextpnr.clone(),
        };
        ensure!(
            *self == found,
            "{REFERENCE}: the reference is {} MHz by nextpnr {}, expected the measured {} MHz by nextpnr {}",
            self.mhz,
            self.nextpnr,
            found.mhz,
            found.nextpnr
        );
        Ok(())
    }
}

/// Limits of a single block.
#[derive(Debug, Deserialize)]
struct BlockLimits {
    /// Least ratio of its clock rate to the soft core's.
    ratio: Option<f64>,
    /// Maximum of each limited resource.
    #[serde(flatten)]
    resources: Limits,
}

/// A resource of a block that is above its limit.
#[derive(Debug, PartialEq, Serialize)]
pub struct Excess {
    /// Name of the block.
    pub block: String,
    /// The resource above its limit.
    pub resource: Resource,
    /// Limit of the resource.
    pub budget: u32,
    /// Measured amount of the resource.
    pub measured: f64,
}

/// A block with a clock rate below its limit.
#[derive(Debug, PartialEq, Serialize)]
pub struct Shortfall {
    /// Name of the block.
    pub block: String,
    /// The minimum ratio of its clock rate to the soft core's.
    pub minimum: f64,
    /// The measured ratio.
    pub measured: f64,
}

impl fmt::Display for Shortfall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: ratio to {REFERENCE}: at least {:.2}, measured {:.2}",
            self.block, self.minimum, self.measured
        )
    }
}

impl fmt::Display for Excess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {}: budget {}, measured {}",
            self.block,
            self.resource.name(),
            number(self.budget.into()),
            number(self.measured)
        )
    }
}

impl Budget {
    /// Reads the budget from `gateware/budget.toml`.
    ///
    /// # Errors
    /// The file cannot be read, or names an unknown block or resource.
    pub fn read() -> Result<Self> {
        let path = "gateware/budget.toml";
        fs::read_to_string(paths::root().join(path))
            .map_err(anyhow::Error::from)
            .and_then(|text| Self::parse(&text))
            .with_context(|| format!("reading {path}"))
    }

    fn parse(text: &str) -> Result<Self> {
        let budget: Self = toml::from_str(text)?;
        for name in budget.block.keys() {
            if !ROWS.contains(&name.as_str()) {
                bail!("unknown block {name}: expected one of {}", ROWS.join(" "));
            }
        }
        Ok(budget)
    }

    /// Returns the limits of a block. A limit of this single block replaces the default limit, which is the device's for the SoC
    /// and that of own blocks otherwise.
    pub fn limits(&self, block: &str) -> Limits {
        let common = if block == SOC {
            &self.device
        } else {
            &self.own
        };
        let mut limits = common.clone();
        if let Some(own) = self.block.get(block) {
            limits.extend(&own.resources);
        }
        limits
    }

    /// Returns the minimum ratio of a block's clock rate to the soft core's, if it has one.
    pub fn ratio(&self, block: &str) -> Option<f64> {
        self.block.get(block)?.ratio
    }

    /// Lists the blocks that have a minimum ratio.
    pub fn routed(&self) -> VecDeque<String> {
        let names = self.block.keys();
        names
            .filter(|name| self.ratio(name).is_some())
            .cloned()
            .collect()
    }

    /// Lists the blocks below their minimum ratios to `reference`, the soft core's rate in MHz.
    pub fn shortfalls(&self, blocks: &[Rate], reference: f64) -> Vec<Shortfall> {
        blocks
            .iter()
            .filter_map(|rate| {
                let (minimum, measured) = (self.ratio(&rate.name)?, rate.mhz / reference);
                let block = rate.name.clone();
                (measured < minimum).then_some(Shortfall {
                    block,
                    minimum,
                    measured,
                })
            })
            .collect()
    }

    /// Lists every resource of every block that is above its limit.
    pub fn excesses(&self, sizes: &[Size]) -> Vec<Excess> {
        let mut excesses = Vec::new();
        for size in sizes {
            for (resource, budget) in self.limits(&size.name) {
                let measured = size.of(resource);
                if measured > f64::from(budget) {
                    excesses.push(Excess {
                        block: size.name.clone(),
                        resource,
                        budget,
                        measured,
                    });
                }
            }
        }
        excesses
    }
}

#[cfg(test)]
pub mod tests {
    use super::super::route::tests::{rate, rates};
    use super::super::size::tests::size;
    use super::*;

    /// A budget with different limits for three names. The block of [`size`] is within those of `setup`, and exceeds those of
    /// `band_buffer` and `soc`.
    pub const BUDGET: &str =
        "device = { lut = 32600, ff = 65200, dsp48 = 120, ramb36 = 75, slices = 8150 }
        own = { path = 9 }
        reference = { mhz = 90.0, nextpnr = '0.11' }
        [block]
        setup = { lut = 1234, ramb36 = 3, ratio = 1.25 }
        band_buffer = { path = 8 }
        soc = { ramb36 = 2, control_sets = 21 }";

    fn excesses(budget: &str, name: &str) -> Vec<String> {
        let budget = Budget::parse(budget).unwrap();
        let found = budget.excesses(&[size(name)]);
        found.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_budget_is_kept_when_reached_and_broken_by_one_more() {
        assert_eq!(excesses(BUDGET, "setup"), [""; 0]);
        let less = BUDGET.replace("1234", "1233");
        assert_eq!(
            excesses(&less, "setup"),
            ["setup: LUT: budget 1,233, measured 1,234"]
        );
    }

    #[test]
    fn only_named_blocks_have_a_least_clock_rate() {
        let budget = |ratio: &str| Budget::parse(&BUDGET.replace("1.25", ratio)).unwrap();
        let mut rates = rates();
        rates.blocks.push(rate("scanout", 1.0));
        assert_eq!(budget("1.25").routed(), ["setup"]);
        let reference = rates.reference.mhz;
        assert_eq!(budget("1.25").shortfalls(&rates.blocks, reference), []);
        assert_eq!(
            budget("1.26").shortfalls(&rates.blocks, reference)[0].to_string(),
            "setup: ratio to vexriscv: at least 1.26, measured 1.25"
        );
    }

    #[test]
    fn the_rate_of_the_soft_core_is_the_measured_one_of_the_same_nextpnr() {
        let reference = |mhz, nextpnr: &str| ReferenceRate {
            mhz,
            nextpnr: nextpnr.to_owned(),
        };
        // Its rate with the first seed is 90.0.
        let measured = rate(REFERENCE, 81.0);
        assert!(reference(90.0, "0.11").check(&measured).is_ok());
        for stale in [reference(90.1, "0.11"), reference(90.0, "0.12")] {
            let error = stale.check(&measured).unwrap_err().to_string();
            assert!(
                error.ends_with("expected the measured 90 MHz by nextpnr 0.11"),
                "{error}"
            );
        }
        let block = rate("setup", 1.0);
        assert!(reference(90.0, "0.11").check_version(&block).is_ok());
        assert!(reference(90.0, "0.12").check_version(&block).is_err());
    }

    #[test]
    fn half_a_block_ram_counts() {
        assert_eq!(
            excesses(BUDGET, "soc"),
            ["soc: RAMB36: budget 2, measured 2.5"]
        );
    }

    #[test]
    fn every_own_block_has_a_path_and_may_have_its_own() {
        let less = BUDGET.replace("path = 9", "path = 7");
        for block in ["setup", "scanout", "binner"] {
            assert_eq!(
                excesses(&less, block),
                [format!("{block}: path: budget 7, measured 9")]
            );
        }
        assert_eq!(
            excesses(BUDGET, "band_buffer"),
            ["band_buffer: path: budget 8, measured 9"]
        );
    }

    #[test]
    fn the_soc_has_to_fit_the_device_and_may_have_a_longer_path() {
        let small = BUDGET
            .replace("ff = 65200", "ff = 1999")
            .replace("path = 9", "path = 1");
        assert_eq!(
            excesses(&small, "soc"),
            [
                "soc: FF: budget 1,999, measured 2,000",
                "soc: RAMB36: budget 2, measured 2.5"
            ]
        );
    }

    #[test]
    fn rejects_unknown_blocks_and_resources() {
        for (from, to, said) in [
            ("setup", "set_up", "unknown block set_up"),
            ("lut = 1234", "luts = 1234", "unknown variant `luts`"),
            ("own =", "owned =", "unknown field `owned`"),
            ("lut = 1234", "lut = -1", "invalid value"),
            ("ratio = 1.25", "ratios = 1", "unknown variant `ratios`"),
        ] {
            let error = format!(
                "{:#}",
                Budget::parse(&BUDGET.replace(from, to)).unwrap_err()
            );
            assert!(error.contains(said), "expected `{said}` in: {error}");
        }
    }

    #[test]
    fn the_budget_file_is_sound() {
        let budget = Budget::read().unwrap();
        for block in ROWS.iter().filter(|block| **block != SOC) {
            assert!(
                budget.limits(block)[&Resource::Path] <= 12,
                "{block} may have a longer path than timing bears"
            );
        }
        for (resource, limit) in &budget.device {
            assert!(budget.limits(SOC)[resource] <= *limit, "{resource:?}");
        }
        assert_eq!(budget.device.len(), 5);
    }
}
