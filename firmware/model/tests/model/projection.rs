//! Tests of the vertex stage: snapped positions and depths of vertices, compared with a projection in f64.

use std::collections::BTreeSet;

use glint_model::triangle::reciprocal::Reciprocal;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{MeshSetup, Projected, SIZES, ScreenVertex};
use glint_vectors::{Camera, Random, math::world};

use crate::{RADII, error};

/// The smallest and the largest half width of a camera, in world units.
const HALF_WIDTHS: [f64; 2] = [0.0087, 115.0];

/// Largest errors of positions in 1/256 pixel, and the number of positions.
#[derive(Clone, Copy, Default)]
struct Worst {
    /// Largest error of a position on the screen.
    screen: f64,
    /// Largest error of a position in the guard band.
    guard: f64,
    /// Number of positions on the screen.
    count: u32,
}

impl Worst {
    fn note(&mut self, place: ScreenVertex, exact: [f64; 3], (width, height): (u32, u32)) {
        let (error, [x, y, _]) = (error(place, exact), exact);
        let on_screen =
            (0.0..=f64::from(width)).contains(&x) && (0.0..=f64::from(height)).contains(&y);
        if on_screen {
            self.screen = self.screen.max(error);
            self.count += 1;
        }
        self.guard = self.guard.max(error);
    }
}

/// Returns a random camera within 8 world units of the origin, a point of a mesh in the camera's guard band, and the depth of this point.
/// The coordinates of the point are in ±`reach`.
fn aimed(
    random: &mut Random,
    (width, height): (u32, u32),
    half_width: f64,
    reach: f64,
) -> (Camera, [i16; 3], f64) {
    loop {
        let point = [0; 3]
            .map(|_| random.integer((-16384.0 * reach) as i64, (16383.0 * reach) as i64) as i16);
        let distance = random.real(0.0, 8.0);
        let eye = random.direction().map(|x| x * distance);
        let towards = [0, 1, 2].map(|i| world(point)[i] - eye[i]);
        let length = glint_vectors::math::dot(towards, towards).sqrt();
        // Position of the point in pixels, which is on the screen with probability 1/2.
        let (x, y) = if random.coin() {
            (
                random.real(0.0, width.into()),
                random.real(0.0, height.into()),
            )
        } else {
            (random.real(-2047.0, 2047.0), random.real(-2047.0, 2047.0))
        };
        let scale = 2.0 * half_width / f64::from(width);
        let place = [
            (x - f64::from(width) / 2.0) * scale,
            (y - f64::from(height) / 2.0) * scale,
        ];
        let z = length / (1.0 + place[0].powi(2) + place[1].powi(2)).sqrt();
        if z > 0.01 {
            let near = random.logarithmic(0.01, z.min(2.0));
            return (
                Camera::aimed(random, eye, towards, place, half_width, near),
                point,
                z,
            );
        }
    }
}

#[test]
fn places_against_f64() {
    let mut random = Random(1);
    for (size, bound) in SIZES.into_iter().zip([1.0, 1.0, 2.0]) {
        let (width, height) = size;
        let [mut same, mut unrounded] = [Worst::default(); 2];
        for round in 0..40_000 {
            let half_width = match round % 8 {
                0 => 0.05,
                1 => 4.0,
                _ => random.logarithmic(0.05, 4.0),
            };
            let index = round / 8 % 2;
            let (camera, point, z) = aimed(&mut random, size, half_width, [0.5, 2.0][index]);
            let view = camera.rounded();
            let frame = MeshSetup::new(&view, width, height, RADII[index]).unwrap();
            for _ in 0..4 {
                // Tests positions near the point, which are therefore also near the point on the screen.
                let spread = (z * half_width * 16384.0).min(20_000.0) as i64 + 1;
                let position = point.map(|x| {
                    (i64::from(x) + random.integer(-spread, spread)).clamp(-32768, 32767) as i16
                });
                if let Projected::Visible(place) = project(&frame, &transform(&frame, position)) {
                    let exact = |camera: &Camera| camera.project(world(position), width, height);
                    same.note(place, exact(&Camera::of(&view)), size);
                    unrounded.note(place, exact(&camera), size);
                }
            }
        }
        println!(
            "{width}x{height}: {} places on the screen; 1/256 px off: {:.3} on it, {:.3} in the guard band \
             (from the camera before its rounding: {:.3}, {:.3})",
            same.count, same.screen, same.guard, unrounded.screen, unrounded.guard
        );
        assert!(same.count > 20_000);
        // `unrounded.guard` has no bound, because for positions outside of the screen a wide camera amplifies the rounding errors of the
        // camera's axes.
        assert!(same.guard <= bound && unrounded.screen <= bound);
    }
}

