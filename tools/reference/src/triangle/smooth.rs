//! Errors of smooth shading. The colours of the model's pixels, and colours that are linear on the screen, are compared with
//! exact perspective interpolation: the quotient of two planes through the triangle's vertices, light/z and 1/z.

use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::mesh::{IndexedTriangle, Mesh, Vertex, encode};
use glint_model::triangle::setup::{Bounds, Facing, Oriented, Setup};
use glint_model::triangle::shade::Lit;
use glint_model::{
    DrawnTriangle, FrameBuffer, Options, Projected, ScreenVertex, Shading, trace, triangle::raster,
};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::errors::Errors;

/// Number of steps of the red, green and blue channel that a light of 1 spans. All colours in this module are in these steps.
const RANGES: [f64; 3] = [32.0, 64.0, 32.0];

/// A triangle on the screen, whose light is interpolated between the vertices in f64.
#[derive(Clone, Copy, Debug)]
pub struct Interpolated {
    places: [[f64; 2]; 3],
    w: [f64; 3],
    light: [[f64; 3]; 3],
}

impl Interpolated {
    /// Makes the triangle of three snapped vertices, with the light `lit[i]` at `vertices[i]`.
    pub fn new(vertices: &[ScreenVertex; 3], lit: &[Lit; 3]) -> Self {
        Self {
            places: vertices.map(|v| [v.x, v.y].map(|x| f64::from(x) / 256.0)),
            w: vertices.map(|v| f64::from(v.w) / 64.0),
            light: lit.map(|Lit(channels)| {
                let [r, g, b] = channels.map(|x| f64::from(x) / 16384.0);
                [r * RANGES[0], g * RANGES[1], b * RANGES[2]]
            }),
        }
    }

    /// Returns the barycentric coordinates of a point: the weight of each vertex, with a sum of 1.
    fn parts(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let [a, b, c] = self.places.map(|[px, py]| [px - x, py - y]);
        let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let areas = [cross(b, c), cross(c, a), cross(a, b)];
        // The divisor is computed from the vertices, because the sum of the three areas would contain their rounding errors.
        let side = |k: usize| [0, 1].map(|axis| self.places[k][axis] - self.places[0][axis]);
        areas.map(|area| area / cross(side(1), side(2)))
    }

    fn weighted(&self, weights: [f64; 3]) -> [f64; 3] {
        let whole: f64 = weights.iter().sum();
        [0, 1, 2].map(|channel| {
            (0..3)
                .map(|i| weights[i] * self.light[i][channel])
                .sum::<f64>()
                / whole
        })
    }

    /// Returns red, green and blue at a point, in steps, for light that is linear on the triangle in space (the exact result).
    pub fn perspective(&self, point: [f64; 2]) -> [f64; 3] {
        let parts = self.parts(point);
        self.weighted([0, 1, 2].map(|i| parts[i] * self.w[i]))
    }

    /// Returns red, green and blue at a point, in steps, for light that is linear on the screen.
    pub fn affine(&self, point: [f64; 2]) -> [f64; 3] {
        self.weighted(self.parts(point))
    }
}

/// Counts and errors over the triangles of a scene. Errors are in steps of a channel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measured {
    /// Number of triangles on the screen: whole triangles, and those that the clipper made.
    pub triangles: u64,
    /// Number of triangles on the screen that the clipper made.
    pub clipped: u64,
    /// Number of triangles on the screen that show their back face.
    pub back: u64,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// The smallest depth code of a covered pixel. It belongs to the farthest pixel.
    pub farthest: u32,
    /// Errors of the colours that the model draws.
    pub model: Errors,
    /// Errors of the exact colours after rounding to whole steps. No method that returns whole steps has smaller errors.
    pub rounded: Errors,
    /// Errors of colours that are linear on the screen, after rounding to whole steps.
    pub affine: Errors,
}

