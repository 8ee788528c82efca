//! `cargo xtask gateware`: the SoC of a board, and the virtual board's library.
//!
//! LiteX writes Verilog, the BIOS and the list of registers to `target/gateware/BOARD`. For the virtual board, `gateware/verilate`
//! makes `libglint_soc.so` of the Verilog; for the ULX3S, `gateware/ecp5` makes a bitstream. Each part is skipped if its inputs
//! have not changed.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::builder::PossibleValuesParser;
use glint_core::block::Block;
use glint_scene_file::{Needs, SceneFile};
use litex_pac::variant::VARIANTS;

use crate::{paths, run, scenes};

/// A target board of the gateware.
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
    /// Name in paths and in arguments of `glint_soc`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Virtual => "virtual",
            Self::Urbana => "urbana",
            Self::Ulx3s => "ulx3s",
        }
    }

    /// Whether the board has the block's pins. The ULX3S has no digits, and its SoC cannot read the flash.
    const fn has(self, block: Block) -> bool {
        match self {
            Self::Virtual | Self::Urbana => true,
            Self::Ulx3s => !matches!(block, Block::Flash | Block::Digits),
        }
    }

    /// The needs of scenes, without blocks for which the board has no pins, and with the SPI flash, from which a board starts without a
    /// host.
    pub fn needs(self, scenes: &[SceneFile]) -> Needs {
        let mut needs = Needs::of(scenes);
        needs.blocks.insert(Block::Flash);
        needs.blocks.retain(|block| self.has(*block));
        needs
    }

    /// Build folder.
    pub fn folder(self) -> PathBuf {
        paths::target().join("gateware").join(self.name())
    }
}

/// The build options that `cargo xtask gateware` and the program `glint_soc` share.
#[derive(clap::Args)]
pub struct Options {
    /// Build exactly what these scenes need, with the SPI flash from which a board starts: names of built-in scenes, scene files, or
    /// `all`
    #[arg(long, value_name = "NAME|FILE.toml|all", value_delimiter = ',', conflicts_with_all = ["smooth", "texture", "no_sky", "fog", "no_antialiasing", "no_geometry", "no_depths", "fields", "lanes"])]
    scene: Vec<String>,
    /// Build the triangle engine with smooth shading
    #[arg(long)]
    smooth: bool,
    /// Build the triangle engine with textures, which it draws under flat light
    #[arg(long, conflicts_with = "smooth")]
    texture: bool,
    /// Leave out the sky behind meshes
    #[arg(long)]
    no_sky: bool,
    /// Build the triangle engine with fog
    #[arg(long)]
    fog: bool,
    /// Leave out pictures with four samples a pixel
    #[arg(long)]
    no_antialiasing: bool,
    /// Leave out the geometry pass of the triangle engine: the soft core makes the descriptors of meshes
    #[arg(long)]
    no_geometry: bool,
    /// Leave out the depth buffer, which a build without `triangle` does not need for pictures
    #[arg(long)]
    no_depths: bool,
    /// Fields of the raymarcher: `all`, `round`, `faces` or `sponge` (docs/raymarch.md), or features with commas between them:
    /// `menger:LEVELS`, `box`, `octahedron`, `spheres`, `lattice`, `fillets`, `stereo`, `normals`, `highlight`, `shadow`, `cone` [default: all; faces for a board with an FPGA]
    #[arg(long)]
    fields: Option<String>,
    /// Evaluations of the field per clock: 1, 2 or 4 [default: depends on the fields]
    #[arg(long)]
    lanes: Option<String>,
    /// Variant of the CPU, VexRiscv; docs/boards.md states the firmware for each [default: full]
    #[arg(long, value_name = "VARIANT", value_parser = PossibleValuesParser::new(VARIANTS.map(|variant| variant.name)))]
    cpu: Option<String>,
    /// Frequency of the system clock in MHz, a multiple of 0.25 [default: the scenes' frequency, else 81.25, or 40 for the ulx3s]
    #[arg(long, value_name = "MHZ")]
    clock: Option<String>,
    /// Optional blocks of the build: `scanout`, `triangle`, `raymarch` (without `triangle` the gateware draws fields alone), `line` (a
    /// part of the triangle engine), `gesture`, `flash`, `i2c` (for the motion sensor), `digits` [default: all; all but `flash`, `digits` and
    /// `raymarch` for the ulx3s]. With `--scene`: further blocks
    #[arg(long, value_parser = PossibleValuesParser::new(Block::NAMES), hide_possible_values = true, value_delimiter = ',', num_args = 1..)]
    blocks: Vec<String>,
}

