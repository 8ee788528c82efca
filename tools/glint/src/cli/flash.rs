//! `glint flash` and `glint upload`.

use super::common::{Baud, LineArguments, bad_value};
use super::config::BoardChoice;
use super::convert::load;
use super::loading::{Loading, WAIT_SECONDS};
use super::messages::{note, print_json, say, warn};
use super::progress::{advance, bar, show_simulation};
use super::texture::{MeshTextureArguments, load_texture, print_textures};
use super::wireframe::read as read_program;
use anyhow::Context;
use clap::Args;
use glint::board::{self, Board, SerialBoard};
use glint::console::Console;
use glint::convert::{Options, TextureReport};
use glint::formats::read_up_to;
use glint::image;
use glint::model::board_name;
use glint::program;
use glint::render::BoardRenderer;
use glint::texture::is_texture;
use glint::transfer;
use glint_core::flash::FIRMWARE;
use glint_core::matrix::Axis;
use glint_core::mesh::{MAX_NAME, is_name};
use glint_core::wireframe::is_program_file;
use std::io::{self, Write};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::Command;
use virtual_board::virtual_flash::MAX_BYTES;

/// Load a program onto a board through its BIOS, and start it; with --spi, write an image to the board's SPI flash.
///
/// Uses LiteX's serial boot (SFL). Damaged frames are sent again, in smaller pieces. With --spi,
/// openFPGALoader writes the parts of the image over the Urbana's USB port. An image without a
/// bitstream does not change the bitstream in the flash.
#[derive(Args)]
pub struct FlashArguments {
    /// Program to load: an ELF file, a flat binary, or `-` for standard input; with --spi, an image made by `glint image make`.
    program: PathBuf,
    /// Write an image to the SPI flash of an Urbana with openFPGALoader.
    #[arg(long, conflicts_with_all = ["board", "address", "no_output", "wait", "baud", "json"])]
    spi: bool,
    #[command(flatten)]
    board: BoardChoice,
    /// Load address and entry point of the program, a multiple of 4 in main memory.
    #[arg(long, default_value = "0x40000000", value_parser = parse_address)]
    address: u32,
    /// Do not expect text from the program. By default a program that prints nothing within 10 seconds of the board's time is an
    /// error.
    #[arg(long)]
    no_output: bool,
    /// Longest wait for the BIOS's request, in seconds of the board's time. The BIOS sends the
    /// request after a reset and after the command `reboot`, which the host sends.
    #[arg(long, default_value_t = WAIT_SECONDS, value_name = "SECONDS")]
    wait: u64,
    #[command(flatten)]
    baud: Baud,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

/// Upload a model, a texture or a wireframe program to a board under a name and show it; other uploads stay on the board.
///
/// An uploaded texture replaces the texture of every textured face; the rest of the scene stays.
#[derive(Args)]
pub struct UploadArguments {
    /// Mesh file, name of a generator, texture (a PNG, JPEG or .glt file), or wireframe program (.wft or .wfb).
    model: String,
    /// Name on the board, at most 24 visible characters of ASCII [default: a mesh file's name without its extension, the name of a texture
    /// or program file, or `model` for a generator].
    #[arg(long, value_parser = mesh_name)]
    name: Option<String>,
    #[command(flatten)]
    board: BoardChoice,
    /// Keep the model's coordinates; coordinates outside [-2, 2) are an error.
    #[arg(long)]
    keep_scale: bool,
    #[command(flatten)]
    textures: MeshTextureArguments,
    /// Keep camera, objects and all other settings of the scene, as for a texture. By default the default scene shows
    /// the whole model, with the axis up that is usual in its format.
    #[arg(long)]
    keep_scene: bool,
    #[command(flatten)]
    line: LineArguments,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

fn mesh_name(text: &str) -> Result<String, String> {
    let expected = format!("expected 1 to {MAX_NAME} visible characters of ASCII");
    is_name(text).then(|| text.to_owned()).ok_or(expected)
}

/// Addresses of main memory on every board.
const MAIN_MEMORY: RangeInclusive<u32> = 0x4000_0000..=0x7fff_fffc;

fn parse_address(text: &str) -> Result<u32, String> {
    let digits = text
        .strip_prefix("0x")
        .ok_or("expected 0x and hexadecimal digits")?;
    let address = u32::from_str_radix(digits, 16).map_err(|error| error.to_string())?;
    let is_valid = MAIN_MEMORY.contains(&address) && address.is_multiple_of(4);
    is_valid.then_some(address).ok_or(format!(
        "expected a multiple of 4 from {:#x} to {:#x}",
        MAIN_MEMORY.start(),
        MAIN_MEMORY.end()
    ))
}

impl FlashArguments {
    pub fn run(self) -> anyhow::Result<()> {
        if self.spi {
            return write_flash(&self.program);
        }
        let name = self.board.name()?;
        self.baud.check(&name)?;
        let program = program::read(&self.program)?.image;
        let mut board: Box<dyn Board> = match board::simulated(&name, None)? {
            Some(board) => {
                show_simulation(board.meter());
                Box::new(board)
            }
            None => Box::new(SerialBoard::open(&name.to_string(), self.baud.rate()?)?),
        };
        let loading = Loading {
            address: self.address,
            wait_ms: self.wait * 1000,
            awaits_text: !self.no_output,
        };
        let report = loading.load(&mut *board, &program)?;
        if self.json {
            return print_json(&report);
        }
        say(format_args!(
            "{} bytes in {} ms of the board's time: {} frames, {} retries",
            report.bytes, report.milliseconds, report.frames, report.retries
        ))
    }
}

/// openFPGALoader's name of a board with the same FPGA and USB bridge as the Urbana, for which
/// openFPGALoader has no entry.
const LOADER_BOARD: &str = "arty_s7_50";

/// Checks an image, and writes it to the SPI flash, starting with the first part that the image
/// contains.
fn write_flash(path: &Path) -> anyhow::Result<()> {
    let bytes = read_up_to(path, MAX_BYTES)?;
    let image = image::check(&bytes).map_err(|error| error.in_path(path))?;
    let offset = match image.bitstream {
        Some(_) => 0,
        None => FIRMWARE,
    };
    // openFPGALoader recognises a raw file by its extension.
    let mut file = tempfile::Builder::new().suffix(".bin").tempfile()?;
    file.write_all(bytes.get(offset..).unwrap_or_default())?;
    let status = Command::new("openFPGALoader")
        .args(["--board", LOADER_BOARD, "--write-flash", "--offset"])
        .arg(offset.to_string())
        .arg(file.path())
        .status();
    let status = match status {
        Err(error) if error.kind() == io::ErrorKind::NotFound => anyhow::bail!(
            "openFPGALoader: expected the program in PATH, found none; `apt-get install openfpgaloader` installs it"
        ),
        status => status.context("openFPGALoader")?,
    };
    anyhow::ensure!(
        status.success(),
        "openFPGALoader: expected success, found {status}; its messages are above"
    );
    say(format_args!(
        "{} bytes at {offset:#x} of the flash",
        bytes.len() - offset
    ))
}

/// The kind of an upload.
#[derive(Clone, Copy)]
enum Kind {
    /// A mesh, with the axis that points up.
    Mesh { up: Axis },
    /// A texture.
    Texture,
    /// A wireframe program.
    Program,
}

/// An upload in the form for the board.
struct Loaded {
    bytes: Vec<u8>,
    kind: Kind,
    /// Reports on the converted textures.
    textures: Vec<TextureReport>,
}

impl UploadArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let Loaded {
            bytes,
            kind,
            textures,
        } = self.load()?;
        let board = self.board.name()?;
        if board.is_simulated() {
            note(
                "the board ends with this command; `glint board` runs a board that keeps running, on a serial port",
            );
        }
        let mut board = self.line.board(&board)?;
        let name = self.name.or_else(|| board_name(&self.model));
        let start = board.now_ms();
        let bar = bar("upload");
        let mut renderer =
            BoardRenderer::new(Console::new(&mut *board)).with_progress(advance(&bar));
        let notes = match kind {
            Kind::Program => renderer.upload_program(&bytes, name.as_deref())?,
            Kind::Mesh { .. } | Kind::Texture => renderer.upload(&bytes, name.as_deref())?,
        };
        if let (Kind::Mesh { up }, false) = (kind, self.keep_scene) {
            let name = name.as_deref().unwrap_or(transfer::MODEL);
            transfer::show(renderer.console(), name, up)?;
        }
        drop(renderer);
        bar.finish();
        let milliseconds = board.now_ms() - start;
        notes.iter().for_each(note);
        if self.json {
            let mut report =
                serde_json::json!({ "bytes": bytes.len(), "milliseconds": milliseconds });
            if !textures.is_empty() {
                report["textures"] = serde_json::to_value(textures)?;
            }
            return print_json(&report);
        }
        print_textures(&textures)?;
        say(format_args!(
            "{} bytes in {milliseconds} ms of the board's time",
            bytes.len()
        ))
    }

