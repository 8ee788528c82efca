//! Tests of the line engine within the triangle engine: frames of lines, and of lines and triangles.

use glint_core::colour::Rgb565;
use glint_model::ScreenVertex;
use glint_model::line::{LineDepth, Segment};
use glint_vectors::meshes::{self, ahead, at};
use glint_vectors::segments::{difficult, of_50_pixels, random};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{Expected, SIZES, expected};
use super::gathered::Gathered;
use super::generated;

/// Number of clocks per frame at 60 frames per second and 81.25 MHz.
const FRAME_CLOCKS: u64 = 81_250_000 / 60;

/// Draws segments, and compares the frame with the model's frame. Returns the clocks of both passes.
fn draw(bench: &mut Bench, name: &str, size: (u32, u32), segments: &[Segment]) -> [u64; 2] {
    let mut expected = Expected::clear(size);
    expected.draw_segments(segments);
    let mut gathered = Gathered::default();
    bench.configure_lines(segments, &expected);
    let geometry = bench.gather(name, &mut gathered);
    [geometry, bench.draw_gathered(name, &gathered, &expected)]
}

#[test]
fn random_segments_with_random_stalls() {
    for seed in 0..12 {
        let mut numbers = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        let size = seed as usize % 3;
        let mut bench = Bench::of("lines", seed, [0.0, 0.2, 0.5, 0.7][seed as usize % 4]);
        bench.with_depth = seed % 5 == 0;
        for frame in 0..3 {
            let count = numbers.random_range(0..150);
            let segments: Vec<_> = (0..count).map(|_| random(&mut numbers, size)).collect();
            bench.slot = numbers.random_range(0..2);
            let name = format!("seed {seed}, frame {frame}");
            draw(&mut bench, &name, SIZES[size], &segments);
        }
    }
}

/// A build for lines alone draws lines without depths like a build for triangles and lines.
#[test]
fn a_build_for_lines_alone_draws_them() {
    for (size, &picture) in SIZES.iter().enumerate() {
        let mut numbers = Pcg64Mcg::new((size as u128) << 1 | 1);
        let stalls = [0.0, 0.3, 0.7][size];
        let mut bench = Bench::of("lines_alone", size as u32, stalls);
        bench.with_depth = false;
        for frame in 0..4 {
            let count = numbers.random_range(0..150);
            let random = (0..count).map(|_| random(&mut numbers, size));
            let segments: Vec<_> = random
                .chain(difficult(size))
                .map(|segment| Segment {
                    depth: LineDepth::Over,
                    ..segment
                })
                .collect();
            bench.slot = frame % 2;
            draw(&mut bench, "lines alone", picture, &segments);
        }
    }
}

/// A build for lines alone skips the descriptors of triangles, and reports them.
#[test]
fn a_build_for_lines_alone_reports_triangles() {
    let (gathered, _) = gathered_face(29);
    let mut bench = Bench::of("lines_alone", 30, 0.0);
    bench.with_depth = false;
    reports(&mut bench, &gathered);
}

/// Checks that a raster pass reports the descriptors of another build.
fn reports(bench: &mut Bench, gathered: &Gathered) {
    bench.start_gathered(gathered, &Expected::clear(SIZES[0]));
    bench.wait_for("status.raster_done");
    assert_eq!(bench.read("status.list_error"), 1);
}

/// A build without the geometry pass draws the lists of another pass.
#[test]
fn a_build_without_geometry_draws_lists() {
    let (gathered, frame) = gathered_face(31);
    let mut bench = Bench::of("no_geometry", 32, 0.3);
    bench.draw_gathered("a face", &gathered, &frame);
}

/// The descriptors and lists of a face, by the module for triangles, and the frame.
fn gathered_face(seed: u32) -> (Gathered, Expected) {
    let mesh = face(0.0, 0xffff);
    let frame = expected(&mesh, &ahead(1.0, 0.1), SIZES[0], false);
    let mut gathered = Gathered::default();
    let mut bench = Bench::new(seed, 0.0);
    bench.configure(&mesh, &frame);
    bench.gather("a face", &mut gathered);
    (gathered, frame)
}

