//! Measurements of single blocks by `gateware/tests/run.py`.

use std::collections::VecDeque;
use std::process::Command;
use std::sync::Mutex;

use anyhow::Result;

use crate::{paths, run};

/// Parallel measurements; each needs one core and about a gigabyte.
const AT_ONCE: usize = 2;

/// Measures blocks in parallel, until one fails.
///
/// # Errors
/// A block cannot be measured.
pub fn two_at_a_time<T: Send>(
    names: VecDeque<String>,
    measure: impl Fn(&str) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let queue = Mutex::new(names);
    let work = || -> Result<Vec<T>> {
        let mut results = Vec::new();
        loop {
            let next = queue.lock().expect("no worker panics").pop_front();
            let Some(name) = next else {
                return Ok(results);
            };
            let result = measure(&name);
            if result.is_err() {
                queue.lock().expect("no worker panics").clear();
            }
            results.push(result?);
        }
    };
    let outcomes: Vec<Result<Vec<T>>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..AT_ONCE).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().expect("a measuring thread does not panic"))
            .collect()
    });
    let results = outcomes.into_iter().collect::<Result<Vec<_>>>()?;
    Ok(results.into_iter().flatten().collect())
}

/// Measures a block by `gateware/tests/run.py` with options, the last of which takes the block's name, and returns the line of
/// JSON that this prints.
///
/// # Errors
/// The program fails.
pub fn measured_line(what: &str, options: &[&str], name: &str) -> Result<String> {
    let mut found = String::new();
    run::watched_step(
        &format!("{what} of {name}"),
        Command::new(paths::venv_program("python"))
            .arg("gateware/tests/run.py")
            .args(options)
            .arg(name)
            .current_dir(paths::root()),
        |line| {
            if line.starts_with('{') {
                line.clone_into(&mut found);
            }
        },
    )?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use anyhow::bail;

    use super::*;

    #[test]
    fn measures_all_in_parallel_until_one_fails() {
        let names = || ["a", "b", "c", "d"].map(String::from).into();
        let mut lengths = two_at_a_time(names(), |name| Ok(name.to_owned())).unwrap();
        lengths.sort();
        assert_eq!(lengths, ["a", "b", "c", "d"]);
        let failed = two_at_a_time(names(), |name| -> Result<()> { bail!("no {name}") });
        assert!(failed.unwrap_err().to_string().starts_with("no "));
    }
}
