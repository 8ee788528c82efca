//! Tests of the depth codes of triangles with random screen coordinates.

use glint_core::colour::Rgb565;
use glint_model::triangle::raster::draw;
use glint_model::triangle::reciprocal::Reciprocal;
use glint_model::{SIZES, ScreenVertex};
use glint_vectors::triangles::{SIZE, at, random_triangle, set_up};
use glint_vectors::{Picture, Random};

/// Compares the stored depth code of every covered pixel with the exact plane through the three vertices (x, y, w).
/// Returns the largest error in codes, which includes the error of up to half a code from the final rounding.
fn depth_error(vertices: [ScreenVertex; 3], size: (u32, u32)) -> f64 {
    let mut picture = Picture::blank(size);
    let Some((triangle, setup)) = set_up(vertices, size) else {
        return 0.0;
    };
    draw(&setup, Rgb565::WHITE, &mut picture.target());
    let [v0, v1, v2] = triangle
        .vertices
        .map(|v| [v.x, v.y, v.w as i32].map(i128::from));
    let area = i128::from(triangle.doubled_area);
    let (p1, p2) = (
        [0, 1, 2].map(|k| v1[k] - v0[k]),
        [0, 1, 2].map(|k| v2[k] - v0[k]),
    );
    // Steps 6 to 8 of the triangle setup, as written in docs/formats/triangle.md.
    let Reciprocal { y, lead } = Reciprocal::of(triangle.doubled_area);
    let gradient =
        |n: i128| ((n * i128::from(y) + (1 << (lead + 7))) >> (lead + 8)).rem_euclid(1 << 40);
    let gx = gradient(p1[2] * p2[1] - p2[2] * p1[1]);
    let gy = gradient(p2[2] * p1[0] - p1[2] * p2[0]);
    let mut worst: f64 = 0.0;
    for (pixel, &code) in picture
        .depth
        .iter()
        .enumerate()
        .filter(|&(_, &code)| code != 0)
    {
        let (i, j) = (
            (pixel % size.0 as usize) as i128,
            (pixel / size.0 as usize) as i128,
        );
        let (dx, dy) = (256 * i + 128 - v0[0], 256 * j + 128 - v0[1]);
        let accumulator = (v0[2] << 8) + ((gx * dx + gy * dy) >> 8);
        let as_written = ((accumulator + (1 << 13)) >> 14).rem_euclid(1 << 18).max(1);
        assert_eq!(i128::from(code), as_written, "{vertices:?} at {i}, {j}");
        // The exact depth minus the stored depth, in codes, multiplied by 64 and by the doubled area of the triangle.
        let exact = (v0[2] - 64 * i128::from(code)) * area
            + (p1[2] * p2[1] - p2[2] * p1[1]) * dx
            + (p2[2] * p1[0] - p1[2] * p2[0]) * dy;
        worst = worst.max(exact.abs() as f64 / (64.0 * area as f64));
        let (low, high) = (v0[2].min(v1[2]).min(v2[2]), v0[2].max(v1[2]).max(v2[2]));
        let code = 64 * i128::from(code);
        assert!(
            low - 64 < code && code < high + 64,
            "a depth code is outside the range of the vertices' depths"
        );
    }
    worst
}

#[test]
fn depth_against_the_exact_plane() {
    let mut random = Random(6);
    // Sets random depths of the vertices from the whole range of a frame, which ends at 2^18 − 4 codes.
    let mut steep = |mut triangle: [ScreenVertex; 3]| {
        for vertex in &mut triangle {
            vertex.w = match random.integer(0, 3) {
                0 => 200 * 64,
                1 => ((1 << 18) - 4) * 64,
                _ => random.integer(200 * 64, ((1 << 18) - 4) * 64) as u32,
            };
        }
        triangle
    };
    let mut shapes = Random(7);
    let mut worst: f64 = 0.0;
    for _ in 0..4000 {
        worst = worst.max(depth_error(steep(random_triangle(&mut shapes)), SIZE));
    }
    // Slivers in all directions, with an aspect ratio of 1000:1 or more.
    let mut slivers: f64 = 0.0;
    for size in [SIZES[0], SIZES[2]] {
        for _ in 0..if size == SIZES[0] { 3000 } else { 150 } {
            let (w, h) = (256 * i64::from(size.0), 256 * i64::from(size.1));
            let [a, b] = [0; 2].map(|_| {
                [
                    shapes.integer(-w / 4, w * 5 / 4),
                    shapes.integer(-h / 4, h * 5 / 4),
                ]
            });
            let length = ((b[0] - a[0]).pow(2) + (b[1] - a[1]).pow(2)).isqrt().max(1);
            let t = shapes.real(0.0, 1.0);
            let side = shapes.integer(0, length / 1000) + 1;
            let c = [0, 1].map(|k| {
                a[k] + ((b[k] - a[k]) as f64 * t) as i64
                    + [-1, 1][k] * (b[1 - k] - a[1 - k]) * side / length
            });
            slivers = slivers.max(depth_error(steep([a, b, c].map(at)), size));
        }
    }
    println!(
        "depth error: at most {worst:.4} codes, on slivers {slivers:.4} (the rounding is half a code)"
    );
    assert!(worst.max(slivers) <= 0.5 + 0.26);
}
