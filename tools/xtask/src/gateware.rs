//! `cargo xtask gateware`: the SoC of a board, and the virtual board's library.
//!
//! LiteX writes Verilog, the BIOS and the SoC's description to `target/gateware/BOARD`. For the virtual board, Verilator
//! translates the Verilog to C++, and g++ compiles it with the harness of `tools/virtual-board/soc` to `libglint_soc.so`:
//! twice, because the first build collects the profile of the second. Each part is skipped if its inputs have not changed.

use std::ffi::OsStr;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};

use crate::{paths, run};

/// Board of a gateware.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Board {
    /// The verilated SoC.
    Virtual,
    /// The RealDigital Urbana, up to Verilog, constraints and a Vivado script.
    Urbana,
}

impl Board {
    /// Name in paths and on the command line of `glint_soc`.
    fn name(self) -> &'static str {
        match self {
            Self::Virtual => "virtual",
            Self::Urbana => "urbana",
        }
    }

    /// Build folder.
    fn folder(self) -> PathBuf {
        paths::target().join("gateware").join(self.name())
    }
}

/// Fields of a raymarcher: `BUILDS` of `glint_soc/raymarch.py`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Fields {
    /// Every field, with cones: two lanes
    All,
    /// No fillets, sponge up to depth 4, no cones: two lanes
    Round,
    /// As `round`, without spheres
    Faces,
    /// Sponge up to depth 4 only, with cones: four lanes
    Sponge,
}

impl Fields {
    /// Name on the command line of `glint_soc`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Round => "round",
            Self::Faces => "faces",
            Self::Sponge => "sponge",
        }
    }
}

/// Builds the gateware of `board`, if out of date.
///
/// # Errors
/// A tool is missing or fails; then its output is printed.
pub fn build(board: Board) -> Result<()> {
    build_with(board, &[])
}

/// Builds `board` with options of `glint_soc`; replaces the build without.
///
/// # Errors
/// As [`build`].
pub fn build_with(board: Board, options: &[&str]) -> Result<()> {
    let folder = board.folder();
    generate(board, &folder, options)?;
    if board == Board::Virtual {
        verilate(&folder, Waveforms::Without)?;
    }
    Ok(())
}

/// Builds the virtual board with the four lanes of [`Fields::Sponge`] in `target/gateware/virtual-sponge`; keeps the standard
/// build.
///
/// # Errors
/// As [`build`].
pub fn build_sponge_beside() -> Result<()> {
    let folder = Board::Virtual.folder().with_file_name("virtual-sponge");
    generate(
        Board::Virtual,
        &folder,
        &["--fields", Fields::Sponge.name()],
    )?;
    verilate(&folder, Waveforms::Without)
}

/// Builds the virtual board's second library, slower and with waveform output.
///
/// # Errors
/// As [`build`].
pub fn build_with_waveforms() -> Result<()> {
    let folder = Board::Virtual.folder();
    generate(Board::Virtual, &folder, &[])?;
    verilate(&folder, Waveforms::With)
}

/// Runs LiteX: Verilog, BIOS, `csr.json` and `soc.svd`.
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
    .context("the gateware generator: `cargo xtask bootstrap` installs what it needs")?;
    fs::write(&stamp, inputs).with_context(|| format!("writing {}", stamp.display()))
}

/// Waveform output of a library.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Waveforms {
    With,
    Without,
}

/// The top module of the virtual board's Verilog.
const TOP: &str = "glint_virtual";

