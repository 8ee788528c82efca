//! Tests of whole frames: drawing order, facing, chunks, and errors.

use glint_core::camera::View;
use glint_core::colour::Rounding;
use glint_core::fixed::Q32_32;
use glint_core::mesh::Mesh;
use glint_model::triangle::setup::{Facing, Oriented};
use glint_model::{FrameBuffer, MeshSetup, Options, Projected, RenderError, SIZES, render};
use glint_vectors::{Camera, Model, Picture, Random, picture::CLEAR};

use crate::mesh_of;

const SIZE: (u32, u32) = SIZES[0];

fn front() -> Camera {
    Camera::looking([3.0, 0.3, 0.2], [0.0; 3], 0.9, 0.1)
}

#[test]
fn a_sphere_is_a_disc_without_holes() {
    let sphere = Model::sphere(0.5, 24);
    for size in SIZES {
        let view = front().rounded();
        let picture = Picture::of(&sphere, &view, size, true);
        assert_eq!(
            picture.stats.drawn + picture.stats.culled,
            picture.stats.triangles_in
        );
        assert_eq!(picture.stats.clipped, 0);
        // Front faces of a convex mesh do not overlap, so every covered pixel is drawn exactly once.
        assert_eq!(picture.stats.pixels_drawn, picture.covered() as u64);
        assert_eq!(picture.stats.pixels_covered, picture.stats.pixels_drawn);
        for row in picture.coverage().chunks(size.0 as usize) {
            let span: Vec<usize> = (0..row.len()).filter(|&i| row[i]).collect();
            assert!(span.windows(2).all(|pair| pair[1] == pair[0] + 1), "a hole");
        }
        // The outline of the sphere is a circle, formed by the rays that are tangent to the sphere. The mesh approximates the sphere by 24
        // rings.
        let distance: f64 = (9.0f64 + 0.09 + 0.04).sqrt();
        let radius = f64::from(size.0) / 2.0 / 0.9 * 0.5 / (distance * distance - 0.25).sqrt();
        let disc = std::f64::consts::PI * radius * radius;
        assert!(
            (0.97..1.0).contains(&(picture.covered() as f64 / disc)),
            "{} of {disc}",
            picture.covered()
        );
        let mut pixels = picture.colour.iter().zip(&picture.depth);
        assert!(pixels.all(|(&c, &d)| (d == 0) == (c == CLEAR)));
    }
}

/// Draws a sphere with and without culling: the pictures are equal, because culling removes only hidden faces. Then draws the sphere with
/// reversed winding: culling now removes the near side, so the far side is visible.
#[test]
fn culling_and_windings() {
    let sphere = Model::sphere(0.5, 12);
    let view = front().rounded();
    let [culled, both] = [true, false].map(|cull| Picture::of(&sphere, &view, SIZE, cull));
    assert_eq!(
        both.stats.drawn + both.stats.culled,
        both.stats.triangles_in
    );
    assert!(culled.stats.drawn < both.stats.drawn);
    assert_eq!(culled.depth, both.depth);
    assert_eq!(culled.colour, both.colour);
    assert!(culled.drawn.iter().all(|t| t.facing == Facing::Front));

    // The far side of a mesh turned inside out is drawn, and shading negates its normals.
    let inverted = Picture::of(&sphere.flipped(), &view, SIZE, true);
    assert_eq!(inverted.coverage(), culled.coverage());
    let mut depths = inverted.depth.iter().zip(&culled.depth);
    assert!(depths.all(|(&far, &near)| near == 0 || far < near));
    let far_sides = both.drawn.iter().filter(|t| t.facing == Facing::Back);
    let far_sides = far_sides.map(|t| (t.index, t.colour));
    assert!(far_sides.eq(inverted.drawn.iter().map(|t| (t.index, t.colour))));
}

