//! Segments on the screen, as the line engine draws them.

use glint_model::line::Line;
use glint_model::triangle::setup::Bounds;
use glint_vectors::triangles::at;

use crate::case::Case;

pub const CASES: &[Case] = &[
    ("horizontal segment", || {
        level(|[along, across]| [along, across]);
        "one pixel in each column, in the row nearest to it".to_owned()
    }),
    ("vertical segment", || {
        level(|[along, across]| [across, along]);
        "one pixel in each row, in the column nearest to it".to_owned()
    }),
    ("segment without length", without_length),
    ("segment from corner to corner of the picture", || {
        let corner = |x: i64, y: i64| [256 * x, 256 * y];
        assert_eq!(pixels([corner(0, 0), corner(640, 360)], 640).len(), 640);
        assert_eq!(pixels([corner(640, 0), corner(0, 360)], 640).len(), 640);
        "one pixel in each column: 640 of 640".to_owned()
    }),
    (
        "segment from corner to corner of the range of positions",
        across_the_range,
    ),
];

/// The pixels of a segment, in units of 1/256 pixel, in the square of `size` pixels at the origin or, with a negative size, about
/// the origin.
fn pixels(ends: [[i64; 2]; 2], size: i32) -> Vec<[i32; 2]> {
    let bounds = Bounds {
        left: size.min(0),
        right: size.abs(),
        top: size.min(0),
        bottom: size.abs(),
    };
    let line = Line::new(&ends.map(at));
    let pixels = line.map(|line| line.pixels(&bounds));
    let pixels = pixels.into_iter().flatten();
    pixels.map(|pixel| [pixel.column, pixel.row]).collect()
}

/// Checks segments along an axis, in both directions, at all places across two pixels.
fn level(turned: fn([i64; 2]) -> [i64; 2]) {
    for across in 1..=512 {
        // The border between two pixels belongs to the first one.
        let row = (across - 1) / 256;
        let expected = (0..640).map(|along| turned([along, row]).map(|x| x as i32));
        // From a quarter of a pixel outside of the picture to as much on the other side.
        let ends = [-64, 640 * 256 + 64].map(|along| turned([along, across]));
        assert!(pixels(ends, 640).into_iter().eq(expected.clone()));
        let [a, b] = ends;
        assert!(pixels([b, a], 640).into_iter().eq(expected.rev()));
    }
}

fn without_length() -> String {
    for x in 0..512 {
        for y in 0..512 {
            assert!(pixels([[x, y]; 2], 640).is_empty());
        }
    }
    "no pixel".to_owned()
}

fn across_the_range() -> String {
    let (low, high) = (-(1 << 19), (1 << 19) - 1);
    let count = pixels([[low, low], [high, high]], -2048).len();
    assert_eq!(count, pixels([[high, low], [low, high]], -2048).len());
    format!("one pixel in each column: {count} of 4096")
}
