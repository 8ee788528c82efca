//! Tests of pictures with four samples per pixel.

use glint_core::appearance::Appearance;
use glint_core::camera::Projection;
use glint_core::colour::{Rgb565, Rounding};
use glint_core::field::Field;
use glint_core::mesh::Mesh;
use glint_core::picture::{Quarter, Samples, Size};
use glint_core::quality::Quality;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{
    FieldSubject, Frame, FrameConstants, MeshSubject, Projected, Subject, average_lines,
};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{any_vector, cube};

/// A frame of 1280×720 pixels with four samples each.
fn divided<'a>(subject: Subject<'a>, camera: &Camera) -> Frame<'a> {
    Frame {
        samples: Samples::Four,
        ..Frame::new(subject, camera.rounded(), Size::W1280)
    }
}

/// Draws the parts of a frame and averages their samples.
fn averaged(frame: &Frame) -> Vec<u16> {
    let mut picture = vec![0; frame.size.pixel_count()];
    for part in frame.parts() {
        let samples = Picture::of_frame(&part);
        part.average(&samples.colour, &mut picture, &mut || {});
    }
    picture
}

/// In a block of 4×2 pixels, the average of samples of one colour is this colour, and the mean of the averages of two mixed colours is
/// exact.
#[test]
fn averages_keep_the_mean() {
    for (high, most) in [(0xF800_u16, 31.0), (0x07E0, 63.0), (0x001F, 31.0)] {
        let step = high & high.wrapping_neg();
        for count in 0..=4 {
            let sample = |at: usize| if at < count { 17 * step } else { 16 * step };
            let lines = [[0, 1], [2, 3]].map(|pair| pair.map(sample).repeat(4));
            let mut sum = 0;
            for y in 0..2 {
                let mut pixels = [0; 4];
                average_lines([&lines[0], &lines[1]], y, Rounding::Dithered, &mut pixels);
                sum += pixels
                    .iter()
                    .map(|pixel| u32::from(pixel / step))
                    .sum::<u32>();
                assert!(count % 4 != 0 || pixels == [sample(0); 4]);
            }
            assert_eq!(sum, 8 * 16 + 2 * count as u32, "{count} of 4, of {most}");
        }
    }
    let white = [0xFFFF; 8];
    let mut pixels = [0; 4];
    average_lines([&white, &white], 1, Rounding::Dithered, &mut pixels);
    assert_eq!(pixels, [0xFFFF; 4]);
}

/// Neither the rounding of the samples nor the rounding of their averages changes the mean colour of a sky or of fog.
#[test]
fn dithered_samples_keep_the_mean() {
    let rounding = Rounding::Dithered;
    for channel in 0..=255_u8 {
        let fine = Rgb565::with_fractions([channel; 3]);
        let samples = |y: u32| -> Vec<u16> {
            (0..8)
                .map(|x| Rgb565::rounded(fine, rounding, [x, y]).0)
                .collect()
        };
        let lines = [0, 1, 2, 3, 4, 5, 6, 7].map(samples);
        let mut sums = [0_u32; 3];
        for (y, pair) in lines.as_chunks::<2>().0.iter().enumerate() {
            let mut pixels = [0; 4];
            average_lines([&pair[0], &pair[1]], y as u32, rounding, &mut pixels);
            for pixel in pixels {
                let shown = Rgb565(pixel).to_rgb888();
                sums = [0, 1, 2].map(|i: usize| sums[i] + u32::from(shown[i]));
            }
        }
        for sum in sums {
            let mean = f64::from(sum) / 16.0;
            assert!((mean - f64::from(channel)).abs() < 1.0, "{channel}: {mean}");
        }
    }
}

/// In random frames, a picture with four samples per pixel is the average of a picture of twice the width and height, sample for sample.
#[test]
fn pictures_are_averages_of_larger_pictures() {
    let mut random = Random(13);
    let (mut drawn, mut mixed) = (0, 0);
    for number in 0..200 {
        let (size, larger) = match number % 20 {
            0 => (Size::W640, Size::W1280),
            _ => (Size::W320, Size::W640),
        };
        let rounding = Rounding::new(number % 2 == 0);
        let bytes = Model::random(&mut random, 20, 16_000).encoded();
        let subject = MeshSubject {
            cull: false,
            ..MeshSubject::new(Mesh::new_checked(&bytes).unwrap())
        };
        let view = Camera::inside(&mut random).rounded();
        let one = Frame {
            rounding,
            ..Frame::new(Subject::Mesh(subject), view, larger)
        };
        let four = Frame {
            size,
            samples: Samples::Four,
            ..one
        };
        // The near plane is too near for the width of the picture.
        if one.constants().is_err() {
            assert!(four.constants().is_err());
            continue;
        }
        let samples = Picture::of_frame(&one).colour;
        let mut expected = vec![0; size.pixel_count()];
        let columns = larger.width() as usize;
        let lines = samples
            .chunks(2 * columns)
            .map(|pair| pair.split_at(columns));
        let pixels = expected.chunks_mut(size.width() as usize);
        for (y, ((upper, lower), pixels)) in (0..).zip(lines.zip(pixels)) {
            average_lines([upper, lower], y, rounding, pixels);
        }
        assert!(averaged(&four) == expected, "frame {number}");
        drawn += 1;
        mixed += expected
            .iter()
            .filter(|pixel| !samples.contains(pixel))
            .count();
    }
    assert!(drawn > 100 && mixed > 10_000, "{drawn}, {mixed}");
}

