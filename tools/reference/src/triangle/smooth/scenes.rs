//! Scenes for the errors of smooth shading.

use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::mesh::{IndexedTriangle, Vertex, encode};
use glint_model::ScreenVertex;
use glint_model::triangle::shade::Lit;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::{Content, Scene};

/// Returns a bound on the error of a channel, in steps, for depth codes of at least `farthest`. The bound is half a step for the
/// last rounding, plus the bound in docs/formats/triangle.md, "Smooth shading".
fn bound(farthest: f64) -> f64 {
    0.5 + 0.032 + 43.0 / farthest
}

/// Smallest possible depth code (of the farthest depth) of a camera and a mesh.
const FARTHEST: f64 = 228.0;
/// Largest depth of a vertex, in steps of 1/64 depth code.
const LARGEST: u32 = ((1 << 18) - 4) * 64;

/// Returns the view along +y from the eye at (0, `y`, 0).
fn along(y: f64, half_width: f64, near: f64) -> Box<View> {
    let json = format!(
        r#"{{"eye":[0,{y},0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":{half_width},"near":{near}}}"#
    );
    Box::new(glint::view::parse(json.as_bytes()).expect("a good camera"))
}

/// Encodes a mesh of triangles without shared vertices, with random colours and random normals, most of them towards −y.
fn soup(random: &mut Pcg64Mcg, triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let quantised = |x: f64| (x * 16384.0).round().clamp(-32768.0, 32767.0) as i16;
    let vertices: Vec<Vertex> = triangles
        .as_flattened()
        .iter()
        .map(|position| {
            let vertex = Vertex {
                position: position.map(quantised),
                normal: [
                    random.random_range(-0.7..0.7),
                    random.random_range(-1.0..0.3),
                    random.random_range(-0.7..0.7),
                ]
                .map(quantised),
                ..Vertex::default()
            };
            // Half of the colours are white or black, because light changes most steeply between them.
            let colours = [[0; 3], [255; 3], random.random(), random.random()];
            vertex.with_rgb888(colours[random.random_range(0..4)])
        })
        .collect();
    let triangles: Vec<IndexedTriangle> = (0..triangles.len() as u32)
        .map(|i| IndexedTriangle {
            indices: [3 * i, 3 * i + 1, 3 * i + 2],
            colour: Rgb565::WHITE,
            normal: [0; 3],
            texture: 0,
        })
        .collect();
    encode(&vertices, &triangles).expect("a small mesh")
}

/// Makes random triangles on the screen, over the whole range of depths. With `thin` the triangles are slivers, otherwise of any shape.
fn screen(random: &mut Pcg64Mcg, thin: bool) -> Vec<([ScreenVertex; 3], [Lit; 3])> {
    const GUARD: i32 = 2047 << 8;
    (0..300)
        .map(|i| {
            let reach = [GUARD, 256 * 400, 256 * 60][i % 3];
            let mut corner = || {
                [160 << 8, 90 << 8]
                    .map(|c: i32| (c + random.random_range(-reach..=reach)).clamp(-GUARD, GUARD))
            };
            let [a, b, mut c] = [corner(), corner(), corner()];
            if thin {
                // The third corner is close to the midpoint of the first two corners.
                c = [0, 1].map(|k| (a[k] + b[k]) / 2 + random.random_range(-64..=64));
            }
            let vertices = [a, b, c].map(|[x, y]| ScreenVertex {
                x,
                y,
                w: match random.random_range(0..4) {
                    0 => FARTHEST as u32 * 64,
                    1 => LARGEST,
                    _ => random.random_range(FARTHEST as u32 * 64..=LARGEST),
                },
            });
            let lit = [0; 3].map(|_| {
                let colour = [[0; 3], [255; 3], random.random()][random.random_range(0..3)];
                Lit::new(
                    Rgb565::with_fractions(colour),
                    [[256, random.random_range(0..=256)][i % 2]; 3],
                )
            });
            (vertices, lit)
        })
        .collect()
}

/// Makes triangles with the smallest and the largest depth, and black and white light, at the vertices.
fn largest_ratio() -> Vec<([ScreenVertex; 3], [Lit; 3])> {
    let places = [[20, 10], [300, 20], [150, 170]];
    let (near, far) = (LARGEST, FARTHEST as u32 * 64);
    let white = Lit::new(Rgb565::WHITE.fractions(), [256; 3]);
    let black = Lit::default();
    [
        [(near, black), (far, white), (far, black)],
        [(near, white), (far, black), (far, white)],
        [(near, white), (near, black), (far, white)],
        [(far, white), (near, black), (near, black)],
    ]
    .map(|corners| {
        let vertices = [0, 1, 2].map(|i| {
            let [x, y] = places[i].map(|pixels: i32| pixels << 8);
            ScreenVertex {
                x,
                y,
                w: corners[i].0,
            }
        });
        (vertices, corners.map(|(_, lit)| lit))
    })
    .to_vec()
}

