//! Resources of a block.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::instances::Instance;

/// Limited resources, in the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Resource {
    /// LUTs of every kind.
    Lut,
    /// Flip-flops.
    Ff,
    /// Multipliers.
    Dsp48,
    /// Block RAMs.
    Ramb36,
    /// Carry chains of four bits.
    Carry4,
    /// Cells on the longest path between registers.
    Path,
    /// Combinations of clock, enable and reset of flip-flops.
    ControlSets,
    /// Slices at least.
    Slices,
}

impl Resource {
    /// All limited resources.
    pub const ALL: [Self; 8] = [
        Self::Lut,
        Self::Ff,
        Self::Dsp48,
        Self::Ramb36,
        Self::Carry4,
        Self::Path,
        Self::ControlSets,
        Self::Slices,
    ];

    /// Number of resources in the table of sizes, at the start of `ALL`. The others are about placement.
    pub const OF_CELLS: usize = 6;

    /// The name in tables and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lut => "LUT",
            Self::Ff => "FF",
            Self::Dsp48 => "DSP48",
            Self::Ramb36 => "RAMB36",
            Self::Carry4 => "CARRY4",
            Self::Path => "path",
            Self::ControlSets => "control sets",
            Self::Slices => "slices",
        }
    }
}

/// The size of a block, from a line of output of `gateware/tests/run.py --size`: the counts of the cells in its mapped netlist.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Size {
    /// Name of the block.
    pub name: String,
    /// Tool of the measurement, with its version.
    pub yosys: String,
    /// LUTs as logic.
    pub logic: u32,
    /// LUTs as shift registers.
    pub srl: u32,
    /// LUTs as memory.
    pub lutram: u32,
    /// Flip-flops.
    pub ff: u32,
    /// Multipliers.
    pub dsp48: u32,
    /// Whole block RAMs.
    pub ramb36: u32,
    /// Half block RAMs.
    pub ramb18: u32,
    /// Carry chains of four bits.
    pub carry4: u32,
    /// Cells on the longest path between registers.
    pub path: u32,
    /// Number of cells of each other kind, by the name of the kind.
    pub others: BTreeMap<String, u32>,
    /// Number of combinations of clock, enable and reset of its flip-flops.
    pub control_sets: u32,
    /// Number of flip-flops in control sets that do not fill a slice.
    pub small_set_ff: u32,
    /// Lower bound of the slices that it takes.
    pub slices: u32,
    /// The nets with the most loads, each with its number of loads.
    pub fan_outs: Vec<(String, u32)>,
    /// Its cells by instance.
    pub instances: Vec<Instance>,
}

impl Size {
    /// Parses a line of JSON.
    ///
    /// # Errors
    /// The line is not a size.
    pub fn parse(line: &str) -> Result<Self> {
        serde_json::from_str(line).with_context(|| format!("not a size: `{line}`"))
    }

    /// Adds up several blocks to a block `name`. Its path is the longest of their paths. A control set that several blocks have
    /// counts once for each of them.
    pub fn sum(name: &str, parts: &[&Self]) -> Self {
        let total = |count: fn(&Self) -> u32| parts.iter().map(|part| count(part)).sum();
        let mut others = BTreeMap::new();
        for (cell, count) in parts.iter().flat_map(|part| &part.others) {
            *others.entry(cell.clone()).or_default() += count;
        }
        let mut fan_outs: Vec<(String, u32)> = parts
            .iter()
            .flat_map(|part| {
                let named = |(net, loads): &(String, u32)| (format!("{}.{net}", part.name), *loads);
                part.fan_outs.iter().map(named)
            })
            .collect();
        fan_outs.sort_by_key(|(_, loads)| std::cmp::Reverse(*loads));
        fan_outs.truncate(parts.first().map_or(0, |part| part.fan_outs.len()));
        Self {
            name: name.to_owned(),
            yosys: parts
                .first()
                .map_or_else(String::new, |part| part.yosys.clone()),
            logic: total(|part| part.logic),
            srl: total(|part| part.srl),
            lutram: total(|part| part.lutram),
            ff: total(|part| part.ff),
            dsp48: total(|part| part.dsp48),
            ramb36: total(|part| part.ramb36),
            ramb18: total(|part| part.ramb18),
            carry4: total(|part| part.carry4),
            path: parts.iter().map(|part| part.path).max().unwrap_or(0),
            others,
            control_sets: total(|part| part.control_sets),
            small_set_ff: total(|part| part.small_set_ff),
            slices: total(|part| part.slices),
            fan_outs,
            instances: vec![],
        }
    }

    /// Amount of `resource` in the block; a half block RAM counts 0.5.
    pub fn of(&self, resource: Resource) -> f64 {
        match resource {
            Resource::Lut => f64::from(self.logic + self.srl + self.lutram),
            Resource::Ff => f64::from(self.ff),
            Resource::Dsp48 => f64::from(self.dsp48),
            Resource::Ramb36 => f64::from(self.ramb36) + f64::from(self.ramb18) / 2.0,
            Resource::Carry4 => f64::from(self.carry4),
            Resource::Path => f64::from(self.path),
            Resource::ControlSets => f64::from(self.control_sets),
            Resource::Slices => f64::from(self.slices),
        }
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Returns a block called `name` in which every count is different.
    pub fn size(name: &str) -> Size {
        let line = r#"{"name": "NAME", "yosys": "Yosys 0.70", "logic": 1200, "srl": 30, "lutram": 4, "ff": 2000, "dsp48": 7,
            "ramb36": 2, "ramb18": 1, "carry4": 50, "path": 9, "others": {"MUXF7": 3},
            "control_sets": 21, "small_set_ff": 17, "slices": 400, "fan_outs": [["enable", 348], ["first[0]", 99]],
            "instances": []}"#;
        Size::parse(&line.replace("NAME", name)).unwrap()
    }

    #[test]
    fn counts_shift_registers_memories_and_halves() {
        let counts = Resource::ALL.map(|resource| size("setup").of(resource));
        assert_eq!(counts, [1234.0, 2000.0, 7.0, 2.5, 50.0, 9.0, 21.0, 400.0]);
    }

    #[test]
    fn rejects_malformed_sizes() {
        assert!(Size::parse("").is_err());
        let line = r#"{"name": "a", "yosys": "b", "logic": 1}"#;
        assert!(format!("{:#}", Size::parse(line).unwrap_err()).contains("missing field `srl`"));
    }

    #[test]
    fn a_sum_has_the_longest_path_of_its_parts() {
        let (mut a, mut b) = (size("a"), size("b"));
        a.path = 11;
        b.logic = 1;
        b.others.insert("BUFG".to_owned(), 1);
        b.fan_outs[0].1 = 350;
        let sum = Size::sum("both", &[&a, &b]);
        assert_eq!(
            (sum.logic, sum.srl, sum.ramb18, sum.path),
            (1201, 60, 2, 11)
        );
        assert_eq!(sum.of(Resource::Ramb36), 5.0);
        assert_eq!(
            (sum.control_sets, sum.small_set_ff, sum.slices),
            (42, 34, 800)
        );
        let fan_outs = [("b.enable".to_owned(), 350), ("a.enable".to_owned(), 348)];
        assert_eq!(sum.fan_outs, fan_outs);
        assert_eq!((sum.others["MUXF7"], sum.others["BUFG"]), (6, 1));
    }
}
