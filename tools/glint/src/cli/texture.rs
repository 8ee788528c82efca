//! `glint texture`, and the options of textures.

use super::common::{bad_value, named};
use super::messages::{print_json, say};
use super::output::{Output, STDOUT, TEXTURE};
use clap::{Args, ValueEnum};
use glint::convert::{TextureOptions, TextureReport};
use glint::error::{FormatError, InputError, quote};
use glint::formats::read_file;
use glint::texture::{self, CUTOFF};
use glint_core::texture::{Blend, Filter, Format, Wrap};
use glint_texture::options::{MAX_SIDE, MIN_SIDE, blend_name, filter_name, wrap_name};
use glint_texture::sheet::sheet;
use std::path::{Path, PathBuf};

/// Options for the texels of textures.
#[derive(Args)]
pub struct TexelArguments {
    /// Representation of texels: indices of a palette of 16 or 256 colours, or `none` for colours
    /// in RGB565 [default: none; a texture in a board's memory layout keeps its representation].
    #[arg(long, value_name = "16|256|none", value_parser = named(Format::ALL, palette_name))]
    palette: Option<Format>,
    /// Largest side of a texture in texels. The sides become the nearest powers of two up to this
    /// number [default: 1024].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(i64::from(MIN_SIDE)..=i64::from(MAX_SIDE)))]
    texture_size: Option<u32>,
    /// Filter: the colour of the nearest texel, or bilinear interpolation of four texels [default:
    /// from the file, otherwise bilinear].
    #[arg(long, value_name = "nearest|bilinear", value_parser = named(Filter::ALL, filter_name))]
    filter: Option<Filter>,
    /// Opacity of textures in eighths, over the picture behind them; `add` adds their colours to it,
    /// and `none` makes them opaque [default: from the file, otherwise none].
    #[arg(long, value_name = "1..7|add|none", value_parser = named(Blend::ALL, blend_name))]
    blend: Option<Blend>,
}

impl TexelArguments {
    /// The options of the conversion of a mesh's textures.
    pub fn options(&self) -> TextureOptions {
        TextureOptions {
            left_out: false,
            format: self.palette,
            largest_side: self.texture_size.unwrap_or(MAX_SIDE),
            filter: self.filter,
            blend: self.blend,
        }
    }

    /// Checks that no option is given. `expected` names what the options require, and `instead`
    /// what was given in its place.
    ///
    /// # Errors
    /// An option is given.
    pub fn refuse(&self, expected: &str, instead: &str) -> Result<(), InputError> {
        let given = [
            (self.palette.is_some(), "--palette"),
            (self.texture_size.is_some(), "--texture-size"),
            (self.filter.is_some(), "--filter"),
            (self.blend.is_some(), "--blend"),
        ];
        match given.iter().find(|(is_given, _)| *is_given) {
            Some((_, option)) => Err(bad_value(option, expected, instead)),
            None => Ok(()),
        }
    }
}

/// The textures of a mesh that a command reads.
#[derive(Args)]
pub struct MeshTextureArguments {
    /// Leave textures out: faces keep the colours of their materials.
    #[arg(long, conflicts_with_all = ["palette", "texture_size", "filter", "blend"])]
    no_textures: bool,
    #[command(flatten)]
    texels: TexelArguments,
}

impl MeshTextureArguments {
    /// The options of the conversion.
    pub fn options(&self) -> TextureOptions {
        TextureOptions {
            left_out: self.no_textures,
            ..self.texels.options()
        }
    }

    /// Checks that no option of texels is given, like [`TexelArguments::refuse`].
    ///
    /// # Errors
    /// An option is given.
    pub fn refuse(&self, expected: &str, instead: &str) -> Result<(), InputError> {
        self.texels.refuse(expected, instead)
    }
}

/// Reads a texture file, and converts it with these options.
pub fn load_texture(
    path: &Path,
    options: &TextureOptions,
) -> Result<(Vec<u8>, TextureReport), InputError> {
    let (bytes, report) = texture::load(path, options)?;
    let name = quote(path.as_os_str().as_encoded_bytes());
    Ok((bytes, TextureReport { name, report }))
}

