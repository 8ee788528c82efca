//! Gazes along the direction up, and the ends of the range of fields of view.

use glint_core::camera::{View, ViewError};
use glint_core::fixed::{Q32_32, Turns, U8_28};
use glint_model::triangle::vertex::{project, transform};
use glint_model::{MeshSetup, Projected, SIZES};
use glint_vectors::Camera;
use glint_vectors::math::world;

use crate::case::{Case, refused};

pub const CASES: &[Case] = &[
    ("gaze parallel to up", parallel_to_up),
    ("gaze within 0.056° of up", || {
        // 0.00097 is below 2^−10, the tangent of 0.05595°.
        assert_eq!(towards([0.000_97, 0.0, -1.0], Z).unwrap().u(), above().u());
        "as parallel".to_owned()
    }),
    ("gaze of length 0", || refused(towards([0.0; 3], Z))),
    ("up of length 0", || refused(towards(Z, [0.0; 3]))),
    ("field of view of 1°", || {
        assert!(field_of_view(1.0, 0.1, [1.7, -2.9, 1.3], 3.0..5.0) <= 2.0);
        "vertices on the screen within 2/256 pixel of f64".to_owned()
    }),
    ("field of view of 179°", || {
        assert!(field_of_view(179.0, 0.01, [0.3, -0.8, 0.5], 0.011..0.0151) <= 1.0);
        "vertices on the screen within 1/256 pixel of f64".to_owned()
    }),
    ("field of view of 0°", || refused(with_field_of_view(0.0))),
    ("field of view of 180°", || {
        refused(with_field_of_view(180.0))
    }),
    ("orthographic width of 0", || {
        refused(above().with_width(U8_28::ZERO))
    }),
    ("orthographic width of 255", || {
        refused(above().with_width(U8_28::from_num(255)))
    }),
];

const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn towards(gaze: [f64; 3], up: [f64; 3]) -> Result<View, ViewError> {
    let number = |v: [f64; 3]| v.map(Q32_32::from_num);
    View::towards(number([0.0, 0.0, 2.0]), number(gaze), number(up))
}

/// The spherical camera above the origin for which x points up on the screen.
fn above() -> View {
    View::spherical(Q32_32::from_num(2), Turns::HALF, Turns(0)).unwrap()
}

fn parallel_to_up() -> String {
    // Both directions, and lengths of the gaze that differ from that of up.
    assert_eq!(towards([0.0, 0.0, -5.0], Z).ok(), Some(above()));
    for (gaze, up, shown_up) in [
        ([0.0, 0.0, 0.3], Z, 0),
        ([7.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 1),
        ([0.0, -0.1, 0.0], [0.0, 2.0, 0.0], 0),
    ] {
        let view = towards(gaze, up).unwrap();
        let mut down = [0.0; 3];
        down[shown_up] = -1.0;
        assert_eq!(Camera::of(&view).v, down);
    }
    "the axis least inclined to up points up on the screen: x for up along z".to_owned()
}

fn with_field_of_view(degrees: f64) -> Result<View, ViewError> {
    above().with_field_of_view(Turns::from_degrees(Q32_32::from_num(degrees)))
}

/// The largest error of positions on the screen, in 1/256 pixel, for vertices that a camera at `eye` with a gaze along y sees at
/// these depths.
fn field_of_view(degrees: f64, near: f64, eye: [f64; 3], depths: std::ops::Range<f64>) -> f64 {
    let view = Camera::looking(eye, [0.0; 3], 0.9, near).rounded();
    let angle = Turns::from_degrees(Q32_32::from_num(degrees));
    let view = view.with_field_of_view(angle).unwrap();
    let camera = Camera::of(&view);
    let mut worst: f64 = 0.0;
    for (width, height) in SIZES {
        let frame = MeshSetup::new(&view, width, height, 56_756).unwrap();
        let (columns, rows, levels) = (64, 36, 4);
        for i in 0..=columns * rows * levels {
            let [column, row, level] = [i % columns, i / columns % rows, i / columns / rows];
            let part = |i: i32, count: i32| f64::from(i) / f64::from(count - 1);
            let across = (2.0 * part(column, columns) - 1.0) * camera.half_width;
            let down = (2.0 * part(row, rows) - 1.0) * camera.half_width * 9.0 / 16.0;
            let depth = depths.start + (depths.end - depths.start) * part(level, levels);
            let place = [0, 1, 2].map(|k| {
                eye[k] + (camera.n[k] + across * camera.u[k] + down * camera.v[k]) * depth
            });
            let position = place.map(|x| (x * 16384.0).round() as i16);
            let Projected::Visible(found) = project(&frame, &transform(&frame, position)) else {
                continue;
            };
            let [x, y, _] = camera.project(world(position), width, height);
            if (0.0..f64::from(width)).contains(&x) && (0.0..f64::from(height)).contains(&y) {
                let error = |found: i32, exact: f64| (f64::from(found) - 256.0 * exact).abs();
                worst = worst.max(error(found.x, x)).max(error(found.y, y));
            }
        }
    }
    println!("{degrees} degrees: {worst:.2}/256 pixel");
    worst
}
