//! Warnings about pictures that do not show the requested subject.

use super::{Frame, Stats};
use glint_model::RenderError;

/// The warnings about a frame with these statistics, each with a remedy.
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
    if let Some(counts) = &stats.mesh
        && counts.triangles_in > 0
        && counts.triangles_drawn == 0
    {
        remarks.push(if frame.subject.meshes().any(|mesh| mesh.culls()) {
            "no triangle is drawn: all face away, or lie outside of the picture; --no-cull draws back faces, --look-at moves the camera"
                .to_owned()
        } else {
            "no triangle is drawn: all lie outside of the picture; --look-at moves the camera"
                .to_owned()
        });
    }
    Ok(remarks)
}