/// Tests horizontal fields of view from 1° to 179°, including 150°, each with the nearest allowed near plane.
#[test]
fn fields_of_view_against_f64() {
    let mut random = Random(6);
    for degrees in [1.0f64, 2.0, 60.0, 120.0, 150.0, 170.0, 179.0] {
        for (width, height) in SIZES {
            let half_width = (degrees / 2.0).to_radians().tan();
            let size = (width, height);
            let (mut worst, mut shift) = (Worst::default(), 0);
            for _ in 0..10_000 {
                let (camera, point, z) = aimed(&mut random, size, half_width, 0.5);
                let least = (2.0 * half_width * 2f64.powi(17 + 4) / f64::from(width))
                    .log2()
                    .floor();
                let near = 2f64.powi(3 - least.min(18.0) as i32).max(0.01);
                let view = Camera { near, ..camera }.rounded();
                let frame = MeshSetup::new(&view, width, height, RADII[0]).unwrap();
                shift = frame.scale_shift;
                if z < near {
                    continue;
                }
                if let Projected::Visible(place) = project(&frame, &transform(&frame, point)) {
                    let exact = Camera::of(&view).project(world(point), width, height);
                    worst.note(place, exact, size);
                }
            }
            println!(
                "{degrees} degrees, {width}x{height}: {} positions, error in 1/256 pixel: {:.3} on the screen, {:.3} in the guard band",
                worst.count, worst.screen, worst.guard
            );
            assert!(worst.count > 1_000);
            // The error bound of docs/formats/triangle.md, with |D|/Z at a corner of the picture.
            let longest = (1.0 + 1.3164 * half_width * half_width).sqrt();
            let rows = 0.5f64.powi(shift as i32 + 1) + f64::from(width) * 0.5f64.powi(25);
            let bound = 0.75 + 256.0 * 3f64.sqrt() * longest * rows;
            assert!(worst.screen <= bound, "{} > {bound}", worst.screen);
        }
    }
    // A near plane that is too near for a narrow picture of many pixels is rejected.
    let camera = |near| Camera::looking([4.0, 0.0, 0.0], [0.0; 3], 0.0088, near).rounded();
    let refused = MeshSetup::new(&camera(0.06), 1280, 720, RADII[0]).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "near 0.06: expected at least 0.0625 for a mesh of this size in a picture of this width and field of view"
    );
    assert!(MeshSetup::new(&camera(0.0625), 1280, 720, RADII[0]).is_ok());
    assert!(MeshSetup::new(&camera(0.016), 320, 180, RADII[0]).is_ok());
}

/// Compares the depth w of a vertex, in 1/64 code, with K/z, and the scale K with its definition: the nearest possible depth of the mesh
/// must have the code 2^18 − 4, or a code that is lower by a relative 2^−16 at most.
#[test]
fn depths_against_f64() {
    let mut random = Random(2);
    let mut worst: f64 = 0.0;
    for round in 0..40_000 {
        let half_width = random.logarithmic(0.05, 4.0);
        let index = round % 2;
        let (camera, point, _) = aimed(&mut random, SIZES[0], half_width, [0.5, 2.0][index]);
        let view = camera.rounded();
        let frame = MeshSetup::new(&view, 320, 180, RADII[index]).unwrap();
        let k = f64::from(frame.depth.mantissa) * 2f64.powi(frame.depth.exponent);
        let [.., z] = Camera::of(&view).project(world(point), 320, 180);
        if let Projected::Visible(place) | Projected::BeyondGuard(place) =
            project(&frame, &transform(&frame, point))
        {
            let exact = 64.0 * k / z;
            assert!(exact < 64.0 * 262_140.5, "{exact} at {z}");
            worst = worst.max((f64::from(place.w) - exact).abs());
        }
        let origin = -glint_vectors::math::dot(Camera::of(&view).n, Camera::of(&view).eye);
        let nearest = view
            .near()
            .to_num::<f64>()
            .max(origin - f64::from(RADII[index]) / 16384.0 * (1.0 + 2f64.powi(-13)));
        assert!(
            (1.0 - 2f64.powi(-16)..=1.0).contains(&(k / nearest / 262_140.0)),
            "K {k} for {nearest}"
        );
    }
    println!("largest difference of w and K/z: {worst:.3}/64 code");
    assert!(worst <= 4.5);
}