impl Measured {
    /// Draws a triangle on an empty picture of this width and height, and adds its pixels to the counts and errors.
    fn add(&mut self, triangle: &Oriented, lit: &[Lit; 3], (width, height): (u32, u32)) {
        let Some(bounds) = Bounds::new(&triangle.vertices, width, height) else {
            return;
        };
        let pixels = width as usize * height as usize;
        let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
        let mut target = FrameBuffer {
            width,
            height,
            colour: &mut colour,
            depth: &mut depth,
        };
        let setup = Setup::smooth(triangle, bounds, lit);
        self.pixels += u64::from(raster::draw(&setup, Rgb565(0), &mut target).covered);
        self.triangles += 1;
        self.back += u64::from(triangle.facing == Facing::Back);
        let reference = Interpolated::new(&triangle.vertices, lit);
        for (pixel, &code) in depth.iter().enumerate().filter(|&(_, &code)| code != 0) {
            let place = [pixel % width as usize, pixel / width as usize];
            let point = place.map(|x| x as f64 + 0.5);
            let found = Rgb565(colour[pixel]).channels().map(f64::from);
            let (exact, affine) = (reference.perspective(point), reference.affine(point));
            for channel in 0..3 {
                let exact = exact[channel];
                self.model.add(found[channel] - exact);
                self.rounded.add((exact + 0.5).floor() - exact);
                self.affine.add((affine[channel] + 0.5).floor() - exact);
            }
            self.farthest = match self.farthest {
                0 => code,
                farthest => farthest.min(code),
            };
        }
    }
}

/// A scene with a bound of the model's error.
pub struct Scene {
    /// Description of the scene.
    pub name: &'static str,
    /// Largest allowed error of the model, in steps of a channel.
    pub bound: f64,
    content: Content,
}

enum Content {
    /// A mesh seen by a camera.
    Mesh {
        bytes: Vec<u8>,
        view: Box<View>,
        size: (u32, u32),
        cull: bool,
    },
    /// Triangles given by their snapped vertices and by the light at each vertex.
    Screen(Vec<([ScreenVertex; 3], [Lit; 3])>),
}

impl Scene {
    /// Draws each triangle of the scene on an empty picture and measures the errors of its pixels.
    ///
    /// # Panics
    /// When the mesh is malformed.
    pub fn measure(&self) -> Measured {
        let mut measured = Measured::default();
        match &self.content {
            Content::Screen(triangles) => {
                for (vertices, lit) in triangles {
                    if let Some(triangle) = Oriented::new(*vertices) {
                        measured.add(&triangle, lit, glint_model::SIZES[0]);
                    }
                }
            }
            Content::Mesh {
                bytes,
                view,
                size,
                cull,
            } => {
                for drawn in drawn(bytes, view, *size, *cull) {
                    let triangle = Oriented {
                        facing: drawn.facing,
                        ..Oriented::new(drawn.vertices).expect("it was drawn")
                    };
                    let lit = drawn.lit.expect("shading is smooth");
                    measured.add(&triangle, &lit, *size);
                    measured.clipped += u64::from(drawn.clipped);
                }
            }
        }
        measured
    }
}

/// Returns the triangles that the model draws for an encoded mesh, after clipping.
fn drawn(bytes: &[u8], view: &View, (width, height): (u32, u32), cull: bool) -> Vec<DrawnTriangle> {
    let mesh = Mesh::new_checked(bytes).expect("a scene's mesh is good");
    let vertices = mesh.chunks().map(|chunk| chunk.vertex_count()).max();
    let pixels = width as usize * height as usize;
    let options = Options {
        cull,
        shading: Shading::Smooth,
        ..Options::default()
    };
    let mut drawn = Vec::new();
    trace(
        &mesh,
        view,
        &mut FrameBuffer {
            width,
            height,
            colour: &mut vec![0; pixels],
            depth: &mut vec![0; pixels],
        },
        &mut vec![Projected::Behind; vertices.unwrap_or(0)],
        &options,
        |triangle| drawn.push(*triangle),
    )
    .expect("a scene's size is one of the model's");
    drawn
}

/// Returns a bound of the error of a channel, in steps, for depth codes of at least `farthest`. It is half a step for the last
/// rounding, plus the bound in docs/formats.md, "Smooth shading".
fn bound(farthest: f64) -> f64 {
    0.5 + 0.032 + 43.0 / farthest
}

/// Smallest depth code (code of the farthest depth) that a camera and a mesh can give.
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

