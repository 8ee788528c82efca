//! A frame drawn in f64.

use anyhow::{Context, Result, bail, ensure};
use glint_core::appearance::Appearance;
use glint_core::colour::{Rgb565, Shading, Winding};
use glint_core::light::{Gradient, Light, Material, Rgb};
use glint_core::matrix::Matrix;
use glint_core::mesh::{Chunk, Triangle};
use glint_core::stereo::Tint;
use glint_model::raymarch::FieldSetup;
use glint_model::wireframe::LINE_COLOUR;
use glint_model::{Clip, FieldSubject, Frame, MeshSubject, Subject, WireframeSubject};

use super::seen::{Eyes, SHOWN, Seen};
use crate::camera::{
    Camera, Ray, Side, Size, Stereo, Vector, add_scaled, cross, dot, length, normalised, subtract,
};
use crate::line::{ExactSegment, Rectangle};
use crate::raymarch::raymarched::reach;
use crate::raymarch::{Face, Field};
use crate::triangle::exact::SnappedVertex;
use crate::triangle::surface::{Class, ProjectedTriangle};

/// A picture of 1280×720 in f64.
pub struct Exact {
    /// Visible surface of each pixel, row by row.
    pub seen: Vec<Eyes>,
    /// Red, green and blue, from 0 to 255.
    pub colours: Vec<Vector>,
}

/// A pixel of an eye's picture.
#[derive(Clone, Copy)]
struct Pixel {
    seen: Seen,
    colour: Vector,
    /// 1/z of the surface, where z is its depth in world units; 0 for the background.
    nearness: f64,
}

impl Exact {
    /// Draws a frame of any size in f64, at the size on the monitor, with a sample at the centre of each pixel.
    ///
    /// # Errors
    /// The model cannot draw the frame, or it has features that no scene uses: meshes for two eyes, edges of a mesh, an
    /// orthographic camera, occlusion, or a union.
    pub fn new(frame: &Frame) -> Result<Self> {
        Self::at(frame, [0.0; 2])
    }

    /// Draws a frame like [`new`](Self::new), with each sample `offset` pixels to the right of and below its pixel's centre. Lines are a
    /// pixel wide.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn at(frame: &Frame, offset: [f64; 2]) -> Result<Self> {
        let frame = &Frame {
            size: SHOWN,
            ..*frame
        };
        let picture = match frame.stereo {
            None => one_eye(frame, None, offset)?
                .into_iter()
                .map(|pixel| ([pixel.seen; 2], pixel.colour))
                .collect(),
            Some(stereo) => {
                ensure!(
                    matches!(frame.subject, Subject::Field(_)),
                    "expected a field for two eyes"
                );
                ensure!(
                    stereo.tint == Tint::RedCyan,
                    "expected red and cyan glasses"
                );
                let [left, right] =
                    [Side::Left, Side::Right].map(|side| one_eye(frame, Some(side), offset));
                let pairs = left?.into_iter().zip(right?);
                pairs
                    .map(|(left, right)| {
                        let [l, r] = [left, right].map(|pixel| luminance(pixel.colour));
                        ([left.seen, right.seen], [l, r, r])
                    })
                    .collect::<Vec<_>>()
            }
        };
        let (seen, colours) = picture.into_iter().unzip();
        Ok(Self { seen, colours })
    }
}

/// Luminance of a colour, with the weights of docs/formats/camera.md.
fn luminance(colour: Vector) -> f64 {
    dot(colour, [77.0, 150.0, 29.0]) / 256.0
}

fn size() -> Size {
    let [width, height] = SHOWN.pixels();
    Size { width, height }
}

/// The position of the sample of each pixel, as column and line, row by row.
fn places([right, down]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let [columns, rows] = SHOWN.pixels();
    let rows = (0..rows).map(move |y| f64::from(y) + down);
    rows.flat_map(move |y| (0..columns).map(move |x| [f64::from(x) + right, y]))
}

