//! Compares the model's lines with the exact reference: equal pixels, in whole pictures and in rectangles, and depths within the
//! documented bound. `--nocapture` shows the figures, and `--ignored` compares a million random segments.

use glint_model::ScreenVertex;
use glint_model::line::{Line, LineDepth, LinePixel};
use glint_model::triangle::setup::Bounds;
use glint_reference::line::{ExactSegment, Rectangle};
use glint_reference::triangle::exact::SnappedVertex;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Largest deviation of a line's depth from the exact depth, before rounding to a code, in depth codes.
const DEPTH_LIMIT: f64 = 0.26;

/// Pictures, bands of pictures, and the whole range of positions.
const RECTANGLES: [[i32; 4]; 6] = [
    [0, 0, 320, 180],
    [0, 0, 640, 360],
    [0, 0, 1280, 720],
    [0, 336, 640, 360],
    [0, 708, 1280, 720],
    [-2049, -2049, 2049, 2049],
];

/// Results of a comparison.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    segments: u64,
    clipped: u64,
    empty: u64,
    pixels: u64,
    depth_error: f64,
}

fn bounds([left, top, right, bottom]: [i32; 4]) -> Bounds {
    Bounds {
        left,
        right,
        top,
        bottom,
    }
}

/// The model's pixels in a rectangle.
fn walked(ends: &[ScreenVertex; 2], rectangle: [i32; 4]) -> Vec<LinePixel> {
    let line = Line::new(ends);
    let pixels = line.map(|line| line.pixels(&bounds(rectangle)));
    pixels.into_iter().flatten().collect()
}

/// Compares the pixels and depths of a segment in a rectangle.
fn check(ends: &[ScreenVertex; 2], rectangle: [i32; 4], tally: &mut Tally) {
    let segment = exact(ends);
    let found = walked(ends, rectangle);
    let mut left: Vec<[i64; 2]> = found.iter().map(place).collect();
    left.sort_unstable();
    let [from_x, from_y, to_x, to_y] = rectangle.map(i64::from);
    let inside = Rectangle {
        from: [from_x, from_y],
        to: [to_x, to_y],
    };
    let mut expected = Vec::new();
    segment.for_each_pixel(inside, &mut |pixel| expected.push(pixel));
    expected.sort_unstable();
    assert_eq!(left, expected, "{ends:?} in {rectangle:?}");

    let [a, b] = ends;
    let is_long = (a.x - b.x).abs().max((a.y - b.y).abs()) >= 256;
    for pixel in found.iter().filter(|_| is_long) {
        let depth = segment.depth(place(pixel)).codes();
        let error = (pixel.depth as f64 / 16384.0 - depth).abs();
        assert!(error <= DEPTH_LIMIT, "{error} codes: {pixel:?} of {ends:?}");
        tally.depth_error = tally.depth_error.max(error);
    }
    tally.segments += 1;
    tally.empty += u64::from(found.is_empty());
    tally.pixels += found.len() as u64;
    let [left, top, right, bottom] = rectangle.map(|pixels| 256 * pixels);
    let is_outside =
        |v: &ScreenVertex| !(left..right).contains(&v.x) || !(top..bottom).contains(&v.y);
    tally.clipped += u64::from(ends.iter().any(is_outside));
}

fn exact(ends: &[ScreenVertex; 2]) -> ExactSegment {
    ExactSegment::new(ends.map(|v| SnappedVertex {
        x: v.x.into(),
        y: v.y.into(),
        w: v.w.into(),
    }))
}

fn place(pixel: &LinePixel) -> [i64; 2] {
    [pixel.column, pixel.row].map(i64::from)
}

fn vertex(random: &mut Pcg64Mcg, [x, y]: [i64; 2]) -> ScreenVertex {
    let inside = |x: i64| x.clamp(-(1 << 19), (1 << 19) - 1) as i32;
    ScreenVertex {
        x: inside(x),
        y: inside(y),
        w: match random.random_range(0..=9) {
            0 => 0,
            1 => ((1 << 18) - 1) << 6,
            _ => random.random_range(0..=((1 << 18) - 1) << 6),
        },
    }
}

/// A random segment: up to 3, 50 or 300 pixels long, from a position in or near the rectangle or anywhere in the guard band. Its ends are
/// anywhere, or on multiples of 1/16, 1/4, 1/2 or 1 pixel, where they touch centres and borders of diamonds and cause ties.
fn segment(random: &mut Pcg64Mcg, rectangle: [i32; 4]) -> [ScreenVertex; 2] {
    let grid = [1, 1, 16, 64, 128, 256][random.random_range(0..6usize)];
    let snap = |x: i64| x / grid * grid;
    let reach = match random.random_range(0..=9) {
        0..=2 => 256 * 3,
        3..=6 => 256 * 50,
        7 => 256 * 300,
        _ => 1 << 20,
    };
    let start = if reach == 1 << 20 {
        [0; 2].map(|_| random.random_range(-(1 << 19)..=(1 << 19) - 1))
    } else {
        let [left, top, right, bottom] = rectangle.map(i64::from);
        [[left, right], [top, bottom]]
            .map(|[from, to]| random.random_range(256 * (from - 20)..=256 * (to + 20)))
    };
    let mut way = [0; 2].map(|_| random.random_range(-reach..=reach));
    match random.random_range(0..=19) {
        0 => way[0] = 0,
        1 => way[1] = 0,
        2 => way[0] = way[1],
        3 => way[0] = -way[1],
        _ => {}
    }
    let end = [snap(start[0]) + snap(way[0]), snap(start[1]) + snap(way[1])];
    let start = start.map(snap);
    [vertex(random, start), vertex(random, end)]
}

