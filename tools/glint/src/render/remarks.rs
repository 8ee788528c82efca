//! Warnings about pictures that do not show the requested subject.

use super::model::picture_of_one;
use super::{Frame, Stats, Subject};
use glint_core::picture::{Samples, Size};
use glint_model::{MeshSubject, Object, RenderError};

/// Returns the warnings about a frame with these statistics. Each warning names a remedy.
///
/// # Errors
/// The frame cannot be drawn.
pub fn remarks(frame: &Frame, stats: &Stats) -> Result<Vec<String>, RenderError> {
    let mut remarks = Vec::new();
    let mut inside = None;
    for eye in frame.drawn()? {
        let constants = eye.constants()?;
        let field = constants.field();
        if field.is_some_and(|field| field.setup.has_eye_inside()) {
            inside = inside.or(Some(eye.view.eye()));
        }
    }
    if let Some([x, y, z]) = inside {
        remarks.push(format!(
            "the eye ({x}, {y}, {z}) is inside the field, and sees one surface in all directions: move it with --camera or --look-at, \
             or choose another --field"
        ));
    }
    if frame.replacement_texture.is_some() && !frame.subject.meshes().any(MeshSubject::has_textures)
    {
        let is_off = frame.subject.meshes().any(|mesh| !mesh.textures);
        remarks.push(if is_off {
            "textures are off, so the replacement texture is not shown: expected `textures = true` in the scene, or no --no-textures"
                .to_owned()
        } else {
            "no face has a texture, so the replacement texture is not shown: expected a mesh with texture coordinates and a texture"
                .to_owned()
        });
    }
    let culls = frame.subject.meshes().any(|mesh| mesh.culls());
    if let Some(counts) = &stats.mesh
        && culls
        && (1..=counts.triangles_culled).contains(&counts.triangles_drawn)
        && shows_backs(frame)?
    {
        remarks.push(
            "most surfaces in view are back faces, which are not drawn: --no-cull draws them; if the mesh is inside out, \
             glint convert --fix-winding reverses its faces"
                .to_owned(),
        );
    }
    if let Some(counts) = &stats.mesh
        && counts.triangles_in > 0
        && counts.triangles_drawn == 0
    {
        remarks.push(if culls {
            "no triangle is drawn: all face away, or lie outside of the picture; --no-cull draws back faces, --look-at moves the camera"
                .to_owned()
        } else {
            "no triangle is drawn: all lie outside of the picture; --look-at moves the camera"
                .to_owned()
        });
    }
    Ok(remarks)
}

/// Whether culled back faces would cover at least half of the pixels with a surface. False for a
/// subject with a field, edges or a wireframe.
fn shows_backs(frame: &Frame) -> Result<bool, RenderError> {
    fn uncull<'a>(subject: &MeshSubject<'a>) -> MeshSubject<'a> {
        MeshSubject {
            cull: false,
            ..*subject
        }
    }
    let objects: Vec<Object>;
    let subject = match &frame.subject {
        Subject::Mesh(mesh) => Subject::Mesh(uncull(mesh)),
        Subject::Objects(culled) => {
            let culled = culled.iter();
            objects = culled
                .map(|object| Object {
                    subject: uncull(&object.subject),
                    ..*object
                })
                .collect();
            Subject::Objects(&objects)
        }
        _ => return Ok(false),
    };
    let culled = Frame {
        size: Size::W320,
        samples: Samples::One,
        stereo: None,
        ..*frame
    };
    let (culled, _) = picture_of_one(&culled)?;
    let (whole, _) = picture_of_one(&Frame {
        subject,
        size: Size::W320,
        samples: Samples::One,
        stereo: None,
        ..*frame
    })?;
    let depths = culled.depth.iter().zip(&whole.depth);
    let covered = depths.filter(|(_, whole)| **whole > 0);
    let (backs, fronts): (Vec<_>, Vec<_>) = covered.partition(|(culled, whole)| culled != whole);
    Ok(!backs.is_empty() && backs.len() >= fronts.len())
}
