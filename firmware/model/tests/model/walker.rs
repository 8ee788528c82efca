//! Tests of the pixels that the setup and the walker cover, for triangles in screen coordinates.

use glint_core::colour::Rgb565;
use glint_model::triangle::raster::{Coverage, draw};
use glint_model::triangle::setup::Oriented;
use glint_model::triangle::vertex::GUARD;
use glint_model::{SIZES, ScreenVertex};
use glint_vectors::triangles::{SIZE, at, random_triangle, set_up};
use glint_vectors::{Picture, Random};

/// Draws one triangle on a blank picture. Returns which pixels are covered, and the walker's counts.
fn alone(vertices: [ScreenVertex; 3], size: (u32, u32)) -> (Vec<bool>, Coverage) {
    let mut picture = Picture::blank(size);
    let coverage = set_up(vertices, size)
        .map(|(_, setup)| draw(&setup, Rgb565::WHITE, &mut picture.target()))
        .unwrap_or_default();
    let covered = picture.coverage();
    assert_eq!(picture.covered(), coverage.covered as usize);
    assert_eq!(coverage.drawn, coverage.covered);
    (covered, coverage)
}

/// Whether all three edge functions are at least 0, for each pixel of the picture. Every pixel is computed independently, without the
/// walker.
fn by_edges(vertices: [ScreenVertex; 3], (width, height): (u32, u32)) -> Vec<bool> {
    let mut covered = vec![false; (width * height) as usize];
    let Some((oriented, setup)) = set_up(vertices, (width, height)) else {
        return covered;
    };
    let top = i64::from(setup.bounds.top);
    for j in 0..i64::from(height) {
        for i in 0..i64::from(width) {
            let inside = setup.edges.iter().all(|edge| {
                let (right, down) = (i - i64::from(setup.start_column), j - top);
                edge.start + right * i64::from(edge.step_x) + down * i64::from(edge.step_y) >= 0
            });
            // Stepping an edge function is exact: it gives the directly computed values.
            assert_eq!(inside, directly(&oriented, i, j));
            covered[(j * i64::from(width) + i) as usize] = inside;
        }
    }
    covered
}

fn directly(triangle: &Oriented, i: i64, j: i64) -> bool {
    let v = triangle.vertices.map(|v| [i64::from(v.x), i64::from(v.y)]);
    [[v[0], v[1]], [v[1], v[2]], [v[2], v[0]]]
        .iter()
        .all(|[a, b]| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let value = dx * (256 * j + 128 - a[1]) - dy * (256 * i + 128 - a[0]);
            value > 0 || value == 0 && (dy < 0 || dy == 0 && dx > 0)
        })
}

#[test]
fn the_walker_finds_what_the_edges_cover() {
    let mut random = Random(1);
    let (mut wide, mut covered, mut tested) = (0, 0, 0);
    for _ in 0..400 {
        let triangle = random_triangle(&mut random);
        let (found, coverage) = alone(triangle, SIZE);
        assert_eq!(found, by_edges(triangle, SIZE), "{triangle:?}");
        wide += u32::from(set_up(triangle, SIZE).is_some_and(|(_, setup)| !setup.narrow));
        covered += coverage.covered;
        tested += coverage.tested;
    }
    println!(
        "{wide} of 400 triangles needed 64-bit edge functions; {tested} pixels tested for {covered} covered"
    );
    assert!(wide >= 5, "both accumulators must be used: {wide}");
}

#[test]
fn both_accumulators_walk_alike() {
    let mut random = Random(2);
    for _ in 0..600 {
        let Some((_, narrow)) = set_up(random_triangle(&mut random), SIZE) else {
            continue;
        };
        let [mut a, mut b] = [0; 2].map(|_| Picture::blank(SIZE));
        let mut wide = narrow;
        wide.narrow = false;
        let drawn = draw(&narrow, Rgb565::WHITE, &mut a.target());
        assert_eq!(drawn, draw(&wide, Rgb565::WHITE, &mut b.target()));
        assert_eq!(a, b);
    }
}