/// Returns the measured scenes, from common to extreme ones.
pub fn scenes() -> Vec<Scene> {
    let mut random = Pcg64Mcg::new(1);
    let [small, _, large] = glint_model::SIZES;
    let generated = |name: &str| {
        let polygons = glint::generate::named(name).expect("a name that is known");
        let made = glint::convert::convert(&polygons, glint::convert::Options::default());
        made.expect("a good mesh").0
    };
    // Two triangles of a floor: the narrow near edge is at y = `from`, just before or behind the eye, the wide far edge at y = 1.99,
    // near the largest coordinate of a mesh.
    let floor = |from: f64| {
        let (near, far) = (0.05, 1.9);
        [
            [[-near, from, -0.02], [near, from, -0.02], [far, 1.99, -0.3]],
            [[-near, from, -0.02], [far, 1.99, -0.3], [-far, 1.99, -0.3]],
        ]
    };
    let edge_on = [
        [
            [-0.05, -1.97, -0.0015],
            [0.05, -1.97, -0.0015],
            [1.9, 1.99, -0.02],
        ],
        [
            [-0.05, -1.97, -0.0015],
            [1.9, 1.99, -0.02],
            [-1.9, 1.99, -0.02],
        ],
    ];
    let close = [[
        [0.004, -1.979, 0.002],
        [1.9, 1.99, -1.2],
        [-1.9, 1.99, -1.2],
    ]];
    let thin: Vec<_> = (0..60)
        .map(|i| {
            let (sin, cos) = f64::from(i).sin_cos();
            let far = |turn: f64| [1.9 * cos - turn * sin, 1.99, 1.9 * sin + turn * cos];
            [[0.015 * cos, -1.97, 0.015 * sin], far(0.02), far(-0.02)]
        })
        .collect();
    let mut anywhere = |count: usize| -> Vec<[[f64; 3]; 3]> {
        (0..count)
            .map(|_| [[0; 3]; 3].map(|c| c.map(|_| random.random_range(-1.99..1.99))))
            .collect()
    };
    let (full, crowd) = (anywhere(20), anywhere(60));
    let screen_any = screen(&mut random, false);
    let screen_thin = screen(&mut random, true);
    let mesh = |bytes, view, size, cull| Content::Mesh {
        bytes,
        view,
        size,
        cull,
    };
    let common = |name, farthest, content| Scene {
        name,
        bound: bound(farthest),
        stiff: false,
        content,
    };
    let stiff = |name, farthest, content| Scene {
        stiff: true,
        ..common(name, farthest, content)
    };
    // A mesh of triangles with random colours and normals, without culling. The eye is at (0, `y`, 0), the near plane at 0.01.
    let mut meshed = |name, triangles: &[_], (y, half_width), size| {
        let (bytes, view) = (soup(&mut random, triangles), along(y, half_width, 0.01));
        stiff(name, 600.0, mesh(bytes, view, size, false))
    };
    let near = (-1.99, 0.9);
    let everyday = Box::new(glint::view::spherical("2,30,60").expect("a good camera"));
    let sphere = |name| mesh(generated(name), everyday.clone(), small, true);
    let inside = mesh(
        generated("icosphere:2"),
        along(0.1, 1.5, 0.01),
        small,
        false,
    );
    vec![
        common("icosphere:6 from 2", 80_000.0, sphere("icosphere:6")),
        common("icosphere:2 from 2", 80_000.0, sphere("icosphere:2")),
        meshed(
            "a floor from 0.02 to 4, near plane at 0.01",
            &floor(-1.97),
            near,
            small,
        ),
        meshed(
            "the floor, cut by the near plane",
            &floor(-2.0),
            (-1.9, 0.9),
            small,
        ),
        meshed("slivers from 0.02 to 4, 1280×720", &thin, near, large),
        common("inside icosphere:2, back faces", 600.0, inside),
        meshed(
            "inside a soup of triangles larger than the picture, 1280×720",
            &full,
            (-0.5, 1.0),
            large,
        ),
        meshed("inside a soup of triangles", &crowd, (-0.2, 3.0), small),
        stiff(
            "triangles on the screen over the whole range of depths",
            FARTHEST,
            Content::Screen(screen_any),
        ),
        stiff(
            "slivers on the screen over the whole range of depths",
            FARTHEST,
            Content::Screen(screen_thin),
        ),
        meshed("a floor seen edge on, 1280×720", &edge_on, near, large),
        meshed(
            "a vertex at 0.011, the others at 4, 1280×720",
            &close,
            near,
            large,
        ),
        stiff(
            "the largest ratio of depths in a triangle, 1,150",
            FARTHEST,
            Content::Screen(largest_ratio()),
        ),
    ]
}
