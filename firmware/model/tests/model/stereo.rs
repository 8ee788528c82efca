//! Tests of two eyes: compares their cameras with a projection in f64, and their pictures with pictures of one eye.

use glint_core::camera::{Projection, View};
use glint_core::colour::Rgb565;
use glint_core::fixed::Q32_32;
use glint_core::picture::Size;
use glint_core::stereo::{Stereo, Tint};
use glint_core::wireframe::{CUBE, Motion, Program};
use glint_model::triangle::vertex::{project, transform};
use glint_model::{Frame, MeshSetup, Projected, RenderError, SIZES, Subject, WireframeSubject};
use glint_vectors::math::{dot, world};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{RADII, any_vector, cube, mesh_of};

fn stereo(half_separation: f64, zero_parallax: f64) -> Stereo {
    Stereo {
        half_separation: Q32_32::from_num(half_separation),
        zero_parallax: Q32_32::from_num(zero_parallax),
        tint: Tint::RedCyan,
    }
}

/// The x coordinate, in pixels, of a position in the picture of an eye that is `aside` to the right of the camera. The position is
/// projected from this eye to the plane of zero parallax, and then from the camera to the picture.
fn column(camera: &Camera, position: [f64; 3], aside: f64, zero: f64, width: u32) -> f64 {
    let d = [0, 1, 2].map(|i| position[i] - camera.eye[i]);
    let (along, z) = (dot(camera.u, d), dot(camera.n, d));
    let on_plane = aside + (along - aside) * zero / z;
    let half = f64::from(width) / 2.0;
    half + on_plane / zero * half / camera.half_width
}

/// Positions in the pictures of both eyes are within 1/256 pixel of the positions in f64, or 2/256 pixel in the largest picture, as with
/// one eye.
#[test]
fn eyes_against_f64() {
    let mut random = Random(17);
    for (size, bound) in SIZES.into_iter().zip([1.0, 1.0, 2.0]) {
        let (mut worst, mut count) = (0f64, 0);
        for round in 0..20_000 {
            let separation = [random.real(0.0, 1.0), 0.0, 1.0][round % 3];
            let zero = random.logarithmic(separation.max(0.1), 8.0);
            let zero = [zero, separation.max(0.1)][round % 2];
            let mut camera = Camera::inside(&mut random);
            camera.half_width = random.logarithmic(0.05, 4.0);
            camera.near = 0.1;
            let (view, stereo) = (camera.rounded(), stereo(separation, zero));
            let camera = Camera::of(&view);
            let numbers = [stereo.half_separation, stereo.zero_parallax];
            let [separation, zero] = numbers.map(|x| x.to_num::<f64>());
            let position = any_vector(&mut random);
            for (eye, aside) in stereo.eyes(&view).iter().zip([-separation, separation]) {
                let frame = MeshSetup::new(eye, size.0, size.1, RADII[1]).unwrap();
                let Projected::Visible(place) = project(&frame, &transform(&frame, position))
                else {
                    continue;
                };
                let x = column(&camera, world(position), aside, zero, size.0);
                if (0.0..=f64::from(size.0)).contains(&x) {
                    worst = worst.max((f64::from(place.x) - 256.0 * x).abs());
                    count += 1;
                }
            }
        }
        println!("{size:?}: {count} positions, largest error {worst:.3}/256 pixel");
        assert!(count > 1_000 && worst <= bound, "{count} {worst}");
    }
}

/// Anaglyph colour of a pixel in the pictures `left` and `right` of the eyes, computed in integers with the formulas of
/// docs/formats/camera.md.
fn composed(tint: Tint, left: u16, right: u16) -> u16 {
    let grey = |pixel: u16| {
        let [r, g, b] = Rgb565(pixel).to_rgb888().map(u32::from);
        (77 * r + 150 * g + 29 * b + 128) / 256
    };
    let (left, right) = (grey(left), grey(right));
    let green = match tint {
        Tint::RedBlue => left.min(right),
        Tint::RedCyan => right,
    };
    (left / 8 * 2048 + green / 4 * 32 + right / 8) as u16
}