fn one_eye(frame: &Frame, side: Option<Side>, offset: [f64; 2]) -> Result<Vec<Pixel>> {
    let camera = Camera::of(&frame.view);
    let background = Pixel {
        seen: Seen::Background,
        colour: full(frame.clear),
        nearness: 0.0,
    };
    let mut pixels = vec![background; SHOWN.pixel_count()];
    if let Some(gradient) = frame.sky {
        draw_gradient(&camera, gradient, offset, &mut pixels);
    }
    if let Subject::Wireframe(subject) = &frame.subject {
        draw_lines(subject, offset, &mut pixels)?;
        return Ok(pixels);
    }
    if let Some(subject) = frame.subject.field_part() {
        draw_field(frame, subject, &camera, (side, offset), &mut pixels)?;
    }
    let lighting = frame.mesh_lighting();
    let light = Lit {
        ambient: share(lighting.ambient),
        lights: vec![lit(&lighting.light, &camera)],
    };
    let (density, horizon) = frame.mesh_fog();
    let fog = (density.to_num(), horizon.map(f64::from));
    let placed = |subject, matrix, object, colour| Placed {
        subject,
        matrix,
        object,
        colour,
        camera: &camera,
        light: &light,
        fog,
        offset,
    };
    match &frame.subject {
        Subject::Mesh(subject) | Subject::MeshInField(subject, _) => {
            placed(subject, &Matrix::IDENTITY, 0, None).draw(&mut pixels);
        }
        Subject::Objects(objects) => {
            for (number, object) in objects.iter().enumerate() {
                let matrix = object.placement.matrix();
                placed(&object.subject, matrix, number, object.colour).draw(&mut pixels);
            }
        }
        Subject::Field(_) => {}
        Subject::Edges(..) | Subject::Wireframe(_) => bail!("expected a mesh, objects or a field"),
    }
    Ok(pixels)
}

/// Light in f64; 1 is the maximum.
struct Lit {
    ambient: Vector,
    /// Directions and colours of the lights.
    lights: Vec<(Vector, Vector)>,
}

impl Lit {
    /// Returns the light on a surface with this outward normal, at most 1 per channel.
    fn on(&self, normal: Vector) -> Vector {
        let mut sum = self.ambient;
        for (towards, colour) in &self.lights {
            sum = add_scaled(sum, *colour, dot(normal, *towards).clamp(0.0, 1.0));
        }
        sum.map(|part| part.min(1.0))
    }
}

fn share(colour: Rgb) -> Vector {
    colour.map(|part| f64::from(part) / 255.0)
}

fn lit(light: &Light, camera: &Camera) -> (Vector, Vector) {
    let towards = match light.is_at_camera() {
        true => camera.n.map(|part| -part),
        false => light.direction().map(|part| f64::from(part) / 16384.0),
    };
    (normalised(towards), share(light.colour()))
}

/// A colour of the mesh, channels from 0 to 255.
fn full(colour: Rgb565) -> Vector {
    let [r, g, b] = colour.channels().map(f64::from);
    [r / 31.0, g / 63.0, b / 31.0].map(|part| 255.0 * part)
}

fn product(a: Vector, b: Vector) -> Vector {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// A mesh of a frame.
struct Placed<'a> {
    subject: &'a MeshSubject<'a>,
    matrix: &'a Matrix,
    /// Index of the object.
    object: usize,
    /// Colour that replaces the mesh's colours.
    colour: Option<Rgb565>,
    camera: &'a Camera,
    light: &'a Lit,
    /// Density and colour of the fog.
    fog: (f64, Vector),
    /// Place of a sample in its pixel.
    offset: [f64; 2],
}

