//! Tests of a mesh in a field: common scale of depth codes, and mutual occlusion.

use glint_core::camera::View;
use glint_core::field::{Field, Menger};
use glint_core::mesh::Mesh;
use glint_core::picture::{Size, Window};
use glint_model::raymarch::{FieldOptions, render_field};
use glint_model::triangle::{PreparedMesh, draw_parts};
use glint_model::{Options, Projected, RenderError, mesh_in_field};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{cube, mesh_of};

const SIZE: (u32, u32) = (320, 180);
const WINDOW: Window = Window::whole(Size::W320);

/// Draws three pictures with the same constants: the mesh alone, the field alone, and the mesh in the field.
fn draw(mesh: &Mesh, field: &str, view: &View) -> [Picture; 3] {
    let field = Field::parse(field).unwrap();
    let options = FieldOptions::default();
    let (frame, setup) =
        mesh_in_field::constants(view, WINDOW, mesh.radius(), &field, &options).unwrap();
    assert_eq!(frame.depth, setup.world_depth);
    let mut scratch = vec![Projected::Behind; mesh.vertex_count() as usize];
    let mut draw = |picture: &mut Picture, with_mesh: bool, with_field: bool| {
        let mut target = picture.target();
        if with_field {
            let palette = options.palette_for(&setup);
            render_field(&setup, &palette, &mut target, &mut |_, _, _| {}).unwrap();
        }
        if with_mesh {
            let part = PreparedMesh {
                mesh: *mesh,
                frame,
                options: Options::default(),
            };
            let clear = (!with_field).then_some(part.options.clear);
            let mut part = |number| (number == 0).then_some(part);
            draw_parts(
                &mut part,
                clear,
                None,
                &mut target,
                &mut scratch,
                &mut |_| {},
            )
            .unwrap();
        }
    };
    let mut pictures = [0; 3].map(|_| Picture::blank(SIZE));
    let [alone, field_alone, both] = &mut pictures;
    draw(alone, true, false);
    draw(field_alone, false, true);
    draw(both, true, true);
    pictures
}

/// A random camera outside of mesh and field that looks approximately at the origin.
fn outside(random: &mut Random) -> View {
    let distance = random.real(1.5, 6.0);
    let eye = random.direction().map(|x| x * distance);
    let target = random.direction().map(|x| x * 0.3);
    Camera::looking(eye, target, random.real(0.2, 0.9), 0.1).rounded()
}

/// Compares a cube as a mesh with a cube as a field, whose faces are in the same planes.
#[test]
fn faces_of_both_in_one_plane_have_the_same_depth() {
    let mesh = cube();
    for field in ["box:0.5,0.5,0.5", "cubes:11.3,0.5"] {
        let mut random = Random(1);
        let mut apart = vec![];
        for _ in 0..4 {
            let [mesh, field, both] = draw(&mesh, field, &outside(&mut random));
            for (i, (&a, &b)) in mesh.depth.iter().zip(&field.depth).enumerate() {
                assert_eq!(both.depth[i], a.max(b), "pixel {i}");
                if a != 0 && b != 0 {
                    apart.push(a.abs_diff(b));
                }
            }
        }
        apart.sort_unstable();
        let at = |part: f64| apart[((apart.len() - 1) as f64 * part) as usize];
        println!(
            "{field}: {} pixels, difference of depth codes: median {}, 99 % {}, 99.9 % {}, maximum {}",
            apart.len(),
            at(0.5),
            at(0.99),
            at(0.999),
            at(1.0)
        );
        assert!(apart.len() > 20_000 && at(0.5) <= 1 && at(0.99) <= 16);
    }
}

