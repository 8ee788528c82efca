//! `cargo xtask gateware`: the SoC of a board, and the virtual board's library.
//!
//! LiteX writes Verilog, the BIOS and the SoC's description to `target/gateware/BOARD`. For the virtual board, `gateware/verilate`
//! makes `libglint_soc.so` of the Verilog; for the ULX3S, `gateware/ecp5` makes a bitstream. Each part is skipped if its inputs
//! have not changed.

use std::ffi::OsStr;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::{paths, run};

/// A board that the gateware is built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Board {
    /// The verilated SoC.
    Virtual,
    /// The RealDigital Urbana: Verilog, constraints and a Vivado script.
    Urbana,
    /// The Radiona ULX3S with an LFE5U-85F: a bitstream.
    Ulx3s,
}

impl Board {
    /// Name in paths and on the command line of `glint_soc`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Virtual => "virtual",
            Self::Urbana => "urbana",
            Self::Ulx3s => "ulx3s",
        }
    }

    /// Build folder.
    pub fn folder(self) -> PathBuf {
        paths::target().join("gateware").join(self.name())
    }
}

/// The sets of distance fields that a raymarcher can be built with: `BUILDS` of `glint_soc/raymarch.py`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Fields {
    /// Every field, with the prepass; two evaluations of the field per clock
    All,
    /// Sponge up to depth 4, box and spheres, without fillets and prepass; two evaluations of the field per clock
    Round,
    /// Sponge up to depth 4 and box, without prepass; two evaluations of the field per clock
    Faces,
    /// Sponge up to depth 4 only, with the prepass; four evaluations of the field per clock
    Sponge,
}

impl Fields {
    /// Name of the set of fields on the command line of the program `glint_soc`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Round => "round",
            Self::Faces => "faces",
            Self::Sponge => "sponge",
        }
    }
}

/// An optional block: `OPTIONAL_BLOCKS` of `glint_soc/register_map.py`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Block {
    /// The scan-out
    Scanout,
    /// The triangle engine
    Triangle,
    /// The raymarcher; without the triangle engine the gateware draws fields alone
    Raymarch,
    /// The line engine, a part of the triangle engine
    Line,
    /// The gesture engine
    Gesture,
}

impl Block {
    /// Name on the command line of `glint_soc`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scanout => "scanout",
            Self::Triangle => "triangle",
            Self::Raymarch => "raymarch",
            Self::Line => "line",
            Self::Gesture => "gesture",
        }
    }
}

/// Builds the gateware of `board`, if out of date.
///
/// # Errors
/// A tool is missing or fails. The output of a failed tool is printed.
pub fn build(board: Board) -> Result<()> {
    build_with(board, &[])
}

/// Builds the gateware of `board` with command-line options of `glint_soc`, and replaces the build without options.
///
/// # Errors
/// As [`build`].
pub fn build_with(board: Board, options: &[&str]) -> Result<()> {
    let folder = board.folder();
    generate(board, &folder, options)?;
    match board {
        Board::Virtual => verilate(&folder, Waveforms::Without),
        Board::Urbana => Ok(()),
        Board::Ulx3s => make_bitstream(&folder),
    }
}

/// Builds the virtual board with command-line options of `glint_soc` in `target/gateware/virtual-NAME`, and leaves the standard build
/// as it is. Returns the folder.
///
/// # Errors
/// As [`build`].
pub fn build_beside(name: &str, options: &[&str]) -> Result<PathBuf> {
    let folder = Board::Virtual
        .folder()
        .with_file_name(format!("virtual-{name}"));
    generate(Board::Virtual, &folder, options)?;
    verilate(&folder, Waveforms::Without)?;
    Ok(folder)
}

/// Builds a second library of the virtual board, which writes waveforms and is slower.
///
/// # Errors
/// As [`build`].
pub fn build_with_waveforms() -> Result<()> {
    let folder = Board::Virtual.folder();
    generate(Board::Virtual, &folder, &[])?;
    verilate(&folder, Waveforms::With)
}