/// Runs Verilator and g++ on the output of [`generate`] for a virtual board.
fn verilate(folder: &Path, waveforms: Waveforms) -> Result<()> {
    let harness = paths::root().join("tools/virtual-board/soc");
    let (objects, library) = match waveforms {
        Waveforms::Without => ("verilated", "libglint_soc.so"),
        Waveforms::With => ("verilated-trace", "libglint_soc_trace.so"),
    };
    let objects = folder.join(objects);
    let library = folder.join(library);
    let bios = folder.join("software/bios/bios.bin");
    let verilog = folder.join("gateware").join(TOP).with_extension("v");
    let exports = harness.join("glint_soc.vlt");
    let verilator = verilator_root()?;
    let mut flags = compiler_flags(waveforms);
    let includes = [
        &objects,
        &verilator.join("include"),
        &verilator.join("include/vltstd"),
    ];
    flags.extend(includes.iter().map(|path| format!("-I{}", path.display())));
    let mut harness_flags = flags.clone();
    harness_flags.push(format!("-DGLINT_BIOS=\"{}\"", bios.display()));
    harness_flags.extend(
        [&folder.join("software/include"), &harness].map(|path| format!("-I{}", path.display())),
    );

    // The model takes most of the compile time.
    // The build's own source counts as an input.
    let inputs = fingerprint(
        &[
            verilog.clone(),
            exports.clone(),
            paths::root().join("gateware/rtl"),
        ],
        include_str!("gateware.rs"),
    )?;
    let stamp = objects.join("model.stamp");
    if !is_current(&stamp, &inputs) {
        // The names of Verilator's output depend on its contents: no file of an older build may remain.
        if objects.exists() {
            fs::remove_dir_all(&objects)
                .with_context(|| format!("clearing {}", objects.display()))?;
        }
        fs::create_dir_all(&objects).with_context(|| format!("creating {}", objects.display()))?;
        run::step(
            "Verilator",
            Command::new(verilator.join("bin/verilator_bin"))
                .args([
                    "--cc",
                    "--no-timing",
                    "--flatten",
                    "-O3",
                    "--x-assign",
                    "fast",
                    "--x-initial",
                    "fast",
                ])
                .args(if waveforms == Waveforms::With {
                    &["--trace-vcd"][..]
                } else {
                    &[]
                })
                .args(["--prefix", "Vglint", "--top-module", TOP, "--Mdir"])
                .arg(&objects)
                .arg(&exports)
                .arg(&verilog)
                .arg("-f")
                .arg(verilog.with_extension("f"))
                .env("VERILATOR_ROOT", &verilator),
        )?;
        let (rare, hot): (Vec<_>, Vec<_>) = model_sources(&objects, &verilator, waveforms)?
            .into_iter()
            .partition(|path| runs_once(path));
        compile("compile the cold code", &rare, &objects, &flags)?;
        let mut hot_flags = flags.clone();
        // Writing waveforms takes most of the time: a profile gains little.
        if waveforms == Waveforms::Without {
            let train = ["glint_soc.cpp", "train.cpp"].map(|name| harness.join(name));
            compile(
                "compile the profiling run",
                &train,
                &objects,
                &harness_flags,
            )?;
            hot_flags.push("-fprofile-generate".into());
            compile("compile with profile counters", &hot, &objects, &hot_flags)?;
            profile(&objects)?;
            hot_flags.pop();
            // The BIOS does not run all code: the rest is optimized all the same.
            hot_flags.extend(["-fprofile-use", "-fprofile-partial-training"].map(String::from));
        }
        compile("compile the hot code", &hot, &objects, &hot_flags)?;
        fs::write(&stamp, &inputs).with_context(|| format!("writing {}", stamp.display()))?;
    }

    // The harness.
    let inputs = fingerprint(&[harness.clone(), bios.clone()], &inputs)?;
    let stamp = objects.join("library.stamp");
    if library.exists() && is_current(&stamp, &inputs) {
        return Ok(());
    }
    compile(
        "compile its harness",
        &[harness.join("glint_soc.cpp")],
        &objects,
        &harness_flags,
    )?;
    // A running board keeps its open library: the new one replaces it by a rename.
    let linked = objects.join("library.so");
    run::step(
        "link the virtual board",
        Command::new("g++")
            .arg("-shared")
            .args(object_files(&objects)?)
            .arg("-o")
            .arg(&linked),
    )?;
    fs::rename(&linked, &library).with_context(|| format!("placing {}", library.display()))?;
    fs::write(&stamp, inputs).with_context(|| format!("writing {}", stamp.display()))
}

/// Runs the training program in `objects`, which writes profile counters beside the object files: hot code, and branch
/// directions. A model compiled with the profile needs a quarter less time per cycle.
fn profile(objects: &Path) -> Result<()> {
    let program = objects.join("train");
    run::step(
        "link the profiling run",
        Command::new("g++")
            .arg("-fprofile-generate")
            .args(object_files(objects)?)
            .arg("-o")
            .arg(&program),
    )?;
    run::step("collect the profile", &mut Command::new(&program))?;
    let object = object(Path::new("train.cpp"), objects);
    fs::remove_file(&object).with_context(|| format!("removing {}", object.display()))
}

