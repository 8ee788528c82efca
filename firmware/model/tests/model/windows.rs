//! Tests of camera windows that are off the camera's axis, or whose pixels are not square: positions, rays and the sky, compared with f64.

use glint_core::camera::{Lens, Projection, View};
use glint_core::field::Field;
use glint_core::fixed::{Q2_23, Q4_28, Q32_32, U4_28, U8_28};
use glint_core::light::Gradient;
use glint_core::picture::Size;
use glint_model::raymarch::exits::{Exits, Words};
use glint_model::raymarch::{FieldOptions, FieldSetup};
use glint_model::triangle::vertex::{project, transform};
use glint_model::{MeshSetup, Projected, RenderError, SIZES, Sky};
use glint_vectors::{Camera, Random, math::dot, math::world};

use crate::{RADII, error};

/// The window of a lens: half width, half height, and the position of the middle along u and v.
fn window(lens: &Lens) -> ([f64; 2], [f64; 2]) {
    let half = [lens.half_width(), lens.half_height()];
    (half.map(U8_28::to_num), lens.middle().map(Q4_28::to_num))
}

/// A camera with a random window whose half width and half height are within `halves`, and whose middle is within `aside` half widths and
/// half heights of the axis, and within 6.
fn random_view(random: &mut Random, projection: Projection, halves: [f64; 2], aside: f64) -> View {
    let towards = random.direction();
    let mut camera = Camera::aimed(random, [0.0; 3], towards, [0.0; 2], 1.0, 0.1);
    camera.eye = random.direction().map(|x| 2.0 * x);
    let half = [0; 2].map(|_| random.logarithmic(halves[0], halves[1]));
    let middle = half.map(|half| (random.real(-aside, aside) * half).clamp(-6.0, 6.0));
    let lens = Lens::window(
        projection,
        half.map(U8_28::from_num),
        middle.map(Q32_32::from_num),
        U4_28::from_num(0.13),
    );
    camera.rounded().with_lens(lens.expect("in range"))
}

/// The components of a vector along the camera's axes.
fn along(view: &View, place: [f64; 3]) -> [f64; 3] {
    [view.u(), view.v(), view.n()].map(|row| dot(row.map(Q2_23::to_num), place))
}

#[test]
fn places_against_f64() {
    let mut random = Random(71);
    for projection in Projection::ALL {
        let mut worst = [0.0_f64; 2];
        let mut count = 0;
        for round in 0..40_000 {
            let size = SIZES[round % 3];
            let view = random_view(&mut random, projection, [0.1, 3.0], 3.0);
            let frame = match MeshSetup::new(&view, size.0, size.1, RADII[0]) {
                Ok(frame) => frame,
                // The middle of the picture is too far from the world's origin.
                Err(error) => {
                    let is_moved = view.eye_of_middle() != view.eye();
                    assert!(matches!(error, RenderError::Eye(_)) && is_moved);
                    continue;
                }
            };
            let eye = view.eye().map(Q32_32::to_num::<f64>);
            let (half, middle) = window(view.lens());
            for _ in 0..20 {
                let point = [0; 3].map(|_| random.integer(-8192, 8191) as i16);
                let from_eye = [0, 1, 2].map(|i| world(point)[i] - eye[i]);
                let [x, y, z] = along(&view, from_eye);
                let depth = match projection {
                    Projection::Perspective => z,
                    Projection::Orthographic => 1.0,
                };
                let pixels = [f64::from(size.0), f64::from(size.1)].map(|n| n / 2.0);
                let place = [x / depth, y / depth];
                let exact = [0, 1].map(|i| pixels[i] * (1.0 + (place[i] - middle[i]) / half[i]));
                let found = project(&frame, &transform(&frame, point));
                let is_inside = (0..2).all(|i| (0.0..2.0 * pixels[i]).contains(&exact[i]));
                if z < 0.131 || !is_inside {
                    continue;
                }
                let Projected::Visible(found) = found else {
                    panic!("{point:?} in {view:?}: {found:?}")
                };
                let large = usize::from(size.0 == 1280);
                worst[large] = worst[large].max(error(found, [exact[0], exact[1], z]));
                count += 1;
            }
        }
        println!(
            "{projection}: {count} positions, largest error in 1/256 pixel, for smaller sizes and for 1280x720: {worst:.3?}"
        );
        assert!(count > 10_000 && worst.into_iter().all(|worst| worst <= 2.0));
    }
}

/// The scale shift is the largest for which the rows of both axes fit 25 bits, for every middle at the same distance from the axis.
#[test]
fn rows_fit_their_width() {
    let mut random = Random(72);
    let mut refused = 0;
    for round in 0..50_000 {
        let size = SIZES[round % 3];
        let halves = [0.0088, 114.0];
        let view = random_view(&mut random, Projection::ALL[round % 2], halves, 1000.0);
        let view = view.with_near(U4_28::from_num(2)).expect("in range");
        match MeshSetup::new(&view, size.0, size.1, 0) {
            Ok(frame) => {
                let rows = [frame.u, frame.v];
                assert!(
                    rows.as_flattened()
                        .iter()
                        .all(|x| x.unsigned_abs() < 1 << 24)
                );
                assert!((6..=18).contains(&frame.scale_shift));
            }
            Err(RenderError::Eye(_)) => {
                assert_eq!(view.projection(), Projection::Orthographic);
            }
            Err(error) => {
                assert_eq!(error, RenderError::Window);
                let (half, middle) = window(view.lens());
                let slope = |i: usize| middle[i].abs().max(1.0) / half[i].min(half[1 - i]);
                assert!(slope(0).max(slope(1)) > 50.0, "{view:?}");
                refused += 1;
            }
        }
    }
    assert!(refused > 1000);
}

