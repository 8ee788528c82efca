//! Cameras: parallel directions, poles, fields of view, long orbits, and whole meshes in view.

use std::slice;

use anyhow::{Context, Result};
use glint_core::camera::{View, ViewError};
use glint_core::fixed::{Q32_32, Turns, U8_28};
use glint_core::framing::{self, BoundingSphere, FramingError};
use glint_core::matrix::{Axis, Matrix};
use glint_model::triangle::vertex::{project, transform};
use glint_model::{MeshSetup, Projected, SIZES};
use glint_vectors::math::world;
use glint_vectors::{Camera, Model};
use serde::Deserialize;

use super::frames::{mesh, number};
use super::steering::distortion;
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

/// The largest radius of a mesh.
const RADIUS: u32 = glint_core::mesh::MAX_RADIUS;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("camera-towards", towards),
        Kind::new("camera-field-of-view", |degrees| {
            let view = with_field_of_view(above(), degrees);
            Ok(Outcome::of(view, |view| {
                format!("half width {}", view.half_width())
            }))
        }),
        Kind::new("camera-field-of-view-error", field_of_view_error),
        Kind::new("camera-spherical", |Spherical { r, theta, phi }| {
            let [theta, phi] = [theta, phi].map(|x| Turns::from_degrees(Q32_32::from_num(x)));
            let view = View::spherical(Q32_32::from_num(r), theta, phi);
            Ok(Outcome::of(view, |view| {
                let [x, y, z] = view.eye();
                format!("eye ({x}, {y}, {z}), {}", sides(&view))
            }))
        }),
        Kind::new("camera-look-error", |angles: [f64; 3]| {
            let [yaw, pitch, roll] = angles.map(|x| Turns::from_degrees(Q32_32::from_num(x)));
            let view = View::look([Q32_32::ZERO; 3], yaw, pitch, roll)?;
            Ok(Outcome::Error(distortion(&view), "of 2^-23"))
        }),
        Kind::new("camera-orbit-error", |frames: u32| {
            let view = |frame: u32| {
                let part = (u64::from(frame) << 32) / u64::from(frames);
                View::spherical(Q32_32::from_num(3), Turns(part as u32), Turns(1 << 29))
            };
            let worst = (0..frames).try_fold(0.0, |worst: f64, frame| {
                Ok::<_, ViewError>(worst.max(distortion(&view(frame)?)))
            })?;
            Ok(Outcome::Error(worst, "of 2^-23"))
        }),
        Kind::new("camera-fit", fit),
        Kind::new("orthographic-depth", orthographic_depth),
        Kind::new("camera-width", |width: f64| {
            let view = above().with_width(U8_28::from_num(width));
            Ok(Outcome::of(view, |view| {
                format!("half width {}", view.half_width())
            }))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Towards {
    gaze: [f64; 3],
    up: [f64; 3],
}

fn towards(Towards { gaze, up }: Towards) -> Result<Outcome> {
    let number = |v: [f64; 3]| v.map(Q32_32::from_num);
    let view = View::towards(number([0.0, 0.0, 2.0]), number(gaze), number(up));
    Ok(Outcome::of(view, |view| sides(&view)))
}

/// The right and down directions of the screen.
fn sides(view: &View) -> String {
    let [ux, uy, uz] = view.u();
    let [vx, vy, vz] = view.v();
    format!("right ({ux}, {uy}, {uz}), down ({vx}, {vy}, {vz})")
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Spherical {
    r: f64,
    theta: f64,
    phi: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fitted {
    /// Half the side of a cube, in units of 2^-14.
    half: i16,
    scale: f64,
    /// Position of the cube in world units.
    place: [f64; 3],
    /// Horizontal field of view in degrees.
    angle: Option<f64>,
}

/// Fits a camera to a whole cube.
fn fit(input: Fitted) -> Result<Outcome> {
    let bytes = Model::cube(input.half).encoded();
    let place = Matrix::translation(input.place.map(number))?;
    let matrix = Matrix::scale([number(input.scale); 3])?.then(&place)?;
    let meshes = std::iter::once((mesh(&bytes), matrix));
    let sphere = BoundingSphere::around(meshes.clone()).context("no mesh")?;
    let angle = input
        .angle
        .map(|x| Turns::from_degrees(Q32_32::from_num(x)));
    let view = sphere.framed(Axis::Z, Turns(0), angle);
    let view = view.and_then(|mut view| {
        if angle.is_none() {
            framing::fill(slice::from_mut(&mut view), meshes).map_err(FramingError::View)?;
        }
        Ok(view)
    });
    Ok(Outcome::of(view, |view| {
        let [x, y, z] = view.eye();
        format!("eye ({x}, {y}, {z}), half width {}", view.half_width())
    }))
}

/// A camera above the origin.
fn above() -> View {
    View::spherical(Q32_32::from_num(2), Turns::HALF, Turns(0)).expect("a radius in range")
}

fn with_field_of_view(view: View, degrees: f64) -> Result<View, ViewError> {
    view.with_field_of_view(Turns::from_degrees(Q32_32::from_num(degrees)))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Seen {
    degrees: f64,
    near: f64,
    eye: [f64; 3],
    /// Depths of the nearest and the farthest vertex.
    depths: [f64; 2],
}

/// The largest error of screen positions against f64, for vertices seen from `eye` along y.
fn field_of_view_error(input: Seen) -> Result<Outcome> {
    let Seen {
        degrees,
        near,
        eye,
        depths,
    } = input;
    let view = Camera::looking(eye, [0.0; 3], 0.9, near).rounded();
    let view = with_field_of_view(view, degrees)?;
    let camera = Camera::of(&view);
    let mut worst: f64 = 0.0;
    for (width, height) in SIZES {
        let frame = MeshSetup::new(&view, width, height, RADIUS)?;
        let (columns, rows, levels) = (64, 36, 4);
        for i in 0..columns * rows * levels {
            let [column, row, level] = [i % columns, i / columns % rows, i / columns / rows];
            let part = |i: i32, count: i32| f64::from(i) / f64::from(count - 1);
            let across = (2.0 * part(column, columns) - 1.0) * camera.half_width;
            let down = (2.0 * part(row, rows) - 1.0) * camera.half_width * 9.0 / 16.0;
            let depth = depths[0] + (depths[1] - depths[0]) * part(level, levels);
            let place = [0, 1, 2].map(|k| {
                eye[k] + (camera.n[k] + across * camera.u[k] + down * camera.v[k]) * depth
            });
            let position = place.map(|x| (x * 16384.0).round() as i16);
            let Projected::Visible(found) = project(&frame, &transform(&frame, position)) else {
                continue;
            };
            let [x, y, _] = camera.project(world(position), width, height);
            if (0.0..f64::from(width)).contains(&x) && (0.0..f64::from(height)).contains(&y) {
                let error = |found: i32, exact: f64| (f64::from(found) - 256.0 * exact).abs();
                worst = worst.max(error(found.x, x)).max(error(found.y, y));
            }
        }
    }
    Ok(Outcome::Error(worst, "of 1/256 pixel"))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Orthographic {
    /// Width of the picture in world units.
    width: f64,
    near: f64,
    /// Distance of the eye from the middle of a cube.
    distance: f64,
    /// Half the side of the cube in 2^-14.
    half: i16,
}

/// The largest error of the depths read back for the corners of a cube, as a fraction of a code's step.
fn orthographic_depth(input: Orthographic) -> Result<Outcome> {
    let Orthographic {
        width,
        near,
        distance,
        half,
    } = input;
    let camera = Camera::looking([0.0, -distance, 0.0], [0.0; 3], 0.9, near);
    let view = camera.rounded().with_width(U8_28::from_num(width))?;
    let bytes = Model::cube(half).encoded();
    let frame = MeshSetup::new(&view, 320, 180, mesh(&bytes).radius())?;
    let step = 2f64.powi(frame.depth.exponent - 19);
    let mut worst: f64 = 0.0;
    for y in [-half, half] {
        let Projected::Visible(found) = project(&frame, &transform(&frame, [half, y, half])) else {
            return Ok(Outcome::exact("clipped"));
        };
        // Depths of vertices have 6 fraction bits more than codes.
        let code = (found.w + (1 << 5)) >> 6;
        let depth = frame.depth.distance(code).context("no surface")?;
        let exact = distance + f64::from(y) / 16384.0;
        worst = worst.max((depth.to_num::<f64>() - exact).abs() / step);
    }
    Ok(Outcome::Error(worst, "of a code's step"))
}
