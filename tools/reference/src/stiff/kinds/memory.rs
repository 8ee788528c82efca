//! The memory of uploads: regions of extreme lengths, the number of regions, and gaps.

use anyhow::Result;
use glint_core::allocator::{Allocator, Region};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("regions", regions)]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Memory {
    length: usize,
    steps: Vec<Step>,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Step {
    /// Allocates this number of bytes.
    Keep(usize),
    /// Releases the region of an earlier step, identified by the number of regions that were allocated before it.
    Release(usize),
    /// Compacts the regions.
    CloseGaps,
}

/// Runs steps on a memory of at most four regions. The outcome states the allocated regions, the moves of each compaction, the final
/// gap, and the number of free bytes.
fn regions(Memory { length, steps }: Memory) -> Result<Outcome> {
    let mut memory = Allocator::<4>::new(length);
    let mut kept: Vec<Region> = Vec::new();
    let mut said = Vec::new();
    for step in steps {
        match step {
            Step::Keep(length) => match memory.allocate(length) {
                Some(region) => {
                    said.push(format!("kept {:?}", memory.range(region)));
                    kept.push(region);
                }
                None => said.push("no room".to_owned()),
            },
            Step::Release(number) => memory.release(kept[number]),
            Step::CloseGaps => memory.compact(|from, to| said.push(format!("{from:?} to {to}"))),
        }
    }
    said.push(format!("gap {:?}, free {}", memory.gap(), memory.free()));
    Ok(Outcome::exact(said.join("; ")))
}
