//! Measurement of the cycles that frames take on the whole SoC, which runs in simulation.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::thread;

use anyhow::{Context, Result, bail};
use glint::board::SimulatedBoard;
use glint::render::BoardRenderer;

/// Clock frequencies of the SoC in Hz: first the default, then a faster one.
pub const CLOCKS: [f64; 2] = [81.25e6, 100e6];

/// Totals of counters over many frames that are drawn back to back, by the counters' names in the console's reply.
pub struct BackToBack {
    kernel: String,
    values: BTreeMap<String, f64>,
}

impl BackToBack {
    /// Draws the renderer's current scene many times, back to back, by the console command `bench KERNEL`. `kernel` is
    /// `triangle` or `field`.
    ///
    /// # Errors
    /// When the console reports an error, or its reply has no line for this kernel.
    pub fn measure(renderer: &mut BoardRenderer<SimulatedBoard>, kernel: &str) -> Result<Self> {
        let command = format!("bench {kernel}");
        let lines = renderer.console().command(&command)?;
        let line = lines
            .iter()
            .find_map(|line| line.strip_prefix(&command))
            .with_context(|| format!("{command}: expected its line in {lines:?}"))?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let values = words.chunks(2).map(|pair| match pair {
            [name, value] => Ok((name.to_string(), value.parse()?)),
            _ => bail!("{command}: expected names and numbers, found {line:?}"),
        });
        Ok(Self {
            kernel: kernel.to_owned(),
            values: values.collect::<Result<_>>()?,
        })
    }

    /// Returns the mean of a counter per frame.
    ///
    /// # Errors
    /// When the reply has no counter of this name.
    pub fn frame(&self, name: &str) -> Result<f64> {
        let value = |name: &str| {
            self.values.get(name).with_context(|| {
                format!(
                    "bench {}: expected {name} in {:?}",
                    self.kernel, self.values
                )
            })
        };
        Ok(value(name)? / value("frames")?)
    }
}

/// Runs `work` on all items and returns the results in the order of the items. Only
/// two items are in work at a time, because each simulation keeps a core busy.
///
/// # Errors
/// When `work` fails or panics.
pub fn two_at_a_time<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let queue = Mutex::new(items.iter().enumerate());
    let worker = || -> Result<Vec<(usize, R)>> {
        let mut results = Vec::new();
        loop {
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((number, item)) = next else {
                return Ok(results);
            };
            results.push((number, work(item)?));
        }
    };
    let mut results = thread::scope(|scope| {
        let other = scope.spawn(worker);
        let mut results = worker()?;
        let others = other.join();
        results.extend(others.map_err(|_| anyhow::anyhow!("a worker panicked"))??);
        anyhow::Ok(results)
    })?;
    results.sort_by_key(|(number, _)| *number);
    Ok(results.into_iter().map(|(_, result)| result).collect())
}