/// The number of tested pixels exceeds the number of covered pixels by at most a multiple of the triangle's width and height, not of its
/// area.
#[test]
fn the_walker_does_not_look_through_the_box() {
    let mut random = Random(3);
    for _ in 0..1000 {
        let triangle = random_triangle(&mut random);
        let Some((_, setup)) = set_up(triangle, SIZE) else {
            continue;
        };
        let (_, coverage) = alone(triangle, SIZE);
        let b = setup.bounds;
        let extents = (4 * (b.right - b.left + 1) + 2 * (b.bottom - b.top)) as u32;
        assert!(
            coverage.tested <= coverage.covered + extents,
            "{coverage:?} in {b:?}"
        );
    }
}

/// Draws every triangle on a 5×5 grid of half pixels, where most pixel centres lie on edges and vertices.
#[test]
fn top_left_torture_on_the_half_pixel_grid() {
    let grid: Vec<[i64; 2]> = (0..=4)
        .flat_map(|j| (0..=4).map(move |i| [1280 + 128 * i, 1280 + 128 * j]))
        .collect();
    let mut tried = 0;
    for (i, &a) in grid.iter().enumerate() {
        for (j, &b) in grid.iter().enumerate().skip(i + 1) {
            for &c in &grid[j + 1..] {
                let triangle = [a, b, c].map(at);
                let Some(oriented) = Oriented::new(triangle) else {
                    continue;
                };
                let (covered, _) = alone(triangle, SIZE);
                for (x, y) in (4..9).flat_map(|y| (4..9).map(move |x| (x, y))) {
                    let expected = directly(&oriented, x as i64, y as i64);
                    assert_eq!(covered[y * 320 + x], expected, "{triangle:?}");
                }
                // Exchanging two vertices, or choosing another first vertex, does not change the covered pixels.
                assert_eq!(covered, alone([b, a, c].map(at), SIZE).0);
                assert_eq!(covered, alone([b, c, a].map(at), SIZE).0);
                tried += 1;
            }
        }
    }
    assert_eq!(tried, 2148);
}

/// Compares the covered pixels of the two triangles of a square with known results of the top-left rule.
#[test]
fn a_square_on_pixel_centres() {
    let [a, b, c, d] = [[0, 0], [4, 0], [4, 4], [0, 4]]
        .map(|[x, y]| at([2560 + 128 + 256 * x, 2560 + 128 + 256 * y]));
    let covered = |triangle| {
        let (covered, _) = alone(triangle, SIZE);
        (0..covered.len())
            .filter(|&i| covered[i])
            .map(|i| (i % 320 - 10, i / 320 - 10))
            .collect::<Vec<_>>()
    };
    // Pixels on the diagonal from top left to bottom right belong to the triangle to the right of the diagonal.
    assert_eq!(
        covered([a, b, c]),
        [
            (0, 0),
            (1, 0),
            (2, 0),
            (3, 0),
            (1, 1),
            (2, 1),
            (3, 1),
            (2, 2),
            (3, 2),
            (3, 3)
        ]
    );
    assert_eq!(
        covered([a, c, d]),
        [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)]
    );
}

#[test]
fn the_whole_picture() {
    let g = i64::from(GUARD) + 128;
    let [a, b, c, d] = [[-g, -g], [g, -g], [g, g], [-g, g]].map(at);
    let one = [[-2047, -300], [2047, -300], [640, 2047]].map(|[x, y]| at([256 * x, 256 * y]));
    for size in SIZES {
        let pixels = size.0 * size.1;
        let halves = [[a, b, c], [a, c, d]].map(|t| alone(t, size).0);
        assert!(halves[0].iter().zip(&halves[1]).all(|(&x, &y)| x != y));
        let (_, coverage) = alone(one, size);
        assert_eq!(coverage.covered, pixels);
        assert!(coverage.tested <= pixels + 2 * size.0, "{coverage:?}");
    }
}