fn random_segments(count: u64, seed: u64) -> Tally {
    let mut random = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
    let mut tally = Tally::default();
    for _ in 0..count {
        let rectangle = RECTANGLES[random.random_range(0..6usize)];
        let ends = segment(&mut random, rectangle);
        check(&ends, rectangle, &mut tally);
    }
    println!("{tally:?}");
    tally
}

#[test]
fn random_segments_have_exactly_their_pixels() {
    let tally = random_segments(20_000, 1);
    assert!(
        tally.pixels > 1_000_000 && tally.clipped > 5_000,
        "{tally:?}"
    );
}

#[test]
#[ignore = "minutes: 1,000,000 segments"]
fn a_million_random_segments_have_exactly_their_pixels() {
    let tally = random_segments(1_000_000, 2);
    assert!(tally.clipped > 100_000, "{tally:?}");
}

/// Every segment of at most 1.25 pixels in each direction, in steps of 1/8 pixel, from every position in a pixel: ends on centres, corners
/// and sides of diamonds, and segments along these sides.
#[test]
fn short_segments_have_exactly_their_pixels() {
    let mut tally = Tally::default();
    let steps = || (0..=8).map(|i| 32 * i);
    for x in steps() {
        for y in steps() {
            for dx in (-10..=10).map(|i| 32 * i) {
                for dy in (-10..=10).map(|i| 32 * i) {
                    let [x, y] = [1024 + x, 1024 + y];
                    let ends =
                        [[x, y], [x + dx, y + dy]].map(|[x, y]| ScreenVertex { x, y, w: 64 });
                    check(&ends, [0, 0, 10, 10], &mut tally);
                }
            }
        }
    }
    println!("{tally:?}");
}

/// Segments of extreme lengths and directions, from end points on and beside centres and borders of pixels.
#[test]
fn difficult_segments_have_exactly_their_pixels() {
    let mut tally = Tally::default();
    let (low, high) = (-(1 << 19), (1 << 19) - 1);
    let places = [
        low,
        low + 1,
        -1,
        0,
        1,
        127,
        128,
        129,
        255,
        256,
        320 * 256,
        320 * 256 + 128,
        high - 1,
        high,
    ];
    for [x, y] in pairs(&places) {
        for [to_x, to_y] in pairs(&places) {
            let ends = [
                ScreenVertex { x, y, w: 0 },
                ScreenVertex {
                    x: to_x,
                    y: to_y,
                    w: ((1 << 18) - 1) << 6,
                },
            ];
            check(&ends, [0, 0, 320, 180], &mut tally);
        }
    }
    // Segments across the whole range, from corner to corner and along the borders.
    for [x, y] in pairs(&[low, high]) {
        for [to_x, to_y] in pairs(&[low, high]) {
            let ends = [[x, y], [to_x, to_y]].map(|[x, y]| ScreenVertex { x, y, w: 1 << 20 });
            check(&ends, RECTANGLES[5], &mut tally);
        }
    }
    println!("{tally:?}");
}

fn pairs(places: &[i32]) -> impl Iterator<Item = [i32; 2]> {
    places
        .iter()
        .flat_map(|&x| places.iter().map(move |&y| [x, y]))
}

/// Depth codes follow the depth, saturate, and include the bias.
#[test]
fn codes_are_rounded_and_saturate() {
    let pixel = |depth| LinePixel {
        column: 0,
        row: 0,
        depth,
    };
    let tested = |bias| LineDepth::Tested { bias };
    for (depth, bias, code) in [
        (0, 0, 1),
        (-1 << 31, 0, 1),
        ((5 << 14) + 8191, 0, 5),
        ((5 << 14) + 8192, 0, 6),
        (5 << 14, 1000, 1005),
        ((1 << 32) - 1, 0, (1 << 18) - 1),
        (3 << 30, u16::MAX - 1, (1 << 18) - 2),
        (3 << 31, 0, (1 << 18) - 1),
    ] {
        assert_eq!(pixel(depth).code(tested(bias)), code, "{depth} + {bias}");
    }
    assert_eq!(pixel(0).code(LineDepth::Over), (1 << 18) - 1);
}