impl Placed<'_> {
    fn draw(&self, pixels: &mut [Pixel]) {
        let mut index = 0;
        for chunk in self.subject.mesh.chunks() {
            for triangle in chunk.triangles() {
                self.draw_triangle(&chunk, &triangle, index, pixels);
                index += 1;
            }
        }
    }

    fn draw_triangle(
        &self,
        chunk: &Chunk,
        triangle: &Triangle,
        index: usize,
        pixels: &mut [Pixel],
    ) {
        let subject = self.subject;
        let vertices = triangle
            .indices
            .map(|i| chunk.vertex(i.into()).unwrap_or_default());
        let corners = vertices.map(|vertex| self.point(vertex.position));
        let projected = ProjectedTriangle::new(self.camera, size(), corners);
        let [right, down] = self.offset;
        let projected = projected.moved([-right, -down]);
        let is_front =
            subject.winding == Winding::Screen || projected.front != self.matrix.mirrors();
        if subject.culls() && !is_front {
            return;
        }
        let shade = |normal, colour| self.shade(normal, colour, is_front);
        let flat = shade(triangle.normal, full(triangle.colour));
        let smooth = vertices.map(|vertex| shade(vertex.normal, vertex.rgb888().map(f64::from)));
        let farthest = match subject.clip {
            Clip::Guard => f64::INFINITY,
            Clip::View { far } => far.to_num(),
        };
        let [columns, rows] = projected.bounds(size());
        for row in rows {
            for column in columns.clone() {
                let pixel = &mut pixels[(row * SHOWN.width() + column) as usize];
                let nearness = projected.inverse_depth(column, row);
                let is_nearest = nearness >= pixel.nearness && nearness * farthest >= 1.0;
                if !is_nearest || projected.classify(column, row, 0.0) != Class::Full {
                    continue;
                }
                let colour = match subject.shading {
                    Shading::Flat => flat,
                    Shading::Smooth => {
                        let place = [f64::from(column) + right, f64::from(row) + down];
                        let ray = self.camera.ray(place, size());
                        let parts = barycentric(corners, ray.at(1.0 / nearness));
                        let colours = smooth.into_iter().zip(parts);
                        colours.fold([0.0; 3], |sum, (colour, part)| {
                            add_scaled(sum, colour, part)
                        })
                    }
                };
                let (density, fog) = self.fog;
                let hidden = 1.0 - (-density / nearness).exp();
                *pixel = Pixel {
                    seen: Seen::Triangle {
                        object: self.object,
                        index,
                    },
                    colour: add_scaled(colour, subtract(fog, colour), hidden),
                    nearness,
                };
            }
        }
    }

    fn point(&self, position: [i16; 3]) -> Vector {
        let units = self.matrix.apply(position);
        units.map(|part| part as f64 / 38f64.exp2())
    }

    /// Returns a colour of the mesh, multiplied by the light on the front or back face.
    fn shade(&self, normal: [i16; 3], colour: Vector, is_front: bool) -> Vector {
        let normal = self.normal(normal);
        let normal = match is_front {
            true => normal,
            false => normal.map(|part| -part),
        };
        product(self.colour.map_or(colour, full), self.light.on(normal))
    }

    /// Returns a normal of the mesh in world coordinates: it is multiplied by the inverse transpose of the matrix, and scaled to its
    /// original length.
    fn normal(&self, normal: [i16; 3]) -> Vector {
        let normal = normal.map(|part| f64::from(part) / 16384.0);
        let rows = self.matrix.linear();
        let [a, b, c] = rows.map(|row| row.map(|part| part.to_num::<f64>()));
        let sign = if self.matrix.mirrors() { -1.0 } else { 1.0 };
        let turned = [cross(b, c), cross(c, a), cross(a, b)].map(|row| sign * dot(row, normal));
        match length(turned) {
            0.0 => turned,
            whole => turned.map(|part| part / whole * length(normal)),
        }
    }
}

/// Barycentric coordinates of a point in a triangle's plane.
fn barycentric([a, b, c]: [Vector; 3], point: Vector) -> Vector {
    let normal = cross(subtract(b, a), subtract(c, a));
    let part = |from: Vector, to: Vector| {
        dot(cross(subtract(to, from), subtract(point, from)), normal) / dot(normal, normal)
    };
    [part(b, c), part(c, a), part(a, b)]
}

/// A field, its light and its colours in f64.
struct Appeared {
    light: Lit,
    sky: [Vector; 2],
    density: f64,
    is_round: bool,
}

/// Draws the gradient behind meshes. Its height at a pixel is the component along z of the pixel's ray or, with fixed places, 1 at the top
/// and −1 at the bottom of the picture.
fn draw_gradient(camera: &Camera, gradient: Gradient, offset: [f64; 2], pixels: &mut [Pixel]) {
    let [zenith, horizon, nadir] = gradient.colours.map(|colour| colour.map(f64::from));
    for (place, pixel) in places(offset).zip(pixels) {
        let [_, y] = place;
        let height = if gradient.is_fixed {
            1.0 - (2.0 * y + 1.0) / f64::from(SHOWN.height())
        } else {
            let [_, _, height] = camera.ray(place, size()).direction;
            height
        };
        let end = if height < 0.0 { nadir } else { zenith };
        let part = height.abs().min(1.0);
        pixel.colour = add_scaled(horizon, subtract(end, horizon), part);
    }
}

