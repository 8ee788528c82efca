//! Palettes for the colours of a picture.

use glint_core::colour::Rgb565;
use quantette::deps::palette::Srgb;
use quantette::{PaletteSize, Pipeline, QuantizeMethod};
use std::collections::{BTreeSet, HashMap};

/// A palette of at most `most` (1 to 256) distinct colours. The palette is exact if the given
/// colours have at most `most` different RGB565 values; otherwise Wu's colour quantisation in the
/// Oklab colour space chooses it. Without colours the palette is empty.
pub fn palette(colours: &[[u8; 3]], most: usize) -> Vec<Rgb565> {
    let exact = |colours: &mut dyn Iterator<Item = [u8; 3]>| {
        let mut distinct = BTreeSet::new();
        for rgb in colours {
            distinct.insert(Rgb565::from_rgb888(rgb).0);
            if distinct.len() > most {
                return None;
            }
        }
        Some(distinct.into_iter().map(Rgb565).collect())
    };
    exact(&mut colours.iter().copied())
        .or_else(|| exact(&mut divided(colours, most)?.into_iter()))
        .unwrap_or_default()
}

/// The colours that Wu's quantisation chooses.
fn divided(colours: &[[u8; 3]], most: usize) -> Option<Vec<[u8; 3]>> {
    let most = u16::try_from(most)
        .ok()
        .and_then(PaletteSize::try_from_u16)?;
    let colours: Vec<Srgb<u8>> = colours.iter().map(|&rgb| Srgb::from(rgb)).collect();
    let pipeline = Pipeline::new()
        .palette_size(most)
        .quantize_method(QuantizeMethod::Wu)
        .ditherer(None)
        .input_slice(&colours)
        .ok()?;
    let colours = pipeline.output_srgb8_palette().into_vec();
    Some(colours.into_iter().map(<[u8; 3]>::from).collect())
}

/// Finds the nearest colours of a palette by the squared distance in sRGB, which is the error that a report states.
pub struct Nearest<'p> {
    palette: &'p [Rgb565],
    known: HashMap<[u8; 3], u16>,
}

impl<'p> Nearest<'p> {
    /// Creates the search for a palette.
    pub fn new(palette: &'p [Rgb565]) -> Self {
        Self {
            palette,
            known: HashMap::new(),
        }
    }

    /// Index of the palette's colour that is nearest to `rgb`, the lowest of several; 0 for an
    /// empty palette.
    pub fn index(&mut self, rgb: [u8; 3]) -> u16 {
        *self.known.entry(rgb).or_insert_with(|| {
            let distance = |colour: Rgb565| -> u32 {
                let pairs = colour.to_rgb888().into_iter().zip(rgb);
                pairs.map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
            };
            let indices = (0..).zip(self.palette);
            let nearest = indices.min_by_key(|&(_, &colour)| distance(colour));
            nearest.map_or(0, |(index, _)| index)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_exact() {
        let colours = [[255, 0, 0], [0, 0, 255], [255, 0, 0]];
        let found = palette(&colours, 2);
        assert_eq!(found, [Rgb565(0x001f), Rgb565(0xf800)]);
        let mut nearest = Nearest::new(&found);
        assert_eq!(colours.map(|rgb| nearest.index(rgb)), [1, 0, 1]);
        assert!(palette(&[], 16).is_empty());
        assert_eq!(Nearest::new(&[]).index([1, 2, 3]), 0);
    }

    #[test]
    fn many_colours_have_near_ones() {
        let colours: Vec<[u8; 3]> = (0..=255).map(|c| [c, 255 - c, c / 2]).collect();
        for (most, largest) in [(256, 8), (255, 8), (16, 32), (15, 32)] {
            let palette = palette(&colours, most);
            assert!((1..=most).contains(&palette.len()));
            let mut nearest = Nearest::new(&palette);
            for &rgb in &colours {
                let near = palette[usize::from(nearest.index(rgb))].to_rgb888();
                let pairs = near.into_iter().zip(rgb);
                let error = pairs.map(|(a, b)| a.abs_diff(b)).max();
                assert!(error <= Some(largest), "{most} {rgb:?} {near:?}");
            }
        }
    }
}