/// The frames of the quarters of a picture.
fn quarters<'a>(frame: &Frame<'a>) -> [Frame<'a>; 4] {
    Quarter::ALL.map(|quarter| Frame { quarter, ..*frame })
}

/// In 10,000 random frames every vertex has the same position in all quarters, so the edges of triangles are continuous across the borders
/// of quarters.
#[test]
fn quarters_have_the_same_vertices() {
    let mut random = Random(11);
    let (mut constants, mut compared) = (FrameConstants::default(), 0);
    for number in 0..10_000 {
        let mut frame = divided(Subject::mesh(cube()), &Camera::inside(&mut random));
        if number % 4 == 3 {
            frame.view = frame.view.with_projection(Projection::Orthographic);
        }
        let parts = quarters(&frame).map(|part| {
            constants
                .update(&part)
                .map(|()| (part.window(), *constants.mesh().unwrap()))
        });
        // The near plane is too near for the width of the picture.
        let [Ok(first), Ok(second), Ok(third), Ok(last)] = parts else {
            assert!(parts.iter().all(Result::is_err));
            continue;
        };
        for _ in 0..10 {
            let position = any_vector(&mut random);
            let places = [first, second, third, last].map(|(window, setup)| {
                let [left, top] = window.origin().map(|place| 256 * place as i32);
                match project(&setup, &transform(&setup, position)) {
                    Projected::Visible(place) => Some((place.x + left, place.y + top, place.w)),
                    Projected::BeyondGuard(_) | Projected::Behind => None,
                }
            });
            let mut seen = places.iter().flatten();
            if let Some(place) = seen.next() {
                assert!(seen.clone().all(|other| other == place), "{places:?}");
                compared += seen.count();
            }
        }
    }
    assert!(compared > 20_000, "{compared}");
}

/// Rays are continuous across the borders of quarters: the ray beyond the last column or line of a quarter is the first ray of the next
/// quarter, up to the rounding of D.
#[test]
fn quarters_have_the_same_rays() {
    let mut random = Random(12);
    let field = Field::parse("menger:3").unwrap();
    let appearance = Appearance::default();
    let subject = Subject::Field(FieldSubject {
        field: &field,
        appearance: &appearance,
        quality: Quality::default(),
    });
    for _ in 0..200 {
        let frame = divided(subject, &Camera::inside(&mut random));
        let exits = quarters(&frame).map(|part| {
            let constants = part.constants().unwrap();
            *constants.field().unwrap().setup.exits().unwrap()
        });
        let [width, height] = frame.size.pixels().map(|size| size as i32);
        for row in [0, 100, height - 1] {
            // The rounding error of a step, accumulated over half a picture.
            let most = 1 + width / 2 + height / 2;
            for (left, right, along) in [(0, 1, [width, row]), (2, 3, [width, row])] {
                let [here, there] = [(left, along), (right, [0, row])].map(|(number, [x, y])| {
                    let (first, [across, down]) =
                        (exits[number].eyes[0].first, exits[number].steps);
                    [0, 1, 2].map(|i: usize| first[i] + x * across[i] + y * down[i])
                });
                let apart = [0, 1, 2].map(|i: usize| (here[i] - there[i]).abs());
                assert!(apart.iter().all(|&apart| apart <= 2 * most), "{apart:?}");
            }
        }
        assert!(
            exits
                .iter()
                .all(|other| other.exponent == exits[0].exponent)
        );
    }
}

/// A square that covers the picture leaves no sample of the background at the borders of the quarters.
#[test]
fn no_seam_between_quarters() {
    let camera = Camera::looking([0.013, -0.3, 0.007], [0.0, 1.0, 0.1], 0.7, 0.02);
    let clear = Rgb565(0xF81F);
    let frame = Frame {
        clear,
        ..divided(Subject::mesh(cube()), &camera)
    };
    let inside = MeshSubject {
        cull: false,
        ..MeshSubject::new(cube())
    };
    let frame = Frame {
        subject: Subject::Mesh(inside),
        ..frame
    };
    assert!(averaged(&frame).iter().all(|&pixel| pixel != clear.0));
    for part in frame.parts() {
        let samples = Picture::of_frame(&part);
        assert!(
            samples.depth.iter().all(|&code| code != 0),
            "{:?}",
            part.quarter
        );
    }
}
