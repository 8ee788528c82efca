//! Tests of the set-up of segments: every field of every piece.

use glint_core::colour::Rgb565;
use glint_core::picture::Size;
use glint_model::ScreenVertex;
use glint_model::line::{LineDepth, Segment};
use glint_testbench::{Bits, Layout, Pipe};
use glint_vectors::segments::{difficult, of_50_pixels, random};
use rand_pcg::Pcg64Mcg;

use crate::segments::{pieces, placed};

/// Sends segments to the set-up, and compares its pieces with the model's. Returns the clocks.
fn check(seed: u32, stalls: [f64; 2], size: usize, segments: &[Segment]) -> u64 {
    let (input, output) = (("in", &["segment"][..]), ("out", &["piece"][..]));
    let mut pipe = Pipe::new("line_setup", seed, input, output, stalls);
    let layouts = ["line_pkg::segment_t", "records_pkg::piece_t"]
        .map(|name| pipe.module.packed_type(name).clone());
    pipe.module.drive("size", size as u32);
    let start = pipe.module.cycles();
    for segment in segments {
        pipe.module.drive("bias", placed(segment).1);
        let expected = pieces(segment, &layouts[1], size);
        pipe.source.push(vec![pack(&layouts[0], segment)]);
        pipe.run(30_000, |pipe| pipe.source.is_empty());
        pipe.module.clock();
        let found: Vec<Bits> = pipe.sink.take().into_iter().map(|item| item[0]).collect();
        let show = |pieces: &[Bits]| -> Vec<String> {
            let record = |&bits| format!("{:?}", layouts[1].record_of(bits));
            pieces.iter().map(record).collect()
        };
        assert_eq!(show(&found), show(&expected), "{segment:?} at size {size}");
    }
    pipe.module.cycles() - start
}

fn pack(layout: &Layout, segment: &Segment) -> Bits {
    let ([a, b], _) = placed(segment);
    layout
        .record()
        .with("a_x", a.x)
        .with("a_y", a.y)
        .with("a_w", a.w)
        .with("b_x", b.x)
        .with("b_y", b.y)
        .with("b_w", b.w)
        .with("colour", segment.colour.0)
        .bits()
}

#[test]
fn random_segments() {
    for (seed, stalls) in [(1, [0.0, 0.0]), (2, [0.5, 0.2]), (3, [0.1, 0.7])] {
        let mut numbers = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        for size in 0..3 {
            let segments: Vec<Segment> = (0..400).map(|_| random(&mut numbers, size)).collect();
            check(seed, stalls, size, &segments);
        }
    }
}

#[test]
fn difficult_segments() {
    for size in 0..3 {
        check(4, [0.0, 0.3], size, &difficult(size));
    }
}

/// At 60 frames per second and 81.25 MHz, a frame of 10,000 segments leaves 135 clocks for each
/// segment.
#[test]
fn segments_of_50_pixels_take_less_than_a_frame_allows() {
    for size in 0..3 {
        let mut segments = of_50_pixels(size, 300);
        let each = |segments: &[Segment]| {
            let clocks = check(5, [0.0; 2], size, segments);
            clocks as f64 / segments.len() as f64
        };
        let deep = each(&segments);
        for segment in &mut segments {
            segment.ends[1].w = segment.ends[0].w;
        }
        let flat = each(&segments);
        println!(
            "size {size}: {deep:.1} clocks a segment of 50 pixels, {flat:.1} with equal depths"
        );
        assert!(flat < deep && deep < 135.0);
    }
}

/// A segment takes 31 clocks, or 59 if the depth changes along it, plus one clock for each of its
/// 10 pixels, one for its piece, and one for each band above the segment. If the depth changes, the
/// clocks for the bands overlap with the division.
#[test]
fn clocks_of_a_segment() {
    let above = u64::from(100 / Size::W640.band_lines());
    for (row, depth, clocks) in [
        (5, 0, 42),
        (5, 64_000, 70),
        (100, 0, 42 + above),
        (100, 64_000, 70),
    ] {
        let place = |x: i32, w| ScreenVertex {
            x: 256 * x + 128,
            y: 256 * row + 128,
            w,
        };
        let segment = Segment {
            ends: [place(10, 0), place(20, depth)],
            colour: Rgb565(1),
            depth: LineDepth::Tested { bias: 0 },
        };
        assert_eq!(check(6, [0.0; 2], 1, &[segment]), clocks, "{segment:?}");
    }
}