/// Prints a line for each texture that was converted: sizes, bytes and errors.
pub fn print_textures(textures: &[TextureReport]) -> anyhow::Result<()> {
    textures.iter().try_for_each(|texture| {
        say(format_args!(
            "texture    {}: {}",
            texture.name, texture.report
        ))
    })
}

/// The value of `--palette` for a representation of texels.
fn palette_name(format: Format) -> &'static str {
    match format {
        Format::Rgb565 => "none",
        Format::Palette256 => "256",
        Format::Palette16 => "16",
    }
}

/// Convert a picture to a texture: sides that are powers of two, mip levels averaged in linear
/// light, and texels in RGB565 or from a palette.
///
/// Reads PNG and JPEG files, and textures in a board's memory layout. A .png output shows the mip
/// levels side by side in the colours that a board shows. The error in the report is the difference
/// from the resized picture, in steps of 1/255.
#[derive(Args)]
pub struct TextureArguments {
    /// PNG, JPEG or .glt file to read; `-` is standard input. The content determines the format.
    input: PathBuf,
    /// Output file; the extension selects the format: .glt or .png. `-` is standard output, in the format of --to.
    out: PathBuf,
    /// Format of the output [default: from the extension of its name].
    #[arg(long, value_enum)]
    to: Option<To>,
    #[command(flatten)]
    texels: TexelArguments,
    /// Wrap mode, for texture coordinates beyond the sides: repeat the texture, mirror it, or clamp
    /// to its edge texels. A second mode, after a comma, applies to the vertical direction
    /// [default: repeat; a .glt file keeps its modes].
    #[arg(long, value_name = "repeat|mirror|clamp", num_args = 1, value_delimiter = ',', value_parser = named(Wrap::ALL, wrap_name))]
    wrap: Vec<Wrap>,
    /// Opacity, 0 to 1, below which texels are transparent. With 0 no texel is transparent.
    #[arg(long, value_name = "0..1", default_value_t = CUTOFF)]
    cutoff: f32,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

/// Output format of a texture.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum To {
    /// A texture in a board's memory layout.
    Glt,
    /// A picture of the mip levels.
    Png,
}

impl TextureArguments {
    pub fn run(self) -> anyhow::Result<()> {
        if !(0.0..=1.0).contains(&self.cutoff) {
            let found = self.cutoff.to_string();
            return Err(bad_value("--cutoff", "an opacity of 0 to 1", found).into());
        }
        if self.wrap.len() > 2 {
            let found = self.wrap.len().to_string();
            return Err(bad_value("--wrap", "one or two modes", found).into());
        }
        let (out, to) = match self.to {
            Some(To::Glt) => (Output::open(&self.out, &["glt"], [&self.input])?, To::Glt),
            Some(To::Png) => (Output::open(&self.out, &["png"], [&self.input])?, To::Png),
            None if self.out == Path::new(STDOUT) => {
                return Err(bad_value("-", "--to with a format", "none").into());
            }
            None => {
                let is_png = self
                    .out
                    .extension()
                    .is_some_and(|end| end.eq_ignore_ascii_case("png"));
                let to = if is_png { To::Png } else { To::Glt };
                (Output::open(&self.out, TEXTURE, [&self.input])?, to)
            }
        };
        let file = read_file(&self.input)?;
        let wrap = match self.wrap[..] {
            [] => None,
            [both] => Some([both; 2]),
            [across, down, ..] => Some([across, down]),
        };
        let converted = texture::of_bytes(&file, &self.texels.options(), wrap, self.cutoff);
        let (bytes, report) = converted.map_err(|error| error.in_path(&self.input))?;
        let bytes = match to {
            To::Glt => bytes,
            To::Png => shown(&bytes).map_err(|error| error.in_path(&self.input))?,
        };
        out.write(|out| out.write_all(&bytes))?;
        if self.json {
            print_json(&report)
        } else {
            say(report)
        }
    }
}

/// The levels of a texture as a PNG file.
fn shown(bytes: &[u8]) -> Result<Vec<u8>, FormatError> {
    let texture = texture::checked(bytes)?;
    sheet(&texture).png().map_err(texture::of_picture)
}
