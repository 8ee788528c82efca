//! Meshes and named fields: the built-in mesh, the uploaded one, and the staging memory for the next upload.

use core::slice;

use glint_core::field::{Cubes, Field, Menger, Primitive};
use glint_core::fixed::Q32_32;
use glint_core::mesh::{Mesh, MeshError};

use crate::cube;

/// Memory for one mesh.
pub struct Buffer {
    memory: &'static mut [u8],
}

impl Buffer {
    /// A buffer in `memory`, aligned to 16 bytes.
    pub const fn new(memory: &'static mut [u8]) -> Self {
        Self { memory }
    }
}

/// A mesh that the console can show by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The built-in cube, shown until a mesh is uploaded.
    Cube,
    /// The mesh that was uploaded last.
    Uploaded,
}

impl Model {
    /// Every model, in the order of help texts.
    pub const ALL: [Self; 2] = [Self::Cube, Self::Uploaded];

    /// The name on the console.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cube => "cube",
            Self::Uploaded => "model",
        }
    }
}

/// Fields that the command `scene` shows, with their names.
pub const FIELDS: [(&str, Field); 2] = [
    (
        "sponge-field",
        Field::Primitive(Primitive::Menger(Menger { depth: 4 })),
    ),
    (
        "cubes-field",
        Field::Primitive(Primitive::Cubes(Cubes {
            period: Q32_32::lit("2"),
            half: Q32_32::lit("0.5"),
        })),
    ),
];

/// The built-in and the uploaded mesh, and two buffers: one for the uploaded mesh, one as staging memory.
pub struct Models {
    buffers: [Buffer; 2],
    /// The uploaded mesh, in the first buffer.
    uploaded: Option<Mesh<'static>>,
    shown: Model,
    cube: Mesh<'static>,
}

impl Models {
    /// The models at start: the cube is shown.
    ///
    /// # Errors
    /// [`MeshError`] for a damaged cube.
    pub fn new(buffers: [Buffer; 2]) -> Result<Self, MeshError> {
        let cube = Mesh::new_checked(&cube::BYTES)?;
        Ok(Self {
            buffers,
            uploaded: None,
            shown: Model::Cube,
            cube,
        })
    }

    /// The shown mesh.
    pub fn mesh(&self) -> &Mesh<'_> {
        match (self.shown, &self.uploaded) {
            (Model::Uploaded, Some(mesh)) => mesh,
            _ => &self.cube,
        }
    }

    /// The shown model.
    pub const fn shown(&self) -> Model {
        self.shown
    }

    /// Whether the model exists: always true for the cube, and true for the upload after the first upload.
    pub const fn has(&self, model: Model) -> bool {
        matches!(model, Model::Cube) || self.uploaded.is_some()
    }

    /// Shows a model if it exists. Returns whether it exists.
    pub const fn show(&mut self, model: Model) -> bool {
        let exists = self.has(model);
        if exists {
            self.shown = model;
        }
        exists
    }

    /// The staging memory for the next upload, which is separate from the shown mesh.
    pub fn staging(&mut self) -> &mut [u8] {
        self.buffers[1].memory
    }

    /// Checks the first `length` bytes of [`staging`](Self::staging) as a mesh, and shows this mesh
    /// as the uploaded model.
    ///
    /// # Errors
    /// [`MeshError`] for an invalid mesh; then nothing changes.
    pub fn accept(&mut self, length: usize) -> Result<(), MeshError> {
        let staged = self.buffers[1].memory.get(..length).unwrap_or_default();
        // SAFETY: the memory is 'static. The mesh is stored as `uploaded`, and its buffer becomes the first buffer
        // below. Only `staging` lends a buffer for writing, and always lends the second buffer. Only this function swaps
        // the buffers, and it drops the old mesh when it does so.
        let staged: &'static [u8] = unsafe { slice::from_raw_parts(staged.as_ptr(), staged.len()) };
        self.uploaded = Some(Mesh::new_checked(staged)?);
        self.buffers.swap(0, 1);
        self.shown = Model::Uploaded;
        Ok(())
    }
}
