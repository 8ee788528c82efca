//! Converts a picture to a texture in a board's memory layout, and reports on the conversion.

use crate::error::PictureError;
use crate::levels::{Level, Texel, colour};
use crate::options::{MAX_SIDE, MIN_SIDE, Options, blend_name, format_name};
use crate::palette::{Nearest, palette};
use crate::picture::Picture;
use crate::sheet::largest_level;
use glint_core::colour::Rgb565;
use glint_core::texture::{Blend, Format, Sampler, Source, Texture, TextureHeader, encode};
use serde::Serialize;
use std::fmt;

/// Report of a conversion.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Width and height of the picture.
    pub picture: [u32; 2],
    /// Width and height of the texture.
    pub size: [u32; 2],
    /// The representation of the texels.
    pub format: &'static str,
    /// Number of colours in the palette that the conversion uses; 0 without a palette.
    pub colours: usize,
    /// Number of mip levels.
    pub levels: usize,
    /// Whether the texture has transparent texels.
    pub cut_out: bool,
    /// How the texture is blended with the picture behind it: a number of eighths, `add`, or `none`.
    pub blend: &'static str,
    /// Length of the texture in bytes.
    pub bytes: usize,
    /// Root mean square of the differences between the picture, after resizing, and the opaque texels of the largest level, over the
    /// three channels, in units of 1/255.
    pub error_rms: f64,
    /// The largest of the differences from which `error_rms` is computed.
    pub error_max: f64,
    /// Remarks for the user, such as the sizes before and after resizing.
    pub remarks: Vec<String>,
}

impl fmt::Display for Report {
    /// One line: size, format, bytes and errors, and the remarks.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [width, height] = self.size;
        write!(f, "{width}×{height}, {}", self.format)?;
        if self.cut_out {
            write!(f, ", cut-out")?;
        }
        if self.blend != blend_name(Blend::Opaque) {
            write!(f, ", blend {}", self.blend)?;
        }
        let plural = if self.levels == 1 { "" } else { "s" };
        write!(f, ", {} level{plural}, {} bytes", self.levels, self.bytes)?;
        write!(
            f,
            ", error {:.2} RMS and {:.1} at most (of 255)",
            self.error_rms, self.error_max
        )?;
        self.remarks
            .iter()
            .try_for_each(|remark| write!(f, "; {remark}"))
    }
}

/// Converts a picture to a texture with all mip levels: the sides become powers of two, and levels are averages in linear light.
///
/// With a cutoff, a texel is transparent if the average opacity of the picture's texels under it is
/// below the cutoff. Smaller levels keep the share of opaque texels as far as possible. No opaque
/// texel has the value that marks transparent texels.
///
/// # Errors
/// The picture has no texel, or `largest_side` is outside of [`MIN_SIDE`] to [`MAX_SIDE`].
pub fn convert(picture: &Picture, options: &Options) -> Result<(Vec<u8>, Report), PictureError> {
    let [width, height] = picture.size;
    if picture.texels.len() as u64 != u64::from(width) * u64::from(height)
        || picture.texels.is_empty()
    {
        let found = format!("{width}×{height} and {} texels", picture.texels.len());
        return Err(PictureError::new("a picture with texels", found));
    }
    if !(MIN_SIDE..=MAX_SIDE).contains(&options.largest_side) {
        let expected = format!("a largest side of {MIN_SIDE} to {MAX_SIDE}");
        return Err(PictureError::new(
            expected,
            options.largest_side.to_string(),
        ));
    }
    let size_log2 = picture
        .size
        .map(|side| side_log2(side, options.largest_side));
    let size = size_log2.map(|side| 1 << side);
    let mut remarks = Vec::new();
    if size != picture.size {
        remarks.push(format!(
            "resized from {width}×{height} to {}×{}",
            size[0], size[1]
        ));
    }
    let cutoff = options.cutoff.filter(|&cutoff| cutoff > 0.0);
    let mut levels = vec![Level::resized(
        picture,
        size,
        options.sampler.wrap,
        cutoff.is_some(),
    )];
    while let Some(next) = levels.last().and_then(Level::next) {
        levels.push(next);
    }
    let texels = opaque(&levels, cutoff.unwrap_or(0.0));
    let count = texels.iter().flatten().flatten().count();
    let cut_out = count < texels.iter().map(Vec::len).sum::<usize>();
    if count == 0 {
        remarks.push("each texel is transparent".into());
    }
    let Values {
        palette,
        key,
        levels: values,
    } = match options.format {
        Format::Rgb565 => coloured(&texels, cut_out),
        Format::Palette256 | Format::Palette16 => indexed(&texels, options.format, cut_out),
    };
    let (error_rms, error_max) = errors(&levels, &values, |value| match options.format {
        _ if key == Some(value) => None,
        Format::Rgb565 => Some(Rgb565(value)),
        Format::Palette256 | Format::Palette16 => palette.get(usize::from(value)).copied(),
    });
    let source = Source {
        format: options.format,
        size_log2,
        sampler: options.sampler,
        key,
        blend: options.blend,
        palette,
        levels: values,
    };
    let bytes = encode(&source).map_err(|error| {
        // The checks above exclude all errors of the encoder.
        PictureError::new("a texture", error.to_string())
    })?;
    let report = Report {
        picture: picture.size,
        size,
        format: format_name(options.format),
        colours: source.palette.len(),
        levels: source.levels.len(),
        cut_out,
        blend: blend_name(options.blend),
        bytes: bytes.len(),
        error_rms,
        error_max,
        remarks,
    };
    Ok((bytes, report))
}

