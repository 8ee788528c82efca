//! Measures a kernel over its inputs on all cores of the computer. The result does not depend on the number of cores.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use super::kernels::Kernel;
use super::statistics::Statistics;

/// Number of steps in a part of a measurement. Each core measures one part at a time. The parts' results are added in order, for
/// a reproducible rounded sum.
const PART: u64 = 1 << 18;

/// Measures the errors of `kernel` in every `stride`-th of its steps. Calls `progress` with the number of steps of each completed part.
pub fn sweep(kernel: &Kernel, stride: u64, progress: &(dyn Fn(u64) + Sync)) -> Statistics {
    let steps = kernel.steps.div_ceil(stride);
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
            (kernel.run)(first..last, stride, &mut statistics);
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