fn draw_field(
    frame: &Frame,
    subject: &FieldSubject,
    camera: &Camera,
    (side, offset): (Option<Side>, [f64; 2]),
    pixels: &mut [Pixel],
) -> Result<()> {
    let constants = frame.constants()?;
    let setup: &FieldSetup = &constants.field().context("expected a field")?.setup;
    let appearance: &Appearance = subject.appearance;
    ensure!(!appearance.occlusion, "expected no occlusion");
    let field = Field::of(subject.field);
    ensure!(
        !matches!(field, Field::Union(..) | Field::SmoothUnion { .. }),
        "expected no union"
    );
    let lighting = appearance.lighting();
    ensure!(!appearance.has_highlight(), "expected no highlight");
    let appeared = Appeared {
        light: Lit {
            ambient: share(lighting.ambient),
            lights: lighting
                .lights
                .iter()
                .map(|light| lit(light, camera))
                .collect(),
        },
        sky: appearance
            .field_background()
            .colours()
            .map(|colour| colour.map(f64::from)),
        density: appearance.fog.to_num(),
        is_round: subject.field.is_round(),
    };
    let stereo = frame.stereo.map(|stereo| Stereo {
        offset: stereo.half_separation.to_num(),
        zero: stereo.zero_parallax.to_num(),
    });
    let eye = usize::from(side == Some(Side::Right));
    for (place, pixel) in places(offset).zip(pixels) {
        let ray = match side.zip(stereo) {
            Some((side, stereo)) => camera.stereo_ray(side, stereo, place, size()),
            None => camera.ray(place, size()),
        };
        // The far limit of the model's rays.
        let farthest = reach(setup, eye, ray.direction);
        *pixel = field_pixel(&field, appearance, &appeared, &ray, (camera.near, farthest));
    }
    Ok(())
}

fn field_pixel(
    field: &Field,
    appearance: &Appearance,
    appeared: &Appeared,
    ray: &Ray,
    (near, far): (f64, f64),
) -> Pixel {
    let [zenith, horizon] = appeared.sky;
    let mix = |from: Vector, part: f64| add_scaled(from, subtract(horizon, from), part);
    let Some(hit) = field.hit(ray.origin, ray.direction, near, far) else {
        let whole = match appeared.is_round {
            true => length(ray.direction),
            false => ray
                .direction
                .iter()
                .fold(0.0, |most: f64, part| most.max(part.abs())),
        };
        let up = (ray.direction[2] / whole).max(0.0);
        return Pixel {
            seen: Seen::Background,
            colour: mix(zenith, 1.0 - up),
            nearness: 0.0,
        };
    };
    let material = appearance.material;
    let sphere = if let Field::Spheres(_) = field {
        hit.member
    } else {
        0
    };
    let colour = match hit.face {
        Face::Axis { axis, positive } => {
            material.faces()[2 * axis + usize::from(positive)].map(f64::from)
        }
        Face::Diagonal { positive } => {
            let face = (0..3).map(|i| usize::from(positive[i]) << i).sum::<usize>();
            material.octants()[face].map(f64::from)
        }
        Face::Round | Face::Inside if material == Material::Normal => {
            hit.normal.map(|part| 130.0 + 95.0 * part)
        }
        Face::Round | Face::Inside => material.spheres()[sphere].map(f64::from),
    };
    let lit = product(colour, appeared.light.on(hit.normal));
    Pixel {
        seen: Seen::Surface {
            face: hit.face,
            sphere,
        },
        colour: mix(lit, 1.0 - (-appeared.density * hit.t).exp()),
        nearness: 1.0 / hit.t,
    }
}

/// Draws the lines of a wireframe: end points in f64, snapped to the grid of the screen, and the exact pixels between them.
fn draw_lines(subject: &WireframeSubject, offset: [f64; 2], pixels: &mut [Pixel]) -> Result<()> {
    let viewing = subject.program.viewing();
    let eye = viewing.eye.map(f64::from);
    let plane = f64::from(viewing.plane);
    let [low, high] = [viewing.window.low, viewing.window.high].map(|corner| corner.map(f64::from));
    let [width, height] = SHOWN.pixels();
    let picture = Rectangle {
        from: [0, 0],
        to: [i64::from(width), i64::from(height)],
    };
    for segment in subject.program.segments() {
        let ends = subject
            .pose
            .segment(segment)
            .map(|end| end.map(|part| part.to_num::<f64>()));
        ensure!(
            ends.iter().all(|end| end[2] <= plane),
            "expected lines behind the view plane"
        );
        let snapped = ends.map(|[x, y, z]| {
            let part = (eye[2] - plane) / (eye[2] - z);
            let [x, y] = [(eye[0], x), (eye[1], y)].map(|(eye, x)| eye - part * (eye - x));
            let right = (x - low[0]) / (high[0] - low[0]) * f64::from(width);
            let down = (high[1] - y) / (high[1] - low[1]) * f64::from(height);
            let place = [right - offset[0], down - offset[1]];
            let [x, y] = place.map(|pixels| (256.0 * pixels).round() as i64);
            SnappedVertex { x, y, w: 0 }
        });
        ExactSegment::new(snapped).for_each_pixel(picture, &mut |[x, y]| {
            pixels[(y * i64::from(width) + x) as usize] = Pixel {
                seen: Seen::Line,
                colour: full(LINE_COLOUR),
                nearness: 1.0,
            };
        });
    }
    Ok(())
}
