//! Tests of several objects in a frame: model matrices, light, order and limits, compared with f64.

use glint_core::camera::View;
use glint_core::colour::{Rgb565, Shading, Winding};
use glint_core::fixed::{Q8_24, Q32_32, Turns, U8_28};
use glint_core::light::{Light, MeshLighting};
use glint_core::matrix::{Axis, Matrix};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_model::triangle::setup::Facing;
use glint_model::triangle::shade::intensity;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{
    Clip, Frame, MeshLight, MeshSetup, MeshSubject, Object, Placement, Projected, RenderError,
    SIZES, Subject,
};
use glint_vectors::math::{dot, normalised, world};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{RADII, applied, cube, error, mesh_of, number, object};

const RADIUS: u32 = RADII[0];

/// A random matrix: rotations, a scale of each axis within `scales` with either sign, and a translation within `reach` of the origin.
fn random_matrix(random: &mut Random, scales: [f64; 2], same: bool, reach: f64) -> Matrix {
    loop {
        let mut factor = || {
            let size = random.logarithmic(scales[0], scales[1]);
            number(if random.coin() { -size } else { size })
        };
        let mut factors = [0; 3].map(|_| factor());
        if same {
            factors = [factors[0]; 3];
        }
        let place = random.direction().map(|x| number(x * reach));
        let [a, b, c, d] = [0; 4].map(|_| Turns(random.bits() as u32));
        let matrix = Matrix::rotation(Axis::X, a)
            .then(&Matrix::rotation(Axis::Y, b))
            .and_then(|matrix| matrix.then(&Matrix::scale(factors)?))
            .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::Z, c)))
            .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::X, d)))
            .and_then(|matrix| matrix.then(&Matrix::translation(place)?));
        // Matrices with very different scales may be rejected as singular.
        if let Ok(matrix) = matrix {
            return matrix;
        }
    }
}

/// Compares positions and depth codes of the vertices of objects with f64, for sizes from 1/100 to 8.
#[test]
fn vertices_of_objects_against_f64() {
    let mut random = Random(30);
    for (width, height) in SIZES {
        let (mut worst, mut share, mut depth, mut count) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
        let mut halved = 0;
        for round in 0..20_000 {
            let same = round % 2 == 0;
            let reach = random.real(0.0, 4.0);
            let matrix = random_matrix(&mut random, [0.01, 8.0], same, reach);
            let distance = random.real(0.0, 7.9);
            let eye = random.direction().map(|x| x * distance);
            let target = matrix
                .place()
                .map(|x| x.to_num::<f64>() + random.real(-0.5, 0.5));
            let half_width = random.logarithmic(0.2, 4.0);
            let towards = [0, 1, 2].map(|i| target[i] - eye[i]);
            let camera = Camera::aimed(&mut random, eye, towards, [0.0; 2], half_width, 0.1);
            let view = camera.rounded();
            let placement = Placement::new(matrix);
            let frame = MeshSetup::new(&view, width, height, 0).unwrap();
            let setup = placement.setup(&view, &frame, RADIUS);
            let setup = setup.unwrap_or_else(|error| panic!("{matrix:?}: {error}"));
            halved += u32::from(setup.near < frame.near);
            for _ in 0..8 {
                let position = [0; 3].map(|_| random.integer(-8192, 8192) as i16);
                let place = applied(&matrix, world(position));
                let [x, y, z] = Camera::of(&view).project(place, width, height);
                if z < 0.1 {
                    continue;
                }
                let Projected::Visible(found) = project(&setup, &transform(&setup, position))
                else {
                    continue;
                };
                if !(0.0..f64::from(width)).contains(&x) || !(0.0..f64::from(height)).contains(&y) {
                    continue;
                }
                let error = error(found, [x, y, z]);
                // The error bound of docs/formats/camera.md.
                let scale = f64::from(width) / 2.0 / view.half_width().to_num::<f64>();
                let length = dot(world(position), world(position)).sqrt();
                let d = [0, 1, 2].map(|i| place[i] - eye[i]);
                let longest = dot(d, d).sqrt();
                let k = (frame.near / setup.near).ilog2();
                let unit = |shift: u32| 0.5f64.powi(shift as i32 + 1) * 3f64.sqrt();
                let rows = unit(frame.scale_shift) * longest
                    + unit(setup.scale_shift - k) * length
                    + unit(frame.scale_shift) * 0.001;
                let across = (x - f64::from(width) / 2.0).hypot(y - f64::from(height) / 2.0);
                let deep = unit(23) * longest + unit(23 - k) * length;
                let bound = 0.75 + 256.0 * (rows / z + across * deep / z + scale * 1e-9);
                worst = worst.max(error);
                share = share.max(error / bound);
                count += 1;
                let exact =
                    64.0 * f64::from(frame.depth.mantissa) * 2f64.powi(frame.depth.exponent) / z;
                if exact < 64.0 * 262_140.0 {
                    depth = depth.max((f64::from(found.w) - exact).abs() / 64.0);
                }
            }
        }
        println!(
            "{width}x{height}: {count} vertices, error {worst:.3}/256 pixel ({share:.3} of the bound), depth {depth:.3} codes; {halved} setups halved"
        );
        assert!(count > 40_000 && halved > 500 && share <= 1.0 && depth <= 1.0);
    }
}