/// Tests extreme valid cameras: nothing overflows, and positions are correct.
#[test]
fn extremes() {
    let mut random = Random(3);
    let corners = [
        [i16::MIN; 3],
        [i16::MAX; 3],
        [i16::MIN, i16::MAX, i16::MIN],
        [0; 3],
        [1, 0, -1],
    ];
    let mut seen = 0;
    for size in SIZES {
        for half_width in [0.05, 4.0] {
            for near in [0.01, 2.0] {
                for eye in [
                    [8.0, 0.0, 0.0],
                    [0.0, 0.0, -8.0],
                    [4.6, 4.6, 4.6],
                    [-2.0, -2.0, -2.0],
                    [0.0; 3],
                    [2.0, -2.0, 2.0],
                ] {
                    for _ in 0..50 {
                        let scale = 1.0 + random.real(-9.9e-5, 9.9e-5);
                        let mut camera = Camera::aimed(
                            &mut random,
                            eye,
                            eye.map(|x| 0.1 - x),
                            [0.0; 2],
                            half_width,
                            near,
                        );
                        for row in [&mut camera.u, &mut camera.v, &mut camera.n] {
                            *row = row.map(|x| x * scale);
                        }
                        let view = camera.rounded();
                        let frame = MeshSetup::new(&view, size.0, size.1, RADII[1]).unwrap();
                        assert!((10..=18).contains(&frame.scale_shift));
                        let mut rows = frame.u.iter().chain(&frame.v);
                        assert!(rows.all(|row| row.abs() < 1 << 24));
                        assert!(frame.translation.iter().all(|t| t.abs() < 1 << 42));
                        for position in corners {
                            let vertex = transform(&frame, position);
                            assert!(
                                [vertex.x, vertex.y].iter().all(|x| x.abs() < 3 << 40)
                                    && vertex.z.abs() < 1 << 41
                            );
                            let [x, y, z] =
                                Camera::of(&view).project(world(position), size.0, size.1);
                            let inside = x.abs().max(y.abs()) < 2046.9;
                            let outside = x.abs().max(y.abs()) > 2047.1;
                            match project(&frame, &vertex) {
                                Projected::Behind => assert!(z < near + 1e-6),
                                Projected::Visible(_) => assert!(z > near - 1e-6 && !outside),
                                Projected::BeyondGuard(place) => {
                                    assert!(z > near - 1e-6 && !inside);
                                    // A saturated position must be beyond the same side of the guard band as the exact position.
                                    let side = |place: i32, x: f64| {
                                        x.abs() < 2046.9
                                            || f64::from(place) * x >= 256.0 * 2046.0 * x.abs()
                                    };
                                    assert!(
                                        side(place.x, x) && side(place.y, y),
                                        "{place:?} for {x}, {y}"
                                    );
                                }
                            }
                            seen += u32::from(z >= near);
                        }
                    }
                }
            }
        }
    }
    assert!(seen > 5000, "{seen}");
}

