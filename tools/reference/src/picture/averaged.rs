//! Patterns of samples in a pixel, and the means of their colours.

use anyhow::Result;
use glint_model::Frame;

use super::exact::Exact;
use super::seen::Eyes;
use crate::camera::{Vector, add_scaled};

/// Places of samples in a pixel: pixels to the right of and below its centre.
pub type Pattern = Vec<[f64; 2]>;

/// The centres of `across`² equal squares of a pixel, row by row.
pub fn grid(across: u32) -> Pattern {
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(across) - 0.5;
    let row = |y: u32| (0..across).map(move |x| [place(x), place(y)]);
    (0..across).flat_map(row).collect()
}

/// A picture of 1280×720 in f64, whose pixels are the means of several samples.
pub struct Averaged {
    /// Red, green and blue, from 0 to 255.
    pub colours: Vec<Vector>,
    /// Whether the samples of a pixel show more than one surface.
    pub edges: Vec<bool>,
}

impl Averaged {
    /// Draws a frame of any size in f64, at the size on the monitor, with a pattern of at least one sample a pixel.
    ///
    /// # Errors
    /// As for [`Exact::new`].
    pub fn new(frame: &Frame, pattern: &[[f64; 2]]) -> Result<Self> {
        let part = 1.0 / pattern.len() as f64;
        let mut first: Vec<Eyes> = Vec::new();
        let (mut colours, mut edges) = (Vec::new(), Vec::new());
        for &offset in pattern {
            let sample = Exact::at(frame, offset)?;
            if first.is_empty() {
                colours = vec![[0.0; 3]; sample.colours.len()];
                edges = vec![false; sample.seen.len()];
                first.clone_from(&sample.seen);
            }
            for (sum, colour) in colours.iter_mut().zip(&sample.colours) {
                *sum = add_scaled(*sum, *colour, part);
            }
            for (is_edge, (first, seen)) in edges.iter_mut().zip(first.iter().zip(&sample.seen)) {
                *is_edge |= first != seen;
            }
        }
        Ok(Self { colours, edges })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_symmetric() {
        assert_eq!(grid(1), [[0.0; 2]]);
        let quarters = [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]];
        assert_eq!(grid(2), quarters);
        let all = grid(8);
        assert_eq!(
            (all.len(), all[0], all[63]),
            (64, [-0.4375; 2], [0.4375; 2])
        );
    }
}
