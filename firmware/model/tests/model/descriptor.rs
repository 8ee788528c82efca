//! Tests that pictures drawn from descriptors in memory, band by band as the raster pass does, equal the pictures of the original triangles
//! and lines.

use glint_core::colour::{Rgb565, Shading};
use glint_core::picture::Size;
use glint_model::line::{Segment, band_bounds};
use glint_model::triangle::descriptor::{Contents, Descriptor, Layout};
use glint_model::triangle::raster::{draw, draw_groups};
use glint_model::triangle::textured::Textured;
use glint_model::{DrawnTriangle, Frame, FrameBuffer, MeshSubject, Projected, SIZES, Subject};
use glint_vectors::segments;
use glint_vectors::triangles::{random_triangle, set_up};
use glint_vectors::{Camera, Model, Picture, Random};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::mesh_of;

/// Draws the triangles and pieces in these descriptors into all bands of a picture. Returns the numbers of covered and drawn pixels.
fn in_bands(descriptors: &[Vec<u32>], size: Size, target: &mut FrameBuffer) -> [u32; 2] {
    let mut counts = [0; 2];
    for band in 0..size.bands() {
        let band = band_bounds(size, band);
        for words in descriptors {
            let descriptor = Descriptor::from_words(words.iter().copied(), Layout::SMOOTH);
            let [covered, drawn] = match descriptor.contents(size.width()) {
                Contents::Triangle(setup, colour, _) => {
                    let rows = setup.in_rows(band.top..band.bottom);
                    let coverage = rows.map(|setup| draw(&setup, colour, target));
                    let coverage = coverage.unwrap_or_default();
                    [coverage.covered, coverage.drawn]
                }
                Contents::Piece(piece) => {
                    let mut covered = 0;
                    let drawn = piece.draw(&band, target, &mut |_| covered += 1);
                    [covered, drawn]
                }
                Contents::Stray => [0; 2],
            };
            counts = [counts[0] + covered, counts[1] + drawn];
        }
    }
    counts
}

#[test]
fn triangles_keep_their_pixels() {
    let mut random = Random(3);
    for size in Size::ALL {
        let [width, height] = size.pixels();
        let mut expected = Picture::blank((width, height));
        let mut found = expected.clone();
        let (mut descriptors, mut counts) = (vec![], [0; 2]);
        while descriptors.len() < 100 {
            let Some((_, setup)) = set_up(random_triangle(&mut random), (width, height)) else {
                continue;
            };
            let colour = Rgb565((descriptors.len() as u16).wrapping_mul(0x1357));
            let coverage = draw(&setup, colour, &mut expected.target());
            counts = [counts[0] + coverage.covered, counts[1] + coverage.drawn];
            let words = Descriptor::new(&setup, colour, None)
                .words(Layout::FLAT)
                .concat();
            descriptors.push(words);
        }
        assert_eq!(in_bands(&descriptors, size, &mut found.target()), counts);
        assert!(found == expected, "{size}");
    }
}

#[test]
fn smooth_triangles_keep_their_pixels() {
    let size = Size::W320;
    let subject = Subject::Mesh(MeshSubject {
        shading: Shading::Smooth,
        ..MeshSubject::new(mesh_of(&Model::sphere(0.6, 8)))
    });
    let view = Camera::looking([0.0, -2.0, 0.3], [0.0; 3], 0.5, 0.1).rounded();
    let frame = Frame::new(subject, view, size);
    let constants = frame.constants().unwrap();
    let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
    let mut expected = Picture::blank(SIZES[0]);
    let mut found = expected.clone();
    let mut descriptors = vec![];
    let mut put = |triangle: &DrawnTriangle, setup: &_, _: Option<&Textured>| {
        draw(setup, triangle.colour, &mut expected.target());
        let descriptor = Descriptor::new(setup, triangle.colour, None);
        descriptors.push(descriptor.words(Layout::SMOOTH).concat());
    };
    frame
        .set_up_meshes(&constants, &mut scratch, &mut put)
        .unwrap();
    let [covered, _] = in_bands(&descriptors, size, &mut found.target());
    assert!(covered > 10_000, "{covered} pixels");
    assert!(found == expected);
}

