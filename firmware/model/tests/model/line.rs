//! Tests of lines in combination with triangles, other lines and depths. `glint-reference` tests the exact pixels of single segments.

use glint_core::colour::Rgb565;
use glint_core::picture::Samples;
use glint_model::ScreenVertex;
use glint_model::line::{Line, LineDepth, LinePixel, Segment, draw};
use glint_model::triangle::descriptor::band_rows;
use glint_model::triangle::raster;
use glint_model::triangle::setup::Bounds;
use glint_vectors::triangles::{SIZE, at, set_up};
use glint_vectors::{Picture, Random};

const PICTURE: Bounds = Bounds {
    left: 0,
    right: SIZE.0 as i32,
    top: 0,
    bottom: SIZE.1 as i32,
};

fn pixels(ends: [ScreenVertex; 2], rectangle: Bounds) -> Vec<LinePixel> {
    let line = Line::new(&ends);
    let pixels = line.map(|line| line.pixels(&rectangle));
    pixels.into_iter().flatten().collect()
}

/// A random position in the picture or at most 30 pixels outside, mostly on a grid that causes ties.
fn place(random: &mut Random) -> [i64; 2] {
    let grid = [1, 64, 128, 256][random.integer(0, 3) as usize];
    [SIZE.0, SIZE.1]
        .map(|size| random.integer(-256 * 30, 256 * (i64::from(size) + 30)) / grid * grid)
}

/// Consecutive segments with the same major axis and direction have one pixel in each column or row.
#[test]
fn a_polyline_has_its_joints_once() {
    let mut random = Random(2);
    for _ in 0..300 {
        let (x_major, backward) = (random.coin(), random.coin());
        let mut points = vec![place(&mut random)];
        for _ in 0..20 {
            let ahead = random.integer(0, 256 * 6);
            let beside = random.integer(-ahead, ahead);
            let ahead = if backward { -ahead } else { ahead };
            // The major axis is horizontal if both distances are equal, so a line with a vertical major axis needs a shorter distance along
            // x.
            let [dx, dy] = if x_major {
                [ahead, beside]
            } else {
                [beside - beside.signum(), ahead]
            };
            let [x, y] = points[points.len() - 1];
            points.push([x + dx, y + dy]);
        }
        let everywhere = Bounds {
            left: -2048,
            right: 2048,
            top: -2048,
            bottom: 2048,
        };
        let mut steps: Vec<i32> = points
            .windows(2)
            .flat_map(|ends| pixels([at(ends[0]), at(ends[1])], everywhere))
            .map(|pixel| if x_major { pixel.column } else { pixel.row })
            .collect();
        if backward {
            steps.reverse();
        }
        assert!(
            steps.windows(2).all(|pair| pair[0] + 1 == pair[1]),
            "{points:?}"
        );
    }
}

/// The pieces of a line in all bands of a picture have the same pixels and depths as the whole line.
#[test]
fn bands_leave_a_line_as_it_is() {
    let mut random = Random(4);
    for _ in 0..2000 {
        let mut ends = [at(place(&mut random)), at(place(&mut random))];
        for end in &mut ends {
            end.w = random.integer(0, ((1 << 18) - 1) << 6) as u32;
        }
        let rows = band_rows(SIZE.0) as i32;
        let mut parts: Vec<LinePixel> = (0..PICTURE.bottom)
            .step_by(rows as usize)
            .flat_map(|top| {
                let bottom = top + rows;
                let band = Bounds {
                    top,
                    bottom,
                    ..PICTURE
                };
                pixels(ends, band)
            })
            .collect();
        let mut whole = pixels(ends, PICTURE);
        for pixels in [&mut parts, &mut whole] {
            pixels.sort_by_key(|pixel| [pixel.row, pixel.column]);
        }
        assert_eq!(parts, whole, "{ends:?}");
    }
}

/// [`Line::new`] rejects a segment with an end point outside of the position format.
#[test]
fn positions_have_a_range() {
    let (low, high) = (-(1 << 19), (1 << 19) - 1);
    assert!(Line::new(&[at([low, low]), at([high, high])]).is_some());
    assert!(Line::new(&[at([low, low]), at([high + 1, 0])]).is_none());
    assert!(Line::new(&[at([0, low - 1]), at([0, 0])]).is_none());
}

/// A line without a depth test replaces all pixels, and stores the largest depth code. A line with a depth test is hidden by nearer pixels,
/// and replaces pixels of equal depth.
#[test]
fn lines_meet_depths() {
    let ends = [[10, 10], [20, 10]].map(|[x, y]| at([256 * x + 128, 256 * y + 128]));
    let code = ends[0].w >> 6;
    for (stored, depth, drawn) in [
        (0, LineDepth::Tested { bias: 0 }, 10),
        (code, LineDepth::Tested { bias: 0 }, 10),
        (code + 1, LineDepth::Tested { bias: 0 }, 0),
        (code + 3, LineDepth::Tested { bias: 2 }, 0),
        (code + 3, LineDepth::Tested { bias: 3 }, 10),
        ((1 << 18) - 1, LineDepth::Over, 10),
    ] {
        let mut picture = Picture::blank(SIZE);
        picture.depth.fill(stored);
        let found = draw(&ends, Rgb565::WHITE, depth, &mut picture.target());
        assert_eq!(found, drawn);
        let expected = match depth {
            LineDepth::Over => (1 << 18) - 1,
            LineDepth::Tested { bias } => code + u32::from(bias),
        };
        let changed = picture.depth.iter().filter(|&&found| found != stored);
        assert!(changed.clone().all(|&found| found == expected));
        let white = picture.colour.iter().filter(|&&colour| colour == 0xFFFF);
        assert_eq!(white.count(), drawn as usize);
    }
}

