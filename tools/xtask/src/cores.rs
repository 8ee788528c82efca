//! The cores of the machine, divided into halves for work that runs side by side.
//!
//! cargo, the Rust tests, pytest and the gateware's programs start as many processes as there are cores for them. Side by side on the same
//! cores they would start too many, and each change from one process to another costs the contents of a cache. Where the system refuses
//! to divide the cores, all work runs on all of them, more slowly and with the same results.

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};

/// Returns the two halves of the cores of this thread, each with the only core if there is no other.
pub fn halves() -> [CpuSet; 2] {
    let all = sched_getaffinity(None).unwrap_or_default();
    let cores: Vec<usize> = (0..CpuSet::MAX_CPU)
        .filter(|&core| all.is_set(core))
        .collect();
    let (first, second) = cores.split_at(cores.len() / 2);
    [if first.is_empty() { second } else { first }, second].map(|cores| {
        let mut half = CpuSet::new();
        cores.iter().for_each(|&core| half.set(core));
        half
    })
}

/// Keeps this thread, and the processes that it starts from now on, to `cores`.
pub fn keep_to(cores: &CpuSet) {
    // The system may refuse, and refuses an empty set.
    let _ = sched_setaffinity(None, cores);
}