/// Encodes a mesh of triangles that share no vertices, with random
/// colours and with random normals, most of which point towards −y.
fn soup(random: &mut Pcg64Mcg, triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let quantised = |x: f64| (x * 16384.0).round().clamp(-32768.0, 32767.0) as i16;
    let vertices: Vec<Vertex> = triangles
        .as_flattened()
        .iter()
        .map(|position| Vertex {
            position: position.map(quantised),
            normal: [
                random.random_range(-0.7..0.7),
                random.random_range(-1.0..0.3),
                random.random_range(-0.7..0.7),
            ]
            .map(quantised),
            // Half of the colours are white or black, because light changes most steeply between them.
            colour: Rgb565(
                [0, 0xFFFF, random.random(), random.random()][random.random_range(0..4)],
            ),
        })
        .collect();
    let triangles: Vec<IndexedTriangle> = (0..triangles.len() as u32)
        .map(|i| IndexedTriangle {
            indices: [3 * i, 3 * i + 1, 3 * i + 2],
            colour: Rgb565::WHITE,
            normal: [0; 3],
        })
        .collect();
    encode(&vertices, &triangles).expect("a small mesh")
}

/// Makes random triangles on the screen, over the whole range of depths. If `thin` is set they are slivers, otherwise they
/// have any shape.
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
                // The third corner is close to the middle of the edge between the first two corners.
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
                let colour = [0, 0xFFFF, random.random()][random.random_range(0..3)];
                Lit::new(
                    Rgb565(colour),
                    [[256, random.random_range(0..=256)][i % 2]; 3],
                )
            });
            (vertices, lit)
        })
        .collect()
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
    // Two triangles of a floor: its narrow near edge is at y = `from`, just in front of the eye, and its wide far edge is at
    // y = 1.99, near the largest coordinate that a mesh can have.
    let floor = |from: f64| {
        let (near, far) = (0.05, 1.9);
        [
            [[-near, from, -0.02], [near, from, -0.02], [far, 1.99, -0.3]],
            [[-near, from, -0.02], [far, 1.99, -0.3], [-far, 1.99, -0.3]],
        ]
    };
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
    let mut soup = |triangles: &[_]| soup(&mut random, triangles);
    let scene = |name, farthest, content| Scene {
        name,
        bound: bound(farthest),
        content,
    };
    let everyday = Box::new(glint::view::spherical("2,30,60").expect("a good camera"));
    vec![
        scene(
            "icosphere:6 from 2",
            80_000.0,
            mesh(generated("icosphere:6"), everyday.clone(), small, true),
        ),
        scene(
            "icosphere:2 from 2",
            80_000.0,
            mesh(generated("icosphere:2"), everyday, small, true),
        ),
        scene(
            "a floor from 0.02 to 4, near plane at 0.01",
            600.0,
            mesh(soup(&floor(-1.97)), along(-1.99, 0.9, 0.01), small, false),
        ),
        scene(
            "the floor, cut by the near plane",
            600.0,
            mesh(soup(&floor(-2.0)), along(-1.9, 0.9, 0.01), small, false),
        ),
        scene(
            "slivers from 0.02 to 4, 1280×720",
            600.0,
            mesh(soup(&thin), along(-1.99, 0.9, 0.01), large, false),
        ),
        scene(
            "inside icosphere:2, back faces",
            600.0,
            mesh(
                generated("icosphere:2"),
                along(0.1, 1.5, 0.01),
                small,
                false,
            ),
        ),
        scene(
            "inside a soup of triangles larger than the picture, 1280×720",
            600.0,
            mesh(
                soup(&full),
                along(-0.5, 1.0, 0.01),
                glint_model::SIZES[2],
                false,
            ),
        ),
        scene(
            "inside a soup of triangles",
            600.0,
            mesh(soup(&crowd), along(-0.2, 3.0, 0.01), small, false),
        ),
        scene(
            "triangles on the screen over the whole range of depths",
            FARTHEST,
            Content::Screen(screen_any),
        ),
        scene(
            "slivers on the screen over the whole range of depths",
            FARTHEST,
            Content::Screen(screen_thin),
        ),
    ]
}
