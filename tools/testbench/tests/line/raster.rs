//! Tests of the line raster: every pixel of every piece, band by band.

use glint_model::SIZES;
use glint_model::line::Segment;
use glint_model::triangle::setup::Bounds;
use glint_testbench::{Bits, Layout, Pipe, Port};
use glint_vectors::segments::{difficult, of_50_pixels, random};
use rand_pcg::Pcg64Mcg;

use crate::segments::{bands, piece, pixels};

/// Number of pixel columns of a group.
const LANES: u32 = 8;

struct Bench {
    pipe: Pipe,
    piece: Layout,
    idle: Port,
}

impl Bench {
    fn new(seed: u32, stalls: [f64; 2], size: usize) -> Self {
        let payload = ["row", "line", "column", "mask", "code", "colour"];
        let (input, output) = (("in", &["piece"][..]), ("group", &payload[..]));
        let mut pipe = Pipe::new("line_raster", seed, input, output, stalls);
        pipe.module.drive("size", size as u32);
        Self {
            piece: pipe.module.packed_type("records_pkg::piece_t").clone(),
            idle: pipe.module.port("idle"),
            pipe,
        }
    }

    /// Draws the pieces of segments in a band, and compares the groups with the model's pixels.
    /// Returns the numbers of clocks and pixels.
    fn band(&mut self, size: usize, band: &Bounds, segments: &[Segment]) -> [u64; 2] {
        let stride = SIZES[size].0 / LANES;
        self.pipe.module.drive("first_row", band.top);
        let mut expected = vec![];
        for segment in segments {
            let Some(piece) = piece(segment, &self.piece, size, band) else {
                continue;
            };
            self.pipe.source.push(vec![piece]);
            for pixel in pixels(segment, band) {
                let [column, line] = [pixel.column as u32, (pixel.row - band.top) as u32];
                let code = pixel.code(segment.depth);
                let group = column / LANES;
                expected.push([
                    line * stride + group,
                    line,
                    group,
                    1 << (column % LANES),
                    code,
                    segment.colour.0.into(),
                ]);
            }
        }
        let (pipe, idle) = (&mut self.pipe, self.idle);
        pipe.module.settle();
        assert!(pipe.module.is_high(idle));
        let clocks = pipe.drain(2_000_000, idle, |_| ());
        let found: Vec<[u32; 6]> = pipe.sink.take().iter().map(|item| group(item)).collect();
        for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "pixel {i} in {band:?}");
        }
        assert_eq!(found.len(), expected.len(), "in {band:?}");
        [clocks, expected.len() as u64]
    }

    fn picture(&mut self, size: usize, segments: &[Segment]) -> [u64; 2] {
        let mut sums = [0; 2];
        for band in bands(size) {
            let counts = self.band(size, &band, segments);
            sums = [sums[0] + counts[0], sums[1] + counts[1]];
        }
        sums
    }
}

fn group(item: &[Bits]) -> [u32; 6] {
    [0, 1, 2, 3, 4, 5].map(|i: usize| item[i].number() as u32)
}

#[test]
fn random_segments() {
    for (seed, stalls) in [(1, [0.0, 0.0]), (2, [0.5, 0.2]), (3, [0.1, 0.7])] {
        let mut numbers = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        for size in 0..3 {
            let segments: Vec<Segment> = (0..200).map(|_| random(&mut numbers, size)).collect();
            let mut bench = Bench::new(seed, stalls, size);
            bench.picture(size, &segments);
        }
    }
}

#[test]
fn difficult_segments() {
    for size in 0..3 {
        let mut bench = Bench::new(4, [0.0, 0.3], size);
        bench.picture(size, &difficult(size));
    }
}

/// Pieces of any length take one clock per pixel, plus the latency of each band.
#[test]
fn a_pixel_a_clock() {
    for size in 0..3 {
        let mut bench = Bench::new(5, [0.0; 2], size);
        let segments = of_50_pixels(size, 1000);
        let [clocks, pixels] = bench.picture(size, &segments);
        let latency = 10 * bands(size).len() as u64;
        println!("size {size}: {pixels} pixels in {clocks} clocks");
        assert!(
            clocks <= pixels + latency,
            "{clocks} clocks, {pixels} pixels"
        );
    }
}