#[test]
fn rays_and_the_sky_against_f64() {
    let mut random = Random(73);
    let field = Field::parse("box:1,1,1").expect("a field");
    let mut worst = [0.0_f64; 2];
    for round in 0..2000 {
        let size = Size::ALL[round % 3];
        let [width, height] = size.pixels();
        let view = random_view(&mut random, Projection::Perspective, [0.06, 1.9], 1.0);
        let (half, middle) = window(view.lens());
        let exits = Exits::new(&field, &view, (width, height), None, Words::CHOSEN).unwrap();
        let gradient = Gradient {
            colours: [[0; 3]; 3],
            is_fixed: false,
        };
        let sky = Sky::new(&view, [width, height], gradient);
        let rows = [view.u(), view.v(), view.n()].map(|row| row.map(Q2_23::to_num::<f64>));
        for _ in 0..50 {
            let x = random.integer(0, i64::from(width) - 1) as u32;
            let y = random.integer(0, i64::from(height) - 1) as u32;
            let direction = |x: f64, y: f64| {
                let place = [x / f64::from(width), y / f64::from(height)];
                let [right, down] = [0, 1].map(|i| middle[i] + (2.0 * place[i] - 1.0) * half[i]);
                [0, 1, 2].map(|i| rows[2][i] + right * rows[0][i] + down * rows[1][i])
            };
            let exact = direction(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let ray = exits.ray(0, x, y);
            let scale = 2f64.powi(exits.exponent as i32 - 28);
            for (i, exact) in exact.into_iter().enumerate() {
                let found = f64::from(ray.speed[i]) * if ray.down[i] { -scale } else { scale };
                worst[0] = worst[0].max((found - exact).abs());
            }
            let exact = direction(f64::from(x / 8 * 8) + 4.0, f64::from(y) + 0.5)[2];
            let found = f64::from(sky.height(x / 8, y)) * 0.5f64.powi(23);
            worst[1] = worst[1].max((found - exact).abs());
        }
    }
    println!(
        "largest error of rays {:.1e}, of heights {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst[0] <= 1e-5 && worst[1] < 221.0 * 0.5f64.powi(23));
}

/// A field requires a window whose sides are within 4 of the axis.
#[test]
fn windows_of_fields() {
    let field = Field::parse("box:1,1,1").expect("a field");
    let view = Camera::looking([0.0, -3.0, 0.0], [0.0; 3], 1.0, 0.1).rounded();
    let drawn = |half: [f64; 2], middle: [f64; 2]| {
        let lens = Lens::window(
            Projection::Perspective,
            half.map(U8_28::from_num),
            middle.map(Q32_32::from_num),
            view.near(),
        );
        let view = view.with_lens(lens.expect("in range"));
        FieldSetup::new(&field, &view, (320, 180), &FieldOptions::default()).map(|_| ())
    };
    for (half, middle) in [
        ([4.0, 4.0], [0.0; 2]),
        ([1.0, 1.0], [3.0, -3.0]),
        ([0.05, 0.03], [0.0; 2]),
    ] {
        assert_eq!(drawn(half, middle), Ok(()));
    }
    for (half, middle) in [
        ([1.0, 4.1], [0.0; 2]),
        ([1.0, 1.0], [3.1, 0.0]),
        ([1.0, 1.0], [0.0, -3.1]),
        ([1.0, 0.028], [0.0; 2]),
    ] {
        assert_eq!(drawn(half, middle), Err(RenderError::Sides));
    }
}

/// A window that is the left half of another window, in a picture of the same size, shows the left half of the other picture with doubled
/// positions.
#[test]
fn halves_of_a_window() {
    let mut random = Random(74);
    let view = Camera::looking([2.0, 1.0, 0.5], [0.0; 3], 0.6, 0.1).rounded();
    let lens = Lens::window(
        Projection::Perspective,
        ["0.3", "0.3375"].map(U8_28::lit),
        [Q32_32::lit("-0.3"), Q32_32::ZERO],
        view.near(),
    );
    let part = view.with_lens(lens.expect("in range"));
    let [whole, part] = [view, part].map(|view| MeshSetup::new(&view, 640, 360, RADII[0]).unwrap());
    for _ in 0..1000 {
        let point = [0; 3].map(|_| random.integer(-8192, 8191) as i16);
        let place = |frame| match project(frame, &transform(frame, point)) {
            Projected::Visible(place) => place,
            other => panic!("{other:?}"),
        };
        let (whole, part) = (place(&whole), place(&part));
        assert!((2 * whole.x - part.x).abs() <= 3 && (whole.y - part.y).abs() <= 1);
        assert_eq!(whole.w, part.w);
    }
}
