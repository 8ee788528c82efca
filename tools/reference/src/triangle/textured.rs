//! Scenes for studies of textures: floors, walls and a sphere, and their pixels in the order in which the triangle engine draws them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glint_core::colour::Rgb565;
use glint_core::mesh::{Attribute, IndexedTriangle, Mesh, Vertex, encode_with};
use glint_core::picture::Size;
use glint_core::records::TextureCoordinates;
use glint_core::texture::{Source, encode};
use glint_model::triangle::descriptor::GROUP;
use glint_model::triangle::setup::{Edge, Plane, Setup};
use glint_model::triangle::textured::{Textured, flat_light};
use glint_model::{Frame, Projected, Subject};
use glint_vectors::Camera;
use glint_vectors::math::{cross, normalised, subtract};

/// A mesh with a texture in front of a camera.
pub struct Scene {
    /// Description of the scene.
    pub name: &'static str,
    /// Size of the picture.
    pub size: Size,
    mesh: Vec<u8>,
    camera: Camera,
}

/// A triangle with a texture.
pub struct Drawn<'a> {
    /// Edges and plane of depth.
    pub setup: Setup,
    /// Planes of the texture coordinates, and the texture.
    pub textured: Textured<'a>,
}

/// A covered pixel of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Column in the picture.
    pub column: i32,
    /// Depth accumulator at the pixel's centre, plus half a code for rounding.
    pub depth: u32,
    /// Accumulators of the texture coordinates at the pixel's centre.
    pub values: [u32; 2],
}

impl Drawn<'_> {
    /// The covered pixels of a row, from left to right.
    pub fn row(&self, row: i32) -> Vec<Pixel> {
        let setup = &self.setup;
        let down = i64::from(row - setup.bounds.top);
        let is_inside = |edge: &Edge, right: i64| {
            edge.start + right * i64::from(edge.step_x) + down * i64::from(edge.step_y) >= 0
        };
        let columns = setup.bounds.left..setup.bounds.right;
        let covered = columns.filter(|column| {
            let right = i64::from(column - setup.start_column);
            setup.edges.iter().all(|edge| is_inside(edge, right))
        });
        covered
            .map(|column| {
                let right = column - setup.start_column;
                let at = |plane: &Plane| {
                    plane
                        .start
                        .wrapping_add(plane.step_x.wrapping_mul(right as u32))
                        .wrapping_add(plane.step_y.wrapping_mul(down as u32))
                };
                Pixel {
                    column,
                    depth: at(&setup.depth).wrapping_add(1 << 13),
                    values: self.textured.axes.map(|axis| at(&axis.plane)),
                }
            })
            .collect()
    }

    /// The exact position of a pixel in the texture, in texels of level 0: the quotient of its accumulators.
    pub fn exact(&self, pixel: &Pixel) -> [f64; 2] {
        self.exact_at(pixel, [0.0; 2])
    }

    /// The exact position, in texels of level 0, of the point `offset` pixels to the right of and below the centre of a pixel in this row;
    /// `None` if the triangle does not cover the point.
    pub fn exact_beside(&self, pixel: &Pixel, row: i32, offset: [f64; 2]) -> Option<[f64; 2]> {
        let setup = &self.setup;
        let right = f64::from(pixel.column - setup.start_column) + offset[0];
        let down = f64::from(row - setup.bounds.top) + offset[1];
        let is_inside = setup.edges.iter().all(|edge| {
            let steps = right * f64::from(edge.step_x) + down * f64::from(edge.step_y);
            edge.start as f64 + steps >= 0.0
        });
        is_inside.then(|| self.exact_at(pixel, offset))
    }

    fn exact_at(&self, pixel: &Pixel, offset: [f64; 2]) -> [f64; 2] {
        let beside = |value: f64, plane: &Plane| {
            let [x, y] = [plane.step_x, plane.step_y].map(|step| f64::from(step as i32));
            value + x * offset[0] + y * offset[1]
        };
        let depth = beside(f64::from(pixel.depth), &self.setup.depth);
        [0, 1].map(|i: usize| {
            let axis = &self.textured.axes[i];
            let side = f64::from(1 << self.textured.texture.size_log2()[i]);
            // An accumulator just below 0 has wrapped.
            let value = f64::from(pixel.values[i] as i32);
            let value = if value < f64::from(-(1 << 26)) {
                f64::from(pixel.values[i])
            } else {
                value
            };
            beside(value, &axis.plane) / depth * f64::from(1 << axis.range_log2) * side
        })
    }

    /// The mip level of each pixel of a row. All pixels of a group have the level of the group's first covered pixel.
    pub fn levels(&self, row: &[Pixel]) -> Vec<u32> {
        let mut level = 0;
        let levels = row.iter().enumerate().map(|(i, pixel)| {
            if i == 0 || pixel.column % GROUP == 0 {
                level = (self.textured).level(&self.setup, pixel.depth, pixel.values);
            }
            level
        });
        levels.collect()
    }
}

impl Scene {
    /// A scene of a mesh in front of a camera. All triangles of the mesh have its first texture.
    pub const fn new(name: &'static str, size: Size, mesh: Vec<u8>, camera: Camera) -> Self {
        Self {
            name,
            size,
            mesh,
            camera,
        }
    }

