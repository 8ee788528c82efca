//! Meshes and wireframe programs: the built-in ones and the uploaded ones, and the staging memory for the next upload.

use core::slice;

use glint_core::mesh::{MAX_NAME, Mesh, MeshError};
use glint_core::object::Place;
use glint_core::regions::Region;
use glint_core::shape::Shape;
use glint_core::wireframe::{Program, ProgramError};
use heapless::{String, Vec};

use crate::arena::Arena;
use crate::objects::{ObjectError, Objects};
use crate::shapes::{CUBE, Shapes};

/// Name of a mesh that is uploaded without a name.
pub const MODEL: &str = "model";
/// Largest number of uploaded meshes.
pub const MAX_MESHES: usize = 16;

/// The name of a mesh.
pub type Name = String<MAX_NAME>;

/// A mesh and its name.
#[derive(Clone)]
struct Named {
    name: Name,
    mesh: Mesh<'static>,
}

/// Reason why no mesh can be uploaded under a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameError {
    /// The name is that of a scene.
    Scene,
    /// There are [`MAX_MESHES`] meshes with other names.
    Full,
}

/// Reason why a mesh cannot be removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemoveError {
    /// No uploaded mesh has the name.
    Unknown,
    /// The object with this number, from 1, has the mesh.
    Object(u32),
}

/// The built-in meshes and program, the uploaded ones side by side in an arena, and the objects that are made of the meshes. An
/// uploaded mesh replaces a built-in one with its name.
pub struct Models {
    arena: Arena,
    /// The uploaded meshes and their memory.
    meshes: Vec<(Named, Region), MAX_MESHES>,
    /// The uploaded program and its memory.
    program: Option<(Program<'static>, Region)>,
    /// The shown mesh.
    shown: Named,
    shapes: Shapes,
    /// The built-in program, shown until a program is uploaded.
    cube_program: Program<'static>,
    objects: Objects,
}

impl Models {
    /// The models at start: the cube is shown. `shapes` is memory for the built-in meshes, `turned` for copies of meshes with turned
    /// normals, and `cube_program` the built-in wireframe program.
    ///
    /// # Errors
    /// [`MeshError`] for a damaged cube.
    pub fn new(
        arena: Arena,
        shapes: &'static mut [u8],
        turned: Arena,
        cube_program: Program<'static>,
    ) -> Result<Self, MeshError> {
        let shapes = Shapes::new(shapes)?;
        Ok(Self {
            arena,
            meshes: Vec::new(),
            program: None,
            shown: named(CUBE, shapes.cube()),
            shapes,
            cube_program,
            objects: Objects::new(turned),
        })
    }

    /// The shown mesh.
    pub const fn mesh(&self) -> &Mesh<'_> {
        &self.shown.mesh
    }

    /// The name of the shown mesh.
    pub fn shown(&self) -> &str {
        &self.shown.name
    }

