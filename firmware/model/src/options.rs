//! Drawing options that all meshes of a scene share.

use glint_core::colour::{Shading, Winding};
use glint_core::mesh::Mesh;

use crate::frame::MeshSubject;
use crate::triangle::Clip;

/// Drawing options that all meshes of a scene share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshOptions {
    /// Whether back faces are culled.
    pub cull: bool,
    /// Source of the colours: triangles (flat) or vertices (smooth).
    pub shading: Shading,
    /// The volume to which triangles are clipped.
    pub clip: Clip,
    /// The rule that selects the visible side of a triangle.
    pub winding: Winding,
    /// Whether the textures of the mesh are drawn.
    pub textures: bool,
}

/// The options of [`MeshSubject::new`].
impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            cull: true,
            shading: Shading::Flat,
            clip: Clip::Guard,
            winding: Winding::Mesh,
            textures: true,
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
            textures: self.textures,
        }
    }
}
