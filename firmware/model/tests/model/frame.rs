//! Tests of frames: constants, drawing with one call, and the band lists of triangles.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::field::Field;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_model::triangle::descriptor::{
    Descriptor, Full, LENGTHS, Layout, ListCounts, ListWriter, band_rows, list_shift, list_word,
};
use glint_model::{
    FieldSubject, Frame, FrameConstants, FrameStats, MeshSubject, Projected, RenderError, Subject,
};
use glint_vectors::triangles::{random_triangle, set_up};
use glint_vectors::{Camera, Picture, Random};

use crate::cube;

fn view() -> View {
    Camera::looking([0.0, -3.0, 1.0], [0.0; 3], 0.5, 0.1).rounded()
}

/// Draws a frame; returns its picture, its counts, and the number of calls of `progress`.
fn drawn(frame: &Frame, constants: &FrameConstants) -> (Picture, FrameStats, u32) {
    let [width, height] = frame.size.pixels();
    let mut picture = Picture::blank((width, height));
    let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
    let mut calls = 0;
    let stats = frame.draw(constants, &mut picture.target(), &mut scratch, &mut || {
        calls += 1;
    });
    (picture, stats.unwrap(), calls)
}

#[test]
fn a_frame_is_drawn_from_constants_that_served_another_one() {
    let mesh = MeshSubject::new(cube());
    let field = FieldSubject {
        field: &Field::parse("box:0.25,2,0.25").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let mut constants = FrameConstants::default();
    assert_eq!(constants.depth_scale(), None);
    let frames = [
        Subject::MeshInField(mesh, field),
        Subject::Mesh(mesh),
        Subject::Field(field),
    ]
    .map(|subject| Frame::new(subject, view(), Size::W320));
    let pictures = frames.map(|frame| {
        constants.update(&frame).unwrap();
        let (picture, stats, calls) = drawn(&frame, &constants);
        let (fresh, ..) = drawn(&frame, &frame.constants().unwrap());
        assert!(picture.colour == fresh.colour && picture.depth == fresh.depth);
        assert_eq!(stats.mesh.is_some(), frame.subject.mesh_part().is_some());
        assert_eq!(stats.field.is_some(), frame.subject.field_part().is_some());
        assert!(calls > 0 || stats.field.is_none());
        picture
    });
    let [both, mesh, field] = &pictures;
    assert!(both.colour != mesh.colour && both.colour != field.colour);
    assert!(mesh.covered() > 0 && mesh.covered() < 320 * 180);
}

#[test]
fn a_clear_colour_fills_the_pixels_without_a_triangle() {
    let clear = Rgb565(0x1234);
    let frame = Frame {
        clear,
        ..Frame::new(Subject::mesh(cube()), view(), Size::W640)
    };
    let (picture, ..) = drawn(&frame, &frame.constants().unwrap());
    let mut pixels = picture.colour.iter().zip(&picture.depth);
    assert!(pixels.all(|(&colour, &code)| (colour == clear.0) == (code == 0)));
}

#[test]
fn a_frame_beyond_the_limits_has_no_constants() {
    let far = Camera::looking([0.0, -20.0, 1.0], [0.0; 3], 0.5, 0.1).rounded();
    let mut constants = FrameConstants::default();
    let frame = Frame::new(Subject::mesh(cube()), view(), Size::W320);
    constants.update(&frame).unwrap();
    let error = constants.update(&Frame { view: far, ..frame });
    assert!(matches!(error, Err(RenderError::Eye(_))), "{error:?}");
    assert!(constants.mesh().is_none() && constants.field().is_none());
}

/// Every triangle is in the lists of exactly the bands that contain one of its rows.
#[test]
fn lists_name_the_triangles_of_their_bands() {
    const DESCRIPTORS: usize = 64;
    let mut random = Random(7);
    for size in Size::ALL {
        for layout in Layout::ALL {
            let shift = list_shift(size.width(), 1 << 20);
            let bands = size.height() / band_rows(size.width());
            let list_words = 4 * list_word(bands, shift) as usize;
            let mut descriptors = vec![0; DESCRIPTORS * layout.words()];
            let mut lists = vec![0; list_words];
            let mut counts = ListCounts::EMPTY;
            let mut put = vec![];
            // Several writers append to the same lists, one after the other.
            for end in [DESCRIPTORS / 4, DESCRIPTORS / 2, DESCRIPTORS] {
                let mut writer = ListWriter::new(
                    &mut descriptors,
                    &mut lists,
                    &mut counts,
                    size.width(),
                    shift,
                    layout,
                );
                while put.len() < end {
                    let triangle = random_triangle(&mut random);
                    let Some((_, setup)) = set_up(triangle, (size.width(), size.height())) else {
                        continue;
                    };
                    writer.put(&setup, Rgb565::WHITE, None);
                    put.push(setup);
                }
                assert_eq!(writer.finish(), Ok(end as u32));
            }
            for band in 0..bands {
                let rows = band_rows(size.width()) as i32;
                let (top, bottom) = (band as i32 * rows, (band as i32 + 1) * rows);
                let expected: Vec<u32> = (0..)
                    .zip(&put)
                    .filter(|(_, setup)| setup.bounds.top < bottom && setup.bounds.bottom > top)
                    .map(|(number, _)| number)
                    .collect();
                let start = 4 * list_word(band, shift) as usize;
                let length = lists[band as usize] as usize;
                assert_eq!(lists[start..start + length], expected[..], "band {band}");
            }
            let mut unused = lists[bands as usize..LENGTHS].iter();
            assert!(unused.all(|&length| length == 0));
            for (setup, found) in put.iter().zip(descriptors.chunks(layout.words())) {
                let expected = Descriptor::new(setup, Rgb565::WHITE, None);
                assert_eq!(expected.words(layout).concat(), found);
            }
        }
    }
}

#[test]
fn lists_without_room_are_refused() {
    let mut random = Random(8);
    let setup = loop {
        let triangle = random_triangle(&mut random);
        if let Some((_, setup)) = set_up(triangle, (320, 180)) {
            break setup;
        }
    };
    for (descriptor_words, list_words, expected) in [
        (Layout::FLAT.words(), 1 << 20, Ok(1)),
        (Layout::FLAT.words() - 1, 1 << 20, Err(Full)),
        (Layout::FLAT.words(), LENGTHS, Err(Full)),
        (Layout::FLAT.words(), LENGTHS - 1, Err(Full)),
    ] {
        let (mut descriptors, mut lists) = (vec![0; descriptor_words], vec![0; list_words]);
        let mut counts = ListCounts::EMPTY;
        let mut writer = ListWriter::new(
            &mut descriptors,
            &mut lists,
            &mut counts,
            320,
            15,
            Layout::FLAT,
        );
        writer.put(&setup, Rgb565::WHITE, None);
        assert_eq!(writer.finish(), expected);
    }
}
