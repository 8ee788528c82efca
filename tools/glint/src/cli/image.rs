//! `glint image`.

use super::messages::{print_json, say};
use super::output::{IMAGE, Output};
use clap::{Args, Subcommand};
use glint::formats::{read_file, read_up_to};
use glint::image;
use glint::program;
use glint_core::flash::{CONTENTS, FIRMWARE, Image};
use glint_core::wire::crc32;
use std::path::{Path, PathBuf};
use virtual_board::virtual_flash::MAX_BYTES;

/// Make, list or check images for a board's SPI flash: bitstream, firmware and scenes (docs/formats/flash.md, "Flash image").
#[derive(Subcommand)]
pub enum ImageCommand {
    Make(MakeArguments),
    List(ListArguments),
    Check(CheckArguments),
}

/// Make an image from a firmware, scenes with their meshes, and optionally a bitstream.
#[derive(Args)]
pub struct MakeArguments {
    /// Firmware or another program: an ELF file, or a flat binary for the start of main memory. `cargo xtask firmware` makes the firmware.
    #[arg(long, value_name = "FILE")]
    firmware: PathBuf,
    /// Bitstream of the FPGA, .bit or raw [default: none; the flash keeps its bitstream].
    #[arg(long, value_name = "FILE")]
    bitstream: Option<PathBuf>,
    /// Scenes that the board shows, separated by commas: built-in scenes, lists of scenes, or scene files.
    #[arg(
        long,
        value_name = "NAME|FILE.toml",
        value_delimiter = ',',
        default_value = "demo"
    )]
    scene: Vec<String>,
    /// Image to write.
    #[arg(long, value_name = "IMAGE.bin")]
    out: PathBuf,
    /// Print the size as JSON.
    #[arg(long)]
    json: bool,
}

/// The size of an image.
#[derive(serde::Serialize)]
struct Made<'a> {
    out: &'a Path,
    bytes: usize,
    items: usize,
}

/// List the parts of an image.
#[derive(Args)]
pub struct ListArguments {
    /// Image to read.
    image: PathBuf,
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

/// Check images: lengths, checksums, meshes, commands of scenes, and names in lists.
#[derive(Args)]
pub struct CheckArguments {
    /// Images to read.
    #[arg(required = true)]
    images: Vec<PathBuf>,
    /// Print the names of the valid images as JSON.
    #[arg(long)]
    json: bool,
}

impl ImageCommand {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Make(arguments) => arguments.run(),
            Self::List(arguments) => arguments.run(),
            Self::Check(arguments) => arguments.run(),
        }
    }
}

impl MakeArguments {
    fn run(self) -> anyhow::Result<()> {
        let inputs = [&self.firmware].into_iter().chain(&self.bitstream);
        let scenes = self.scene.iter().map(PathBuf::from);
        let out = Output::open(&self.out, IMAGE, inputs.cloned().chain(scenes))?;
        let firmware = program::read(&self.firmware)?.image;
        let bitstream = match &self.bitstream {
            Some(path) => {
                let file = read_file(path)?;
                let bytes = image::bitstream(&file).map_err(|error| error.in_path(path))?;
                bytes.to_vec()
            }
            None => Vec::new(),
        };
        let scenes = self.scene.iter().map(|name| super::scene::read(name));
        let pieces = image::pieces(&scenes.collect::<Result<Vec<_>, _>>()?)?;
        let made = image::make(&bitstream, &firmware, &pieces);
        let made = made.map_err(|error| error.in_path(&self.out))?;
        out.write(|out| out.write_all(&made))?;
        let made = Made {
            out: &self.out,
            bytes: made.len(),
            items: pieces.len(),
        };
        if self.json {
            return print_json(&made);
        }
        let Made { out, bytes, items } = made;
        say(format_args!(
            "{}: {bytes} bytes, {items} items",
            out.display()
        ))
    }
}

/// A part of an image: its offset and length in bytes.
#[derive(serde::Serialize)]
struct Part<'a> {
    kind: &'static str,
    name: &'a str,
    offset: usize,
    bytes: usize,
    crc32: u32,
}

fn parts<'a>(image: &Image<'a>) -> Vec<Part<'a>> {
    let part = |kind, name, offset, bytes: &[u8]| Part {
        kind,
        name,
        offset,
        bytes: bytes.len(),
        crc32: crc32(bytes),
    };
    let bitstream = image
        .bitstream
        .map(|bytes| part("bitstream", "-", 0, bytes));
    let firmware = part("firmware", "-", FIRMWARE, image.firmware);
    let items = image.contents.items().map(|item| {
        // The image has been checked, so each part lies within it.
        let bytes = item.checked().unwrap_or_default();
        part(item.kind.name(), item.name, CONTENTS + item.offset(), bytes)
    });
    bitstream
        .into_iter()
        .chain([firmware])
        .chain(items)
        .collect()
}

impl ListArguments {
    fn run(self) -> anyhow::Result<()> {
        let bytes = read_up_to(&self.image, MAX_BYTES)?;
        let image = image::check(&bytes).map_err(|error| error.in_path(&self.image))?;
        let parts = parts(&image);
        if self.json {
            return print_json(&parts);
        }
        parts.iter().try_for_each(|part| {
            say(format_args!(
                "{:9} {:24} at {:#08x}  {:8} bytes  CRC-32 {:#010x}",
                part.kind, part.name, part.offset, part.bytes, part.crc32
            ))
        })
    }
}

impl CheckArguments {
    fn run(self) -> anyhow::Result<()> {
        for path in &self.images {
            let bytes = read_up_to(path, MAX_BYTES)?;
            image::check(&bytes).map_err(|error| error.in_path(path))?;
            if !self.json {
                say(format_args!("{}: valid", path.display()))?;
            }
        }
        if self.json {
            return print_json(&self.images);
        }
        Ok(())
    }
}