#[test]
fn ties_go_to_the_later() {
    let triangle = [[0, -8000, -8000], [0, 8000, -8000], [0, 0, 8000]];
    let view = front().rounded();
    let once = Picture::of(&Model::soup(&[triangle]), &view, SIZE, true);
    assert!(once.covered() > 1000);
    for copies in 2..5 {
        let picture = Picture::of(&Model::soup(&vec![triangle; copies]), &view, SIZE, true);
        let last = picture.drawn.last().unwrap().colour.0;
        assert_eq!(picture.depth, once.depth);
        assert_eq!(picture.stats.pixels_drawn, (once.covered() * copies) as u64);
        let mut pixels = picture.colour.iter().zip(&picture.depth);
        assert!(pixels.all(|(&c, &d)| c == if d == 0 { CLEAR } else { last }));
    }
}

/// At different depths the order of the triangles has no effect; exceptions are drawn after all other triangles.
#[test]
fn order() {
    let mut random = Random(1);
    let mut parts = 0;
    for _ in 0..20 {
        let camera = Camera::inside(&mut random);
        let view = camera.rounded();
        let model = Model::random(&mut random, 40, 32768);
        let mut reversed = model.clone();
        reversed.triangles.reverse();
        let [forwards, backwards] = [&model, &reversed].map(|m| Picture::of(m, &view, SIZE, false));
        assert_eq!(forwards.depth, backwards.depth);
        let regular = forwards.drawn.iter().take_while(|t| !t.clipped).count();
        let (regular, exceptions) = forwards.drawn.split_at(regular);
        assert!(regular.is_sorted_by(|a, b| a.index < b.index));
        assert!(exceptions.iter().all(|t| t.clipped));
        assert!(exceptions.is_sorted_by_key(|t| t.index));
        parts += exceptions.len();
    }
    assert!(parts > 100, "{parts}");
}

/// A mesh in two chunks gives the same picture as a mesh with the same triangles in one chunk.
#[test]
fn chunks() {
    let mut random = Random(5);
    let positions: Vec<[i16; 3]> = (0..3000)
        .map(|_| [0; 3].map(|_| random.integer(-20_000, 20_000) as i16))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..22_000)
        .map(|_| [0; 3].map(|_| random.integer(0, 2999) as u32))
        .collect();
    let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
    let apart = Model::soup(&triangles.iter().map(corners).collect::<Vec<_>>());
    let shared = Model {
        positions,
        triangles,
    };
    let [one, two] = [shared, apart].map(|model| model.encoded());
    let chunks = [&one, &two].map(|bytes| Mesh::new_checked(bytes).unwrap().chunks().count());
    assert_eq!(chunks, [1, 2]);
    let view = Camera::looking([0.1, 0.1, 0.0], [0.0, 0.0, 0.1], 0.3, 0.02).rounded();
    let [one, two] = [one, two].map(|bytes| Picture::of_bytes(&bytes, &view, SIZE, true));
    assert!(one == two, "{:?} {:?}", one.stats, two.stats);
    let mut clipped = one.drawn.iter().filter(|t| t.clipped).map(|t| t.index);
    assert!(clipped.any(|index| index < 21_000) && clipped.any(|index| index >= 21_900));
}

