//! Options of a conversion, and their names on command lines.

use glint_core::texture::{Blend, Filter, Format, SIDES_LOG2, Sampler, Wrap};

/// Largest side of a texture in texels.
pub const MAX_SIDE: u32 = 1 << *SIDES_LOG2.end();
/// Smallest side of a texture in texels.
pub const MIN_SIDE: u32 = 1 << *SIDES_LOG2.start();

/// Options of a conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The representation of the texels: colours, or indices of a palette.
    pub format: Format,
    /// The largest side in texels. A side of the texture is the power of two, at most this number,
    /// that is nearest to the picture's side.
    pub largest_side: u32,
    /// Wrap modes and filter of the texture.
    pub sampler: Sampler,
    /// Opacity, 0 to 1, below which texels are transparent. With `None` the texture is opaque, and
    /// the picture's opacity has no effect.
    pub cutoff: Option<f32>,
    /// How the texture is blended with the picture behind it.
    pub blend: Blend,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            format: Format::Rgb565,
            largest_side: MAX_SIDE,
            sampler: Sampler::default(),
            cutoff: None,
            blend: Blend::Opaque,
        }
    }
}

/// The command-line name of a representation of texels.
pub const fn format_name(format: Format) -> &'static str {
    match format {
        Format::Rgb565 => "rgb565",
        Format::Palette256 => "palette 256",
        Format::Palette16 => "palette 16",
    }
}

/// The command-line name of a wrap mode.
pub const fn wrap_name(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "repeat",
        Wrap::Mirror => "mirror",
        Wrap::Clamp => "clamp",
    }
}

/// The command-line name of a filter.
pub const fn filter_name(filter: Filter) -> &'static str {
    match filter {
        Filter::Nearest => "nearest",
        Filter::Bilinear => "bilinear",
    }
}

/// The command-line name of a blend: its number of eighths, `add` or `none`.
pub const fn blend_name(blend: Blend) -> &'static str {
    const NAMES: [&str; Blend::ALL.len()] = ["none", "1", "2", "3", "4", "5", "6", "7", "add"];
    NAMES[blend.number() as usize]
}
