//! Tests frames of lines, alone and after triangles.

use glint_core::picture::Size;
use glint_model::line::Segment;
use glint_model::triangle::raster::draw;
use glint_vectors::meshes::ahead;
use glint_vectors::segments;
use glint_vectors::{Model, Picture};
use litex_pac::register::Value;
use litex_pac::triangle::{Error, Geometry, offset};
use rand_pcg::Pcg64Mcg;

use crate::bench::{Bench, DESCRIPTORS, Kind, LISTS, MESH, alone, code};

/// Writes the segments to memory, in two chunks. Returns their length in bytes.
fn write_segments(bench: &mut Bench, segments: &[Segment]) -> u32 {
    let (first, second) = segments.split_at(segments.len() / 3);
    let chunks = [first, second].map(|chunk| {
        let words = chunk.iter().map(Segment::words);
        let words = [Segment::header(chunk.len() as u32)]
            .into_iter()
            .chain(words);
        words
            .flatten()
            .flat_map(u32::to_le_bytes)
            .collect::<Vec<u8>>()
    });
    let bytes = chunks.concat();
    bench.write(MESH, &bytes);
    bytes.len() as u32
}

/// Runs the geometry pass of lines; its output goes to the set number `set`.
fn geometry_of_lines(bench: &mut Bench, size: Size, segments: &[Segment], set: usize) -> Error {
    let bytes = write_segments(bench, segments);
    bench.set_output();
    bench.set_all([
        (offset::MESH, MESH),
        (offset::MESH_BYTES, bytes),
        (offset::GEOMETRY_DESCRIPTORS, DESCRIPTORS[set]),
        (offset::GEOMETRY_LISTS, LISTS[set]),
        (offset::EXCEPTION_LIMIT, 0),
    ]);
    let flags = Geometry::default()
        .with_start(true)
        .with_lines(true)
        .with_size(code(size));
    bench.pass(Kind::Geometry, flags.bits())
}

#[test]
fn lines_are_the_models() {
    let mut bench = Bench::new();
    for (number, size) in Size::ALL.into_iter().enumerate() {
        let mut random = Pcg64Mcg::new(7 + number as u128);
        let random = (0..500).map(|_| segments::random(&mut random, number));
        let all: Vec<Segment> = random.chain(segments::difficult(number)).collect();
        let mut expected = Picture::blank(size.pixels().into());
        let (mut covered, mut drawn) = (0, 0);
        for segment in &all {
            covered += segment.covered(&expected.target()) as u32;
            drawn += segment.draw(&mut expected.target());
        }
        assert_eq!(geometry_of_lines(&mut bench, size, &all, 0), Error::None);
        let counters = [offset::PIXELS_COVERED, offset::PIXELS_DRAWN, offset::GROUPS];
        let before = counters.map(|counter| bench.read(counter));
        let flags = bench.prepare_raster(size, false, &[]);
        assert_eq!(bench.pass(Kind::Raster, flags.bits()), Error::None);
        bench.compare("lines", size, false, &expected);
        let grown = [0, 1, 2].map(|i| bench.read(counters[i]) - before[i]);
        // A group of a line has one pixel.
        assert_eq!(grown, [covered, drawn, covered]);
    }
}

/// Draws triangles from the first set and lines from the second set, as for the edges of a mesh.
#[test]
fn lines_are_drawn_over_triangles() {
    let size = Size::W640;
    let mut bench = Bench::new();
    let mesh = Model::sphere(0.5, 12).encoded();
    let part = alone(&mesh, &ahead(1.0, 0.1), Size::W640, true);
    let mut expected = Picture::blank((640, 360));
    let mut scratch = vec![glint_model::Projected::Behind; 4096];
    glint_model::triangle::set_up_parts(
        &mut |number| (number == 0).then_some(part),
        (640, 360),
        &mut scratch,
        &mut |triangle, setup, _| {
            draw(setup, triangle.colour, &mut expected.target());
        },
    )
    .unwrap();
    let mut random = Pcg64Mcg::new(9);
    let segments: Vec<Segment> = (0..300).map(|_| segments::random(&mut random, 1)).collect();
    for segment in &segments {
        segment.draw(&mut expected.target());
    }
    let flags = bench.prepare(&part);
    assert_eq!(bench.pass(Kind::Geometry, flags.bits()), Error::None);
    let triangles = bench.read(offset::DESCRIPTOR_COUNT);
    assert_eq!(
        geometry_of_lines(&mut bench, size, &segments, 1),
        Error::None
    );
    let pieces = bench.read(offset::DESCRIPTOR_COUNT);
    assert!(pieces > 300);
    let flags = bench.prepare_raster(size, false, &[]).with_second(true);
    bench.set(offset::COUNT_0, triangles);
    bench.set(offset::COUNT_1, pieces);
    assert_eq!(bench.pass(Kind::Raster, flags.bits()), Error::None);
    bench.compare("edges", size, false, &expected);
}