/// Compares the vertex stage with the steps in docs/formats/triangle.md, computed in 128-bit numbers.
#[test]
fn steps_as_written() {
    let mut random = Random(4);
    let nearest = |x: i128, shift: i32| (x + (1 << (shift - 1))) >> shift;
    for round in 0..100_000 {
        let (width, height) = SIZES[round % 3];
        let half_width = random.logarithmic(HALF_WIDTHS[0], HALF_WIDTHS[1]);
        let (camera, point, _) = aimed(&mut random, (width, height), half_width, 2.0);
        // A near plane that is accepted for every half width.
        let near = camera.near.max(0.0625);
        let view = Camera { near, ..camera }.rounded();
        let frame = MeshSetup::new(&view, width, height, RADII[1]).unwrap();
        let f = frame.scale_shift as i32;

        let rows = [(view.u(), f), (view.v(), f), (view.n(), 23)].map(|(row, bits)| {
            row.map(|x| {
                let x = i128::from(x.to_bits());
                if bits == 23 {
                    return x;
                }
                // Computes x·(W/2)/h·2^f, where x has 23 and h has 28 fraction bits.
                let (top, bottom) = (
                    (x * i128::from(width / 2)) << (f + 5),
                    i128::from(view.half_width().to_bits()),
                );
                (2 * top + bottom).div_euclid(2 * bottom)
            })
        });
        let [x, y, z] = rows.map(|row| {
            let product =
                |vector: [i64; 3]| -> i128 { (0..3).map(|k| i128::from(vector[k]) * row[k]).sum() };
            product(point.map(i64::from)) + nearest(-product(view.eye().map(|x| x.to_bits())), 18)
        });
        let vertex = transform(&frame, point);
        assert_eq!([x, y, z], [vertex.x, vertex.y, vertex.z].map(i128::from));
        if z < i128::from(view.near().to_bits()) << 9 {
            assert_eq!(project(&frame, &vertex), Projected::Behind);
            continue;
        }
        let Reciprocal {
            y: reciprocal,
            lead,
        } = Reciprocal::of(z as u64);
        let (reciprocal, lead) = (i128::from(reciprocal), lead as i32);
        let place = |x: i128, size: u32| {
            let normalised = nearest(x, f + lead - 34).clamp(-1 << 24, (1 << 24) - 1);
            256 * i128::from(size / 2) + nearest(normalised * reciprocal, 27)
        };
        let (km, ke) = (i128::from(frame.depth.mantissa), frame.depth.exponent);
        let expected = [
            place(x, width),
            place(y, height),
            nearest(km * reciprocal, 18 + lead - 37 - ke),
        ];
        let found = match project(&frame, &vertex) {
            Projected::Visible(place) | Projected::BeyondGuard(place) => place,
            Projected::Behind => panic!("not behind"),
        };
        assert_eq!(
            expected,
            [found.x.into(), found.y.into(), i128::from(found.w)]
        );
    }
}

/// The scale shift is the largest number up to 18 for which the components of the scaled camera axes `u` and `v` fit 25 bits. Tested with
/// the longest axes that a camera may have, over the whole range of half widths.
#[test]
fn rows_fill_their_width() {
    let mut random = Random(5);
    let [narrowest, widest] = HALF_WIDTHS;
    let mut shifts = BTreeSet::new();
    for round in 0..20_000 {
        let (width, height) = SIZES[round % 3];
        // For half of the cameras the scale s is slightly below a power of two, where the scale shift changes.
        let power = f64::from(width) / 2.0 / 2f64.powi(random.integer(1, 16) as i32);
        let half_width = match power * (1.0 + random.real(0.0, 3e-4)) {
            _ if round < 6 => HALF_WIDTHS[round / 3],
            near_power if round % 2 == 0 && (narrowest..widest).contains(&near_power) => near_power,
            _ => random.logarithmic(narrowest, widest),
        };
        let length = 1.000_099;
        let camera = Camera {
            eye: [0.0; 3],
            u: [length, 0.0, 0.0],
            v: [0.0, 0.0, -length],
            n: [0.0, length, 0.0],
            half_width,
            near: 0.1,
        };
        let view = camera.rounded();
        let frame = MeshSetup::new(&view, width, height, 0).unwrap();
        shifts.insert(frame.scale_shift);
        assert!(
            frame.u[0] < 1 << 24 && frame.v[2] > -1 << 24,
            "{half_width}"
        );
        let scale = f64::from(width) / 2.0 / view.half_width().to_num::<f64>();
        let fits = |f: i32| (scale * 2f64.powi(f)).ceil() * (1.0 + 2f64.powi(-12)) < 2f64.powi(24);
        let f = frame.scale_shift as i32;
        assert!(fits(f) && (f == 18 || !fits(f + 1)), "{f} for {half_width}");
    }
    assert!(shifts.into_iter().eq(7..=18));
}
