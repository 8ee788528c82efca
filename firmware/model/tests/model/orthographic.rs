//! Tests of orthographic projection: positions and linear depth codes of vertices, compared with f64.

use glint_core::appearance::Appearance;
use glint_core::camera::{Projection, View};
use glint_core::colour::{Rgb565, Rounding};
use glint_core::field::Field;
use glint_core::fixed::{Turns, U8_28};
use glint_core::matrix::{Axis, Matrix};
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_model::triangle::raster::draw;
use glint_model::triangle::setup::Setup;
use glint_model::triangle::shade::Lit;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{
    Clip, FieldSubject, Frame, MeshSetup, MeshSubject, Object, Projected, RenderError, SIZES,
    ScreenVertex, Subject,
};
use glint_vectors::math::{dot, world};
use glint_vectors::triangles::{SIZE, random_triangle, set_up};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{RADII, applied, cube, error, number, object};

/// A camera at (0, −`distance`, 0) that looks along y, with a picture `width` world units wide.
fn along_y(distance: f64, width: f64) -> View {
    let view = Camera::looking([0.0, -distance, 0.0], [0.0; 3], 0.9, 0.1).rounded();
    view.with_width(U8_28::from_num(width)).unwrap()
}

/// A point on the screen in pixels, and its depth in world units.
fn projected(view: &View, point: [f64; 3], (width, height): (u32, u32)) -> [f64; 3] {
    let camera = Camera::of(view);
    let d = [0, 1, 2].map(|i| point[i] - camera.eye[i]);
    let scale = f64::from(width) / 2.0 / camera.half_width;
    [
        f64::from(width) / 2.0 + dot(camera.u, d) * scale,
        f64::from(height) / 2.0 + dot(camera.v, d) * scale,
        dot(camera.n, d),
    ]
}

/// The depth code of a depth, from the definition: 2^18 − 4 at the nearest depth, and 2^(19 − ke) codes less per world unit.
fn code(frame: &MeshSetup, z: f64) -> f64 {
    let origin = frame.depth.origin.unwrap() as f64 * 0.5f64.powi(37);
    2f64.powi(18) - (z - origin) * 2f64.powi(19 - frame.depth.exponent)
}

/// Returns a random orthographic camera within 8 world units of the origin, and a point of a mesh within ±`reach` that is on the screen.
fn aimed(random: &mut Random, size: (u32, u32), half_width: f64, reach: f64) -> (View, [i16; 3]) {
    loop {
        let point = [0; 3]
            .map(|_| random.integer((-16384.0 * reach) as i64, (16383.0 * reach) as i64) as i16);
        let towards = random.direction();
        let mut camera = Camera::aimed(random, [0.0; 3], towards, [0.0; 2], half_width, 0.0);
        let place = [
            random.real(-1.0, 1.0) * half_width,
            random.real(-1.0, 1.0) * half_width * f64::from(size.1) / f64::from(size.0),
        ];
        let z = random.logarithmic(0.02, 11.0);
        camera.near = random.logarithmic(0.01, (0.9 * z).min(2.0));
        camera.eye = [0, 1, 2].map(|i| {
            world(point)[i] - camera.u[i] * place[0] - camera.v[i] * place[1] - camera.n[i] * z
        });
        if dot(camera.eye, camera.eye) < 63.9 {
            let view = camera.rounded();
            return (view.with_projection(Projection::Orthographic), point);
        }
    }
}

/// The error bound of docs/formats/camera.md for a position, in 1/256 pixel: the error of snapping, plus the error of the rounded rows for
/// a point at `distance`.
fn bound(frame: &MeshSetup, distance: f64) -> f64 {
    0.54 + 256.0 * 3f64.sqrt() * 0.5f64.powi(frame.scale_shift as i32 + 1) * distance
}