/// The intensity of a face is that of a normal transformed by the inverse transpose of the matrix, for a light at the camera and a
/// directional light.
#[test]
fn light_on_objects_against_f64() {
    let mut random = Random(31);
    let mut worst = [0.0_f64; 2];
    for round in 0..40_000 {
        let same = round % 2 == 0;
        let matrix = random_matrix(&mut random, [0.02, 4.0], same, 1.0);
        let view = Camera::looking([4.0, 1.0, 2.0], [0.0; 3], 0.9, 0.1).rounded();
        let mut frame = MeshSetup::new(&view, 320, 180, 0).unwrap();
        let mut towards = Camera::of(&view).n.map(|x| -x);
        if round % 3 == 0 {
            towards = random.direction();
            let lighting = MeshLighting {
                light: Light::new(towards.map(Q32_32::from_num), [255; 3]).unwrap(),
                ..MeshLighting::CAMERA
            };
            frame.light = MeshLight::new(&lighting, &view).row;
        }
        let placement = Placement::new(matrix);
        let setup = placement.setup(&view, &frame, RADIUS).unwrap();
        assert_eq!(placement.normals().is_none(), same);
        let normal = random.direction().map(|x| (x * 16_384.0).round() as i16);
        let rows = matrix.linear().map(|row| row.map(Q8_24::to_num::<f64>));
        let cofactor = |i: usize, j: usize| {
            let (p, q, r, s) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            rows[p][r] * rows[q][s] - rows[p][s] * rows[q][r]
        };
        let sign = if matrix.mirrors() { -1.0 } else { 1.0 };
        let part = |i, j: usize| cofactor(i, j) * f64::from(normal[j]);
        let turned = normalised([0, 1, 2].map(|i| sign * (0..3).map(|j| part(i, j)).sum::<f64>()));
        let exact = dot(turned, towards).max(0.0);
        let normals = placement.normals();
        let turned = normals.map_or(normal, |normals| normals.apply(normal));
        let found = intensity(turned, &setup.light, Facing::Front);
        let error = (f64::from(found) - 256.0 * exact).abs();
        worst[usize::from(same)] = worst[usize::from(same)].max(error);
    }
    println!(
        "largest error of the intensity: {:.3}/256 with transformed normals, {:.3}/256 with the light rotated",
        worst[0], worst[1]
    );
    assert!(worst.iter().all(|&worst| worst <= 0.53));
}

fn of(objects: &[Object], view: View) -> Picture {
    Picture::of_frame(&Frame::new(Subject::Objects(objects), view, Size::W320))
}

