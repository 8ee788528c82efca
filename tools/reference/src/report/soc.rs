//! Measurement of the cycles of frames on the whole simulated SoC.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::thread;

use anyhow::{Context, Result, bail, ensure};
use glint::board::SimulatedBoard;
use glint::console::Console;
use glint::render::{self, BoardRenderer, Parts, Rendered, Route, Stats};
use glint::scene::{self, Changes};
use glint_scene_file::SceneFile;
use virtual_board::{Start, VirtualBoard};

use crate::report::workspace;

/// Default clock frequency of the SoC in Hz.
pub const CLOCK: f64 = 81.25e6;

/// A virtual board with the gateware of a folder in `target/gateware`, and with `firmware` in its memory.
///
/// # Errors
/// The board is not built, or the firmware is for a different gateware build.
pub fn started(folder: &str, firmware: &[u8]) -> Result<SimulatedBoard> {
    let library = format!("target/gateware/{folder}/libglint_soc.so");
    let board = VirtualBoard::builder()
        .library(workspace::path(&library))
        .start(Start::Fast { firmware })
        .build()?;
    Ok(SimulatedBoard::new(board))
}

/// Draws a frame of a scene with `changes` of size and quality on a newly started virtual board, with smooth shading if the scene
/// needs it, and returns the frame's statistics.
///
/// # Errors
/// Those of [`frame_on`].
pub fn frame(firmware: &[u8], scene: &SceneFile, changes: &Changes) -> Result<Stats> {
    let folder = match scene.needs().smooth {
        true => "virtual-smooth",
        false => "virtual",
    };
    frame_on(folder, firmware, scene, changes)
}

/// Draws a frame as [`frame`], with the gateware of a folder in `target/gateware`.
///
/// # Errors
/// The board is not built, the soft core draws the frame, or the frame differs from the model's.
pub fn frame_on(
    folder: &str,
    firmware: &[u8],
    scene: &SceneFile,
    changes: &Changes,
) -> Result<Stats> {
    let mut board = started(folder, firmware)?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let mut renderer = BoardRenderer::new(console).with_route(Route::Memory);
    let size = changes.size.unwrap_or(scene.size());
    let quality = changes.quality.map(|quality| format!("quality {quality}"));
    let lines = scene.settings().iter().cloned().chain(quality);
    let lines = lines.chain([render::size_command(size)]);
    let lines: Vec<String> = lines
        .chain(changes.samples.map(render::samples_command))
        .collect();
    let Rendered { image, stats } = renderer.render_after(&lines, size, Parts::COLOUR)?;
    ensure!(
        stats.backend.as_deref() == Some("gateware"),
        "expected a frame of the gateware, found the soft core's"
    );
    let expected = scene::draw(scene, changes, render::on_model)??;
    ensure!(
        image.colour == expected.image.colour,
        "the frame is not the model's"
    );
    Ok(stats)
}

/// Totals of counters over many frames drawn back to back, by the counters' names in the console's reply.
pub struct BackToBack {
    kernel: String,
    values: BTreeMap<String, f64>,
}

impl BackToBack {
    /// Draws `frames` frames of the renderer's current scene, back to back, by the console command `bench KERNEL FRAMES`. `kernel` is
    /// `triangle` or `field`.
    ///
    /// # Errors
    /// When the console reports an error, or its reply has no line for this kernel.
    pub fn measure(
        renderer: &mut BoardRenderer<SimulatedBoard>,
        kernel: &str,
        frames: u32,
    ) -> Result<Self> {
        let command = format!("bench {kernel} {frames}");
        let lines = renderer.console().command(&command)?;
        let line = lines
            .iter()
            .find_map(|line| line.strip_prefix(&format!("bench {kernel} ")))
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

/// Runs `work` on all items and returns the results in the order of the items. Only two items run at a time, because each
/// simulation keeps a core busy.
///
/// # Errors
/// When `work` fails. If `work` panics, the result is an error or a panic.
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
