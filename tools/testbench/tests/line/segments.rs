//! Segments for the tests, and the pieces into which the bands of a picture cut their lines.

use glint_model::line::{Line, LinePixel};
use glint_model::triangle::descriptor::band_rows;
use glint_model::triangle::setup::Bounds;
use glint_model::{SIZES, ScreenVertex};
use glint_testbench::{Bits, Layout};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Largest depth w, u18.6.
pub const NEAREST: u32 = ((1 << 18) - 1) << 6;

/// A segment and its colour.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    pub ends: [ScreenVertex; 2],
    pub colour: u16,
}

/// Pictures by their size codes.
pub fn picture(size: usize) -> Bounds {
    let (width, height) = SIZES[size];
    Bounds {
        left: 0,
        right: width as i32,
        top: 0,
        bottom: height as i32,
    }
}

/// The bands of a picture, from the top.
pub fn bands(size: usize) -> Vec<Bounds> {
    let picture = picture(size);
    let rows = band_rows(SIZES[size].0) as i32;
    let tops = (0..picture.bottom).step_by(rows as usize);
    tops.map(|top| Bounds {
        top,
        bottom: top + rows,
        ..picture
    })
    .collect()
}

impl Segment {
    /// The pixels in a band.
    pub fn pixels(&self, band: &Bounds) -> Vec<LinePixel> {
        let pixels = Line::new(&self.ends).map(|line| line.pixels(band));
        pixels.into_iter().flatten().collect()
    }

    /// The piece of the line in a band, as `line_pkg::piece_t`.
    pub fn piece(&self, layout: &Layout, band: &Bounds, bias: u16) -> Option<Bits> {
        let pixels = Line::new(&self.ends)?.pixels(band);
        let rest = *pixels.rest()?;
        let first = pixels.clone().next()?;
        let [major, minor] = rest.span;
        let [left, up] = if rest.x_major {
            rest.backward
        } else {
            [rest.backward[1], rest.backward[0]]
        };
        let piece = layout
            .record()
            .with("colour", self.colour)
            .with("x_major", u8::from(rest.x_major))
            .with("left", u8::from(left))
            .with("up", u8::from(up))
            .with("column", first.column)
            .with("row", first.row)
            .with("count", rest.count)
            .with("error", rest.error + minor)
            .with("minor", minor)
            .with("fall", minor - major)
            .with("depth", rest.depth + (i64::from(bias) << 14) + (1 << 13))
            .with("depth_step", rest.depth_step);
        Some(piece.bits())
    }

    /// The pieces of the line in the order in which it meets the bands.
    pub fn pieces(&self, layout: &Layout, size: usize, bias: u16) -> Vec<Bits> {
        let mut bands = bands(size);
        if self.ends[1].y < self.ends[0].y {
            bands.reverse();
        }
        bands
            .iter()
            .filter_map(|band| self.piece(layout, band, bias))
            .collect()
    }
}

/// A vertex at a position in 1/256 pixel, moved into the range of positions.
fn vertex([x, y]: [i32; 2], w: u32) -> ScreenVertex {
    let inside = |x: i32| x.clamp(-(1 << 19), (1 << 19) - 1);
    ScreenVertex {
        x: inside(x),
        y: inside(y),
        w,
    }
}

/// Random segments in and near a picture: short ones, of up to 60 pixels, and some anywhere in the guard band; a third of them on
/// coarse grids, where they meet centres, borders and ties.
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
        colour: random.random(),
    }
}

/// Horizontal, vertical and diagonal segments, in both directions: without length, within a pixel, across the picture and across
/// the whole range of positions, with ends on centres and borders and beside them.
pub fn difficult(size: usize) -> Vec<Segment> {
    let (width, height) = SIZES[size];
    let [right, bottom] = [width, height].map(|n| 256 * n as i32);
    let mut segments = vec![];
    let mut add = |a: [i32; 2], b: [i32; 2]| {
        for ends in [[a, b], [b, a]] {
            segments.push(Segment {
                ends: [vertex(ends[0], 0), vertex(ends[1], NEAREST)],
                colour: segments.len() as u16,
            });
        }
    };
    let (low, high) = (-(1 << 19), (1 << 19) - 1);
    for place in [
        -1,
        0,
        1,
        127,
        128,
        129,
        255,
        256,
        bottom - 129,
        bottom - 1,
        bottom,
    ] {
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
    for [x, y] in [
        [low, low],
        [low, high],
        [0, 0],
        [right, 0],
        [right - 1, bottom - 1],
    ] {
        for [to_x, to_y] in [[high, low], [high, high], [right, bottom], [0, bottom]] {
            add([x, y], [to_x, to_y]);
        }
    }
    segments
}

/// Segments of 50 pixels in all directions, wholly in the picture.
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
                colour: random.random(),
            }
        })
        .collect()
}
