//! The mesh that is shown and room for the next one, and fields with a name.

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
    /// A buffer of `memory`, at a multiple of 16 bytes.
    pub const fn new(memory: &'static mut [u8]) -> Self {
        Self { memory }
    }
}

/// Which model is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The one in the program, so that there is something to see before any upload.
    Cube,
    /// The one uploaded last.
    Uploaded,
}

impl Model {
    /// Every model, in the order of help texts.
    pub const ALL: [Self; 2] = [Self::Cube, Self::Uploaded];

    /// Its name on the console.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cube => "cube",
            Self::Uploaded => "model",
        }
    }
}

/// Fields that are shown by a name as models are.
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

/// Both meshes, and two buffers of which the one that holds no mesh takes the next upload.
pub struct Models {
    buffers: [Buffer; 2],
    /// The uploaded mesh; it lies in the first buffer.
    uploaded: Option<Mesh<'static>>,
    shown: Model,
    cube: Mesh<'static>,
}

impl Models {
    /// No upload yet; the cube is shown.
    ///
    /// # Errors
    /// When the program's own cube is not a mesh.
    pub fn new(buffers: [Buffer; 2]) -> Result<Self, MeshError> {
        let cube = Mesh::new_checked(&cube::BYTES)?;
        Ok(Self {
            buffers,
            uploaded: None,
            shown: Model::Cube,
            cube,
        })
    }

    /// The mesh that is shown.
    pub fn mesh(&self) -> &Mesh<'_> {
        match (self.shown, &self.uploaded) {
            (Model::Uploaded, Some(mesh)) => mesh,
            _ => &self.cube,
        }
    }

    /// Which model that is.
    pub const fn shown(&self) -> Model {
        self.shown
    }

    /// Whether there is such a model.
    pub const fn has(&self, model: Model) -> bool {
        matches!(model, Model::Cube) || self.uploaded.is_some()
    }

    /// Shows another model, if there is one, and tells whether there is.
    pub const fn show(&mut self, model: Model) -> bool {
        let exists = self.has(model);
        if exists {
            self.shown = model;
        }
        exists
    }

    /// Where the next upload goes: never over the mesh that is shown.
    pub fn staging(&mut self) -> &mut [u8] {
        self.buffers[1].memory
    }

    /// Checks the first `length` bytes of [`staging`](Self::staging) and shows them as the uploaded model.
    ///
    /// # Errors
    /// When they are not a mesh; then nothing changes.
    pub fn accept(&mut self, length: usize) -> Result<(), MeshError> {
        let staged = self.buffers[1].memory.get(..length).unwrap_or_default();
        // SAFETY: the memory is 'static. The mesh is kept as `uploaded` of these bytes' buffer, which below becomes the
        // first; only `staging` lends a buffer for writing, always the second, and the two change places only here,
        // where the mesh that looked at the other one is dropped.
        let staged: &'static [u8] = unsafe { slice::from_raw_parts(staged.as_ptr(), staged.len()) };
        self.uploaded = Some(Mesh::new_checked(staged)?);
        self.buffers.swap(0, 1);
        self.shown = Model::Uploaded;
        Ok(())
    }
}