    /// Checks that no option is given that only meshes have.
    fn check_no_mesh(&self, found: &str) -> anyhow::Result<()> {
        for (is_given, option) in [
            (self.keep_scale, "--keep-scale"),
            (self.textures.options().left_out, "--no-textures"),
            (self.keep_scene, "--keep-scene"),
        ] {
            if is_given {
                return Err(bad_value(option, "a mesh", found).into());
            }
        }
        Ok(())
    }

    fn load(&self) -> anyhow::Result<Loaded> {
        let textures = self.textures.options();
        let path = Path::new(&self.model);
        if is_program_file(&self.model) {
            self.check_no_mesh("a wireframe program")?;
            self.textures
                .refuse("a mesh or a texture", "a wireframe program")?;
            return Ok(Loaded {
                bytes: read_program(path)?,
                kind: Kind::Program,
                textures: Vec::new(),
            });
        }
        if is_texture(&self.model) {
            self.check_no_mesh("a texture")?;
            let (bytes, report) = load_texture(path, &textures)?;
            return Ok(Loaded {
                bytes,
                kind: Kind::Texture,
                textures: vec![report],
            });
        }
        let options = Options {
            keep_scale: self.keep_scale,
            textures,
            ..Options::default()
        };
        let model = load(&self.model, options)?;
        if let Some(remark) = model.inside_out() {
            warn(format_args!("{}: {remark}", self.model.escape_debug()));
        }
        Ok(Loaded {
            textures: model.textures().to_vec(),
            bytes: model.mesh,
            kind: Kind::Mesh { up: model.up },
        })
    }
}
