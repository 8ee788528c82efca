//! Scenes for the tests of the triangle engine and of the whole SoC.

use glint_core::camera::View;
use glint_core::fixed::{Q32_32, Turns};
use rand_pcg::Pcg64Mcg;

use crate::camera::Camera;
use crate::meshes::{self, Triangle, ahead, at};

/// A scene: name, bytes of the mesh, camera, and whether back faces are culled.
pub type Scene = (&'static str, Vec<u8>, View, bool);

/// A wide-angle view from near the middle of a model.
pub fn inside() -> View {
    let camera = Camera {
        eye: [0.21, -0.1, 0.05],
        u: [0.6, 0.8, 0.0],
        v: [0.0, 0.0, -1.0],
        n: [-0.8, 0.6, 0.0],
        half_width: 1.5,
        near: 0.05,
    };
    camera.rounded()
}

/// A fan of `parts` front faces around a common corner, in the plane at `y`. The plane's distance from the camera `ahead` is y + 2.
fn fan(y: f64, radius: f64, parts: usize) -> Vec<Triangle> {
    let rim = |part: usize| {
        let (sin, cos) = (std::f64::consts::TAU * part as f64 / parts as f64).sin_cos();
        at(radius * cos, y, radius * sin)
    };
    (0..parts)
        .map(|part| {
            let corners = [at(0.01, y, 0.02), rim(part), rim(part + 1)];
            (corners, 0x1111 * (part as u16 % 15 + 1))
        })
        .collect()
}

/// Triangles with these colours and corners, in world units.
fn coloured<const N: usize>(colours: [u16; N], corners: [[[f64; 3]; 3]; N]) -> [Triangle; N] {
    std::array::from_fn(|i| (corners[i].map(|[x, y, z]| at(x, y, z)), colours[i]))
}

/// Makes all scenes. `generated` returns the mesh of the model with a given name, such as `icosphere:6`.
pub fn scenes(generated: impl Fn(&str) -> Vec<u8>) -> Vec<Scene> {
    let mut random = Pcg64Mcg::new(1);
    let many = usize::from(u16::MAX);
    let mesh = |triangles: &[Triangle]| meshes::mesh(triangles, many);
    let slivers: Vec<Triangle> = (0..60)
        .map(|i| {
            let (sin, cos) = f64::from(i).sin_cos();
            let (x, z) = (
                0.5 * (1.7 * f64::from(i)).sin(),
                0.3 * (2.3 * f64::from(i)).cos(),
            );
            let thin = 0.5e-3;
            let corners = [(1.0, 0.0), (0.0, 1.0), (-1.0, -1.0)];
            let corner = |(long, across): (f64, f64)| {
                let across = across * thin;
                at(
                    x + long * cos - across * sin,
                    0.0,
                    z + long * sin + across * cos,
                )
            };
            (corners.map(corner), 0x1081_u16.wrapping_mul(i as u16 + 1))
        })
        .collect();
    let screen = coloured(
        [0xf800, 0x07e0],
        [
            [[-1.9, -1.0, -1.9], [1.9, -1.0, -1.9], [1.9, -1.0, 1.9]],
            [[-1.9, -1.0, -1.9], [1.9, -1.0, 1.9], [-1.9, -0.9, 1.9]],
        ],
    );
    // A point that projects onto a pixel centre at 320x180, where a world unit spans 128 pixels, and onto a pixel corner in
    // larger pictures.
    let centre = |x: i32, z: i32| {
        let [x, z] = [x, z].map(|c| f64::from(2 * c + 1) / 256.0);
        at(x, -1.0, z)
    };
    let centres: Vec<Triangle> = (-12..12)
        .flat_map(|i| {
            let (x, z) = (8 * i, 3 * i);
            let [a, b] = [centre(x, z), centre(x + 8, z)];
            let [c, d] = [centre(x + 8, z + 5), centre(x, z + 5)];
            [([a, b, c], 0xffe0), ([a, c, d], 0x001f)]
        })
        .collect();
    let equal: Vec<Triangle> = (0..6)
        .flat_map(|_| fan(0.0, 0.6, 7))
        .zip(1..)
        .map(|((c, _), i)| (c, 0x0841_u16.wrapping_mul(i)))
        .collect();
    let turned: Vec<Triangle> = fan(0.0, 0.6, 9)
        .iter()
        .map(|&([a, b, c], colour)| ([a, c, b], colour))
        .collect();
    let before_near = -1.0 - 1.0 / 16384.0;
    let at_near = coloured(
        [0xffff, 0x07ff],
        [
            [[-0.5, -1.0, -0.5], [0.5, -1.0, -0.5], [0.0, -1.0, 0.5]],
            [[-0.5, before_near, 0.0], [0.5, -1.0, -0.4], [0.0, 0.5, 0.5]],
        ],
    );
    let wide = coloured(
        [0xf81f, 0x7bef, 0x39e7],
        [
            [[-1.99, -1.93, 0.3], [1.0, 1.0, -0.6], [0.3, 1.5, 0.5]],
            [[1.99, -1.95, -0.8], [0.2, 0.1, 0.4], [-0.4, 0.2, -0.3]],
            [[-1.5, -1.99, -1.5], [1.5, -1.99, -1.5], [0.0, 1.0, 1.5]],
        ],
    );
    let full = meshes::random(&mut random, many / 3, 0.02);
    let beyond = meshes::random(&mut random, many / 3 + 400, 0.02);
    let tiny = meshes::random(&mut random, 3000, 0.002);
    vec![
        ("slivers", mesh(&slivers), ahead(1.0, 0.5), false),
        ("triangles of a pixel", mesh(&tiny), ahead(0.6, 0.1), false),
        ("the whole screen", mesh(&screen), ahead(1.0, 0.5), false),
        ("pixel centres", mesh(&centres), ahead(1.25, 0.5), true),
        ("a fan", mesh(&fan(0.0, 0.7, 40)), ahead(1.0, 0.5), true),
        ("equal depths", mesh(&equal), ahead(1.0, 0.5), true),
        ("all culled", mesh(&turned), ahead(1.0, 0.5), true),
        ("none culled", mesh(&turned), ahead(1.0, 0.5), false),
        ("no triangle", mesh(&[]), ahead(1.0, 0.5), true),
        ("inside a sponge", generated("sponge:1"), inside(), false),
        ("inside a sphere", generated("icosphere:6"), inside(), false),
        (
            "a sphere",
            generated("icosphere:6"),
            spherical(2, 30, 60),
            true,
        ),
        ("at the near plane", mesh(&at_near), ahead(1.0, 1.0), false),
        (
            "beyond the guard band",
            mesh(&wide),
            ahead(1.0, 0.01),
            false,
        ),
        ("65,535 vertices", mesh(&full), ahead(0.8, 0.5), false),
        ("two chunks", mesh(&beyond), ahead(0.8, 0.5), true),
    ]
}

/// A camera on a sphere of radius `r` about the origin, with the azimuth `theta` and the angle `phi` from the z axis, in
/// degrees.
fn spherical(r: i32, theta: i32, phi: i32) -> View {
    let [theta, phi] = [theta, phi].map(|angle| Turns::from_degrees(Q32_32::from_num(angle)));
    View::spherical(Q32_32::from_num(r), theta, phi).expect("a camera within the limits of a view")
}
