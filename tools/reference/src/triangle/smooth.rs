//! Errors of smooth shading. The colours of the model's pixels, and colours interpolated linearly on the screen, are compared
//! with exact perspective interpolation: the quotient of two planes through the triangle's vertices, light/z and 1/z.
//!
//! - [`forms`]: other forms of the interpolation.
//! - [`scenes()`]: the measured scenes, from common to extreme ones.

pub mod forms;
mod scenes;

pub use scenes::scenes;

use glint_core::camera::View;
use glint_core::colour::{Rgb565, Rounding};
use glint_model::triangle::setup::{Bounds, Facing, Oriented, Setup};
use glint_model::triangle::shade::Lit;
use glint_model::{Options, ScreenVertex, Shading, triangle::raster};
use glint_vectors::Picture;

use crate::errors::Errors;

/// Steps of the red, green and blue channel for a light of 1. All colours in this module are in these steps.
pub const RANGES: [f64; 3] = [32.0, 64.0, 32.0];

/// A triangle on the screen with light interpolated between the vertices in f64.
#[derive(Clone, Copy, Debug)]
pub struct Interpolated {
    places: [[f64; 2]; 3],
    w: [f64; 3],
    light: [[f64; 3]; 3],
}

impl Interpolated {
    /// Makes the triangle of three snapped vertices, with the light `lit[i]` at `vertices[i]`.
    pub fn new(vertices: &[ScreenVertex; 3], lit: &[Lit; 3]) -> Self {
        let steps = |Lit(channels): Lit| {
            let [r, g, b] = channels.map(|x| f64::from(x) / 65536.0);
            [r * RANGES[0], g * RANGES[1], b * RANGES[2]]
        };
        Self::of(vertices, lit.map(steps))
    }

    /// Makes the triangle of three snapped vertices, with the light `light[i]`, in steps, at `vertices[i]`.
    pub fn of(vertices: &[ScreenVertex; 3], light: [[f64; 3]; 3]) -> Self {
        Self {
            places: vertices.map(|v| [v.x, v.y].map(|x| f64::from(x) / 256.0)),
            w: vertices.map(|v| f64::from(v.w) / 64.0),
            light,
        }
    }

    /// Returns the barycentric coordinates of a point: the weight of each vertex, with a sum of 1.
    fn parts(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let [a, b, c] = self.places.map(|[px, py]| [px - x, py - y]);
        let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let areas = [cross(b, c), cross(c, a), cross(a, b)];
        // The divisor is computed from the vertices, because the sum of the three areas has rounding errors.
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

    /// Returns red, green and blue at a point, in steps, for light linear on the triangle in space (the exact result).
    pub fn perspective(&self, point: [f64; 2]) -> [f64; 3] {
        let parts = self.parts(point);
        self.weighted([0, 1, 2].map(|i| parts[i] * self.w[i]))
    }

    /// Returns red, green and blue at a point, in steps, for light linear on the screen.
    pub fn affine(&self, point: [f64; 2]) -> [f64; 3] {
        self.weighted(self.parts(point))
    }
}

/// A triangle of a scene, on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// The triangle, which may show its back face.
    pub oriented: Oriented,
    /// The light at each vertex.
    pub lit: [Lit; 3],
    /// Whether the clipper has produced the triangle.
    pub clipped: bool,
    /// Width and height of the picture, in pixels.
    pub size: (u32, u32),
}

/// A covered pixel of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Column in the picture.
    pub column: i32,
    /// Row in the picture.
    pub row: i32,
    /// The model's colour.
    pub colour: Rgb565,
    /// The model's depth code.
    pub code: u32,
}

impl Pixel {
    /// Returns the centre of the pixel.
    pub fn centre(&self) -> [f64; 2] {
        [self.column, self.row].map(|x| f64::from(x) + 0.5)
    }
}

impl Triangle {
    /// Computes the triangle's setup; `None` if its [`Bounds`] contain no pixel.
    pub fn setup(&self) -> Option<Setup> {
        let (width, height) = self.size;
        let bounds = Bounds::new(&self.oriented.vertices, width, height)?;
        Some(Setup::smooth(&self.oriented, bounds, &self.lit))
    }