#[test]
fn difficult_segments() {
    for (size, &picture) in SIZES.iter().enumerate() {
        let mut bench = Bench::of("lines", 21, 0.1);
        draw(&mut bench, "difficult segments", picture, &difficult(size));
    }
}

/// A frame of 10,000 segments of 50 pixels takes less than 1/60 s if both passes run concurrently.
#[test]
fn ten_thousand_segments_of_50_pixels() {
    for (size, &picture) in SIZES.iter().enumerate() {
        let mut bench = Bench::of("lines", 22, 0.0);
        bench.with_depth = false;
        let segments = of_50_pixels(size, 10_000);
        let [geometry, raster] = draw(&mut bench, "50 pixels", picture, &segments);
        println!("{picture:?}: {geometry} clocks for the geometry, {raster} for the raster");
        assert!(geometry.max(raster) < FRAME_CLOCKS);
    }
}

/// A drawing step of a frame.
enum Step {
    /// A rectangle parallel to the image plane: distance from the eye, and colour.
    Face(f64, u16),
    /// Segments.
    Lines(Vec<Segment>),
}

/// The depth code of all pixels of a face at this distance.
fn code(distance: f64) -> u32 {
    expected(&face(distance, 0), &ahead(1.0, 0.1), SIZES[0], false).nearest()
}

fn face(distance: f64, colour: u16) -> Vec<u8> {
    let corner = |x: f64, z: f64| at(x, distance, z);
    let [left, right, top, bottom] = [-0.9, 0.7, -0.3, 0.4];
    let corners = [
        corner(left, top),
        corner(right, top),
        corner(right, bottom),
        corner(left, bottom),
    ];
    let triangle = |places: [usize; 3]| (places.map(|i| corners[i]), colour);
    meshes::mesh(&[triangle([0, 1, 2]), triangle([0, 2, 3])], 100)
}

/// Lines and faces are drawn in the order of the list, even at equal depths.
#[test]
fn lines_and_faces_in_turn() {
    let mut numbers = Pcg64Mcg::new(23);
    for round in 0..8 {
        let size = [0, 0, 1, 2][round % 4];
        let codes = [0.0, 0.1].map(code);
        let steps = (0..6).map(|step| {
            if numbers.random() {
                return Step::Face([0.0, 0.1][numbers.random_range(0..2)], 0x1111 * step);
            }
            let lines = (0..numbers.random_range(0..40)).map(|_| {
                let w = 64 * codes[numbers.random_range(0..2)];
                let segment = random(&mut numbers, size);
                Segment {
                    ends: segment.ends.map(|end| ScreenVertex { w, ..end }),
                    depth: LineDepth::Tested {
                        bias: numbers.random_range(0..2),
                    },
                    ..segment
                }
            });
            Step::Lines(lines.collect())
        });
        let steps: Vec<Step> = steps.collect();
        let mut bench = Bench::of("lines", round as u32, [0.0, 0.3][round / 4]);
        let mut gathered = Gathered::default();
        let mut frame = Expected::clear(SIZES[size]);
        let name = format!("round {round}");
        for step in &steps {
            match step {
                Step::Face(distance, colour) => {
                    let mesh = face(*distance, *colour);
                    let face = expected(&mesh, &ahead(1.0, 0.1), SIZES[size], false);
                    bench.configure(&mesh, &face);
                    frame.draw_over(&face);
                }
                Step::Lines(segments) => {
                    bench.configure_lines(segments, &frame);
                    frame.draw_segments(segments);
                }
            }
            bench.gather(&name, &mut gathered);
        }
        bench.draw_gathered(&name, &gathered, &frame);
    }
}