    /// Calls `visit` for each row of each triangle, with the row's number and covered pixels. The order is the engine's: band by band.
    ///
    /// # Panics
    /// If the model refuses the frame.
    pub fn rows(&self, visit: &mut dyn FnMut(&Drawn, i32, &[Pixel])) {
        let mesh = Mesh::new_checked(&self.mesh).expect("a good mesh");
        let frame = Frame::new(Subject::mesh(mesh), self.camera.rounded(), self.size);
        let constants = frame.constants().expect("a good frame");
        let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
        let mut drawn = Vec::new();
        // The texture is taken from the mesh, because the callback's texture does not live long enough.
        let textures: Vec<_> = mesh.textures().collect();
        let texture = textures[0];
        frame
            .set_up_meshes(&constants, &mut scratch, &mut |_, setup, textured| {
                let textured = textured.expect("a texture");
                drawn.push(Drawn {
                    setup: *setup,
                    textured: Textured {
                        texture,
                        // Full light leaves the colours of the texels unchanged.
                        light: flat_light(Rgb565::WHITE, [256; 3]),
                        ..*textured
                    },
                });
            })
            .expect("enough memory");
        let lines = self.size.band_lines() as i32;
        for top in (0..self.size.height() as i32).step_by(lines as usize) {
            for triangle in &drawn {
                let bounds = triangle.setup.bounds;
                for row in bounds.top.max(top)..bounds.bottom.min(top + lines) {
                    visit(triangle, row, &triangle.row(row));
                }
            }
        }
    }
}

/// Returns a function that makes black textures, with all mip levels or only level 0. Its argument has the base-2 logarithms of width
/// and height in texels.
pub fn blank(has_levels: bool) -> impl Fn([u8; 2]) -> Vec<u8> {
    move |size_log2| {
        let [width, height] = size_log2;
        let last = if has_levels { width.max(height) } else { 0 };
        encode(&Source {
            size_log2,
            levels: vec![Vec::new(); usize::from(last) + 1],
            ..Source::default()
        })
        .expect("a good texture")
    }
}

/// All scenes. `texture` makes a texture from the base-2 logarithms of its sides: 1024×1024 texels, or 512×256 for the globe.
#[must_use]
pub fn scenes(texture: &dyn Fn([u8; 2]) -> Vec<u8>) -> Vec<Scene> {
    let square = glint_vectors::meshes::textured_square(&[texture([10, 10])], 0.5);
    let floor = |name, size| Scene {
        name,
        size,
        mesh: square.clone(),
        camera: Camera::looking([0.0, -1.9, 0.3], [0.0, 2.0, 0.0], 0.8, 0.02),
    };
    let wall = |name, size, degrees: f64| Scene {
        name,
        size,
        mesh: square.clone(),
        camera: across(degrees.to_radians()),
    };
    let globe = |name, size| Scene {
        name,
        size,
        mesh: globe(texture([9, 8]), 24),
        camera: Camera::looking([0.0, -1.8, 0.6], [0.0; 3], 0.8, 0.1),
    };
    vec![
        floor("floor to the horizon, 320×180", Size::W320),
        floor("floor to the horizon, 1280×720", Size::W1280),
        wall("wall at 45°, 320×180", Size::W320, 45.0),
        wall("wall at 10°, 320×180", Size::W320, 10.0),
        wall("wall at 10°, 1280×720", Size::W1280, 10.0),
        globe("globe of 512×256, 320×180", Size::W320),
        globe("globe of 512×256, 1280×720", Size::W1280),
    ]
}

/// A camera that sees the square at z = 0 as a wall to its left, at this angle to the line of sight.
fn across(angle: f64) -> Camera {
    let (sin, cos) = angle.sin_cos();
    let eye = [0.0, -1.2 * cos, 1.2 * sin];
    let n = normalised(subtract([0.0; 3], eye));
    let up = [1.0, 0.0, 0.0];
    let u = normalised(cross(n, up));
    Camera {
        eye,
        u,
        v: cross(n, u),
        n,
        half_width: 0.8,
        near: 0.02,
    }
}

/// A sphere of radius 1 about the origin, of `bands` bands and twice as many sectors. The texture covers the sphere once.
///
/// # Panics
/// If it has too many vertices for a mesh.
#[must_use]
pub fn globe(texture: Vec<u8>, bands: u32) -> Vec<u8> {
    let sectors = 2 * bands;
    let places = (0..=bands).flat_map(|band| (0..=sectors).map(move |sector| [sector, band]));
    let (vertices, elements): (Vec<_>, Vec<_>) = places
        .map(|[sector, band]| {
            let [s, t] = [
                f64::from(sector) / f64::from(sectors),
                f64::from(band) / f64::from(bands),
            ];
            let (longitude, latitude) = (TAU * s, FRAC_PI_2 - PI * t);
            let direction = [
                longitude.cos() * latitude.cos(),
                longitude.sin() * latitude.cos(),
                latitude.sin(),
            ];
            let normal = direction.map(|c| (c * 16_384.0) as i16);
            let vertex = Vertex {
                position: normal,
                normal,
                colour: Rgb565::WHITE,
                fine: 0,
            };
            let [s, t] = [s, t].map(|c| (c * 65_536.0) as i32);
            (vertex, TextureCoordinates { s, t }.to_bytes())
        })
        .unzip();
    let at = |sector: u32, band: u32| band * (sectors + 1) + sector;
    let triangles: Vec<_> = (0..bands)
        .flat_map(|band| (0..sectors).map(move |sector| [sector, band]))
        .flat_map(|[x, y]| {
            let [a, b, c, d] = [at(x, y), at(x, y + 1), at(x + 1, y + 1), at(x + 1, y)];
            [[a, b, c], [a, c, d]]
        })
        .map(|indices| IndexedTriangle {
            indices,
            colour: Rgb565::WHITE,
            normal: [0, 0, 1 << 14],
            texture: 1,
        })
        .collect();
    let attributes = [(Attribute::TextureCoordinates, elements.as_flattened())];
    encode_with(&vertices, &triangles, &attributes, &[texture]).expect("a small mesh")
}
