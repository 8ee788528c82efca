//! Cycles of kernels on the soft core, measured by the firmware's console command `bench`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use virtual_board::Uart;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use virtual_board::{Start, VirtualBoard};

use super::workspace;

/// Cycles of the soft core for a call of a kernel, which is a measured function of the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Figures {
    /// Cycles of the fastest call.
    pub min: u64,
    /// Median of the calls' cycles.
    pub median: u64,
    /// Cycles of the slowest call.
    pub max: u64,
}

/// Cycles of each kernel, by the kernel's name.
pub type Cycles = BTreeMap<String, Figures>;

/// Parses the lines `bench NAME min MIN median MEDIAN max MAX cycles` in the output of a console.
///
/// # Errors
/// When such a line is malformed, or the output has none.
pub fn parse(console: &str) -> Result<Cycles> {
    let mut cycles = Cycles::new();
    for line in console.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [
                "bench",
                name,
                "min",
                min,
                "median",
                median,
                "max",
                max,
                "cycles",
            ] => {
                let number = |word: &str| {
                    word.parse().with_context(|| {
                        format!("{line:?}: expected a number of cycles, found {word:?}")
                    })
                };
                let figures = Figures {
                    min: number(min)?,
                    median: number(median)?,
                    max: number(max)?,
                };
                cycles.insert(name.to_owned(), figures);
            }
            ["bench", _, "min", ..] => {
                bail!("{line:?}: expected \"bench NAME min MIN median MEDIAN max MAX cycles\"")
            }
            _ => {}
        }
    }
    if cycles.is_empty() {
        bail!(
            "expected a line \"bench NAME min MIN median MEDIAN max MAX cycles\" in the console's output"
        );
    }
    Ok(cycles)
}

/// The console's prompt.
const PROMPT: &str = "glint> ";
/// Maximum number of cycles for the firmware's start, and for the run of all kernels. Start and run take only a fraction of this number.
const LIMIT: u64 = 500_000_000;

/// Command-line arguments for the source of the cycles: a run on the virtual board, or a transcript.
#[derive(clap::Args)]
pub struct Source {
    /// Verilated SoC [default: the build of `cargo xtask gateware`]
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
    /// Firmware [default: the build of `cargo xtask firmware --features peers`]
    #[arg(long, value_name = "FILE")]
    firmware: Option<PathBuf>,
    /// Console transcript of `bench`, such as from a real board, instead of a run on the virtual board
    #[arg(long, value_name = "FILE")]
    transcript: Option<PathBuf>,
}

impl Source {
    /// Returns the cycles reported by the console command `bench KERNELS`.
    ///
    /// # Errors
    /// When the transcript cannot be read, or the run on the virtual board fails.
    pub fn measure(&self, kernels: &str) -> Result<Cycles> {
        if let Some(path) = &self.transcript {
            let text = std::fs::read_to_string(path)
                .with_context(|| format!("cannot read {}", path.display()))?;
            return parse(&text);
        }
        measure(&self.library(), &self.firmware(), kernels)
    }

    /// Returns the path of the library with the verilated SoC.
    fn library(&self) -> PathBuf {
        let built = || workspace::path("target/gateware/virtual/libglint_soc.so");
        self.library.clone().unwrap_or_else(built)
    }

    /// Returns the path of the firmware's image.
    pub fn firmware(&self) -> PathBuf {
        let built = || workspace::path("target/firmware/glint-peers.bin");
        self.firmware.clone().unwrap_or_else(built)
    }
}

/// Runs the console command `bench KERNELS` on the virtual board and returns the reported cycles.
///
/// # Errors
/// When the board or the firmware is not built, or the console does not answer.
fn measure(library: &Path, firmware: &Path, kernels: &str) -> Result<Cycles> {
    for (path, command) in [
        (library, "cargo xtask gateware"),
        (firmware, "cargo xtask firmware --features peers"),
    ] {
        if !path.exists() {
            let path = path.strip_prefix(workspace::path("")).unwrap_or(path);
            bail!("{} is missing: run `{command}`", path.display());
        }
    }
    let firmware = std::fs::read(firmware)?;
    let mut board = VirtualBoard::builder()
        .library(library)
        .start(Start::Fast {
            firmware: &firmware,
        })
        .build()?;
    let spinner = ProgressBar::new_spinner().with_style(ProgressStyle::with_template(
        "{spinner} {msg} on the virtual board, {pos} million cycles",
    )?);
    let command = format!("bench {kernels}");
    spinner.set_message(command.clone());
    board.read_until(PROMPT, LIMIT)?;
    board.uart_write(format!("{command}\r").as_bytes());
    let mut reply = Vec::new();
    let answered = board.run_until(LIMIT, |board| {
        spinner.set_position(board.cycles() / 1_000_000);
        board.uart_read(&mut reply);
        ends(&reply)
    });
    spinner.finish_and_clear();
    let reply = String::from_utf8_lossy(&reply);
    if !answered {
        bail!("`{command}` did not end within {LIMIT} cycles; so far: {reply:?}");
    }
    parse(&reply).with_context(|| format!("`{command}` on the virtual board"))
}

/// Whether the reply to a command is complete: its last line is `ok` or an error.
fn ends(reply: &[u8]) -> bool {
    let last = reply.strip_suffix(PROMPT.as_bytes()).unwrap_or(reply);
    let last = last
        .strip_suffix(b"\n")
        .map(|whole| whole.trim_ascii_end().rsplit(|&byte| byte == b'\n').next());
    last.flatten()
        .is_some_and(|line| line == b"ok" || line.starts_with(b"error:"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_found_among_others() {
        let console = "glint> bench sine\r\nbench sin_cos_q30 min 90 median 101 max 260 cycles\r\n\
                       bench idsp min 40 median 44 max 90 cycles\r\nok\r\nglint> ";
        let cycles = parse(console).expect("two lines");
        let expected = Figures {
            min: 90,
            median: 101,
            max: 260,
        };
        assert_eq!(cycles["sin_cos_q30"], expected);
        assert_eq!(cycles.len(), 2);
    }

    #[test]
    fn a_reply_ends_in_ok_or_an_error() {
        assert!(ends(
            b"bench sine\r\nbench idsp min 1 median 1 max 1 cycles\r\nok\r\n"
        ));
        assert!(ends(b"bench sine\r\nok\r\nglint> "));
        assert!(ends(b"bench sine\r\nerror: bench: no kernel\r\n"));
        assert!(!ends(
            b"bench sine\r\nbench idsp min 1 median 1 max 1 cycles\r\n"
        ));
        assert!(!ends(b"bench sine\r\nok"));
    }

    #[test]
    fn malformed_lines_are_refused() {
        assert!(parse("error: unknown command\n").is_err());
        assert!(parse("bench idsp min 40 median many max 90 cycles\n").is_err());
        assert!(parse("bench idsp min 40 max 90 cycles\n").is_err());
    }
}