#[test]
fn an_object_with_the_identity_is_the_mesh() {
    let mut random = Random(32);
    let far = U8_28::lit("1.5");
    for round in 0..24 {
        let subject = MeshSubject {
            shading: [Shading::Flat, Shading::Smooth][round % 2],
            winding: [Winding::Mesh, Winding::Screen][round / 2 % 2],
            clip: [Clip::Guard, Clip::View { far }][round / 4 % 2],
            ..MeshSubject::new(mesh_of(&Model::random(&mut random, 20, 30_000)))
        };
        let view = Camera::inside(&mut random).rounded();
        let alone = Picture::of_frame(&Frame::new(Subject::Mesh(subject), view, Size::W320));
        let object = Object {
            subject,
            ..object(subject.mesh, Matrix::IDENTITY)
        };
        assert!(of(&[object], view) == alone, "round {round}");
    }
}

/// A copy of a mesh with transformed normals gives the same picture as the mesh, for every shading, winding, clipping and light.
#[test]
fn a_copy_with_turned_normals_gives_the_same_picture() {
    let mut random = Random(33);
    let far = U8_28::lit("3");
    for round in 0..96 {
        let bytes = Model::random(&mut random, 20, 20_000).encoded();
        let subject = MeshSubject {
            shading: [Shading::Flat, Shading::Smooth][round % 2],
            winding: [Winding::Mesh, Winding::Screen][round / 2 % 2],
            cull: random.coin(),
            clip: [Clip::Guard, Clip::View { far }][round / 4 % 2],
            ..MeshSubject::new(Mesh::new_checked(&bytes).unwrap())
        };
        let lighting = match round / 8 % 3 {
            0 => MeshLighting::CAMERA,
            1 => MeshLighting {
                ambient: [40, 0, 80],
                light: Light::at_camera([255, 200, 90]),
            },
            _ => MeshLighting {
                ambient: [20, 60, 0],
                light: Light::new(random.direction().map(Q32_32::from_num), [90, 255, 220])
                    .unwrap(),
            },
        };
        let matrix = random_matrix(&mut random, [0.4, 2.0], round % 7 == 0, 0.3);
        let own = Object {
            subject,
            ..object(subject.mesh, matrix)
        };
        let mut memory = vec![0xA5; bytes.len() + 5];
        let mut turn = |normal| match own.placement.normals() {
            Some(normals) => normals.apply(normal),
            None => normal,
        };
        let copy = subject.mesh.copy_with_normals(&mut memory, &mut turn);
        let mesh = copy.unwrap();
        assert_eq!(Mesh::new_checked(mesh.bytes()), Ok(mesh));
        let turned = Object {
            subject: MeshSubject { mesh, ..subject },
            placement: own.placement.of_turned_mesh(),
            colour: None,
        };
        assert_eq!(turned.placement.normals(), None);
        let view = Camera::inside(&mut random).rounded();
        let [expected, found] = [own, turned].map(|object| {
            Picture::of_frame(&Frame {
                lighting,
                ..Frame::new(Subject::Objects(&[object]), view, Size::W320)
            })
        });
        assert!(expected == found, "round {round}");
    }
    let mut memory = vec![0; cube().bytes().len() - 1];
    assert_eq!(cube().copy_with_normals(&mut memory, &mut |x| x), None);
}

