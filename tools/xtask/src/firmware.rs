//! `cargo xtask firmware`: builds the firmware image that the BIOS loads.

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};
use glint_program_image as image;
use glint_scene_file::{NAMES, Needs, SceneFile};
use litex_pac::memories::MAIN_RAM;
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, SectionKind};

use crate::gateware::Board;
use crate::{paths, run};

/// Package of the firmware.
const FIRMWARE: &str = "glint-firmware";

/// Package of the alternative kernels.
const VARIANTS: &str = "glint-variants";

/// Feature that adds kernels of other crates, for comparison by the console command `bench`.
const PEERS: &str = "peers";

/// Rust target of the soft core: RV32IM without an operating system.
pub const TARGET: &str = "riscv32im-unknown-none-elf";

/// Size in bytes of the main memory of `board`. The register access crate has the size for the virtual board and the Urbana; any
/// other board's gateware build writes it to `csr.json`.
fn main_ram(board: Board) -> Result<u64> {
    if board != Board::Ulx3s {
        return Ok(MAIN_RAM.size.into());
    }
    let path = board.folder().join("csr.json");
    let text = fs::read_to_string(&path).with_context(|| {
        format!(
            "reading {} (run `cargo xtask gateware --board {}` first)",
            path.display(),
            board.name()
        )
    })?;
    let soc: serde_json::Value = serde_json::from_str(&text)?;
    let size = soc["memories"]["main_ram"]["size"].as_u64();
    size.with_context(|| format!("{}: expected the size of main memory", path.display()))
}

/// The sizes of a firmware image in bytes.
pub struct Image {
    /// Length of the image.
    pub length: u64,
    /// Instructions, without constants.
    pub code: u64,
    /// Read-only data.
    pub constants: u64,
    /// Variables: initialised variables, which are also in the image, and zeroed variables.
    pub variables: u64,
    /// Address range of the stack, which grows down from the end.
    pub stack: Range<u64>,
}

/// Builds the firmware for `board` with all parts and with `features`. The image is `target/firmware/glint.bin` for the virtual
/// board and the Urbana, `glint-BOARD.bin` for another board, `glint-FEATURE….bin` with features.
///
/// # Errors
/// The firmware does not compile, or exceeds the SoC's memory.
pub fn build(board: Board, features: &[&str]) -> Result<Image> {
    let for_speed: &[&str] = match features.contains(&PEERS) {
        true => &[FIRMWARE, VARIANTS, "\"*\""],
        false => &[],
    };
    compile(board, features, true, features, for_speed)
}

/// Checks that the firmware with the report's kernels compiles and fits the memory. Unlike [`build`], the check compiles the crates that
/// have no functions in the SRAM with the standard optimisation, which takes less time.
///
/// # Errors
/// Those of [`build`].
pub fn check_peers() -> Result<Image> {
    let suffixes = [PEERS, "check"];
    compile(Board::Virtual, &suffixes, true, &[PEERS], &[FIRMWARE])
}

/// Builds the firmware for `board` with only the parts that `scenes` need, and with `features`. The image is `glint-SCENE….bin`,
/// or `glint-all.bin` for all built-in scenes; its name includes board and features as for [`build`].
///
/// # Errors
/// Those of [`build`].
pub fn build_for(board: Board, scenes: &[SceneFile], features: &[&str]) -> Result<Image> {
    let mut names: Vec<&str> = scenes.iter().map(SceneFile::name).collect();
    if names == NAMES {
        names = vec!["all"];
    }
    names.extend(features);
    let needs = Needs::of(scenes);
    let parts = needs.features.iter().map(|feature| feature.name);
    let parts: Vec<_> = parts.chain(features.iter().copied()).collect();
    compile(board, &names, false, &parts, &[])
}

