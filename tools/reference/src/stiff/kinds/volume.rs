//! The planes of the view volume, and vertices in the eye's plane.

use anyhow::{Context, Result, ensure};
use glint_core::colour::Rgb565;
use glint_core::matrix::Matrix;
use glint_core::picture::Size;
use glint_model::triangle::clip::clip;
use glint_model::triangle::vertex::transform;
use glint_model::{Clip, Frame, MeshSetup, MeshSubject, Object, Subject};
use glint_vectors::{Camera, Model, Picture};
use serde::Deserialize;

use super::frames::{ahead, mesh, number, object, view_volume};
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("far-plane", far_plane),
        Kind::new("near-plane", near_plane),
        Kind::new("deep-volume", deep_volume),
        Kind::new("vertex-beside-eye", vertex_beside_eye),
        Kind::new("object-at", object_at),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Planes {
    near: f64,
    far: f64,
}

/// The frame of a cube clipped to a view volume.
fn far_plane(Planes { near, far }: Planes) -> Result<Outcome> {
    let bytes = Model::cube(8192).encoded();
    let subject = MeshSubject {
        clip: view_volume(far),
        ..MeshSubject::new(mesh(&bytes))
    };
    let frame = Frame::new(Subject::Mesh(subject), ahead(near), Size::W320);
    Ok(Outcome::of(frame.constants(), |_| "accepted".to_owned()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Distant {
    near: f64,
    place: [f64; 3],
}

/// The frame of a distant cube.
fn near_plane(Distant { near, place }: Distant) -> Result<Outcome> {
    let bytes = Model::cube(8192).encoded();
    let objects = [object(&bytes, Matrix::translation(place.map(number))?)];
    let frame = Frame::new(Subject::Objects(&objects), ahead(near), Size::W320);
    Ok(Outcome::of(frame.constants(), |_| "accepted".to_owned()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Deep {
    near: f64,
    far: f64,
    /// Depths of the two cubes in the middle.
    cubes: [f64; 2],
}

/// Draws a cube at the near plane beside the middle of the picture, and two cubes in the middle. States which of these two cubes
/// is visible, and the depth codes of both planes.
fn deep_volume(Deep { near, far, cubes }: Deep) -> Result<Outcome> {
    let bytes = Model::cube(8192).encoded();
    let cube = |place: [f64; 3], size: f64, colour| -> Result<Object<'_>> {
        let matrix = Matrix::scale([number(size); 3])?;
        let matrix = matrix.then(&Matrix::translation(place.map(number))?)?;
        let mut object = Object {
            colour: Some(Rgb565(colour)),
            ..object(&bytes, matrix)
        };
        object.subject.clip = view_volume(far);
        Ok(object)
    };
    let [red, blue] = [0xF800, 0x001F];
    let [first, second] = cubes.map(|depth| [0.0, depth - 1.5, 0.0]);
    let objects = [
        cube([0.0, -1.9848, 0.0075], 0.01, 0xFFFF)?,
        cube(first, 1.0, red)?,
        cube(second, 1.0, blue)?,
    ];
    let frame = Frame::new(Subject::Objects(&objects), ahead(near), Size::W320);
    let scale = frame.constants()?.depth_scale().context("no depth scale")?;
    let k = f64::from(scale.mantissa) * 2f64.powi(scale.exponent);
    let picture = Picture::of_frame(&frame);
    let largest = picture.depth.iter().max().copied().unwrap_or_default();
    ensure!(largest > 250_000, "{largest}: the near cube is not drawn");
    let colour = picture.colour[picture.colour.len() / 2 + 160];
    let seen = match (colour & red != 0, colour & blue != 0) {
        (true, false) => "first",
        (false, true) => "second",
        _ => "neither",
    };
    let [nearest, farthest] = [near, far].map(|depth| (k / depth).round());
    Ok(Outcome::exact(format!(
        "{seen} cube seen; depth codes {nearest} at the near plane, {farthest} at the far plane"
    )))
}

/// Clips a triangle with this vertex, which lies in the eye's plane, first to the near plane alone and then to a view volume.
fn vertex_beside_eye(position: [i16; 3]) -> Result<Outcome> {
    let view = Camera {
        eye: [0.0; 3],
        ..Camera::of(&ahead(0.1))
    }
    .rounded();
    let frame = MeshSetup::new(&view, 320, 180, glint_core::mesh::MAX_RADIUS)?;
    for volume in [Clip::Guard, view_volume(1.5)] {
        let frame = frame.with_clip(volume)?;
        let inside = [[0, 8192, 0], [2000, 9000, 0]].map(|p| transform(&frame, p));
        let vertex = transform(&frame, position);
        ensure!(vertex.z == 0, "{position:?} is not in the plane of the eye");
        let mut space = Default::default();
        let vertices = clip(&frame, [inside[0], vertex, inside[1]], &mut space);
        if vertices.len() < 3 || vertices.iter().any(|v| v.z < frame.near) {
            return Ok(Outcome::exact(format!("{vertices:?}")));
        }
    }
    Ok(Outcome::exact(
        "cut off: the rest is at the near plane or beyond",
    ))
}

/// Draws a cube of side 0.2 at this position with a far plane at 3. A cube whose middle is at a depth of at most 2 must look the same
/// without a far plane.
fn object_at(place: [f64; 3]) -> Result<Outcome> {
    let bytes = Model::cube(1638).encoded();
    let drawn = |clip: Clip| -> Result<_> {
        let mut object = object(&bytes, Matrix::translation(place.map(number))?);
        (object.subject.clip, object.subject.cull) = (clip, false);
        let objects = [object];
        let frame = Frame::new(Subject::Objects(&objects), ahead(0.1), Size::W320);
        let picture = Picture::of_frame(&frame);
        Ok((picture.stats.drawn, picture.covered()))
    };
    let (triangles, pixels) = drawn(view_volume(3.0))?;
    if place[1] <= 0.0 {
        let unlimited = drawn(Clip::Guard)?;
        ensure!(
            unlimited == (triangles, pixels),
            "without a far plane {unlimited:?}"
        );
    }
    Ok(Outcome::exact(format!(
        "{triangles} triangles on {pixels} pixels"
    )))
}
