//! Tests of cameras against computations in f64, and of the conditions on their bases.

use std::f64::consts::TAU;

use glint_core::camera::{
    DEFAULT_HALF_WIDTH, DEFAULT_NEAR, HALF_WIDTH, Projection, View, ViewError, WIDTH,
};
use glint_core::fixed::{Q2_23, Q32_32, Turns, U4_28, U8_28};

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| a[i] * b[j] - a[j] * b[i])
}

fn difference(a: Vector, b: Vector) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn rows(view: &View) -> [[Q2_23; 3]; 3] {
    [view.u(), view.v(), view.n()]
}

fn basis(view: &View) -> [Vector; 3] {
    rows(view).map(|row| row.map(Q2_23::to_num))
}

/// Returns the deviation of a view's basis from an orthonormal right-handed basis: the largest of |a·a − 1|, |a·b| and |u × v −
/// n|.
fn deviation(view: &View) -> f64 {
    let [u, v, n] = basis(view);
    [
        dot(u, u) - 1.0,
        dot(v, v) - 1.0,
        dot(n, n) - 1.0,
        dot(u, v),
        dot(v, n),
        dot(n, u),
        difference(cross(u, v), n),
    ]
    .map(f64::abs)
    .into_iter()
    .fold(0.0, f64::max)
}

fn radians(angle: u32) -> f64 {
    f64::from(angle) / 2f64.powi(32) * TAU
}

/// Returns test angles in units of 2^−32 turns: the multiples of an eighth of a turn, their neighbours, and `count` further
/// angles over the circle.
fn angles(count: u32) -> impl Iterator<Item = u32> + Clone {
    let edges = (0..8_u32)
        .flat_map(|octant| [u32::MAX, 0, 1].map(|offset| (octant << 29).wrapping_add(offset)));
    edges.chain((0..count).map(|k| k.wrapping_mul(2_654_435_769).wrapping_add(k >> 3)))
}

/// Checks a view's basis against the expected vectors, and returns its deviation from an orthonormal basis.
#[track_caller]
fn check(view: &View, expected: [Vector; 3]) -> f64 {
    for (row, expected) in basis(view).into_iter().zip(expected) {
        // The tolerance is half a unit of Q2.23, plus 5 % for the errors of the sines and of one product.
        assert!(
            difference(row, expected) <= 2f64.powi(-24) * 1.05,
            "{row:?} {expected:?}"
        );
    }
    let again = View::new_checked(
        view.eye(),
        view.u(),
        view.v(),
        view.n(),
        view.half_width(),
        view.near(),
    );
    assert_eq!(again, Ok(*view));
    deviation(view)
}

#[test]
fn the_spherical_camera_is_what_it_should_be() {
    let mut largest: f64 = 0.0;
    let (mut eye_error, r) = (0.0_f64, Q32_32::lit("3.7"));
    for theta in angles(700) {
        for phi in angles(700).filter(|&phi| phi <= 1 << 31) {
            let view = View::spherical(r, Turns(theta), Turns(phi)).expect("in range");
            let ((st, ct), (sp, cp)) = (radians(theta).sin_cos(), radians(phi).sin_cos());
            let outward = [sp * ct, sp * st, cp];
            let expected = [[-st, ct, 0.0], [cp * ct, cp * st, -sp], outward.map(|x| -x)];
            largest = largest.max(check(&view, expected));
            let eye = view.eye().map(Q32_32::to_num);
            eye_error = eye_error.max(difference(eye, outward.map(|x| x * r.to_num::<f64>())));
        }
    }
    println!(
        "spherical: orthonormal within 2^{:.2}, eye within {eye_error:.2e}",
        largest.log2()
    );
    assert!(largest <= 2f64.powi(-20), "{largest}");
    assert!(eye_error <= 1e-8, "{eye_error}");
}

#[test]
fn the_free_camera_is_what_it_should_be() {
    let mut largest: f64 = 0.0;
    for yaw in angles(50) {
        for pitch in angles(50) {
            for roll in angles(50) {
                let view = View::look([Q32_32::ONE; 3], Turns(yaw), Turns(pitch), Turns(roll))
                    .expect("in range");
                let ((sy, cy), (sp, cp), (sr, cr)) = (
                    radians(yaw).sin_cos(),
                    radians(pitch).sin_cos(),
                    radians(roll).sin_cos(),
                );
                let (right, up) = ([cy, 0.0, -sy], [sp * sy, cp, sp * cy]);
                let mix = |a: f64, b: f64| [0, 1, 2].map(|i| a * right[i] + b * up[i]);
                let swap = |[x, y, z]: Vector| [x, z, y];
                let expected = [
                    swap(mix(cr, sr)),
                    swap(mix(sr, -cr)),
                    swap([cp * sy, -sp, cp * cy]),
                ];
                largest = largest.max(check(&view, expected));
            }
        }
    }
    println!("free: orthonormal within 2^{:.2}", largest.log2());
    assert!(largest <= 2f64.powi(-20), "{largest}");
}