/// Builds the firmware with `features`, and with the default features if `has_default`. `suffixes` are appended to the image's name. The
/// packages `for_speed`, where `"*"` is each from another project, are optimised for speed.
fn compile(
    board: Board,
    suffixes: &[&str],
    has_default: bool,
    features: &[&str],
    for_speed: &[&str],
) -> Result<Image> {
    let main_ram = main_ram(board)?;
    let names: &[&str] = match board {
        Board::Virtual | Board::Urbana => &["glint"],
        Board::Ulx3s => &["glint", board.name()],
    };
    let name = [names, suffixes].concat().join("-");
    let built = paths::target().join("firmware-build");
    let mut cargo = Command::new("cargo");
    cargo.args([
        "build",
        "--package",
        FIRMWARE,
        "--profile",
        "firmware",
        "--target",
        TARGET,
    ]);
    if !has_default {
        cargo.arg("--no-default-features");
    }
    cargo.arg("--features").arg(features.join(","));
    cargo.env("GLINT_MAIN_RAM_MB", (main_ram >> 20).to_string());
    // Generic functions of other crates are compiled as a part of the crate that uses them, so this level also applies to the
    // generic kernels of other crates that `bench` measures.
    for package in for_speed {
        cargo
            .arg("--config")
            .arg(format!("profile.firmware.package.{package}.opt-level = 3"));
    }
    // A separate target folder, because cargo locks a target folder during a build.
    cargo
        .arg("--target-dir")
        .arg(&built)
        .current_dir(paths::root());
    run::step(&format!("build firmware {name}"), &mut cargo)?;

    let elf = fs::read(built.join(TARGET).join("firmware/glint-firmware"))
        .context("reading the firmware")?;
    let bytes = image::of_elf(&elf, main_ram).with_context(|| format!("firmware {name}"))?;
    let folder = paths::target().join("firmware");
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    let path = folder.join(&name).with_extension("bin");
    write(&path.with_extension("elf"), &elf)?;
    write(&path, &bytes)?;
    let image = sizes(&elf, bytes.len() as u64)?;
    let Image {
        length,
        code,
        constants,
        variables,
        ..
    } = image;
    run::print_progress(&format!(
        "  {name}.bin: {length} bytes (code {code}, constants {constants}), variables {variables}"
    ));
    Ok(image)
}

/// Writes a file only if its contents change, to avoid a rebuild of everything that depends on it.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    fs::write(path, bytes).with_context(|| format!("writing {}", path.display()))
}

/// The sizes of an ELF file whose image has this `length`.
fn sizes(elf: &[u8], length: u64) -> Result<Image> {
    let file = ElfFile32::<Endianness>::parse(elf).context("not an ELF file")?;
    let size = |wanted: &[SectionKind]| -> u64 {
        let sections = file
            .sections()
            .filter(|section| wanted.contains(&section.kind()));
        sections
            .filter(|section| section.address() != 0 && section.name() != Ok(".stack"))
            .map(|s| s.size())
            .sum()
    };
    Ok(Image {
        length,
        code: size(&[SectionKind::Text]),
        constants: size(&[SectionKind::ReadOnlyData, SectionKind::ReadOnlyString]),
        variables: size(&[SectionKind::Data, SectionKind::UninitializedData]),
        stack: symbol(&file, "__ebss")?..symbol(&file, "_stack_start")?,
    })
}

/// The value of a symbol.
fn symbol(file: &ElfFile32<Endianness>, name: &str) -> Result<u64> {
    image::symbol(file, name).with_context(|| format!("no symbol {name}"))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use glint_core::feature;

    use crate::paths;

    /// Lists origin and length of each memory window in a file of `firmware/windows`, in the notation of the documents.
    fn windows(memory_x: &str) -> Vec<(String, String)> {
        let windows = memory_x.lines().filter_map(|line| {
            let (_, rest) = line.split_once(": ORIGIN = 0x")?;
            let (origin, length) = rest.split_once(", LENGTH = ")?;
            let (high, low) = origin.split_at_checked(4)?;
            let (number, unit) = length.split_at_checked(length.len() - 1)?;
            let unit = if unit == "M" { "MB" } else { "KiB" };
            Some((format!("0x{high}_{low}"), format!("{number} {unit}")))
        });
        windows.collect()
    }

    /// The default features of a manifest, which are the parts of the firmware.
    fn default_features(manifest: &str) -> Vec<String> {
        let text = fs::read_to_string(paths::root().join(manifest)).unwrap();
        let manifest: toml::Table = toml::from_str(&text).unwrap();
        let names = manifest["features"]["default"].as_array().unwrap();
        let names = names.iter().map(|name| name.as_str().unwrap().to_owned());
        names.collect()
    }

    #[test]
    fn every_part_is_a_feature_of_the_firmware() {
        let parts = feature::ALL.map(|part| part.name);
        for manifest in ["Cargo.toml", "firmware/core/Cargo.toml"] {
            assert_eq!(default_features(manifest), parts, "{manifest}");
        }
    }

    #[test]
    fn the_documented_memory_maps_are_those_of_the_linker() {
        let read = |path: &str| fs::read_to_string(paths::root().join(path)).unwrap();
        for (file, page) in [
            ("128.x", "docs/architecture.md"),
            ("32.x", "docs/boards.md"),
        ] {
            let windows = windows(&read(&format!("firmware/windows/{file}")));
            assert_eq!(windows.len(), 14, "{windows:?}");
            let documented = read(page);
            // The last window is in the SRAM; the page describes it in prose.
            for (origin, length) in windows
                .iter()
                .filter(|(origin, _)| origin.starts_with("0x4"))
            {
                let row = format!("| {origin} | {length} |");
                assert!(documented.contains(&row), "{page} has no row `{row}`");
            }
        }
    }
}