impl Options {
    /// The options as arguments of `glint_soc` for a board.
    ///
    /// # Errors
    /// A scene cannot be read, or, without `--clock`, the scenes state different clocks.
    pub fn arguments(&self, board: Board) -> Result<Vec<String>> {
        let mut arguments = Vec::new();
        let mut clock = self.clock.clone();
        if !self.scene.is_empty() {
            let scenes = scenes::read(&self.scene)?;
            let mut needs = board.needs(&scenes);
            let is_further = |block: &Block| self.blocks.iter().any(|name| name == block.name());
            needs
                .blocks
                .extend(Block::ALL.into_iter().filter(is_further));
            needs.sky |= is_further(&Block::Triangle);
            needs.antialiasing |= is_further(&Block::Triangle);
            needs.geometry |= needs.blocks.contains(&Block::Line) || is_further(&Block::Triangle);
            needs.depths |= needs.blocks.contains(&Block::Triangle);
            arguments = needs.options();
            if clock.is_none() {
                clock = scenes::clock(&scenes)?.map(|clock| clock.to_string());
            }
        } else if !self.blocks.is_empty() {
            arguments.push("--blocks".to_owned());
            arguments.extend(self.blocks.iter().cloned());
        }
        let flags = [
            ("--smooth", self.smooth),
            ("--texture", self.texture),
            ("--no-sky", self.no_sky),
            ("--fog", self.fog),
            ("--no-antialiasing", self.no_antialiasing),
            ("--no-geometry", self.no_geometry),
            ("--no-depths", self.no_depths),
        ];
        for (name, _) in flags.into_iter().filter(|(_, is_set)| *is_set) {
            arguments.push(name.to_owned());
        }
        let values = [
            ("--fields", &self.fields),
            ("--lanes", &self.lanes),
            ("--cpu", &self.cpu),
            ("--clock", &clock),
        ];
        for (name, value) in values {
            if let Some(value) = value {
                arguments.extend([name.to_owned(), value.clone()]);
            }
        }
        Ok(arguments)
    }
}

/// Builds the gateware of `board`, if it is out of date.
///
/// # Errors
/// A tool is missing or fails. The output of a failed tool is printed.
pub fn build(board: Board) -> Result<()> {
    build_with(board, &[])
}

/// Builds the gateware of `board` with `options` of `glint_soc` in the folder of the standard build, which it replaces.
///
/// # Errors
/// Those of [`build`].
pub fn build_with(board: Board, options: &[&str]) -> Result<()> {
    let folder = board.folder();
    generate(board, &folder, options)?;
    match board {
        Board::Virtual => verilate(&folder, Library::Profiled),
        Board::Urbana => Ok(()),
        Board::Ulx3s => make_bitstream(&folder),
    }
}

/// Builds the virtual board as `library` with `options` of `glint_soc` in `target/gateware/virtual-NAME`, beside the standard
/// build. Returns the folder.
///
/// # Errors
/// Those of [`build`].
pub fn build_beside(name: &str, options: &[&str], library: Library) -> Result<PathBuf> {
    let folder = generate_beside(Board::Virtual, name, options)?;
    verilate(&folder, library)?;
    Ok(folder)
}

/// Generates the gateware of `board` with `options` of `glint_soc`, beside the standard build. Returns its folder: in `target/gateware`, the
/// board's name, a hyphen and `name`.
///
/// # Errors
/// Those of [`build`].
pub fn generate_beside(board: Board, name: &str, options: &[&str]) -> Result<PathBuf> {
    let folder = board
        .folder()
        .with_file_name(format!("{}-{name}", board.name()));
    generate(board, &folder, options)?;
    Ok(folder)
}

/// Builds the slower library of the virtual board that writes waveforms.
///
/// # Errors
/// Those of [`build`].
pub fn build_with_waveforms() -> Result<()> {
    let folder = Board::Virtual.folder();
    generate(Board::Virtual, &folder, &[])?;
    verilate(&folder, Library::Waveforms)
}

/// Runs LiteX if its inputs have changed since its last run. It writes Verilog, the BIOS and `csr.json` to `folder`.
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
        run::python(&["-m", "glint_soc", "--board", board.name(), "--output"])
            .arg(folder)
            .args(options)
            .current_dir(folder)
            // A cache of objects, because LiteX compiles the same C library again in another folder for each BIOS.
            .env("CCACHE", "ccache")
            .env("CCACHE_DIR", paths::target().join("ccache"))
            .env("CCACHE_BASEDIR", paths::target())
            .env("CCACHE_NOHASHDIR", "1"),
    )
    .context("running the gateware generator (`cargo xtask bootstrap` installs its packages)")?;
    fs::write(&stamp, inputs).with_context(|| format!("writing {}", stamp.display()))
}

/// Writes the committed files that are generated from the descriptions of blocks, records and shared numbers. With `check`, writes
/// nothing and fails if a file is stale.
///
/// # Errors
/// A description is wrong, or (with `check`) a file is stale.
pub fn write_generated(check: bool) -> Result<()> {
    run::foreground(
        "the generator of the committed files",
        run::python(&["-m", "glint_soc.packages"]).args(check.then_some("--check")),
    )
}

/// Compiler options for the library of the virtual board.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Library {
    /// Optimised for speed, with a branch profile.
    Profiled,
    /// Little optimisation and no profile: a shorter build for a board that runs only a few frames.
    Quick,
    /// Writes waveforms, and is slower.
    Waveforms,
}