    /// The wireframe program.
    pub fn program(&self) -> &Program<'_> {
        self.uploaded_program().unwrap_or(&self.cube_program)
    }

    /// The uploaded program, if there is one.
    pub fn uploaded_program(&self) -> Option<&Program<'_>> {
        self.program.as_ref().map(|(program, _)| program)
    }

    /// Names and meshes of the uploads.
    pub fn uploads(&self) -> impl Iterator<Item = (&str, &Mesh<'_>)> + Clone {
        let uploads = self.meshes.iter();
        uploads.map(|(named, _)| (named.name.as_str(), &named.mesh))
    }

    /// Names of the built-in meshes that no upload has taken the place of.
    pub fn built_in(&self) -> impl Iterator<Item = &'static str> {
        Shapes::names().filter(move |built_in| self.uploads().all(|(name, _)| name != *built_in))
    }

    /// Number of bytes without an upload.
    pub fn free(&self) -> usize {
        self.arena.free()
    }

    /// Shows the mesh with this name. Returns whether it exists, and whether it was not shown before.
    pub fn show(&mut self, name: &str) -> Option<bool> {
        let mesh = self.find(name)?;
        let is_other = self.shown.name != name;
        self.shown = named(name, mesh);
        Some(is_other)
    }

    /// The objects.
    pub const fn objects(&self) -> &Objects {
        &self.objects
    }

    /// The objects, to change their places or to remove them.
    pub const fn objects_mut(&mut self) -> &mut Objects {
        &mut self.objects
    }

    /// Adds an object with the mesh of this name, if it exists.
    pub fn add_object(&mut self, name: &str, place: &Place) -> Option<Result<(), ObjectError>> {
        let mesh = self.find(name)?;
        Some(self.objects.add(&named(name, mesh).name, mesh, place))
    }

    /// A built-in shape; `None` if there is no memory for it.
    pub fn shape(&mut self, shape: Shape) -> Option<Mesh<'static>> {
        self.shapes.shape(shape)
    }

    /// Whether an uploaded mesh has this name.
    pub fn has_upload(&self, name: &str) -> bool {
        self.meshes.iter().any(|(named, _)| named.name == name)
    }

    /// Whether an uploaded or a built-in mesh has this name.
    pub fn has(&self, name: &str) -> bool {
        self.has_upload(name) || Shapes::names().any(|built_in| built_in == name)
    }

    fn find(&mut self, name: &str) -> Option<Mesh<'static>> {
        let uploaded = self.meshes.iter().find(|(named, _)| named.name == name);
        match uploaded {
            Some((named, _)) => Some(named.mesh),
            None => self.shapes.named(name),
        }
    }

    /// The staging memory for the next upload, which is separate from all uploads.
    pub fn staging(&mut self) -> &mut [u8] {
        self.arena.staging()
    }

    /// Checks that an upload may have this name, which is not that of a scene.
    ///
    /// # Errors
    /// The reason why not.
    pub fn check_name(&self, name: &str) -> Result<(), NameError> {
        if self.meshes.is_full() && !self.has_upload(name) {
            return Err(NameError::Full);
        }
        Ok(())
    }

    /// Returns the first `length` bytes of the staging memory; `None` if the free memory is shorter. This may move uploads, so no
    /// frame may be in progress.
    pub fn staging_of(&mut self, length: usize) -> Option<&mut [u8]> {
        if (self.arena.staging().len() + 1..=self.arena.free()).contains(&length) {
            self.close_gaps();
        }
        self.arena.staging().get_mut(..length)
    }

    /// Checks the first `length` bytes of [`staging`](Self::staging) as a mesh, and keeps them under `name`, instead of an earlier mesh
    /// of this name.
    ///
    /// # Errors
    /// [`MeshError`] for an invalid mesh; then nothing changes.
    pub fn accept(&mut self, name: &str, length: usize) -> Result<(), MeshError> {
        let Some(region) = self.arena.keep(length) else {
            // The caller has checked name and length, so this returns an error.
            return Mesh::new_checked(&[]).map(drop);
        };
        let mesh = match Mesh::new_checked(self.lasting(region, length)) {
            Ok(mesh) => mesh,
            Err(error) => {
                self.arena.release(region);
                return Err(error);
            }
        };
        let new = (named(name, mesh), region);
        if self.shown.name == name {
            self.shown = new.0.clone();
        }
        self.objects.replace(name, mesh);
        let old = self.meshes.iter_mut().find(|(old, _)| old.name == name);
        match old.map(|old| core::mem::replace(old, new.clone())) {
            Some((_, unused)) => self.arena.release(unused),
            // The caller has checked that the list is not full.
            None => drop(self.meshes.push(new)),
        }
        Ok(())
    }

    /// Checks the first `length` bytes of [`staging`](Self::staging) as a wireframe program, and keeps the program instead of the
    /// last one.
    ///
    /// # Errors
    /// [`ProgramError`] for an invalid program; then nothing changes.
    pub fn accept_program(&mut self, length: usize) -> Result<(), ProgramError<'static>> {
        let Some(region) = self.arena.keep(length) else {
            // The caller has checked the length, so this returns an error.
            return Program::new_checked(&[]).map(drop);
        };
        match Program::new_checked(self.lasting(region, length)) {
            Ok(program) => {
                if let Some((_, old)) = self.program.replace((program, region)) {
                    self.arena.release(old);
                }
                Ok(())
            }
            Err(error) => {
                self.arena.release(region);
                Err(error)
            }
        }
    }

    /// Removes an uploaded mesh, and moves the others together, so no frame may be in progress. If the mesh is shown, the cube is
    /// shown instead.
    ///
    /// # Errors
    /// No mesh has the name, or an object has the mesh.
    pub fn remove(&mut self, name: &str) -> Result<(), RemoveError> {
        let position = self.meshes.iter().position(|(named, _)| named.name == name);
        let position = position.ok_or(RemoveError::Unknown)?;
        if let Some(number) = self.objects.first_of(name) {
            return Err(RemoveError::Object(number));
        }
        let (_, region) = self.meshes.remove(position);
        if self.shown.name == name {
            self.shown = named(CUBE, self.shapes.cube());
        }
        self.arena.release(region);
        self.close_gaps();
        Ok(())
    }

    /// Moves all uploads together, so that one gap remains.
    fn close_gaps(&mut self) {
        let (shown, cube) = (self.shown.name.clone(), self.shapes.cube());
        // Nothing may borrow from the arena while it moves its regions.
        let lengths: Vec<usize, MAX_MESHES> = self
            .meshes
            .iter_mut()
            .map(|(named, _)| {
                let length = named.mesh.bytes().len();
                named.mesh = cube;
                length
            })
            .collect();
        let meshes = &self.meshes;
        self.objects.replace_all(|name| {
            let moves = meshes.iter().any(|(named, _)| named.name == name);
            moves.then_some(cube)
        });
        self.shown = named(CUBE, cube);
        let program = self.program.take();
        let program = program.map(|(program, region)| (program.bytes().len(), region));

        self.arena.close_gaps();
        for (index, length) in lengths.iter().enumerate() {
            let region = self.meshes.get(index).map(|(_, region)| *region);
            let mesh = region.map(|region| Mesh::new_checked(self.lasting(region, *length)));
            if let (Some((named, _)), Some(Ok(mesh))) = (self.meshes.get_mut(index), mesh) {
                named.mesh = mesh;
            }
        }
        if let Some((length, region)) = program {
            let program = Program::new_checked(self.lasting(region, length));
            self.program = program.ok().map(|program| (program, region));
        }
        let meshes = &self.meshes;
        self.objects.replace_all(|name| {
            let moved = meshes.iter().find(|(named, _)| named.name == name);
            moved.map(|(named, _)| named.mesh)
        });
        self.show(&shown);
    }

    /// The first `length` bytes of a region, for a mesh or a program that borrows them.
    fn lasting(&self, region: Region, length: usize) -> &'static [u8] {
        let bytes = self.arena.bytes(region, length);
        // SAFETY: the memory is 'static. What borrows these bytes is dropped, or kept in `meshes`, `program`, `shown` and `objects`,
        // which are private. `accept`, `accept_program` and `remove` take it out of these before they release its region, and
        // `close_gaps` before it moves the regions; the arena lends nothing but gaps for writing.
        unsafe { slice::from_raw_parts(bytes.as_ptr(), bytes.len()) }
    }
}

/// A mesh and its name, which has at most [`MAX_NAME`] bytes.
fn named(name: &str, mesh: Mesh<'static>) -> Named {
    Named {
        name: Name::try_from(name).unwrap_or_default(),
        mesh,
    }
}