#[test]
fn what_is_nearer_is_seen() {
    let mesh = mesh_of(&Model::sphere(1.2, 12));
    // The corners of the cube (the field) extend beyond the sphere (the mesh), and the sphere extends beyond the cube's
    // faces.
    let mut random = Random(2);
    let mut seen = [0; 3];
    for view in [0; 3].map(|_| outside(&mut random)) {
        let [mesh, field, both] = draw(&mesh, "box:1,1,1", &view);
        for i in 0..both.depth.len() {
            let (a, b) = (mesh.depth[i], field.depth[i]);
            // At equal depth codes the mesh is visible, because the mesh is drawn later. The code of a pixel that the mesh does not cover
            // is 0. If the codes of mesh and field are 0, the field's background is visible.
            let (which, expected) = if b > a || a == 0 {
                (1, &field)
            } else {
                (0, &mesh)
            };
            assert_eq!(both.colour[i], expected.colour[i], "pixel {i}");
            seen[if a.max(b) == 0 { 2 } else { which }] += 1;
        }
    }
    assert!(seen.iter().all(|&pixels| pixels > 500), "{seen:?}");
}

/// For every half width, the constants of a mesh in a field are in the ranges that are valid for a mesh alone and a field alone.
#[test]
fn shared_constants_keep_their_ranges() {
    let mut random = Random(3);
    // Tolerated relative error of the scale: for a world unit of 40.5 or 45.5625 field units or of a power of two, all 17 bits of the scale
    // are kept.
    const EXACT: f64 = 1e-12;
    // A field, its tolerance, and the part of the scale that is lost to cleared bits.
    let fields = [
        ("menger:4", EXACT, 1.0 / 512.0),
        ("menger:5", EXACT, 1.0 / 64.0),
        ("box:12,0.01,12", EXACT, 1.0 / 512.0),
        ("planes:0.01", EXACT, 1.0 / 512.0),
        ("cubes:0.25,0.1", EXACT, 1.0 / 512.0),
        ("cubes:16,7", EXACT, 1.0 / 512.0),
        ("cubes:11.3,1", 1.0 / 65536.0, 1.0 / 512.0),
    ];
    for round in 0..2_000 {
        let (name, most, cleared) = fields[round % fields.len()];
        let field = Field::parse(name).unwrap();
        let eye = [0; 3].map(|_| random.real(-4.5, 4.5));
        let (half_width, near) = (random.logarithmic(0.05, 4.0), random.logarithmic(0.01, 2.0));
        let towards = random.direction();
        let view = Camera::aimed(&mut random, eye, towards, [0.0; 2], half_width, near).rounded();
        let radius = random.integer(0, 3 << 14) as u32;
        let options = FieldOptions::default();
        let (frame, setup) =
            mesh_in_field::constants(&view, WINDOW, radius, &field, &options).unwrap();
        let scale = frame.depth;
        assert_eq!(scale, setup.world_depth);
        assert!((1 << 16..1 << 17).contains(&scale.mantissa) && (-5..=5).contains(&scale.exponent));
        let world = f64::from(scale.mantissa) * f64::from(scale.exponent).exp2();
        let least = f64::from((1 << 18) - 4) * near * (1.0 - cleared - 1.0 / 512.0);
        assert!(world >= least, "{world} {least}");
        let own = f64::from(setup.depth.mantissa) * f64::from(setup.depth.exponent).exp2();
        let expected = world * setup.scale.to_num::<f64>() * f64::from(1 << setup.exponent);
        let lost = 1.0 - own / expected;
        assert!((-EXACT..=most).contains(&lost), "{field}: {lost}");
        assert!((-32..32).contains(&setup.depth.exponent));
    }
}

#[test]
fn far_eyes_and_wide_cameras_are_refused() {
    let field = Field::from(Menger { depth: 4 });
    let view = outside(&mut Random(4));
    let wide = Camera {
        half_width: 4.01,
        ..Camera::of(&view)
    }
    .rounded();
    let refused =
        mesh_in_field::constants(&wide, WINDOW, 1 << 14, &field, &FieldOptions::default());
    assert_eq!(refused, Err(RenderError::HalfWidth(wide.half_width())));
    let far = Camera::looking([0.0, -9.0, 0.0], [0.0; 3], 0.9, 0.1).rounded();
    let refused = mesh_in_field::constants(&far, WINDOW, 1 << 14, &field, &FieldOptions::default());
    assert_eq!(refused, Err(RenderError::Eye(far.eye())));
}