/// All object files in a folder.
fn object_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut objects = files(folder)?;
    objects.retain(|path| path.extension() == Some(OsStr::new("o")));
    Ok(objects)
}

/// Whether Verilator marks a source as slow: code that runs once.
fn runs_once(source: &Path) -> bool {
    source.to_string_lossy().contains("__Slow")
}

/// Compiler options of g++, without include paths.
fn compiler_flags(waveforms: Waveforms) -> Vec<String> {
    let trace = if waveforms == Waveforms::With { 1 } else { 0 };
    let mut flags = ["-std=gnu++17", "-O3", "-fPIC", "-fvisibility=hidden", "-w"]
        .map(String::from)
        .to_vec();
    flags.extend(["SC", "COVERAGE", "TIMING"].map(|what| format!("-DVM_{what}=0")));
    flags.extend(["TRACE", "TRACE_VCD"].map(|what| format!("-DVM_{what}={trace}")));
    flags
}

/// Verilator's output in `objects`, and its runtime.
fn model_sources(objects: &Path, verilator: &Path, waveforms: Waveforms) -> Result<Vec<PathBuf>> {
    let mut sources = files(objects)?;
    sources.retain(|path| path.extension() == Some(OsStr::new("cpp")));
    let runtime = verilator.join("include");
    sources.extend(["verilated.cpp", "verilated_threads.cpp"].map(|name| runtime.join(name)));
    if waveforms == Waveforms::With {
        sources.push(runtime.join("verilated_vcd_c.cpp"));
    }
    Ok(sources)
}

/// Compiles every source to an object file in `folder`, one per core at a time. `name` is the step's name.
fn compile(name: &str, sources: &[PathBuf], folder: &Path, flags: &[String]) -> Result<()> {
    let start = Instant::now();
    // The largest first: they determine the end of the step.
    let mut queue: Vec<&PathBuf> = sources.iter().collect();
    queue.sort_by_key(|path| std::cmp::Reverse(fs::metadata(path).map_or(0, |data| data.len())));
    let style = ProgressStyle::with_template("  {bar:30} {pos}/{len}  {elapsed}  {msg}")?;
    let bar = ProgressBar::new(queue.len() as u64)
        .with_style(style)
        .with_message(name.to_owned());
    let next = AtomicUsize::new(0);
    let work = || -> Result<()> {
        while let Some(source) = queue.get(next.fetch_add(1, Ordering::Relaxed)) {
            let output = Command::new("g++")
                .args(flags)
                .args(runs_once(source).then_some("-O1"))
                .arg("-c")
                .arg(source)
                .arg("-o")
                .arg(object(source, folder))
                .output()
                .context("g++: not found; `cargo xtask bootstrap` installs it")?;
            if !output.status.success() {
                bail!(
                    "g++ {}:\n{}",
                    source.display(),
                    String::from_utf8_lossy(&output.stderr)
                );
            }
            bar.inc(1);
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().expect("a compiling thread does not panic"))
    })?;
    bar.finish_and_clear();
    println!("  ok   {:6.1} s  {name}", start.elapsed().as_secs_f64());
    Ok(())
}

/// Object file of `source`.
fn object(source: &Path, folder: &Path) -> PathBuf {
    folder
        .join(source.file_name().unwrap_or_default())
        .with_extension("o")
}

/// Folder of the pinned Verilator in the Python environment.
fn verilator_root() -> Result<PathBuf> {
    let output = Command::new(paths::venv_program("python"))
        .args([
            "-c",
            "import os, verilator; print(os.path.dirname(verilator.__file__), end='')",
        ])
        .output()
        .context("python: `cargo xtask bootstrap` makes the Python environment")?;
    if !output.status.success() {
        bail!("Verilator is not in the Python environment: `cargo xtask bootstrap` installs it");
    }
    Ok(PathBuf::from(String::from_utf8(output.stdout)?))
}

/// A line that changes with any file below `roots`, and with `salt`.
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

/// All files below `root` in a fixed order, or `root` itself if it is a file; without Python's caches.
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

/// Whether the last build had the same `inputs`.
fn is_current(stamp: &Path, inputs: &str) -> bool {
    fs::read_to_string(stamp).is_ok_and(|last| last == inputs)
}