#[test]
fn full_lists_and_damaged_segments_are_reported() {
    let mut bench = Bench::of("lines", 24, 0.2);
    let segments = of_50_pixels(0, 60);
    let clear = Expected::clear(SIZES[0]);
    let run = |bench: &mut Bench| {
        bench.run_geometry();
        bench.set("geometry_flags.lines", 0);
        ["status.full", "status.mesh_error"].map(|path| bench.read(path))
    };
    for (port, value, errors) in [
        ("geometry.descriptor_limit", 10, [1, 0]),
        ("geometry.list_shift", 0, [1, 0]),
        ("geometry.mesh_bytes", 32 + 32 * 60 - 16, [0, 1]),
        ("geometry.mesh_bytes", 0, [0, 1]),
    ] {
        bench.configure_lines(&segments, &clear);
        bench.set(port, value);
        assert_eq!(run(&mut bench), errors, "{port} {value}");
        draw(&mut bench, "with room", SIZES[0], &segments);
    }
    // An incomplete segment at the end has no effect.
    for words in [1, 119] {
        bench.configure_lines(&segments, &clear);
        bench.overwrite_words(words);
        bench.set("geometry.mesh_bytes", u64::from(32 + 16 * words));
        assert_eq!(run(&mut bench), [0, 0], "{words} words");
        draw(&mut bench, "whole segments", SIZES[0], &segments);
    }
}

/// A cancelled frame of lines does not change the next frame of lines or of triangles.
#[test]
fn a_cancelled_frame_leaves_a_working_engine() {
    let segments = of_50_pixels(0, 60);
    let mesh = generated("icosphere:4");
    let faces = expected(&mesh, &ahead(1.0, 0.1), SIZES[0], true);
    let mut numbers = Pcg64Mcg::new(25);
    for stalls in [0.0, 0.6] {
        let mut bench = Bench::of("lines", 25, stalls);
        for start in ["geometry_start", "raster_start"] {
            for _ in 0..4 {
                draw(&mut bench, "before", SIZES[0], &segments);
                bench.configure_lines(&segments, &Expected::clear(SIZES[0]));
                bench.cancel_after(start, numbers.random_range(0..4000));
                bench.set("geometry_flags.lines", 0);
                if numbers.random() {
                    bench.draw("triangles", &mesh, &faces);
                }
            }
        }
    }
}

/// Draws frames from random pieces. Such a frame ends and writes only its own memory, and the next frame is correct.
#[test]
fn frames_end_with_random_pieces() {
    let mut bench = Bench::of("lines", 26, 0.1);
    bench.with_depth = false;
    for seed in 0..9 {
        let mut numbers = Pcg64Mcg::new(seed);
        let size = SIZES[seed as usize % 3];
        let clear = Expected::clear(size);
        let mut descriptors: Vec<u8> = (0..48 * 300).map(|_| numbers.random()).collect();
        for descriptor in descriptors.as_chunks_mut::<48>().0 {
            // Bits 366 and 367 mark a descriptor as a piece.
            descriptor[45] |= 0xc0;
        }
        let list: Vec<_> = (0..40).map(|_| numbers.random_range(0..300)).collect();
        let lengths = std::array::from_fn(|_| numbers.random_range(0..=40));
        let name = format!("seed {seed}");
        bench.draw_raw(&name, &clear, &descriptors, lengths, &list);
        assert_eq!(bench.read("status.list_error"), 0, "{name}");
        let segments = of_50_pixels(0, 20);
        draw(&mut bench, &format!("after {name}"), SIZES[0], &segments);
        draw(&mut bench, &format!("nothing after {name}"), SIZES[2], &[]);
    }
}

/// Engines without lines skip pieces, and report them.
#[test]
fn a_build_without_lines_reports_pieces() {
    let segment = Segment {
        ends: [[0, 0], [9000, 9000]].map(|[x, y]| ScreenVertex { x, y, w: 640 }),
        colour: Rgb565(0xffff),
        depth: LineDepth::Over,
    };
    let mut gathered = Gathered::default();
    let mut bench = Bench::of("lines", 27, 0.0);
    bench.configure_lines(&[segment], &Expected::clear(SIZES[0]));
    bench.gather("a piece", &mut gathered);
    reports(&mut Bench::new(28, 0.0), &gathered);
}