/// Two objects in one frame cover the same pixels as in separate frames; the nearer object hides the other, and at equal depths the later
/// object wins.
#[test]
fn objects_share_one_depth() {
    let view = Camera::looking([0.0, -4.0, 0.5], [0.0; 3], 0.5, 0.1).rounded();
    let at = |x: f64, y: f64| Matrix::translation([x, y, 0.0].map(number)).unwrap();
    let [red, blue] = [0xF800, 0x001F].map(|colour| Some(Rgb565(colour)));
    let object = |matrix, colour| Object {
        colour,
        ..object(cube(), matrix)
    };
    let near = object(at(0.25, -0.5), red);
    let far = object(at(-0.25, 0.5), blue);
    let pictures = [of(&[near, far], view), of(&[far, near], view)];
    // At different depths the order has no effect.
    assert!(pictures[0].colour == pictures[1].colour && pictures[0].depth == pictures[1].depth);
    let alone = [of(&[near], view).depth, of(&[far], view).depth];
    for (i, &colour) in pictures[0].colour.iter().enumerate() {
        let expected = match (alone[0][i] > 0, alone[1][i] > 0) {
            (true, _) => colour & 0xF800 != 0 && colour & 0x001F == 0,
            (false, true) => colour & 0x001F != 0 && colour & 0xF800 == 0,
            (false, false) => colour == 0,
        };
        assert!(expected, "pixel {i}: {colour:#x}");
    }
    // If both objects are at the same position, every pixel has the colour of the later object.
    let twice = of(
        &[object(at(0.0, 0.0), red), object(at(0.0, 0.0), blue)],
        view,
    );
    assert!(twice.colour.iter().all(|colour| colour & 0xF800 == 0));
    assert_eq!(twice.stats.triangles_in, 24);
    // Without objects the picture is empty.
    let empty = of(&[], view);
    assert!(empty.colour.iter().all(|&x| x == 0) && empty.covered() == 0);
}

/// A frame with several objects draws as many triangles as one frame per object, including clipped triangles.
#[test]
fn clipped_objects_are_drawn() {
    let mesh = mesh_of(&Model::sphere(0.5, 6));
    let view = Camera::looking([0.0, -1.0, 0.0], [0.0; 3], 0.9, 0.1).rounded();
    let at = |x: f64, size: f64| {
        let place = Matrix::translation([x, 0.0, 0.0].map(number)).unwrap();
        let matrix = Matrix::scale([number(size); 3]).unwrap().then(&place);
        object(mesh, matrix.unwrap())
    };
    // The eye is inside the second object and near the surface of the third.
    let objects = [at(0.0, 0.5), at(0.0, 4.0), at(2.0, 4.4)].map(|mut object| {
        object.subject.cull = false;
        object
    });
    let picture = of(&objects, view);
    let stats = picture.stats;
    assert!(
        stats.clipped > 20 && picture.covered() == picture.depth.len(),
        "{stats:?}"
    );
    let drawn = objects.map(|object| of(&[object], view).stats.drawn);
    assert_eq!(stats.drawn, drawn.iter().sum::<u32>());
}

#[test]
fn an_object_too_large_for_the_near_plane_is_refused() {
    let object = |size: f64| object(cube(), Matrix::scale([number(size); 3]).unwrap());
    let view = |near| Camera::looking([0.0, -4.0, 0.5], [0.0; 3], 0.5, near).rounded();
    let refused = |size, near| {
        let objects = [object(size)];
        let frame = Frame::new(Subject::Objects(&objects), view(near), Size::W320);
        frame.constants().err()
    };
    assert_eq!(refused(1.0, 0.01), None);
    assert_eq!(refused(16.0, 0.1), None);
    let Some(RenderError::Near { near, least }) = refused(16.0, 0.02) else {
        panic!("accepted")
    };
    assert!(near < least && least < 0.1, "{least}");
    assert_eq!(refused(16.0, least.to_num()), None);
}

#[test]
fn a_frame_has_at_most_16_objects() {
    let objects = [object(cube(), Matrix::IDENTITY); 17];
    let view = Camera::looking([0.0, -4.0, 0.5], [0.0; 3], 0.5, 0.1).rounded();
    let refused = |count| {
        let frame = Frame::new(Subject::Objects(&objects[..count]), view, Size::W320);
        frame.constants().err()
    };
    assert_eq!(refused(16), None);
    assert_eq!(refused(17), Some(RenderError::Objects(17)));
}
