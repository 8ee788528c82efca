//! Progress of long steps: a bar on a terminal, otherwise a line every ten seconds, which keeps logs short.

use super::messages::{Loudness, loudness};
use glint::board::Meter;
use indicatif::{HumanBytes, HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// Interval of progress lines without a terminal.
const PERIOD: Duration = Duration::from_secs(10);
/// Frame rate of the monitor in frames per second of the board's time.
const MONITOR_HZ: f64 = 60.0;

/// The cycle counter of the simulated board in this process, if any.
static SIMULATION: Mutex<Option<Meter>> = Mutex::new(None);

/// Adds the cycle count of a simulated board to the progress of all later steps.
pub fn show_simulation(meter: Meter) {
    if let Ok(mut simulation) = SIMULATION.lock() {
        *simulation = Some(meter);
    }
}

/// Unit of a step's progress.
#[derive(Clone, Copy)]
enum Unit {
    /// No unit: the length of the step is unknown.
    None,
    Bytes,
    /// Items, with their name in the plural.
    Items(&'static str),
}

/// A step of a command, which may take a long time. Dropping a step removes its progress from the
/// terminal.
pub struct Step {
    bar: ProgressBar,
    /// Dropping the sender ends the thread that prints lines.
    _lines: Option<Sender<()>>,
}

/// A step of unknown length.
pub fn spinner(label: &str) -> Step {
    Step::new(label, Unit::None)
}

/// A step that counts bytes.
pub fn bar(label: &str) -> Step {
    Step::new(label, Unit::Bytes)
}

/// A step that counts items; `items` is their name in the plural.
pub fn count_bar(label: &str, items: &'static str) -> Step {
    Step::new(label, Unit::Items(items))
}

/// Returns a progress callback that sets the position and the length of the step.
pub fn advance(step: &Step) -> impl FnMut(u64, u64) {
    move |done, all| {
        step.bar.set_length(all);
        step.bar.set_position(done);
    }
}

impl Step {
    fn new(label: &str, unit: Unit) -> Self {
        let bar = match unit {
            Unit::None => ProgressBar::new_spinner(),
            _ => ProgressBar::new(0),
        };
        let bar = bar.with_message(label.to_owned());
        if loudness() == Loudness::Quiet {
            bar.set_draw_target(indicatif::ProgressDrawTarget::hidden());
            return Self { bar, _lines: None };
        }
        let from = simulated_cycles();
        let template = match unit {
            Unit::None => "{spinner} {msg} {elapsed}{simulation}".to_owned(),
            Unit::Bytes => {
                "{msg} {wide_bar} {bytes}/{total_bytes} {bytes_per_sec} {eta}{simulation}"
                    .to_owned()
            }
            Unit::Items(items) => {
                format!(
                    "{{msg}} {{wide_bar}} {{pos}}/{{len}} {items} {{per_sec}} {{eta}}{{simulation}}"
                )
            }
        };
        let style = ProgressStyle::with_template(&template);
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let simulation = move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            // An error of writing to the terminal cannot be reported.
            let _ = out.write_str(&simulation(from, state.elapsed()));
        };
        bar.set_style(style.with_key("simulation", simulation));
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(200));
            return Self { bar, _lines: None };
        }
        let print = |line: String| {
            // An error of writing to standard error cannot be reported.
            let _ = writeln!(io::stderr(), "{line}");
        };
        let lines = Some(every(PERIOD, bar.clone(), unit, from, print));
        Self { bar, _lines: lines }
    }

    /// Sets the number of items.
    pub fn set_length(&self, items: u64) {
        self.bar.set_length(items);
    }

    /// Counts an item.
    pub fn inc(&self) {
        self.bar.inc(1);
    }

    /// Restarts the step.
    pub fn reset(&self) {
        self.bar.reset();
    }

    /// Ends the step.
    pub fn finish(&self) {
        if loudness() == Loudness::Verbose && !self.bar.is_finished() {
            let seconds = self.bar.elapsed().as_secs_f64();
            let label = self.bar.message();
            self.bar.suspend(|| {
                // An error of writing to standard error cannot be reported.
                let _ = writeln!(io::stderr(), "{label}: {seconds:.3} s");
            });
        }
        self.bar.finish_and_clear();
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        self.finish();
    }
}

/// Prints a line about a step every `period`, until the sender is dropped.
fn every(
    period: Duration,
    bar: ProgressBar,
    unit: Unit,
    from: u64,
    mut print: impl FnMut(String) + Send + 'static,
) -> Sender<()> {
    let (sender, end) = channel();
    std::thread::spawn(move || {
        let start = Instant::now();
        while end.recv_timeout(period) == Err(RecvTimeoutError::Timeout) {
            if bar.is_finished() {
                return;
            }
            let elapsed = start.elapsed();
            let mut line = bar.message();
            if line_of(&mut line, unit, bar.position(), bar.length(), elapsed) {
                line += &simulation(from, elapsed);
                print(line);
            }
        }
    });
    sender
}

