//! Compares the rasterizer with glint-model: its pixel groups, band by band, must compose the model's picture.

mod bench;
mod triangles;

use glint_core::colour::Rgb565;
use glint_model::triangle::shade::Lit;
use glint_model::triangle::vertex::GUARD;
use glint_model::{ScreenVertex, Shading};

use crate::raster::bench::Bench;
use crate::raster::triangles::{LARGE, MIDDLE, Random, SMALL, Triangle, numbered, pixels};

#[test]
fn random_triangles() {
    for (seed, source_stalls, sink_stalls) in [(1, 0.0, 0.0), (2, 0.5, 0.2), (3, 0.1, 0.7)] {
        let mut random = Random::new(seed.into());
        let mut bench = Bench::new(Shading::Flat, seed, [source_stalls, sink_stalls]);
        let triangles = (0..250).map(|_| random.triangle(SMALL));
        let triangles = numbered(SMALL, triangles);
        let counts = bench.check("random", SMALL, &triangles);
        println!("{} triangles: {counts:?}", triangles.len());
        assert!(triangles.len() > 150 && counts.pixels > 200_000);
    }
}

/// Draws smooth and flat triangles in one frame, over the whole range of depths.
#[test]
fn random_triangles_smooth() {
    for (seed, source_stalls, sink_stalls) in [(4, 0.0, 0.0), (5, 0.5, 0.2), (6, 0.1, 0.7)] {
        let mut random = Random::new(seed.into());
        let mut bench = Bench::new(Shading::Smooth, seed, [source_stalls, sink_stalls]);
        for (name, size, count) in [("small", SMALL, 120), ("large", LARGE, 36)] {
            let triangles = (0..count).map(|_| random.triangle(size).map(visible));
            let triangles: Vec<Triangle> = numbered(size, triangles.collect::<Vec<_>>())
                .into_iter()
                .map(|triangle| match random.within(0, 3) {
                    0 => triangle,
                    _ => triangle.with_light(&[0; 3].map(|_| random.lit())),
                })
                .collect();
            let counts = bench.check(name, size, &triangles);
            println!("{} triangles: {counts:?}", triangles.len());
            assert!(counts.pixels > 50_000);
        }
    }
}

/// Draws triangles with light from 0 to the maximum, and with constant light, over several ranges of depths. Each triangle is drawn alone.
#[test]
fn extreme_light() {
    let (near, far) = (((1 << 18) - 4) * 64, 228 * 64);
    let mut bench = Bench::new(Shading::Smooth, 7, [0.0, 0.3]);
    let white = Lit::new(Rgb565::WHITE.fractions(), [256; 3]);
    let dark = Lit::default();
    let any = Lit::new(Rgb565(0x5AA5).fractions(), [77; 3]);
    for depths in [[near, far, far], [far, near, far], [far; 3], [near; 3]] {
        for lit in [
            [white, dark, dark],
            [dark, white, dark],
            [white, white, dark],
            [white; 3],
            [dark; 3],
            [any; 3],
        ] {
            for corners in shapes_at(depths) {
                let triangles = numbered(SMALL, [corners]);
                let lit: Vec<Triangle> =
                    triangles.into_iter().map(|t| t.with_light(&lit)).collect();
                bench.check("light", SMALL, &lit);
            }
        }
    }
}

/// Makes a huge, a small and a narrow triangle whose vertices have these depths.
fn shapes_at(depths: [u32; 3]) -> [[ScreenVertex; 3]; 3] {
    let shapes = [
        [[-2000.0, -1500.0], [2000.0, 60.0], [-1900.0, 2000.0]],
        [[100.2, 50.1], [103.3, 50.4], [101.1, 53.7]],
        [[5.0, 5.0], [5.3, 5.0], [300.0, 170.0]],
    ];
    shapes.map(|shape| {
        let mut corners = pixels(shape);
        for (corner, w) in corners.iter_mut().zip(depths) {
            corner.w = w;
        }
        corners
    })
}

/// Clamps the depth of a vertex to the farthest depth of a frame.
fn visible(corner: ScreenVertex) -> ScreenVertex {
    ScreenVertex {
        w: corner.w.max(228 * 64),
        ..corner
    }
}

