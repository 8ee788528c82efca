//! The surface visible at each pixel of the model's picture.

use anyhow::{Result, bail, ensure};
use glint_core::colour::Shading;
use glint_core::field::Surface;
use glint_core::light::MeshLighting;
use glint_core::mesh::Rgb565;
use glint_model::raymarch::{State, Tracer};
use glint_model::triangle::raster;
use glint_model::{Frame, MeshSubject, Object, Projected, Subject};
use glint_vectors::Picture;

use super::seen::{Eyes, Seen};
use crate::raymarch::Face;

/// Returns the surface visible at each pixel of the model's picture, row by row.
///
/// # Errors
/// The model cannot draw the frame, or it has meshes for two eyes or edges of a mesh.
pub fn seen(frame: &Frame) -> Result<Vec<Eyes>> {
    let [width, height] = frame.size.pixels();
    let mut buffer = Picture::blank((width, height));
    buffer.colour.fill(0);
    if let Subject::Wireframe(_) = frame.subject {
        frame.draw(
            &frame.constants()?,
            &mut buffer.target(),
            &mut [],
            &mut || {},
        )?;
        let seen = |&colour| match colour {
            0 => Seen::Background,
            _ => Seen::Line,
        };
        return Ok(buffer
            .colour
            .iter()
            .map(|colour| [seen(colour); 2])
            .collect());
    }
    let triangles = match frame.subject {
        Subject::Field(_) => Vec::new(),
        _ => draw_triangles(frame, &mut buffer)?,
    };
    let mut seen: Vec<Eyes> = buffer
        .colour
        .iter()
        .map(|&number| {
            [number
                .checked_sub(1)
                .map_or(Seen::Background, |number| triangles[usize::from(number)]); 2]
        })
        .collect();
    let constants = frame.constants()?;
    if let Some(field) = constants.field() {
        let setup = &field.setup;
        let tracer = setup.tracer();
        let eyes = 1 + usize::from(setup.stereo.is_some());
        let places = (0..setup.height).flat_map(|y| (0..setup.width).map(move |x| (x, y)));
        for (place, (x, y)) in places.enumerate() {
            for (eye, seen) in seen[place].iter_mut().enumerate().take(eyes) {
                let (surface, code) = surface(&tracer, eye, x, y);
                // At equal depths, the field is in front of the triangle.
                if code >= buffer.depth[place] && surface != Seen::Background {
                    *seen = surface;
                }
            }
            if eyes == 1 {
                seen[place][1] = seen[place][0];
            }
        }
    }
    Ok(seen)
}

/// End of a ray of a field, and its depth code.
fn surface(tracer: &Tracer, eye: usize, x: u32, y: u32) -> (Seen, u32) {
    let end = tracer.trace(eye, x, y);
    let State::Hit(surface) = end.state else {
        return (Seen::Background, 0);
    };
    let face = match surface {
        Surface::Face { axis, positive } => Face::Axis {
            axis: axis.into(),
            positive,
        },
        Surface::Octant { signs } => Face::Diagonal {
            positive: [0, 1, 2].map(|i| signs >> i & 1 == 1),
        },
        Surface::Round { .. } | Surface::Blended { .. } => Face::Round,
    };
    let sphere = surface.number().unwrap_or(0).into();
    (
        Seen::Surface { face, sphere },
        tracer.setup.depth_code(&end),
    )
}

/// Draws the triangles of a frame. The colour of a triangle is its index in the returned list, counted from 1.
fn draw_triangles(frame: &Frame, buffer: &mut Picture) -> Result<Vec<Seen>> {
    ensure!(frame.stereo.is_none(), "expected meshes for one eye");
    let flat = |subject| MeshSubject {
        shading: Shading::Flat,
        ..subject
    };
    let objects = frame.subject.objects();
    // In full ambient light a flat triangle has its object's colour, which is the object's index here.
    let numbered = objects.unwrap_or_default().iter().zip(0..);
    let numbered = numbered.map(|(object, number)| Object {
        subject: flat(object.subject),
        colour: Some(Rgb565(number)),
        ..*object
    });
    let numbered: Vec<_> = numbered.collect();
    let frame = &Frame {
        subject: match frame.subject {
            Subject::Mesh(mesh) => Subject::Mesh(flat(mesh)),
            Subject::MeshInField(mesh, field) => Subject::MeshInField(flat(mesh), field),
            Subject::Objects(_) => Subject::Objects(&numbered),
            _ => bail!("expected a mesh, objects or a field"),
        },
        lighting: MeshLighting {
            ambient: [0xFF; 3],
            ..frame.lighting
        },
        ..*frame
    };
    let constants = frame.constants()?;
    let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
    let mut target = buffer.target();
    let mut triangles = Vec::new();
    frame.set_up_meshes(&constants, &mut scratch, &mut |triangle, setup, _| {
        let object = objects.map_or(0, |_| triangle.colour.0.into());
        triangles.push(Seen::Triangle {
            object,
            index: triangle.index as usize,
        });
        raster::draw(setup, Rgb565(triangles.len() as u16), &mut target);
    })?;
    ensure!(
        triangles.len() <= usize::from(u16::MAX),
        "expected at most {} triangles",
        u16::MAX
    );
    Ok(triangles)
}