#[test]
fn places_and_depths_against_f64() {
    let mut random = Random(50);
    for (index, reach) in [0.5, 2.0].into_iter().enumerate() {
        for size in SIZES {
            let ([mut worst, mut narrow], mut share, mut depth, mut count) =
                ([0.0_f64; 2], 0.0_f64, 0.0_f64, 0);
            for round in 0..20_000 {
                let half_width = match round % 8 {
                    0 => 0.00871,
                    1 => 115.0,
                    2 | 3 => random.logarithmic(0.1, 2.0),
                    _ => random.logarithmic(0.00871, 115.0),
                };
                let (view, point) = aimed(&mut random, size, half_width, reach);
                let frame = MeshSetup::new(&view, size.0, size.1, RADII[index]).unwrap();
                let vertex = transform(&frame, point);
                assert!([vertex.x, vertex.y].iter().all(|x| x.abs() < 3 << 40));
                let Projected::Visible(found) = project(&frame, &vertex) else {
                    panic!("{point:?} in {view:?}")
                };
                let exact = projected(&view, world(point), size);
                let error = error(found, exact);
                let distance = dot(world(point), world(point)).sqrt();
                share = share.max(error / bound(&frame, distance));
                let worst = if half_width < 0.05 {
                    &mut narrow
                } else {
                    &mut worst
                };
                *worst = worst.max(error);
                depth = depth.max((f64::from(found.w) - 64.0 * code(&frame, exact[2])).abs());
                count += 1;
            }
            println!(
                "±{reach}, {}x{}: {count} positions, error {worst:.3}/256 px, {narrow:.3} for a width below 0.1, {share:.3} of the bound; depth {depth:.3}/64 code",
                size.0, size.1
            );
            assert!(share <= 1.0 && depth <= 1.01);
            // The error bound for a mesh in a box of 1×1×1 world units.
            if index == 0 {
                assert!(worst <= 1.0 && narrow <= 2.0);
            }
        }
    }
}

/// Compares the projection with the steps in docs/formats/camera.md, computed in 128-bit numbers.
#[test]
fn steps_as_written() {
    let mut random = Random(51);
    let nearest = |x: i128, shift: i32| (x + (1 << (shift - 1))) >> shift;
    for round in 0..50_000 {
        let (width, height) = SIZES[round % 3];
        let half_width = random.logarithmic(0.0088, 114.0);
        let (view, point) = aimed(&mut random, (width, height), half_width, 2.0);
        let frame = MeshSetup::new(&view, width, height, RADII[1]).unwrap();
        let (f, ke) = (frame.scale_shift as i32, frame.depth.exponent);
        let vertex = transform(&frame, point);
        let product = |row: [i32; 3], k: usize| i128::from(point[k]) * i128::from(row[k]);
        let sum = |row| (0..3).map(|k| product(row, k)).sum::<i128>();
        let [tx, ty, tz] = frame.translation.map(i128::from);
        let place = |x: i128, size: u32| {
            let normalised = nearest(x, f + 2).clamp(-1 << 24, (1 << 24) - 1);
            256 * i128::from(size / 2) + nearest(normalised << 23, 27)
        };
        let z = sum(frame.n) + tz;
        let y = (1 << 24) - (z >> (12 + ke));
        let expected = [
            place(sum(frame.u) + tx, width),
            place(sum(frame.v) + ty, height),
            nearest(y << 16, 16),
        ];
        let Projected::Visible(found) = project(&frame, &vertex) else {
            panic!("{point:?} in {view:?}")
        };
        assert_eq!(
            expected,
            [found.x.into(), found.y.into(), i128::from(found.w)]
        );
        // The depth code converts back to the depth in the world, and is in the range of codes of the mesh's bounding sphere.
        let code = found.w >> 6;
        let depth = frame.depth.distance(code).unwrap().to_num::<f64>();
        let [.., exact] = projected(&view, world(point), (width, height));
        assert!((depth - exact).abs() <= 2f64.powi(ke - 18));
        assert!((4..=(1 << 18) - 4).contains(&code));
    }
}