/// Draws each triangle alone, not hidden by other triangles.
#[test]
fn difficult_triangles() {
    let far = f64::from(GUARD) / 256.0;
    let shapes = [
        [[-far, -far], [far, -far], [-far, far]], // as wide as the guard band
        [[far, far], [-far, far], [far, -far]],   // the other half of this rectangle
        [[10.0, 20.0], [310.0, 20.3], [160.0, 20.4]], // a sliver, 1000 to 1
        [[33.3, 2.0], [33.6, 2.0], [33.5, 178.0]], // an upright sliver
        [[20.0, 0.0], [21.0, 0.0], [300.0, 180.0]], // a steep sliver
        [[-far, 10.0], [far, 95.2], [far, 95.9]], // a flat sliver from the guard band
        [[100.5, 50.5], [101.5, 50.5], [100.5, 51.5]], // one pixel
        [[100.4, 50.4], [100.7, 50.5], [100.4, 50.7]], // around one pixel centre
        [[100.6, 10.0], [101.4, 10.0], [101.0, 90.0]], // between two pixel centres
        [[20.0, 40.6], [90.0, 41.4], [20.0, 41.4]], // between two rows
        [[64.0, 8.0], [72.0, 8.0], [64.0, 108.0]], // one group wide
        [[40.0, 8.0], [64.0, 8.0], [40.0, 108.0]], // up to the border of a group
        [[64.5, 8.0], [71.5, 8.0], [71.5, 100.0]], // vertices at the first and last pixel centre of a group
        [[8.0, 8.0], [300.0, 8.0], [8.0, 170.0]],  // a horizontal and a vertical edge
        [[150.0, 8.0], [300.0, 170.0], [8.0, 170.0]], // a horizontal lower edge
        [[300.0, 8.0], [300.0, 170.0], [8.0, 90.0]], // pointing left
        [[10.0, 45.0], [90.0, 45.0], [50.0, 46.0]], // in the first row of a band
        [[10.0, 44.0], [90.0, 44.0], [50.0, 45.0]], // in the last row of a band
        [[319.0, 179.0], [320.0, 179.0], [320.0, 180.0]], // in the corner of the picture
        [[-500.0, 20.0], [40.0, 90.0], [-500.0, 160.0]], // across the left border of the picture
        [[900.0, 20.0], [280.0, 90.0], [900.0, 160.0]], // across the right border of the picture
        [[160.0, -900.0], [200.0, 100.0], [120.0, 100.0]], // across the upper border of the picture
        [[3.0, 3.0], [9.0, 3.0], [319.0, 2000.0]], // a vertex far below the picture
        [[310.0, 1.0], [1.0, 4.0], [318.0, 9.0]],  // a sliver with edges in opposite directions
    ]
    .map(pixels);
    let mut bench = Bench::new(Shading::Flat, 11, [0.3, 0.3]);
    for corners in shapes {
        // Draws each triangle with three orders of its corners (both orientations), and mirrored left to right.
        let [a, b, c] = corners;
        let flipped = [a, b, c].map(|v| ScreenVertex {
            x: 256 * 320 - v.x,
            ..v
        });
        for corners in [[a, b, c], [b, c, a], [b, a, c], flipped] {
            bench.check("difficult", SMALL, &numbered(SMALL, [corners]));
        }
    }
    assert!(numbered(SMALL, shapes).len() >= 20);
}

/// Draws triangles with depths at both ends of the range, where intermediate results of the depth's gradients overflow.
#[test]
fn extreme_depths() {
    let near = ((1 << 18) - 4) * 64;
    let mut bench = Bench::new(Shading::Flat, 12, [0.0, 0.3]);
    let triangles = [
        [near, 0, 0],
        [0, near, 0],
        [0, 0, near],
        [near, near, 0],
        [0; 3],
        [near; 3],
    ];
    for depths in triangles {
        for corners in shapes_at(depths) {
            bench.check("depths", SMALL, &numbered(SMALL, [corners]));
        }
    }
}

#[test]
fn whole_pictures() {
    let corners = [
        [-2047.0, -2047.0],
        [2047.0, -2047.0],
        [2047.0, 2047.0],
        [-2047.0, 2047.0],
    ];
    let [a, b, c, d] = corners;
    let mut bench = Bench::new(Shading::Flat, 14, [0.0, 0.0]);
    for size in [MIDDLE, LARGE] {
        let triangles = numbered(size, [pixels([a, b, c]), pixels([a, c, d])]);
        let counts = bench.check("all of it", size, &triangles);
        assert_eq!(counts.pixels, u64::from(size.0 * size.1));
        println!("{size:?}: {counts:?}");
        // The rasterizer visits few groups without covered pixels.
        assert!(counts.walked < counts.pixels / 8 * 11 / 10);

        let mut random = Random::new(6);
        let small = (0..60).map(|_| {
            let place = [
                random.within(0, size.0 as i32),
                random.within(0, size.1 as i32),
            ];
            [0; 3].map(|_| random.near(place, 60, 1))
        });
        bench.check("some of it", size, &numbered(size, small));
    }
}

/// The rasterizer drops a triangle without a line in the band, and draws the next triangle.
#[test]
fn triangles_outside_of_the_band() {
    let mut bench = Bench::new(Shading::Flat, 15, [0.0, 0.0]);
    let at = |[top, bottom]: [f64; 2]| pixels([[10.0, top], [60.0, top + 1.0], [10.0, bottom]]);
    for y0 in [0, 45, 90, 135] {
        let (above, below) = (f64::from(y0), f64::from(y0 + 45));
        let outside = (0..170)
            .map(f64::from)
            .map(|top| [top, top + 9.0])
            .filter(|&[top, bottom]| bottom <= above || top >= below);
        let all = outside.chain([[0.0, 180.0]]).map(at);
        let triangles = numbered(SMALL, all);
        let groups = bench.band([y0, 45, 40], triangles.iter());
        let last = triangles.len() as u64 - 1;
        assert!(!groups.is_empty());
        assert!(groups.iter().all(|group| group[3].element(16, 0) == last));
    }
}