/// Appends the progress, the rate and the remaining time of a step to `line`. Returns false if the
/// step counts items or bytes but has no length yet, because it has not begun.
fn line_of(line: &mut String, unit: Unit, done: u64, all: Option<u64>, elapsed: Duration) -> bool {
    let seconds = elapsed.as_secs_f64();
    let rate = done as f64 / seconds;
    // Writing to a string does not fail.
    let _ = match (unit, all) {
        (Unit::None, _) => write!(line, ": {}", HumanDuration(elapsed)),
        (_, None | Some(0)) => return false,
        (Unit::Bytes, Some(all)) => write!(
            line,
            ": {} of {}, {}/s{}",
            HumanBytes(done),
            HumanBytes(all),
            HumanBytes(rate as u64),
            left(done, all, rate)
        ),
        (Unit::Items(items), Some(all)) => {
            write!(
                line,
                ": {done} of {all} {items}, {rate:.1}/s{}",
                left(done, all, rate)
            )
        }
    };
    true
}

/// The remaining time; empty until a part of the step is done.
fn left(done: u64, all: u64, rate: f64) -> String {
    if done == 0 {
        return String::new();
    }
    let seconds = all.saturating_sub(done) as f64 / rate;
    match Duration::try_from_secs_f64(seconds) {
        Ok(left) => format!(", {} left", HumanDuration(left)),
        Err(_) => String::new(),
    }
}

fn simulated_cycles() -> u64 {
    let simulation = SIMULATION.lock();
    simulation.map_or(0, |meter| meter.as_ref().map_or(0, Meter::cycles))
}

/// Progress of a simulated board since the cycle `from`: cycles, and frames of its monitor per second on this host.
fn simulation(from: u64, elapsed: Duration) -> String {
    let Ok(Some((cycles, clock))) = SIMULATION.lock().map(|meter| {
        meter
            .as_ref()
            .map(|meter| (meter.cycles(), meter.clock_hz()))
    }) else {
        return String::new();
    };
    simulated(cycles.saturating_sub(from), clock, elapsed)
}

fn simulated(cycles: u64, clock: u32, elapsed: Duration) -> String {
    let millions = cycles as f64 / 1e6;
    let frames = cycles as f64 / f64::from(clock.max(1)) * MONITOR_HZ;
    let rate = frames / elapsed.as_secs_f64().max(1e-3);
    format!(" ({millions:.1} million cycles, {rate:.2} frames/s of the simulation)")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(unit: Unit, done: u64, all: Option<u64>) -> Option<String> {
        let mut line = "mesh".to_owned();
        line_of(&mut line, unit, done, all, Duration::from_secs(20)).then_some(line)
    }

    #[test]
    fn lines_have_rate_and_remaining_time() {
        let bytes = text(Unit::Bytes, 20 << 10, Some(60 << 10));
        assert_eq!(
            bytes.unwrap(),
            "mesh: 20.00 KiB of 60.00 KiB, 1.00 KiB/s, 40 seconds left"
        );
        let items = text(Unit::Items("frames"), 5, Some(36));
        assert_eq!(
            items.unwrap(),
            "mesh: 5 of 36 frames, 0.2/s, 2 minutes left"
        );
        let start = text(Unit::Items("frames"), 0, Some(36));
        assert_eq!(start.unwrap(), "mesh: 0 of 36 frames, 0.0/s");
        assert_eq!(text(Unit::None, 0, None).unwrap(), "mesh: 20 seconds");
        // A step that has not begun prints no line.
        assert_eq!(text(Unit::Bytes, 0, Some(0)), None);
    }

    #[test]
    fn a_simulation_counts_cycles_and_frames() {
        // A second of the board's time has 60 frames, and takes 20 s.
        let text = simulated(81_250_000, 81_250_000, Duration::from_secs(20));
        assert_eq!(
            text,
            " (81.2 million cycles, 3.00 frames/s of the simulation)"
        );
    }

    /// Progress lines are printed until the step ends.
    #[test]
    fn a_step_prints_lines_until_its_end() {
        let bar = ProgressBar::hidden().with_message("mesh");
        bar.set_length(4);
        bar.set_position(1);
        let (said, lines) = channel();
        let print = move |line| said.send(line).unwrap();
        let end = every(
            Duration::from_millis(1),
            bar,
            Unit::Items("frames"),
            0,
            print,
        );
        for _ in 0..2 {
            assert!(lines.recv().unwrap().starts_with("mesh: 1 of 4 frames, "));
        }
        drop(end);
        // The thread then drops its end of the channel.
        while lines.recv().is_ok() {}
    }
}
