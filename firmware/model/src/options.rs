//! The options that all meshes of a scene have.

use glint_core::colour::{Shading, Winding};
use glint_core::mesh::Mesh;

use crate::frame::MeshSubject;
use crate::triangle::Clip;

/// Options that all meshes of a scene have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshOptions {
    /// Whether back faces are left out.
    pub cull: bool,
    /// Source of the colours.
    pub shading: Shading,
    /// Clipping of triangles.
    pub clip: Clip,
    /// The rule that tells which side of a triangle is seen.
    pub winding: Winding,
}

/// The options of [`MeshSubject::new`].
impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            cull: true,
            shading: Shading::Flat,
            clip: Clip::Guard,
            winding: Winding::Mesh,
        }
    }
}

impl MeshOptions {
    /// A mesh with these options.
    pub const fn subject<'a>(&self, mesh: Mesh<'a>) -> MeshSubject<'a> {
        MeshSubject {
            mesh,
            cull: self.cull,
            shading: self.shading,
            clip: self.clip,
            winding: self.winding,
        }
    }
}