/// Runs LiteX if its inputs have changed since its last run. It writes Verilog, the BIOS, `csr.json` and `soc.svd` to `folder`.
fn generate(board: Board, folder: &Path, options: &[&str]) -> Result<()> {
    let root = paths::root();
    let gateware = root.join("gateware");
    let inputs = fingerprint(
        &[
            gateware.join("glint_soc"),
            gateware.join("rtl"),
            gateware.join("requirements.txt"),
        ],
        &[&[board.name()], options].concat().join(" "),
    )?;
    let stamp = folder.join("generated.stamp");
    if is_current(&stamp, &inputs) {
        return Ok(());
    }
    fs::create_dir_all(folder).with_context(|| format!("creating {}", folder.display()))?;
    run::step(
        &format!(
            "SoC and BIOS ({})",
            [&[board.name()], options].concat().join(" ")
        ),
        Command::new(paths::venv_program("python"))
            .args(["-m", "glint_soc", "--board", board.name(), "--output"])
            .arg(folder)
            .args(options)
            .current_dir(folder)
            .env("PYTHONPATH", gateware)
            .env("PYTHONDONTWRITEBYTECODE", "1"),
    )
    .context("the gateware generator: `cargo xtask bootstrap` installs its packages")?;
    fs::write(&stamp, inputs).with_context(|| format!("writing {}", stamp.display()))
}

/// Whether the library of the virtual board can write waveforms.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Waveforms {
    With,
    Without,
}

/// Builds the library of the virtual board from the output of [`generate`].
fn verilate(folder: &Path, waveforms: Waveforms) -> Result<()> {
    let name = match waveforms {
        Waveforms::Without => "verilated SoC",
        Waveforms::With => "verilated SoC with waveforms",
    };
    let options: &[&str] = match waveforms {
        Waveforms::Without => &[],
        Waveforms::With => &["--waveforms"],
    };
    run::step(
        name,
        Command::new(paths::venv_program("python"))
            .args(["-m", "verilate"])
            .arg(folder)
            .args(options)
            .current_dir(folder)
            .env("PYTHONPATH", paths::root().join("gateware"))
            .env("PYTHONDONTWRITEBYTECODE", "1"),
    )
}

/// Makes a bitstream of the output of [`generate`], and prints its summary.
fn make_bitstream(folder: &Path) -> Result<()> {
    let gateware = paths::root().join("gateware");
    let stamp = folder.join("bitstream.stamp");
    let generated = folder.join("generated.stamp");
    let inputs = fingerprint(&[gateware.join("ecp5"), generated], "")?;
    let summary = folder.join("bitstream.txt");
    if !is_current(&stamp, &inputs) || !summary.exists() {
        for (step, name) in [
            ("synthesis", "synthesis (ulx3s)"),
            ("route", "place and route (ulx3s)"),
            ("bitstream", "bitstream (ulx3s)"),
        ] {
            run::step(
                name,
                Command::new(paths::venv_program("python"))
                    .args(["-m", "ecp5", step])
                    .arg(folder)
                    .current_dir(folder)
                    .env("PYTHONPATH", &gateware)
                    .env("PYTHONDONTWRITEBYTECODE", "1"),
            )?;
        }
        fs::write(&stamp, inputs).with_context(|| format!("writing {}", stamp.display()))?;
    }
    let text =
        fs::read_to_string(&summary).with_context(|| format!("reading {}", summary.display()))?;
    for line in text.lines() {
        run::print_progress(&format!("  {line}"));
    }
    Ok(())
}

/// Returns a hash, as text, of `salt` and of the paths and contents of all files below `roots`.
fn fingerprint(roots: &[PathBuf], salt: &str) -> Result<String> {
    let mut hasher = DefaultHasher::new();
    salt.hash(&mut hasher);
    for root in roots {
        for path in files(root)? {
            path.hash(&mut hasher);
            fs::read(&path)
                .with_context(|| format!("reading {}", path.display()))?
                .hash(&mut hasher);
        }
    }
    Ok(format!("{:016x}\n", hasher.finish()))
}

/// Lists all files below the folder `root` in a fixed order, without Python's caches. If `root` is a file, lists that file only.
fn files(root: &Path) -> Result<Vec<PathBuf>> {
    if !root.is_dir() {
        return Ok(vec![root.to_owned()]);
    }
    let mut entries = fs::read_dir(root)
        .and_then(|entries| {
            entries
                .map(|entry| entry.map(|entry| entry.path()))
                .collect::<Result<Vec<_>, _>>()
        })
        .with_context(|| format!("listing {}", root.display()))?;
    entries.sort();
    let mut found = Vec::new();
    for entry in entries {
        if entry.file_name() != Some(OsStr::new("__pycache__")) {
            found.extend(files(&entry)?);
        }
    }
    Ok(found)
}

/// Whether the last build had the same fingerprint `inputs`, which it wrote to the file `stamp`.
fn is_current(stamp: &Path, inputs: &str) -> bool {
    fs::read_to_string(stamp).is_ok_and(|last| last == inputs)
}