/// Converts a texture again from its largest level. A `format` or `blend` of `None` keeps the value of the texture. A texture that already
/// satisfies the options is kept unchanged with all its levels.
///
/// # Errors
/// As for [`convert`].
pub fn again(
    texture: &Texture,
    format: Option<Format>,
    largest_side: u32,
    sampler: Sampler,
    blend: Option<Blend>,
) -> Result<(Vec<u8>, Report), PictureError> {
    let format = format.unwrap_or(texture.format());
    let blend = blend.unwrap_or(texture.blend());
    let sides = texture.size_log2().map(|side| 1 << side);
    let is_small = sides.iter().all(|&side: &u32| side <= largest_side);
    let is_same = [
        format == texture.format(),
        sampler == texture.sampler(),
        blend == texture.blend(),
    ];
    if is_small && is_same == [true; 3] {
        return Ok((texture.bytes().to_vec(), kept(texture)));
    }
    let options = Options {
        format,
        largest_side,
        sampler,
        // Half-way between the opacities 0 of transparent and 1 of opaque texels.
        cutoff: Some(0.5),
        blend,
    };
    convert(&largest_level(texture), &options)
}

/// The report on a texture that is kept as it is.
fn kept(texture: &Texture) -> Report {
    let header = texture.bytes().first_chunk().map(TextureHeader::from_bytes);
    let size = texture.size_log2().map(|side| 1 << side);
    Report {
        picture: size,
        size,
        format: format_name(texture.format()),
        colours: texture.format().colours(),
        levels: texture.levels() as usize,
        cut_out: header.is_some_and(|header| header.cut_out != 0),
        blend: blend_name(texture.blend()),
        bytes: texture.bytes().len(),
        error_rms: 0.0,
        error_max: 0.0,
        remarks: Vec::new(),
    }
}

/// Base-2 logarithm of the power of two from [`MIN_SIDE`] to `largest` that is nearest to a side by
/// ratio.
fn side_log2(side: u32, largest: u32) -> u8 {
    // Larger sides give the largest power of two, too; clamping keeps the square within 64 bits.
    let side = u64::from(side.clamp(MIN_SIDE, MAX_SIDE));
    let below = side.ilog2();
    // side / 2^below > √2
    let nearest = below + u32::from(side * side > 1 << (2 * below + 1));
    nearest.min(largest.ilog2()) as u8
}