    /// Draws the triangle on an empty picture and returns its pixels, row by row.
    pub fn pixels(&self, setup: &Setup) -> Vec<Pixel> {
        let width = self.size.0 as i32;
        let mut picture = Picture::blank(self.size);
        let mut target = picture.target();
        target.rounding = Rounding::Nearest;
        raster::draw(setup, Rgb565(0), &mut target);
        let covered = picture
            .depth
            .iter()
            .enumerate()
            .filter(|&(_, &code)| code != 0);
        covered
            .map(|(place, &code)| Pixel {
                column: place as i32 % width,
                row: place as i32 / width,
                colour: Rgb565(picture.colour[place]),
                code,
            })
            .collect()
    }
}

/// Counts and errors over the triangles of a scene. Errors are in steps of a channel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measured {
    /// Number of triangles on the screen: unclipped triangles, and triangles that the clipper has produced.
    pub triangles: u64,
    /// Number of triangles on the screen that the clipper has produced.
    pub clipped: u64,
    /// Number of triangles on the screen with a visible back face.
    pub back: u64,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// The smallest depth code of a covered pixel, which is the code of the farthest pixel.
    pub farthest: u32,
    /// Errors of the model's colours.
    pub model: Errors,
    /// Errors of the exact colours after rounding to whole steps. No method with results in whole steps has smaller errors.
    pub rounded: Errors,
    /// Errors of colours that are linear on the screen, after rounding to whole steps.
    pub affine: Errors,
}

impl Measured {
    /// Draws a triangle on an empty picture, and adds its pixels to the counts and errors.
    fn add(&mut self, triangle: &Triangle) {
        let Some(setup) = triangle.setup() else {
            return;
        };
        let pixels = triangle.pixels(&setup);
        self.pixels += pixels.len() as u64;
        self.triangles += 1;
        self.clipped += u64::from(triangle.clipped);
        self.back += u64::from(triangle.oriented.facing == Facing::Back);
        let reference = Interpolated::new(&triangle.oriented.vertices, &triangle.lit);
        for pixel in pixels {
            let point = pixel.centre();
            let found = pixel.colour.channels().map(f64::from);
            let (exact, affine) = (reference.perspective(point), reference.affine(point));
            for channel in 0..3 {
                let exact = exact[channel];
                self.model.add(found[channel] - exact);
                self.rounded.add((exact + 0.5).floor() - exact);
                self.affine.add((affine[channel] + 0.5).floor() - exact);
            }
            self.farthest = match self.farthest {
                0 => pixel.code,
                farthest => farthest.min(pixel.code),
            };
        }
    }
}

/// A scene with a bound on the model's error.
pub struct Scene {
    /// Description of the scene.
    pub name: &'static str,
    /// Largest allowed error of the model, in steps of a channel.
    pub bound: f64,
    /// Whether depth or light change strongly between neighbouring pixels.
    pub stiff: bool,
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
    /// Triangles by their snapped vertices and the light at each vertex.
    Screen(Vec<([ScreenVertex; 3], [Lit; 3])>),
}

impl Scene {
    /// Draws each triangle of the scene on an empty picture and measures the errors of its pixels.
    ///
    /// # Panics
    /// When the mesh is malformed.
    pub fn measure(&self) -> Measured {
        let mut measured = Measured::default();
        for triangle in self.triangles() {
            measured.add(&triangle);
        }
        measured
    }

    /// Returns the triangles drawn by the model.
    ///
    /// # Panics
    /// When the mesh is malformed.
    pub fn triangles(&self) -> Vec<Triangle> {
        match &self.content {
            Content::Screen(triangles) => {
                let oriented = triangles.iter().filter_map(|(vertices, lit)| {
                    Some(Triangle {
                        oriented: Oriented::new(*vertices)?,
                        lit: *lit,
                        clipped: false,
                        size: glint_model::SIZES[0],
                    })
                });
                oriented.collect()
            }
            Content::Mesh {
                bytes,
                view,
                size,
                cull,
            } => {
                let options = Options {
                    cull: *cull,
                    shading: Shading::Smooth,
                    ..Options::default()
                };
                let picture = Picture::with_options(bytes, view, *size, &options);
                let triangles = picture.drawn.iter().map(|drawn| Triangle {
                    oriented: Oriented {
                        facing: drawn.facing,
                        ..Oriented::new(drawn.vertices).expect("it was drawn")
                    },
                    lit: drawn.lit.expect("shading is smooth"),
                    clipped: drawn.clipped,
                    size: *size,
                });
                triangles.collect()
            }
        }
    }
}
