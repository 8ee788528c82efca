//! Segments drawn by the model of the line engine.

use glint_model::line::Line;
use glint_model::triangle::setup::Bounds;
use glint_vectors::triangles::at;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("line", |Ends { ends, square }| {
            let pixels = pixels(ends, square);
            Ok(Outcome::exact(format!("{} pixels", pixels.len())))
        }),
        Kind::new("line-along-axis", |axis: usize| {
            Ok(along_axis(|[along, across]| {
                let mut place = [across; 2];
                place[axis % 2] = along;
                place
            }))
        }),
        Kind::new("line-without-length", |places: i64| {
            let all = (0..places).flat_map(|x| (0..places).map(move |y| [x, y]));
            let drawn = all
                .filter(|&place| !pixels([place; 2], [0, 640]).is_empty())
                .count();
            Ok(Outcome::exact(format!(
                "{drawn} of the segments have pixels"
            )))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ends {
    /// The end points, in 1/256 pixel.
    ends: [[i64; 2]; 2],
    /// Bounds of a square picture, for columns and for rows: the first index, and the index after the last.
    square: [i32; 2],
}

/// The pixels of a segment in a square picture.
fn pixels(ends: [[i64; 2]; 2], [first, end]: [i32; 2]) -> Vec<[i64; 2]> {
    let bounds = Bounds {
        left: first,
        right: end,
        top: first,
        bottom: end,
    };
    let line = Line::new(&ends.map(at));
    let pixels = line.map(|line| line.pixels(&bounds));
    let pixels = pixels.into_iter().flatten();
    pixels
        .map(|pixel| [pixel.column, pixel.row].map(i64::from))
        .collect()
}

/// Draws segments along an axis, in both directions, at all positions across two pixels. `turned` converts coordinates along and
/// across the axis to a position.
fn along_axis(turned: impl Fn([i64; 2]) -> [i64; 2]) -> Outcome {
    for across in 1..=512 {
        // The border between two pixels belongs to the first pixel.
        let row = (across - 1) / 256;
        let expected = (0..640).map(|along| turned([along, row]));
        // From a quarter of a pixel before the picture to a quarter of a pixel after it.
        let [a, b] = [-64, 640 * 256 + 64].map(|along| turned([along, across]));
        let is_forward = pixels([a, b], [0, 640]).into_iter().eq(expected.clone());
        let is_backward = pixels([b, a], [0, 640]).into_iter().eq(expected.rev());
        if !is_forward || !is_backward {
            return Outcome::exact(format!("other pixels at {across}/256"));
        }
    }
    Outcome::exact("one pixel in each column or row, in the line of pixels nearest to the segment")
}
