//! Runs a kernel over its inputs on all cores, with the same result whatever the cores do.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use super::kernels::Kernel;
use super::statistics::Statistics;

/// Steps that one core takes at a time; the sums of a part do not depend on who made it.
const PART: u64 = 1 << 18;

/// The errors of `kernel` over every `stride`-th of its steps. `progress` is told of steps done.
pub fn sweep(kernel: &Kernel, stride: u64, progress: &(dyn Fn(u64) + Sync)) -> Statistics {
    let steps = kernel.steps().div_ceil(stride);
    let parts = steps.div_ceil(PART);
    let next = AtomicU64::new(0);
    let done = Mutex::new(Vec::new());
    let work = || {
        loop {
            let part = next.fetch_add(1, Ordering::Relaxed);
            if part >= parts {
                return;
            }
            let (first, last) = (part * PART, ((part + 1) * PART).min(steps));
            let mut statistics = Statistics::default();
            kernel.run(first..last, stride, &mut statistics);
            if let Ok(mut done) = done.lock() {
                done.push((part, statistics));
            }
            progress(last - first);
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |cores| cores.get()) {
            scope.spawn(work);
        }
    });
    let mut parts = done
        .into_inner()
        .unwrap_or_else(|poisoned| poisoned.into_inner());
    parts.sort_by_key(|(part, _)| *part);
    let mut total = Statistics::default();
    for (_, statistics) in &parts {
        total.merge(statistics);
    }
    total
}
