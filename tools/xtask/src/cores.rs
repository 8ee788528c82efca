//! The cores of the machine, divided into halves for work that runs in parallel.
//!
//! cargo, the Rust tests, pytest and the gateware's programs each start a process for every core that they may use. In parallel on the same
//! cores they would start too many processes, and each context switch evicts data from the caches. If the system refuses to divide the
//! cores, all work runs on all cores, more slowly and with the same results.

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};

/// Returns the two halves of the cores of this thread; both halves have the same core if there is only one.
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

/// Restricts this thread, and the processes that it starts from now on, to `cores`.
pub fn keep_to(cores: &CpuSet) {
    // The system may refuse, and refuses an empty set.
    let _ = sched_setaffinity(None, cores);
}