/// If the eyes' pictures are shifted by whole pixels, the picture of each eye equals the picture of a single eye at the same position,
/// moved by a number of columns, except for the rounding of positions.
#[test]
fn eyes_see_shifted_pictures_of_one_eye() {
    let mesh = mesh_of(&Model::sphere(0.5, 12));
    let (separation, columns) = (0.1, 16);
    let camera = Camera::looking([1.0, -2.0, 0.8], [0.0; 3], 0.5, 0.1);
    // With zero parallax at this distance, the pictures are shifted by 16 of the 160 pixels of half a picture.
    let zero = separation / (camera.half_width * f64::from(columns) / 160.0);
    let view = camera.rounded();
    let stereo = stereo(separation, zero);
    let frame = Frame {
        stereo: Some(stereo),
        ..Frame::new(Subject::mesh(mesh), view, Size::W320)
    };
    let eyes = frame.eyes().unwrap().unwrap();
    for (eye, side) in [(eyes.left, -1.0), (eyes.right, 1.0)] {
        let mut alone = camera;
        for i in 0..3 {
            alone.eye[i] += side * separation * camera.u[i];
        }
        let view = alone.rounded();
        let alone = Picture::of_frame(&Frame { view, ..eye });
        let seen = Picture::of_frame(&eye);
        let mut differ = 0;
        for (y, x) in (0..180).flat_map(|y| (columns..320 - columns).map(move |x| (y, x))) {
            let aside = (x - side as i32 * columns) as usize;
            differ +=
                usize::from(seen.colour[320 * y + x as usize] != alone.colour[320 * y + aside]);
        }
        println!("{differ} of {} pixels differ", seen.covered());
        assert!(seen.covered() > 4_000 && 100 * differ < seen.covered());
    }
    let [left, right] = [eyes.left, eyes.right].map(|eye| Picture::of_frame(&eye).colour);
    assert!(left != right);
    for tint in Tint::ALL {
        let expected = left.iter().zip(&right);
        let expected = expected.map(|(&left, &right)| composed(tint, left, right));
        let expected = words(&expected.collect::<Vec<_>>());
        // Includes pictures whose end is within a cache line.
        for pixels in [left.len(), 2 * 11] {
            let mut both = words(&left[..pixels]);
            let eyes = glint_model::Eyes { tint, ..eyes };
            eyes.compose(&mut both, &words(&right[..pixels]), &mut || {});
            assert!(both == expected[..pixels / 2], "{tint:?}");
        }
    }
}

/// Packs pixels into words of two pixels.
fn words(pixels: &[u16]) -> Vec<u32> {
    let pairs = pixels.as_chunks().0.iter();
    pairs
        .map(|&[a, b]| u32::from(a) | u32::from(b) << 16)
        .collect()
}

/// Two eyes at the same position give the picture of one eye, in grey.
#[test]
fn eyes_at_one_place() {
    let view = Camera::looking([1.0, -2.0, 0.8], [0.0; 3], 0.5, 0.1).rounded();
    let one = Frame::new(Subject::mesh(cube()), view, Size::W320);
    let two = Frame {
        stereo: Some(stereo(0.0, 0.1)),
        ..one
    };
    let eyes = two.eyes().unwrap().unwrap();
    let pictures = [one, eyes.left, eyes.right].map(|frame| Picture::of_frame(&frame));
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
    assert!(two.drawn().unwrap().all(|eye| eye.view == view));
}

#[test]
fn refused_eyes() {
    let mesh = Subject::mesh(cube());
    let wireframe = Subject::Wireframe(WireframeSubject {
        program: Program::new_checked(CUBE.as_flattened()).unwrap(),
        pose: Motion::default().pose(),
    });
    let near_the_limit = Camera::looking([7.99, 0.0, 0.0], [0.0; 3], 0.5, 0.1).rounded();
    let frame = |subject, view: View| Frame {
        stereo: Some(stereo(1.0, 1.5)),
        ..Frame::new(subject, view, Size::W320)
    };
    let refused = |frame: Frame| frame.eyes().map(|_| ()).unwrap_err();
    assert_eq!(
        refused(frame(wireframe, near_the_limit)),
        RenderError::Stereo
    );
    let parallel = near_the_limit.with_projection(Projection::Orthographic);
    assert_eq!(refused(frame(mesh, parallel)), RenderError::Orthographic);
    // The camera is within the permitted distance, but its eyes are not.
    let eyes = frame(mesh, near_the_limit).eyes().unwrap().unwrap();
    for eye in [eyes.left, eyes.right] {
        let error = eye.constants().map(|_| ()).unwrap_err();
        assert_eq!(error, RenderError::Eye(eye.view.eye()));
    }
    // Such a frame must be drawn as two frames.
    let error = frame(mesh, near_the_limit).constants().map(|_| ());
    assert_eq!(error, Err(RenderError::Stereo));
}
