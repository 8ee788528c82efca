//! Meshes, wireframe programs and named fields: the built-in ones, the uploaded one, and the staging memory for the next upload.

use core::slice;

use glint_core::field::{Cubes, Field, Menger, Primitive};
use glint_core::fixed::Q32_32;
use glint_core::mesh::{Mesh, MeshError};
use glint_core::object::Place;
use glint_core::wireframe::{Program, ProgramError};

use crate::cube;
use crate::objects::{ObjectError, Objects};

/// Memory for one mesh or wireframe program.
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

    /// The model with this name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
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

/// The last upload.
enum Upload {
    Mesh(Mesh<'static>),
    Program(Program<'static>),
}

/// The built-in mesh and program, and two buffers: one for the uploaded mesh or program, one as staging memory.
pub struct Models {
    buffers: [Buffer; 2],
    /// The uploaded mesh or program, in the first buffer.
    uploaded: Option<Upload>,
    shown: Model,
    cube: Mesh<'static>,
    /// The built-in program, shown until a program is uploaded.
    cube_program: Program<'static>,
    objects: Objects,
}

impl Models {
    /// The models at start: the cube is shown. `cube_program` is the built-in wireframe program.
    ///
    /// # Errors
    /// [`MeshError`] for a damaged cube.
    pub fn new(buffers: [Buffer; 2], cube_program: Program<'static>) -> Result<Self, MeshError> {
        let cube = Mesh::new_checked(&cube::BYTES)?;
        Ok(Self {
            buffers,
            uploaded: None,
            shown: Model::Cube,
            cube,
            cube_program,
            objects: Objects::default(),
        })
    }

    /// The shown mesh.
    pub fn mesh(&self) -> &Mesh<'_> {
        match (self.shown, &self.uploaded) {
            (Model::Uploaded, Some(Upload::Mesh(mesh))) => mesh,
            _ => &self.cube,
        }
    }

    /// The wireframe program.
    pub const fn program(&self) -> &Program<'_> {
        match &self.uploaded {
            Some(Upload::Program(program)) => program,
            _ => &self.cube_program,
        }
    }

    /// The shown model.
    pub const fn shown(&self) -> Model {
        self.shown
    }

    /// Whether the model exists: always true for the cube, and true for the upload while a mesh is the last upload.
    pub const fn has(&self, model: Model) -> bool {
        matches!(model, Model::Cube) || matches!(self.uploaded, Some(Upload::Mesh(_)))
    }

    /// Shows a model if it exists. Returns whether it exists.
    pub const fn show(&mut self, model: Model) -> bool {
        let exists = self.has(model);
        if exists {
            self.shown = model;
        }
        exists
    }

    /// The objects.
    pub const fn objects(&self) -> &Objects {
        &self.objects
    }

    /// The objects, to change their places or to remove them.
    pub const fn objects_mut(&mut self) -> &mut Objects {
        &mut self.objects
    }

    /// Adds an object with the mesh of `model`, if it exists.
    pub fn add_object(&mut self, model: Model, place: &Place) -> Option<Result<(), ObjectError>> {
        let mesh = match (model, &self.uploaded) {
            (Model::Cube, _) => self.cube,
            (Model::Uploaded, Some(Upload::Mesh(mesh))) => *mesh,
            _ => return None,
        };
        Some(self.objects.add(model, mesh, place))
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
        let mesh = Mesh::new_checked(self.staged(length))?;
        self.keep(Upload::Mesh(mesh));
        self.shown = Model::Uploaded;
        Ok(())
    }

    /// Checks the first `length` bytes of [`staging`](Self::staging) as a wireframe program, and keeps the program in place of the
    /// last upload.
    ///
    /// # Errors
    /// [`ProgramError`] for an invalid program; then nothing changes.
    pub fn accept_program(&mut self, length: usize) -> Result<(), ProgramError<'static>> {
        let program = Program::new_checked(self.staged(length))?;
        self.keep(Upload::Program(program));
        self.shown = Model::Cube;
        Ok(())
    }

    /// The first `length` bytes of the staging memory, for [`keep`](Self::keep).
    fn staged(&self, length: usize) -> &'static [u8] {
        let staged = self.buffers[1].memory.get(..length).unwrap_or_default();
        // SAFETY: the memory is 'static. The callers drop the slice, or pass what borrows from it to `keep`, by which its buffer
        // becomes the first buffer. Only `staging` lends a buffer for writing, and always lends the second buffer. Only `keep`
        // swaps the buffers, and it drops the last upload, also from the objects, when it does so.
        unsafe { slice::from_raw_parts(staged.as_ptr(), staged.len()) }
    }

    /// Keeps an upload that borrows from the staging memory, in place of the last one.
    fn keep(&mut self, upload: Upload) {
        let mesh = match &upload {
            Upload::Mesh(mesh) => Some(*mesh),
            Upload::Program(_) => None,
        };
        self.objects.replace(Model::Uploaded, mesh);
        self.uploaded = Some(upload);
        self.buffers.swap(0, 1);
    }
}
