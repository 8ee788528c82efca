//! Segments in screen coordinates: random segments, edge cases, and segments for measurements of the line engine's rate.

use glint_core::colour::Rgb565;
use glint_model::line::{LineDepth, Segment};
use glint_model::{SIZES, ScreenVertex};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Largest depth w, u18.6.
pub const NEAREST: u32 = ((1 << 18) - 1) << 6;

/// A vertex at a position in 1/256 pixel, clamped to the range of positions.
fn vertex([x, y]: [i32; 2], w: u32) -> ScreenVertex {
    let inside = |x: i32| x.clamp(-(1 << 19), (1 << 19) - 1);
    ScreenVertex {
        x: inside(x),
        y: inside(y),
        w,
    }
}

/// Makes a random segment in or near a picture of the size `SIZES[size]`. Most have up to 60 pixels, some lie anywhere in the guard band,
/// and a third lie on coarse grids, where they touch pixel centres and borders and cause ties.
pub fn random(random: &mut Pcg64Mcg, size: usize) -> Segment {
    let grid = [1, 1, 1, 1, 64, 128][random.random_range(0..6usize)];
    let (width, height) = SIZES[size];
    let reach = match random.random_range(0..20) {
        0..8 => 256 * 4,
        8..18 => 256 * 60,
        _ => 1 << 20,
    };
    let start = [width, height].map(|n| random.random_range(-256 * 20..256 * (n as i32 + 20)));
    let mut way = [0; 2].map(|_| random.random_range(-reach..=reach));
    match random.random_range(0..12) {
        0 => way[0] = 0,
        1 => way[1] = 0,
        2 => way[0] = way[1],
        _ => {}
    }
    let end = [start[0] + way[0], start[1] + way[1]];
    let depths = match random.random_range(0..4) {
        0 => [NEAREST; 2],
        1 => [0, NEAREST],
        _ => [0; 2].map(|_| random.random_range(0..=NEAREST)),
    };
    let snap = |place: [i32; 2]| place.map(|x| x / grid * grid);
    Segment {
        ends: [vertex(snap(start), depths[0]), vertex(snap(end), depths[1])],
        colour: Rgb565(random.random()),
        depth: match random.random_range(0..4) {
            0 => LineDepth::Over,
            1 => LineDepth::Tested { bias: 0 },
            2 => LineDepth::Tested { bias: u16::MAX },
            _ => LineDepth::Tested {
                bias: random.random_range(0..200),
            },
        },
    }
}

/// Makes horizontal, vertical and diagonal segments, in both directions: of length 0, within a pixel, across the picture and
/// across the whole range of positions, with end points on and beside pixel centres and borders.
pub fn difficult(size: usize) -> Vec<Segment> {
    let (width, height) = SIZES[size];
    let [right, bottom] = [width, height].map(|n| 256 * n as i32);
    let mut segments = vec![];
    let mut add = |a: [i32; 2], b: [i32; 2]| {
        for ends in [[a, b], [b, a]] {
            segments.push(Segment {
                ends: [vertex(ends[0], 0), vertex(ends[1], NEAREST)],
                colour: Rgb565(segments.len() as u16),
                depth: LineDepth::Tested { bias: 5 },
            });
        }
    };
    let (low, high) = (-(1 << 19), (1 << 19) - 1);
    let at_bottom = [bottom - 129, bottom - 1, bottom];
    for place in [-1, 0, 1, 127, 128, 129, 255, 256]
        .into_iter()
        .chain(at_bottom)
    {
        add([0, place], [right, place]);
        add([low, place], [high, place]);
        add([place, 0], [place, bottom]);
        add([place, low], [place, high]);
        add([place, place], [place, place]);
        add([place, place], [place + 1, place]);
        add([place, place], [place + 200, place + 100]);
        add([low, place], [high, place + 300]);
        add([low, place], [high, bottom - place]);
        add([place, low], [place + 300, high]);
    }
    let last = [right - 1, bottom - 1];
    for from in [[low, low], [low, high], [0, 0], [right, 0], last] {
        for to in [[high, low], [high, high], [right, bottom], [0, bottom]] {
            add(from, to);
        }
    }
    segments
}

/// Makes segments of 50 pixels in all directions, inside the picture.
pub fn of_50_pixels(size: usize, count: usize) -> Vec<Segment> {
    let mut random = Pcg64Mcg::new(7);
    let (width, height) = SIZES[size];
    (0..count)
        .map(|_| {
            let angle = random.random_range(0.0..std::f64::consts::TAU);
            let (sine, cosine) = angle.sin_cos();
            let scale = 256.0 * 50.0 / sine.abs().max(cosine.abs());
            let start =
                [width, height].map(|n| random.random_range(256 * 51..256 * (n as i32 - 51)));
            let way = [cosine, sine].map(|part| (scale * part) as i32);
            let end = [start[0] + way[0], start[1] + way[1]];
            let depths = [0; 2].map(|_| random.random_range(0..=NEAREST));
            Segment {
                ends: [vertex(start, depths[0]), vertex(end, depths[1])],
                colour: Rgb565(random.random()),
                depth: LineDepth::Tested { bias: 0 },
            }
        })
        .collect()
}