/// Returns `count` vectors with random directions, whose components have all magnitudes up to 2^23.
fn vectors(count: u32) -> impl Iterator<Item = [Q32_32; 3]> {
    (1..=count).map(|k| {
        let mut state = u64::from(k).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        [0; 3].map(|_| {
            state = (state ^ (state >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            Q32_32::from_bits(state as i64 >> (8 + k % 40))
        })
    })
}

#[test]
fn the_camera_towards_a_gaze_is_what_it_should_be() {
    let normalised = |a: Vector| a.map(|x| x / dot(a, a).sqrt());
    let zero = [Q32_32::ZERO; 3];
    let (mut largest, mut error, mut places) = (0.0_f64, 0.0_f64, 0);
    for (gaze, up) in vectors(200_000).zip(vectors(200_001).skip(1)) {
        let Ok(view) = View::towards(zero, gaze, up) else {
            assert!(gaze == zero || up == zero);
            continue;
        };
        largest = largest.max(deviation(&view));
        let n = normalised(gaze.map(|x| x.to_bits() as f64));
        let across = cross(n, normalised(up.map(|x| x.to_bits() as f64)));
        let sine = dot(across, across).sqrt();
        if sine < 2e-3 {
            continue;
        }
        places += 1;
        let u = normalised(across);
        for (row, expected) in basis(&view).into_iter().zip([u, cross(n, u), n]) {
            let units = difference(row, expected) * 2f64.powi(23);
            error = error.max(units - 2f64.powi(-6) / sine);
        }
    }
    println!(
        "towards: orthonormal within 2^{:.2}, {error:.3} units",
        largest.log2()
    );
    assert!(largest <= 2f64.powi(-20) && error <= 0.51 && places > 100_000);
}

#[test]
fn fields_of_view_are_tangents() {
    let view = View::spherical(Q32_32::from_num(2), Turns(0), Turns(0)).expect("in range");
    let mut largest: f64 = 0.0;
    for tenths in 10..=1790 {
        let angle = Turns::from_degrees(Q32_32::from_num(f64::from(tenths) / 10.0));
        let wide = view.with_field_of_view(angle).expect("in range");
        let exact = (radians(angle.0) / 2.0).tan();
        largest = largest.max((wide.half_width().to_num::<f64>() / exact - 1.0).abs());
        assert_eq!(
            (wide.eye(), wide.n(), wide.near()),
            (view.eye(), view.n(), view.near())
        );
        check(&wide, basis(&view));
    }
    println!("relative error of the half width: 2^{:.2}", largest.log2());
    assert!(largest <= 2f64.powi(-22));
    for degrees in [0.99, 179.01, 0.0, 180.0, 359.0] {
        let angle = Turns::from_degrees(Q32_32::from_num(degrees));
        assert_eq!(
            view.with_field_of_view(angle),
            Err(ViewError::FieldOfView(angle))
        );
    }
}

#[test]
fn orthographic_cameras_have_a_width() {
    let view = View::spherical(Q32_32::from_num(2), Turns(0), Turns(0)).expect("in range");
    assert_eq!(view.projection(), Projection::Perspective);
    let lens = (view.half_width(), view.near());
    assert_eq!(lens, (DEFAULT_HALF_WIDTH, DEFAULT_NEAR));
    let with_width = |x: f64| view.with_width(U8_28::from_num(x));
    let parallel = with_width(3.5).expect("in range");
    assert_eq!(
        (parallel.projection(), parallel.half_width()),
        (Projection::Orthographic, U8_28::from_num(1.75))
    );
    assert_eq!((parallel.eye(), parallel.near()), (view.eye(), view.near()));
    // A field of view selects perspective; the lens of another camera includes its projection.
    let angle = Turns::from_degrees(Q32_32::from_num(60));
    let wide = parallel.with_field_of_view(angle).expect("in range");
    assert_eq!(wide.projection(), Projection::Perspective);
    assert_eq!(view.with_lens_of(&parallel), parallel);
    assert_eq!(
        parallel
            .with_projection(Projection::Perspective)
            .with_lens_of(&view),
        view
    );
    for x in WIDTH {
        let ends = view.with_width(x).expect("in range");
        assert!((HALF_WIDTH[0]..=HALF_WIDTH[1]).contains(&ends.half_width()));
    }
    for x in [0.0173, 230.1, 0.0] {
        assert_eq!(with_width(x), Err(ViewError::Width(U8_28::from_num(x))));
    }
    assert!(parallel.to_string().ends_with(" 1.75 0.1 orthographic"));
}

/// Returns the numbers of a valid camera (eye, basis, half width, near plane); each test changes one of them.
fn numbers() -> ([Q32_32; 3], [[Q2_23; 3]; 3], U8_28, U4_28) {
    let view = View::look(
        [Q32_32::ONE; 3],
        Turns(123_456_789),
        Turns(987_654_321),
        Turns(1 << 28),
    )
    .expect("in range");
    (view.eye(), rows(&view), view.half_width(), view.near())
}

#[test]
fn what_is_out_of_range_is_refused() {
    let (eye, [u, v, n], half_width, near) = numbers();
    let with_eye = |eye| View::new_checked(eye, u, v, n, half_width, near).map(|view| view.eye());
    let farthest = Q32_32::from_num(32);
    for eye in [
        [farthest, Q32_32::ZERO, Q32_32::ZERO],
        [Q32_32::lit("18.4752"); 3],
        [-Q32_32::lit("18.4752"); 3],
    ] {
        assert_eq!(with_eye(eye), Ok(eye));
    }
    let too_far = [
        [farthest + Q32_32::DELTA, Q32_32::ZERO, Q32_32::ZERO],
        [Q32_32::lit("18.4753"); 3],
        [Q32_32::MIN; 3],
        [Q32_32::MAX; 3],
    ];
    for eye in too_far {
        assert_eq!(with_eye(eye), Err(ViewError::Eye(eye)));
        assert_eq!(
            View::look(eye, Turns(0), Turns(0), Turns(0)),
            Err(ViewError::Eye(eye))
        );
    }
    let with_half_width =
        |x| View::new_checked(eye, u, v, n, x, near).map(|view| view.half_width());
    for x in ["0.0087", "0.9", "115"].map(U8_28::lit) {
        assert_eq!(with_half_width(x), Ok(x));
    }
    for x in ["0", "0.0086", "115.0001", "255.9"].map(U8_28::lit) {
        assert_eq!(with_half_width(x), Err(ViewError::HalfWidth(x)));
    }
    let with_near = |x| View::new_checked(eye, u, v, n, half_width, x).map(|view| view.near());
    for x in ["0.01", "0.1", "2"].map(U4_28::lit) {
        assert_eq!(with_near(x), Ok(x));
    }
    for x in ["0", "0.0099", "2.0001", "15.9"].map(U4_28::lit) {
        assert_eq!(with_near(x), Err(ViewError::Near(x)));
    }
}

#[test]
fn a_basis_is_orthonormal_to_1e_4() {
    let (eye, [u, v, n], half_width, near) = numbers();
    let make = |u, v, n| View::new_checked(eye, u, v, n, half_width, near);
    let scaled = |row: [Q2_23; 3], by: f64| row.map(|x| Q2_23::from_num(x.to_num::<f64>() * by));
    let tilted = |row: [Q2_23; 3], to: [Q2_23; 3], by: f64| {
        [0, 1, 2].map(|i| row[i] + Q2_23::from_num(to[i].to_num::<f64>() * by))
    };
    for within in [-0.99e-4, -1e-6, 0.0, 1e-6, 0.99e-4] {
        assert!(make(scaled(u, 1.0 + within), v, n).is_ok());
        assert!(make(u, tilted(v, u, within), n).is_ok());
        assert!(make(u, v, tilted(n, v, within)).is_ok());
    }
    let is_long = |made: Result<View, ViewError>| matches!(made, Err(ViewError::Length { .. }));
    for beyond in [-1e-2, -1.02e-4, 1.02e-4, 1e-2] {
        assert!(is_long(make(scaled(u, 1.0 + beyond), v, n)));
        assert!(is_long(make(u, v, scaled(n, 1.0 + beyond))));
    }
    for beyond in [-9e-3, -1.02e-4, 1.02e-4, 9e-3] {
        for made in [
            make(u, tilted(v, u, beyond), n),
            make(u, v, tilted(n, v, beyond)),
        ] {
            let is_tilted = matches!(made, Err(ViewError::NotPerpendicular { .. }));
            assert!(is_tilted || is_long(made));
        }
    }
    assert_eq!(make(v, u, n), Err(ViewError::Mirrored));
    assert_eq!(make(u, v, n.map(|x| -x)), Err(ViewError::Mirrored));
    for extreme in [Q2_23::MIN, Q2_23::MAX, Q2_23::ZERO] {
        assert!(is_long(make([extreme; 3], v, n)));
    }
}