/// The depth slope of a face along an axis of the screen, 0 for x, in codes per pixel.
fn slope(corners: [ScreenVertex; 3], axis: usize) -> f64 {
    let [a, b, c] = corners.map(|v| [v.x, v.y, v.w as i32].map(f64::from));
    let from_a = |v: [f64; 3], i: usize| v[i] - a[i];
    let cross = |i, j| from_a(b, i) * from_a(c, j) - from_a(c, i) * from_a(b, j);
    let rise = if axis == 0 { cross(2, 1) } else { cross(0, 2) };
    (rise / cross(0, 1)).abs() * 256.0 / 64.0
}

/// With the bias that docs/formats/line.md states, the edges of a face are never hidden by the face.
#[test]
fn edges_with_bias_lie_in_front_of_their_face() {
    let mut random = Random(5);
    let (mut drawn, mut hidden_without) = (0, 0);
    for _ in 0..1000 {
        let corners = [0; 3].map(|_| ScreenVertex {
            w: random.integer(1000, 200_000) as u32 * 64,
            ..at(place(&mut random))
        });
        let Some((_, setup)) = set_up(corners, SIZE) else {
            continue;
        };
        let mut picture = Picture::blank(SIZE);
        raster::draw(&setup, Rgb565::WHITE, &mut picture.target());
        let [a, b, c] = corners;
        for ends in [[a, b], [b, c], [c, a]] {
            let is_wide = (ends[0].x - ends[1].x).abs() >= (ends[0].y - ends[1].y).abs();
            let bias = slope(corners, usize::from(is_wide)) / 2.0 + 1.52;
            if bias > 65535.0 {
                continue;
            }
            let bias = bias.ceil() as u16;
            let shown = |bias, picture: &mut Picture| {
                let depth = LineDepth::Tested { bias };
                draw(&ends, Rgb565(0), depth, &mut picture.target())
            };
            let count = pixels(ends, PICTURE).len() as u32;
            hidden_without += count - shown(0, &mut picture.clone());
            let with_bias = shown(bias, &mut picture.clone());
            assert_eq!(with_bias, count, "{ends:?} of {corners:?}");
            drawn += count;
        }
    }
    println!("{drawn} pixels of edges, of which {hidden_without} would be hidden without bias");
    assert!(drawn > 50_000 && hidden_without > 1_000);
}

/// With four samples per pixel, a segment is drawn as two lines: the second line covers the samples next to those of the first line, on the
/// other side of the segment. Ends at the limits of the coordinates remain in range.
#[test]
fn segments_are_as_wide_as_pixels() {
    let mut random = Random(11);
    for number in 0..300 {
        let ends = [(); 2].map(|()| {
            let [x, y] = match number % 3 {
                0 => [(); 2].map(|()| random.integer(-(1 << 19), (1 << 19) - 1)),
                _ => place(&mut random),
            };
            ScreenVertex {
                x: x as i32,
                y: y as i32,
                w: random.integer(1 << 8, 1 << 23) as u32,
            }
        });
        let bias = random.integer(0, 1 << 15) as u16;
        let segment = Segment {
            ends,
            colour: Rgb565(0xFFFF),
            depth: LineDepth::Tested { bias },
        };
        assert!(segment.strokes(Samples::One).eq([segment]));
        let lines: Vec<_> = segment.strokes(Samples::Four).collect();
        assert!(lines.iter().all(|line| {
            let is_in_range = |place: i32| (-(1 << 19)..1 << 19).contains(&place);
            line.ends
                .iter()
                .all(|end| is_in_range(end.x) && is_in_range(end.y))
                && line.depth == LineDepth::Tested { bias: 2 * bias }
        }));
        if number % 3 == 0 {
            continue;
        }
        let [a, b] = ends;
        let everywhere = Bounds {
            left: -2048,
            right: 2048,
            top: -2048,
            bottom: 2048,
        };
        let is_flat = (b.x - a.x).abs() >= (b.y - a.y).abs();
        let [first, second] = [0, 1].map(|line: usize| pixels(lines[line].ends, everywhere));
        let beside = first.iter().map(|pixel| match is_flat {
            true => [pixel.column, pixel.row + 1],
            false => [pixel.column + 1, pixel.row],
        });
        assert!(
            second
                .iter()
                .map(|pixel| [pixel.column, pixel.row])
                .eq(beside),
            "{segment:?}"
        );
    }
}