/// The colours of the opaque texels of all levels, rounded; `None` for transparent texels.
///
/// A fence of thin bars would vanish in small levels, whose texels have the average opacity of bars
/// and gaps. Therefore each level has the same share of opaque texels as the largest level. The
/// texels with the highest opacity are chosen, and among equal opacities texels in an even pattern.
fn opaque(levels: &[Level], cutoff: f32) -> Vec<Vec<Option<[u8; 3]>>> {
    let rounded = |texel: Texel| colour(texel).map(|value| value.round() as u8);
    let is_opaque = |texel: &Texel| texel[3] > 0.0 && texel[3] >= cutoff;
    let Some(largest) = levels.first() else {
        return Vec::new();
    };
    let texels = largest.texels.iter();
    let of_largest: Vec<_> = texels
        .map(|texel| is_opaque(texel).then(|| rounded(*texel)))
        .collect();
    let opaque = of_largest.iter().flatten().count();
    let of_level = |level: &Level| {
        let count = level.texels.len();
        // The product exceeds 32 bits.
        let [part, all, whole] = [opaque, count, of_largest.len()].map(|count| count as u64);
        let aim = ((part * all + whole / 2) / whole) as usize;
        let mut by_opacity: Vec<usize> = (0..count).filter(|&i| level.texels[i][3] > 0.0).collect();
        let order = |i: usize| even_order(i % level.size[0], i / level.size[0]);
        if aim < by_opacity.len() {
            by_opacity.sort_unstable_by(|&a, &b| {
                let opacity = |i: usize| level.texels[i][3];
                let opacities = opacity(b).total_cmp(&opacity(a));
                opacities.then_with(|| order(a).cmp(&order(b)))
            });
        }
        let mut texels = vec![None; count];
        for &i in by_opacity.iter().take(aim) {
            texels[i] = Some(rounded(level.texels[i]));
        }
        texels
    };
    let smaller: Vec<_> = levels.iter().skip(1).map(of_level).collect();
    std::iter::once(of_largest).chain(smaller).collect()
}

/// Rank of a texel in Bayer's matrix: for any n, the n texels of the lowest ranks are evenly
/// distributed.
fn even_order(x: usize, y: usize) -> u32 {
    (0..MAX_SIDE.ilog2()).fold(0, |order, bit| {
        let [x, y] = [x, y].map(|c| (c >> bit) as u32 & 1);
        order << 2 | (x ^ y) << 1 | y
    })
}

/// The encoded texels of all levels.
struct Values {
    palette: Vec<Rgb565>,
    key: Option<u16>,
    levels: Vec<Vec<u16>>,
}

/// Encodes texels as colours, with a key value that no opaque texel has.
fn coloured(texels: &[Vec<Option<[u8; 3]>>], cut_out: bool) -> Values {
    let value = |texel: &Option<[u8; 3]>| texel.map(|rgb| Rgb565::from_rgb888(rgb).0);
    if !cut_out {
        let all = |level: &Vec<_>| {
            level
                .iter()
                .map(|texel| value(texel).unwrap_or(0))
                .collect()
        };
        return Values {
            palette: Vec::new(),
            key: None,
            levels: texels.iter().map(all).collect(),
        };
    }
    let mut counts = vec![0_u32; 1 << 16];
    for value in texels.iter().flatten().filter_map(value) {
        counts[usize::from(value)] += 1;
    }
    // The key is the first of the rarest values. If opaque texels have this value, as in a picture
    // with all 65536 values, their blue changes by one step.
    let rarest = (0..=u16::MAX).min_by_key(|&value| counts[usize::from(value)]);
    let key = rarest.unwrap_or(0);
    let marked = |texel: &Option<[u8; 3]>| match value(texel) {
        None => key,
        Some(value) if value == key => value ^ 1,
        Some(value) => value,
    };
    Values {
        palette: Vec::new(),
        key: Some(key),
        levels: texels
            .iter()
            .map(|level| level.iter().map(marked).collect())
            .collect(),
    }
}

/// Encodes texels as indices of a palette for all levels. The last index marks transparent texels.
fn indexed(texels: &[Vec<Option<[u8; 3]>>], format: Format, cut_out: bool) -> Values {
    let colours: Vec<[u8; 3]> = texels.iter().flatten().flatten().copied().collect();
    let palette = palette(&colours, format.colours() - usize::from(cut_out));
    let key = (format.colours() - 1) as u16;
    let mut nearest = Nearest::new(&palette);
    let mut values = |level: &Vec<Option<[u8; 3]>>| -> Vec<u16> {
        let texels = level.iter();
        texels
            .map(|texel| texel.map_or(key, |rgb| nearest.index(rgb)))
            .collect()
    };
    Values {
        levels: texels.iter().map(&mut values).collect(),
        palette,
        key: cut_out.then_some(key),
    }
}