/// Equal cameras and meshes give identical pictures, for any previous contents of the scratch memory and the target.
#[test]
fn frames_do_not_depend_on_what_was_before() {
    let bytes = Model::sphere(0.5, 9).encoded();
    let mesh = Mesh::new_checked(&bytes).unwrap();
    let mut scratch = vec![Projected::Behind; 5000];
    let mut used = Picture::blank(SIZE);
    for i in 0..4 {
        let camera = Camera::looking([2.0, 0.5 * f64::from(i), 0.3], [0.0; 3], 0.9, 0.1);
        let options = Options {
            cull: i % 2 == 0,
            clear: CLEAR,
            ..Options::default()
        };
        let view = camera.rounded();
        let stats = render(&mesh, &view, &mut used.target(), &mut scratch, &options);
        let fresh = Picture::of_bytes(&bytes, &view, SIZE, options.cull);
        assert_eq!(stats, Ok(fresh.stats));
        assert_eq!((&used.colour, &used.depth), (&fresh.colour, &fresh.depth));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let mesh = mesh_of(&Model::cube(8000));
    let view = front().rounded();
    let refuse = |(width, height): (u32, u32), colours: usize, depths: usize, room: usize| {
        let (mut colour, mut depth) = (vec![7; colours], vec![7; depths]);
        let mut target = FrameBuffer {
            width,
            height,
            colour: &mut colour,
            depth: &mut depth,
            rounding: Rounding::Dithered,
        };
        let result = render(
            &mesh,
            &view,
            &mut target,
            &mut vec![Projected::Behind; room],
            &Options::default(),
        );
        let untouched = colour.iter().all(|&c| c == 7) && depth.iter().all(|&d| d == 7);
        assert_eq!(untouched, result.is_err());
        result.map(|_| ()).map_err(|error| error.to_string())
    };
    let pixels = 320 * 180;
    assert_eq!(refuse(SIZE, pixels, pixels, 8), Ok(()));
    let texts = [
        "picture size 320x240: expected 320x180, 640x360, 1280x720",
        "picture size 0x0: expected 320x180, 640x360, 1280x720",
        "colour buffer of 57599 pixels: expected 57600, the picture's width times its height",
        "depth buffer of 57601 pixels: expected 57600, the picture's width times its height",
        "scratch for 7 vertices: expected at least 8, the number in the largest chunk",
    ];
    let refused = [
        refuse((320, 240), 76_800, 76_800, 8),
        refuse((0, 0), 0, 0, 8),
        refuse(SIZE, pixels - 1, pixels, 8),
        refuse(SIZE, pixels, pixels + 1, 8),
        refuse(SIZE, pixels, pixels, 7),
    ];
    assert_eq!(refused, texts.map(|text| Err(text.to_owned())));
    let (width, height) = (1, 1);
    let refused = MeshSetup::new(&view, width, height, 0);
    assert_eq!(refused, Err(RenderError::Size { width, height }));
}

#[test]
fn an_eye_too_far_for_a_mesh_is_refused() {
    let at = |z: Q32_32| {
        let view = front().rounded();
        let eye = [Q32_32::ZERO, Q32_32::ZERO, z];
        let (half_width, near) = (view.half_width(), view.near());
        let view = View::new_checked(eye, view.u(), view.v(), view.n(), half_width, near).unwrap();
        MeshSetup::new(&view, 320, 180, 1 << 14).map(|frame| frame.translation[2])
    };
    assert!(at(Q32_32::lit("8")).is_ok());
    let eye = [Q32_32::ZERO, Q32_32::ZERO, Q32_32::lit("8.5")];
    let error = at(eye[2]).expect_err("too far");
    assert_eq!(error, RenderError::Eye(eye));
    assert_eq!(
        error.to_string(),
        "eye (0, 0, 8.5): expected within 8 of the origin for a mesh"
    );
}

/// Draws random valid meshes from random cameras. Nothing overflows or panics, and the numbers of every drawn triangle fit their formats.
#[test]
fn anything_goes() {
    let mut random = Random(6);
    let mut clipped = 0;
    for round in 0..400 {
        let reach = [32768, 8192, 64][round % 3];
        let mut model = Model::random(&mut random, 24, reach);
        if round % 5 == 0 {
            model
                .positions
                .iter_mut()
                .for_each(|p| *p = p.map(|x| if x < 0 { i16::MIN } else { i16::MAX }));
        }
        let distance = random.real(0.0, 7.999);
        let half_width = [0.05, 4.0, random.logarithmic(0.05, 4.0)][round % 3];
        let near = [0.01, 2.0, random.logarithmic(0.01, 2.0)][round / 3 % 3];
        let eye = random.direction().map(|x| x * distance);
        let towards = random.direction();
        let camera = Camera::aimed(&mut random, eye, towards, [0.0; 2], half_width, near);
        let picture = Picture::of(
            &model,
            &camera.rounded(),
            SIZES[usize::from(round % 20 == 0) * 2],
            false,
        );
        clipped += picture.stats.clipped;
        for triangle in &picture.drawn {
            let limit = if triangle.clipped {
                2048 << 8
            } else {
                2047 << 8
            };
            assert!(
                triangle.vertices.iter().all(|v| v.x.abs() <= limit
                    && v.y.abs() <= limit
                    && v.w < ((1 << 18) - 3) * 64)
            );
            assert_eq!(
                Oriented::new(triangle.vertices).unwrap().facing,
                Facing::Back
            );
        }
    }
    assert!(clipped > 1000, "{clipped}");
}