/// For meshes of all sizes, at all distances: of two vertices whose depths differ by more than 1/32 code, the nearer vertex has the larger
/// depth code before rounding.
#[test]
fn nearer_vertices_have_larger_codes() {
    let mut random = Random(52);
    let mut fewest = u32::MAX;
    for round in 0..20_000 {
        let size = SIZES[round % 3];
        let reach = [2.0, 0.5, 0.01, 0.000_2][round % 4];
        let radius = (reach * 3f64.sqrt() * 16384.0).ceil() as u32 + 2;
        let (view, a) = aimed(&mut random, size, reach * 2.0_f64.max(0.01 / reach), reach);
        let frame = MeshSetup::new(&view, size.0, size.1, radius).unwrap();
        let limit = (16384.0 * reach) as i64;
        let b = a.map(|x| {
            let step = random.integer(-1, 1) << random.integer(0, 13);
            (i64::from(x) + step).clamp(-limit, limit - 1) as i16
        });
        let [p, q] = [a, b].map(|point| {
            let [.., z] = projected(&view, world(point), size);
            let place = project(&frame, &transform(&frame, point));
            (place.place().map(|place| place.w), code(&frame, z))
        });
        let (Some(nearer), Some(farther)) = (p.0, q.0) else {
            continue;
        };
        if (p.1 - q.1).abs() > 1.0 / 32.0 {
            assert_eq!(nearer > farther, p.1 > q.1, "{a:?} and {b:?} in {view:?}");
        }
        if reach > 0.002 {
            // A bounding sphere that is completely beyond the near plane uses at least half of the codes.
            let codes = f64::from(radius) / 16384.0 * 2.0 * 2f64.powi(19 - frame.depth.exponent);
            fewest = fewest.min(codes as u32);
        }
    }
    println!("at least {fewest} codes used");
    assert!(fewest >= 131_000);
}

/// Compares positions and depths of objects with scales from 1/100 to 8 with f64.
#[test]
fn objects_against_f64() {
    let mut random = Random(53);
    let mesh = cube();
    let (mut worst, mut share, mut depth, mut count) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    let mut halved = 0;
    for round in 0..20_000 {
        let size = SIZES[round % 3];
        let scale = random.logarithmic(0.01, 8.0);
        let place = random
            .direction()
            .map(|x| number(x * random.real(0.0, 16.0)));
        let turn = [0; 2].map(|_| Turns(random.bits() as u32));
        let matrix = Matrix::rotation(Axis::X, turn[0])
            .then(&Matrix::rotation(Axis::Z, turn[1]))
            .and_then(|matrix| matrix.then(&Matrix::scale([number(scale); 3])?))
            .and_then(|matrix| matrix.then(&Matrix::translation(place)?))
            .unwrap();
        let half_width = random.logarithmic(0.5, 30.0);
        let (view, _) = aimed(&mut random, size, half_width, 0.5);
        let object = object(mesh, matrix);
        let objects = [object];
        let picture = Size::of(size.0, size.1).unwrap();
        let frame = Frame::new(Subject::Objects(&objects), view, picture);
        let constants = frame.constants().unwrap();
        let camera = constants.mesh().unwrap();
        let setup = object.placement.setup(&view, camera, mesh.radius());
        let setup = setup.unwrap();
        halved += u32::from(setup.near < camera.near);
        for _ in 0..8 {
            let position = [0; 3].map(|_| random.integer(-8192, 8192) as i16);
            let point = applied(&matrix, world(position));
            let exact = projected(&view, point, size);
            let Projected::Visible(found) = project(&setup, &transform(&setup, position)) else {
                continue;
            };
            let error = error(found, exact);
            let [length, far] = [world(position), point].map(|p| dot(p, p).sqrt());
            share = share.max(error / (bound(&setup, length) + bound(camera, far + 0.001)));
            worst = worst.max(error);
            depth = depth.max((f64::from(found.w) - 64.0 * code(camera, exact[2])).abs());
            count += 1;
        }
    }
    println!(
        "{count} vertices, largest error {worst:.3}/256 pixel ({share:.3} of the bound), depth {depth:.3}/64 code; {halved} setups halved"
    );
    assert!(count > 10_000 && halved > 100 && share <= 1.0 && depth <= 8.0);
}

/// A cube of side 1 covers the same square at every distance. Of two cubes on a line with the eye, the nearer cube is visible.
#[test]
fn sizes_do_not_depend_on_the_distance() {
    for distance in [1.0, 2.0, 7.9] {
        let cube = Model::cube(8192);
        let picture = Picture::of(&cube, &along_y(distance, 3.2), (320, 180), true);
        let seen = |x: usize, y: usize| picture.depth[y * 320 + x] != 0;
        for (i, covered) in picture.coverage().into_iter().enumerate() {
            let (x, y) = (i % 320, i / 320);
            let inside = (110..210).contains(&x) && (40..140).contains(&y);
            assert_eq!(covered, inside, "{x}, {y} at {distance}");
        }
        assert!(seen(110, 40) && seen(209, 139));
    }
    let at = |y: f64, colour| {
        let place = Matrix::translation([0.0, y, 0.0].map(number)).unwrap();
        Object {
            colour: Some(Rgb565(colour)),
            ..object(cube(), place)
        }
    };
    let shown = |objects: &[Object]| {
        let frame = Frame::new(Subject::Objects(objects), along_y(4.0, 3.2), Size::W320);
        Picture::of_frame(&frame).colour[90 * 320 + 160]
    };
    let (near, far) = (at(-1.0, 0x001F), at(0.5, 0xF800));
    assert_eq!([shown(&[near, far]), shown(&[far, near])], [0x001F; 2]);
}