#[test]
fn lines_keep_their_pixels() {
    let mut random = Pcg64Mcg::new(5);
    for (code, size) in Size::ALL.into_iter().enumerate() {
        let random = (0..300).map(|_| segments::random(&mut random, code));
        let all: Vec<Segment> = random.chain(segments::difficult(code)).collect();
        let mut expected = Picture::blank(SIZES[code]);
        let mut found = expected.clone();
        let (mut descriptors, mut counts) = (vec![], [0; 2]);
        for segment in &all {
            let covered = segment.covered(&expected.target()) as u32;
            let drawn = segment.draw(&mut expected.target());
            counts = [counts[0] + covered, counts[1] + drawn];
            let stored = Segment::from_words(segment.words());
            let pieces: Vec<_> = stored.pieces(size).collect();
            assert_eq!(pieces, segment.pieces(size).collect::<Vec<_>>());
            descriptors.extend(pieces.iter().map(|piece| {
                let descriptor = Descriptor::of_piece(piece);
                descriptor.words(Layout::FLAT).concat()
            }));
        }
        assert_eq!(in_bands(&descriptors, size, &mut found.target()), counts);
        assert!(found == expected, "{size}");
    }
}

#[test]
fn every_covered_group_is_visited() {
    let mut random = Random(11);
    let mut most = 0;
    for _ in 0..200 {
        let mut picture = Picture::blank(SIZES[0]);
        let Some((_, setup)) = set_up(random_triangle(&mut random), SIZES[0]) else {
            continue;
        };
        let mut found = vec![];
        let visit = &mut |row, [first, last]: [i32; 2]| {
            found.extend((first..=last).map(|group| (row, group)));
        };
        draw_groups(
            &setup,
            Rgb565::WHITE,
            None,
            None,
            &mut picture.target(),
            visit,
        );
        let covered = picture.coverage();
        let groups = (0..).zip(covered.chunks(8));
        let expected: Vec<(i32, i32)> = groups
            .filter(|(_, group)| group.contains(&true))
            .map(|(number, _)| (number / 40, number % 40))
            .collect();
        assert_eq!(found, expected);
        most = most.max(found.len());
    }
    assert!(most > 100, "{most}");
}

#[test]
fn random_descriptors_stay_in_their_band() {
    let mut random = Pcg64Mcg::new(9);
    let mut kinds = [0; 3];
    for number in 0..3000 {
        let mut words: [u32; 24] = random.random();
        let mut groups: [u8; 3] = std::array::from_fn(|_| random.random_range(0..40));
        if number % 3 > 0 {
            // The columns of a triangle in the picture, or the bit pattern that marks a piece.
            match number % 3 {
                1 => groups.sort_unstable(),
                _ => groups[1] = 0xC0,
            }
            let [left, start, right] = groups;
            let rows = words[10] & 0x00FF_FFFF;
            words[10] = rows | u32::from(left) << 24;
            words[11] = words[11] & 0xFFFF_0000 | u32::from(start) << 8 | u32::from(right);
        }
        let band = band_bounds(Size::W320, 1);
        let mut picture = Picture::blank(SIZES[0]);
        match Descriptor::from_words(words, Layout::WHOLE).contents(320) {
            Contents::Triangle(setup, colour, _) => {
                kinds[0] += 1;
                if let Some(setup) = setup.in_rows(band.top..band.bottom) {
                    draw(&setup, colour, &mut picture.target());
                }
            }
            Contents::Piece(piece) => {
                kinds[1] += 1;
                piece.draw(&band, &mut picture.target(), &mut |_| {});
            }
            Contents::Stray => kinds[2] += 1,
        }
        let blank = Picture::blank(SIZES[0]);
        let rows = 320 * band.top as usize..320 * band.bottom as usize;
        assert!(picture.depth[..rows.start] == blank.depth[..rows.start]);
        assert!(picture.depth[rows.end..] == blank.depth[rows.end..]);
    }
    assert!(kinds.iter().all(|&kind| kind > 100), "{kinds:?}");
}