/// Root mean square and maximum of the rounding errors of the largest level.
fn errors(
    levels: &[Level],
    values: &[Vec<u16>],
    colour_of: impl Fn(u16) -> Option<Rgb565>,
) -> (f64, f64) {
    let (Some(before), Some(after)) = (levels.first(), values.first()) else {
        return (0.0, 0.0);
    };
    let (mut squares, mut largest, mut count) = (0.0, 0.0_f64, 0_u32);
    for (&texel, &value) in before.texels.iter().zip(after) {
        let Some(rounded) = colour_of(value) else {
            continue;
        };
        for (before, after) in colour(texel).into_iter().zip(rounded.to_rgb888()) {
            let difference = f64::from(before - f32::from(after)).abs();
            squares += difference * difference;
            largest = largest.max(difference);
            count += 1;
        }
    }
    let mean = squares / f64::from(count.max(1));
    (mean.sqrt(), largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::sheet;
    use glint_core::texture::{Wrap, checksum};

    fn ramp(size: [u32; 2]) -> Picture {
        Picture::drawn(size, |x, y| {
            [(4 * x) as u8, (4 * y) as u8, (x ^ y) as u8, 255]
        })
    }

    fn cut_out() -> Options {
        Options {
            cutoff: Some(0.5),
            ..Options::default()
        }
    }

    #[test]
    fn sides_become_the_nearest_powers_of_two() {
        for (side, largest, power) in [
            (1, 1024, 8),
            (3, 1024, 8),
            (8, 1024, 8),
            (11, 1024, 8),
            (12, 1024, 16),
            (90, 1024, 64),
            (91, 1024, 128),
            (724, 1024, 512),
            (725, 1024, 1024),
            (5000, 1024, 1024),
            (u32::MAX, 1024, 1024),
            (5000, 8, 8),
            (5000, 100, 64),
        ] {
            assert_eq!(1 << side_log2(side, largest), power, "{side} {largest}");
        }
    }

    #[test]
    fn sizes_of_all_kinds() {
        for (size, expected, levels) in [
            ([1, 1], [8, 8], 4),
            ([1, 1024], [8, 1024], 11),
            ([5000, 3], [1024, 8], 11),
            ([64, 64], [64, 64], 7),
        ] {
            let (bytes, report) = convert(&ramp(size), &Options::default()).unwrap();
            let texture = Texture::new_checked(&bytes).unwrap();
            assert_eq!(texture.size_log2().map(|side| 1 << side), expected);
            assert_eq!((report.size, report.levels), (expected, levels));
            assert_eq!(report.bytes, bytes.len());
            let [[width, height], [to_width, to_height]] = [size, expected];
            let resized = format!("resized from {width}×{height} to {to_width}×{to_height}");
            let remarks: &[String] = if size == expected { &[] } else { &[resized] };
            assert_eq!(report.remarks, remarks);
            let stated = TextureHeader::from_bytes(bytes.first_chunk().unwrap()).checksum;
            assert_eq!(stated, checksum(&bytes));
        }
        for size in [[0, 0], [0, 8], [8, 0]] {
            let error = convert(&ramp(size), &Options::default()).unwrap_err();
            assert_eq!(error.expected, "a picture with texels");
        }
        for largest_side in [0, 7, 1025, u32::MAX] {
            let options = Options {
                largest_side,
                ..Options::default()
            };
            let error = convert(&ramp([8, 8]), &options).unwrap_err();
            let expected = format!("expected a largest side of 8 to 1024, found {largest_side}");
            assert_eq!(error.to_string(), expected);
        }
    }

    #[test]
    fn colours_are_the_nearest() {
        let ramp = ramp([64, 64]);
        let (bytes, report) = convert(&ramp, &Options::default()).unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        for (i, &[red, green, blue, _]) in (0..).zip(&ramp.texels) {
            let value = texture.value(0, [i % 64, i / 64]);
            assert_eq!(Rgb565(value), Rgb565::from_rgb888([red, green, blue]));
        }
        assert!(report.error_max <= 5.0, "{report:?}");
        assert!((0.5..2.5).contains(&report.error_rms), "{report:?}");
        assert!(!report.cut_out);
    }

    #[test]
    fn palettes_have_more_error_and_fewer_bytes() {
        let mut last = (usize::MAX, 0.0);
        for (format, colours) in Format::ALL.into_iter().zip([0, 256, 16]) {
            let options = Options {
                format,
                ..Options::default()
            };
            let (bytes, report) = convert(&ramp([64, 64]), &options).unwrap();
            assert!(report.colours <= colours && report.colours >= colours / 2);
            assert!(
                bytes.len() < last.0 && report.error_rms > last.1,
                "{report:?}"
            );
            last = (bytes.len(), report.error_rms);
        }
        assert!(last.1 < 25.0);
    }

    #[test]
    fn cut_out_in_each_format() {
        // Opaque, just opaque, just transparent, and transparent columns.
        let opacity = |x: u32| [255, 128, 127, 0][x as usize % 4];
        let holes = Picture::drawn([16, 16], |x, y| {
            [(16 * x) as u8, (16 * y) as u8, 0, opacity(x)]
        });
        let clear = Picture::drawn([8, 8], |_, _| [1, 2, 3, 0]);
        for format in Format::ALL {
            let options = Options {
                format,
                ..cut_out()
            };
            let (bytes, report) = convert(&holes, &options).unwrap();
            assert!(report.cut_out);
            let texture = Texture::new_checked(&bytes).unwrap();
            for x in 0..16 {
                for y in 0..16 {
                    let colour = texture.colour(0, [x, y]);
                    assert_eq!(colour.is_some(), x % 4 < 2, "{format:?} {x} {y}");
                }
            }
            for cutoff in [None, Some(0.0)] {
                let opaque = Options { cutoff, ..options };
                assert!(!convert(&holes, &opaque).unwrap().1.cut_out);
            }
            let (_, report) = convert(&clear, &options).unwrap();
            assert_eq!(report.remarks, ["each texel is transparent"]);
            assert_eq!((report.error_rms, report.error_max), (0.0, 0.0));
        }
    }

    #[test]
    fn smaller_levels_keep_the_share_of_opaque_texels() {
        // Thin bars in one direction, dots, and texels with the same opacity.
        let bars = |x: u32, _: u32| x.is_multiple_of(5);
        let dots = |x: u32, y: u32| (x * x + 3 * y * y + x * y) % 7 < 2;
        let shares = |picture: &Picture| -> Vec<f64> {
            let (bytes, _) = convert(picture, &cut_out()).unwrap();
            let texture = Texture::new_checked(&bytes).unwrap();
            let share = |level| {
                let [width, height] = texture.level_log2(level).map(|side| 1 << side);
                let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
                let opaque = places.filter(|&place| texture.colour(level, place).is_some());
                opaque.count() as f64 / f64::from(width * height)
            };
            (0..texture.levels()).map(share).collect()
        };
        for is_opaque in [&bars as &dyn Fn(u32, u32) -> bool, &dots] {
            let opacity = |x, y| if is_opaque(x, y) { 255 } else { 0 };
            let found = shares(&Picture::drawn([64, 64], |x, y| [9, 9, 9, opacity(x, y)]));
            for (level, share) in found.iter().enumerate() {
                let texels = f64::from(1 << (12 - 2 * level));
                assert!((share - found[0]).abs() <= 0.5 / texels, "{found:?}");
            }
        }
        for (opacity, share) in [(100, 0.0), (200, 1.0)] {
            let even = Picture::drawn([8, 8], |_, _| [9, 9, 9, opacity]);
            assert_eq!(shares(&even), [share; 4]);
        }
    }

    #[test]
    fn the_key_is_no_colour_of_an_opaque_texel() {
        // All values of RGB565, and a transparent texel.
        let texels = (0..=u16::MAX).map(|value| {
            let [red, green, blue] = Rgb565(value).to_rgb888();
            [red, green, blue, if value == 0x8000 { 0 } else { 255 }]
        });
        let all = Picture {
            size: [256, 256],
            texels: texels.collect(),
        };
        let (bytes, _) = convert(&all, &cut_out()).unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        let places = (0..256).flat_map(|y| (0..256).map(move |x| [x, y]));
        let transparent = places.filter(|&place| texture.colour(0, place).is_none());
        assert_eq!(transparent.collect::<Vec<_>>(), [[0, 128]]);
    }

    #[test]
    fn the_sampler_is_kept_and_the_sheet_shows_all_levels() {
        let options = Options {
            sampler: Sampler {
                wrap: [Wrap::Clamp, Wrap::Mirror],
                ..Sampler::default()
            },
            ..Options::default()
        };
        let red = Picture::drawn([16, 8], |_, _| [255, 0, 0, 255]);
        let (bytes, _) = convert(&red, &options).unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        assert_eq!(texture.sampler(), options.sampler);
        let sheet = sheet(&texture);
        assert_eq!(sheet.size, [16 + 8 + 4 + 2 + 1, 8]);
        let visible = sheet.texels.iter().filter(|texel| texel[3] == 255);
        assert_eq!(visible.count(), 128 + 32 + 8 + 2 + 1);
        assert_eq!(Picture::decode(&sheet.png().unwrap()).unwrap(), sheet);
    }
}