#[test]
fn refused_frames() {
    let mesh = cube();
    let field = FieldSubject {
        field: &Field::parse("menger:3").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    let view = along_y(4.0, 3.2);
    for subject in [
        Subject::Field(field),
        Subject::MeshInField(MeshSubject::new(mesh), field),
    ] {
        let refused = Frame::new(subject, view, Size::W320).constants().err();
        assert_eq!(refused, Some(RenderError::Orthographic));
    }
    // The far plane must be beyond the near plane, not beyond the nearest depth of the mesh.
    let with_far = |far: f64| {
        let far = U8_28::from_num(far);
        let frame = MeshSetup::new(&view, 320, 180, mesh.radius()).unwrap();
        frame.with_clip(Clip::View { far }).map(|_| ())
    };
    assert_eq!(with_far(0.1), Err(RenderError::Far(U8_28::from_num(0.1))));
    assert_eq!(with_far(0.2), Ok(()));
    // A view too narrow for the number of pixels and the size of an object is rejected.
    let large = object(mesh, Matrix::scale([number(16.0); 3]).unwrap());
    let setup = |width: U8_28| {
        let view = along_y(4.0, width.to_num());
        let camera = MeshSetup::new(&view, 1280, 720, 0).unwrap();
        let setup = large.placement.setup(&view, &camera, mesh.radius());
        setup.map(|setup| setup.scale_shift)
    };
    let Err(RenderError::Width { width, least }) = setup(U8_28::from_num(0.02)) else {
        panic!("accepted")
    };
    assert!(width < least && setup(least).is_ok(), "{least}");
}

/// Compares the light of each pixel, which is linear on the screen, with f64, in steps of a channel.
#[test]
fn light_against_f64() {
    let mut random = Random(54);
    let (mut worst, mut pixels) = (0.0_f64, 0);
    for round in 0..2_000 {
        let vertices = random_triangle(&mut random).map(|vertex| ScreenVertex {
            w: random.integer(4 * 64, ((1 << 18) - 4) * 64) as u32,
            ..vertex
        });
        let Some((triangle, Setup { bounds, .. })) = set_up(vertices, SIZE) else {
            continue;
        };
        let mut light =
            [0; 3].map(|_| Lit::new(Rgb565(random.bits() as u16).fractions(), [256; 3]));
        if round % 4 == 0 {
            light = [light[0]; 3];
        }
        let setup = Setup::linear(&triangle, bounds, &light);
        let mut picture = Picture::blank(SIZE);
        let mut target = picture.target();
        target.rounding = Rounding::Nearest;
        pixels += draw(&setup, Rgb565(0), &mut target).covered;
        let place = triangle
            .vertices
            .map(|v| [v.x, v.y].map(|x| f64::from(x) / 256.0));
        let area = triangle.doubled_area as f64 / 65536.0;
        for i in (0..picture.depth.len()).filter(|&i| picture.depth[i] != 0) {
            let at = [i % SIZE.0 as usize, i / SIZE.0 as usize].map(|x| x as f64 + 0.5);
            let part = |a: [f64; 2], b: [f64; 2]| {
                ((b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0])) / area
            };
            let parts = [
                part(place[1], place[2]),
                part(place[2], place[0]),
                part(place[0], place[1]),
            ];
            for (channel, found) in Rgb565(picture.colour[i]).channels().into_iter().enumerate() {
                let steps = [32.0, 64.0, 32.0][channel] / 65536.0;
                let exact: f64 = (0..3)
                    .map(|k| parts[k] * f64::from(light[k].0[channel]) * steps)
                    .sum();
                worst = worst.max((f64::from(found) - exact).abs());
                if round % 4 == 0 {
                    assert_eq!(f64::from(found), exact.round());
                }
            }
        }
    }
    println!("{pixels} pixels, largest error of the light {worst:.4} steps");
    assert!(pixels > 500_000 && worst <= 0.5 + 1.0 / 31.0 + 0.001);
}
