//! What the pages have in common that say how fast the engines are on the whole SoC.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::thread;

use anyhow::{Context, Result, bail};
use glint::board::SimulatedBoard;
use glint::render::Renderer;

/// The clock that the targets in frames a second are for, and the faster one.
pub const CLOCKS: [f64; 2] = [81.25e6, 100e6];

/// What many frames that follow each other took, by the names of the console's line.
pub struct Bench {
    kernel: String,
    values: BTreeMap<String, f64>,
}

impl Bench {
    /// Has the scene that is shown drawn back to back; `kernel` is what `bench` calls it.
    pub fn measure(renderer: &mut Renderer<SimulatedBoard>, kernel: &str) -> Result<Self> {
        let command = format!("bench {kernel}");
        let lines = renderer.console().command(&command)?;
        let line = lines
            .iter()
            .find_map(|line| line.strip_prefix(&command))
            .with_context(|| format!("{command}: no such line in {lines:?}"))?;
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

    /// Of one frame.
    pub fn frame(&self, name: &str) -> Result<f64> {
        let value = |name: &str| {
            self.values
                .get(name)
                .with_context(|| format!("bench {}: no {name} in {:?}", self.kernel, self.values))
        };
        Ok(value(name)? / value("frames")?)
    }
}

/// Works on all items, two at a time, as a simulation keeps one core busy; the results are in their order.
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
        results.extend(others.map_err(|_| anyhow::anyhow!("the other half has failed"))??);
        anyhow::Ok(results)
    })?;
    results.sort_by_key(|(number, _)| *number);
    Ok(results.into_iter().map(|(_, result)| result).collect())
}