/// Builds the library of the virtual board from the output of [`generate`].
fn verilate(folder: &Path, library: Library) -> Result<()> {
    let (name, options): (_, &[&str]) = match library {
        Library::Profiled => ("verilated SoC", &[]),
        Library::Quick => ("verilated SoC, compiled once", &["--quick"]),
        Library::Waveforms => ("verilated SoC with waveforms", &["--waveforms"]),
    };
    run::step(
        name,
        run::python(&["-m", "verilate"])
            .arg(folder)
            .args(options)
            .current_dir(folder),
    )
}

/// Builds a bitstream from the output of [`generate`], and prints its summary.
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
            ecp5_step(folder, step, name)?;
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

/// Runs a step of `gateware/ecp5` on the output of [`generate`].
fn ecp5_step(folder: &Path, step: &str, name: &str) -> Result<()> {
    run::step(
        name,
        run::python(&["-m", "ecp5", step])
            .arg(folder)
            .current_dir(folder),
    )
}

/// Numbers of used and of available cells, by kind of cell.
pub type Cells = BTreeMap<String, [u64; 2]>;

/// Counts the cells of the ULX3S's build with `options` of `glint_soc` in `target/gateware/ulx3s-NAME`. The build stops before place and
/// route.
///
/// # Errors
/// Those of [`build`].
pub fn ulx3s_cells(name: &str, options: &[&str]) -> Result<Cells> {
    let folder = generate_beside(Board::Ulx3s, name, options)?;
    let cells = folder.join("ecp5/cells.json");
    let stamp = folder.join("cells.stamp");
    let sources = [
        paths::root().join("gateware/ecp5"),
        folder.join("generated.stamp"),
    ];
    let inputs = fingerprint(&sources, "")?;
    if !is_current(&stamp, &inputs) || !cells.exists() {
        ecp5_step(
            &folder,
            "synthesis",
            &format!("synthesis of {name} (ulx3s)"),
        )?;
        ecp5_step(&folder, "pack", &format!("cells of {name} (ulx3s)"))?;
        fs::write(&stamp, inputs).with_context(|| format!("writing {}", stamp.display()))?;
    }
    let text =
        fs::read_to_string(&cells).with_context(|| format!("reading {}", cells.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{}", cells.display()))
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

/// Whether the file `stamp` has the fingerprint `inputs`, so that the last build had the same inputs.
fn is_current(stamp: &Path, inputs: &str) -> bool {
    fs::read_to_string(stamp).is_ok_and(|last| last == inputs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Arguments {
        #[command(flatten)]
        options: Options,
    }

    fn arguments(board: Board, line: &str) -> Vec<String> {
        let words = ["gateware"].into_iter().chain(line.split(' '));
        let parsed = Arguments::try_parse_from(words).unwrap();
        parsed.options.arguments(board).unwrap()
    }

    fn blocks(arguments: &[String]) -> Vec<&str> {
        let blocks = arguments.iter().skip_while(|word| *word != "--blocks");
        let blocks = blocks.skip(1).take_while(|word| !word.starts_with("--"));
        blocks.map(String::as_str).collect()
    }

    /// A board without a host starts from its flash, so every build for scenes needs the block `flash`.
    #[test]
    fn builds_for_scenes_start_from_the_flash() {
        for name in glint_scene_file::NAMES
            .into_iter()
            .chain(["all", "cubes,objects"])
        {
            let line = format!("--scene {name}");
            for board in [Board::Urbana, Board::Virtual] {
                let found = arguments(board, &line);
                assert!(blocks(&found).contains(&"flash"), "{name}: {found:?}");
            }
            let found = arguments(Board::Ulx3s, &line);
            let has_pins = |block: &&str| !["flash", "digits"].contains(block);
            assert!(blocks(&found).iter().all(has_pins), "{name}: {found:?}");
        }
    }

    #[test]
    fn a_build_has_the_default_cpu_unless_another_is_named() {
        let line = "--blocks scanout";
        assert_eq!(arguments(Board::Urbana, line), ["--blocks", "scanout"]);
        let found = arguments(Board::Urbana, &format!("{line} --cpu linux+no-dsp"));
        assert_eq!(found, ["--blocks", "scanout", "--cpu", "linux+no-dsp"]);
        let refused = Arguments::try_parse_from(["gateware", "--cpu", "minimal"]);
        let refused = refused.err().map(|error| error.to_string());
        assert!(refused.is_some_and(|error| error.contains("possible values: full, lite")));
    }

    #[test]
    fn blocks_are_added_to_those_of_scenes() {
        let found = arguments(Board::Ulx3s, "--scene cubes --blocks gesture line");
        let expected = ["gesture", "line", "raymarch", "scanout"];
        let mut blocks = blocks(&found);
        blocks.sort_unstable();
        assert_eq!(blocks, expected);
        assert_eq!(found.iter().filter(|word| *word == "--blocks").count(), 1);
        let found = arguments(Board::Urbana, "--blocks scanout raymarch");
        assert_eq!(found, ["--blocks", "scanout", "raymarch"]);
    }
}
