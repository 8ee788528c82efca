//! Meshes and wireframe programs, built-in and uploaded, and the staging memory for the next upload.

use core::slice;

use glint_core::allocator::Region;
use glint_core::deviation::Deviation;
use glint_core::mesh::Mesh;
use glint_core::shape::Shape;
use glint_core::wireframe::{Program, ProgramError};
use glint_model::Frame;
use glint_scene::{Assets, Name, Scene};
use heapless::Vec;

use crate::arena::{Arena, Loan};
use crate::objects::Objects;
use crate::shapes::Shapes;

/// Name of a mesh that is uploaded without a name.
pub const MODEL: &str = "model";
/// Largest number of uploaded meshes.
pub const MAX_MESHES: usize = 16;

/// A mesh and its name.
struct Named {
    name: Name,
    mesh: Mesh<'static>,
}

/// Reason why a name is not allowed for an upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameError {
    /// The name is the name of a scene.
    Scene,
    /// There are [`MAX_MESHES`] meshes with other names.
    Full,
}

/// The built-in meshes and program, the uploads in an arena, and the objects made of the meshes. An uploaded mesh replaces a built-in mesh
/// of equal name.
pub struct Models {
    arena: Arena,
    /// The uploaded meshes and their memory.
    meshes: Vec<(Named, Region), MAX_MESHES>,
    /// The uploaded program and its memory.
    program: Option<(Program<'static>, Region)>,
    shapes: Shapes,
    /// The built-in program, shown until a program is uploaded.
    cube_program: Program<'static>,
    objects: Objects,
    /// The mesh of the scene of the last [`update`](Models::update). The mesh is stored, because finding it
    /// by its name takes a thousand clock cycles, and every step of drawing a frame needs it.
    shown: Mesh<'static>,
    revision: u32,
    /// Largest number of triangles of an uploaded mesh.
    most_triangles: u32,
}

impl Models {
    /// Makes the initial models. `shapes` is memory for the built-in meshes, `turned` is memory for copies of meshes with transformed
    /// normals, `cube_program` is the built-in wireframe program, and `most_triangles` the largest number of triangles of an uploaded mesh.
    ///
    /// # Errors
    /// [`Deviation`] for a damaged cube.
    pub fn new(
        arena: Arena,
        shapes: &'static mut [u8],
        turned: Arena,
        cube_program: Program<'static>,
        most_triangles: u32,
    ) -> Result<Self, Deviation> {
        let shapes = Shapes::new(shapes)?;
        Ok(Self {
            arena,
            meshes: Vec::new(),
            program: None,
            shown: shapes.cube(),
            shapes,
            cube_program,
            objects: Objects::new(turned),
            revision: 0,
            most_triangles,
        })
    }

    /// Largest number of triangles of an uploaded mesh.
    pub const fn most_triangles(&self) -> u32 {
        self.most_triangles
    }

    /// A number that changes with each change of the uploads.
    pub const fn revision(&self) -> u32 {
        self.revision
    }

    /// The mesh of `scene`, with or without a field; the cube if the mesh does not exist.
    pub fn mesh(&self, scene: &Scene) -> Mesh<'_> {
        self.known(&scene.mesh).unwrap_or(self.shapes.cube())
    }

    /// The frame of `scene`, with mesh and objects as of the last [`update`](Self::update).
    pub fn frame<'a>(&'a self, scene: &'a Scene) -> Frame<'a> {
        scene.frame(Assets {
            mesh: Some(self.shown),
            objects: self.objects.all(),
            program: *self.program(),
        })
    }

    /// Prepares mesh and objects of `scene` for the next frame. Calls `progress` at short intervals.
    pub fn update(&mut self, scene: &Scene, progress: &mut dyn FnMut()) {
        let mesh = known(&self.meshes, &self.shapes, &scene.mesh);
        self.shown = mesh.unwrap_or(self.shapes.cube());
        if scene.shows_objects() {
            let Self {
                objects,
                meshes,
                shapes,
                ..
            } = self;
            objects.update(scene, |name| known(meshes, shapes, name), progress);
        }
    }

    /// The uploaded wireframe program, or else the built-in one.
    pub fn program(&self) -> &Program<'_> {
        self.uploaded_program().unwrap_or(&self.cube_program)
    }

    /// The uploaded program, if any.
    pub fn uploaded_program(&self) -> Option<&Program<'_>> {
        self.program.as_ref().map(|(program, _)| program)
    }

    /// Names and meshes of the uploads.
    pub fn uploads(&self) -> impl Iterator<Item = (&str, &Mesh<'_>)> + Clone {
        let uploads = self.meshes.iter();
        uploads.map(|(named, _)| (named.name.as_str(), &named.mesh))
    }

    /// Names of the built-in meshes that no upload replaces.
    pub fn built_in(&self) -> impl Iterator<Item = &'static str> {
        Shapes::names().filter(move |built_in| self.uploads().all(|(name, _)| name != *built_in))
    }

    /// Number of free bytes.
    pub fn free(&self) -> usize {
        self.arena.free()
    }

    /// A built-in shape; `None` if its memory is too small.
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

    /// Whether there is a mesh with this name. Makes a built-in shape on first use.
    pub fn prepare(&mut self, name: &str) -> bool {
        self.has_upload(name) || self.shapes.named(name).is_some()
    }

    /// The mesh with this name, if it is an upload or a built-in mesh that has been made.
    pub fn known(&self, name: &str) -> Option<Mesh<'_>> {
        known(&self.meshes, &self.shapes, name)
    }

    /// The staging memory for the next upload, which is separate from all uploads.
    pub fn staging(&mut self) -> &mut [u8] {
        self.arena.staging()
    }

    /// Checks that the list of meshes has a place for an upload with this name. An upload in progress counts as a mesh.
    ///
    /// # Errors
    /// [`NameError::Full`].
    pub fn check_capacity(&self, name: &str) -> Result<(), NameError> {
        if self.meshes.len() + self.arena.lent() >= MAX_MESHES && !self.has_upload(name) {
            return Err(NameError::Full);
        }
        Ok(())
    }

    /// Lends the first `length` bytes of the staging memory; `None` if the free memory is smaller. This may move uploads, so no frame may
    /// be in progress.
    pub fn lend(&mut self, length: usize) -> Option<Loan> {
        let moves = self.arena.lent() == 0;
        if moves && (self.arena.staging().len() + 1..=self.arena.free()).contains(&length) {
            self.compact();
        }
        self.arena.lend(length)
    }

    /// Takes back memory that [`lend`](Self::lend) has lent. The bytes stay unchanged in the staging memory.
    pub fn give_back(&mut self, loan: Loan) {
        self.arena.give_back(loan);
    }

    /// Checks lent memory as a mesh, and keeps the mesh under `name`; it replaces an earlier mesh of this name. No frame may be in
    /// progress.
    ///
    /// # Errors
    /// [`Deviation`] for an invalid mesh, or one of too many triangles; then nothing changes, and the memory is given back.
    pub fn accept(&mut self, name: &str, loan: Loan) -> Result<(), Deviation> {
        let length = loan.as_ref().len();
        let region = self.arena.keep_lent(loan);
        let mesh = Mesh::new_checked(self.lasting(region, length));
        let mesh = match mesh.and_then(|mesh| mesh.with_at_most(self.most_triangles)) {
            Ok(mesh) => mesh,
            Err(error) => {
                self.arena.release(region);
                return Err(error);
            }
        };
        self.revise();
        let new = (named(name, mesh), region);
        let old = self.meshes.iter_mut().find(|(old, _)| old.name == name);
        match old {
            Some(old) => {
                let (_, unused) = core::mem::replace(old, new);
                self.arena.release(unused);
            }
            // The caller has checked that the list is not full.
            None => drop(self.meshes.push(new)),
        }
        Ok(())
    }

    /// Records a change of the uploads. Drops every reference to an uploaded mesh except those in the list of uploads: empties the list of
    /// objects, and shows the cube.
    fn revise(&mut self) {
        self.revision = self.revision.wrapping_add(1);
        self.objects.truncate(0);
        self.shown = self.shapes.cube();
    }

    /// Checks lent memory as a wireframe program, and keeps the program; it replaces the last program. No frame may be in progress.
    ///
    /// # Errors
    /// [`ProgramError`] for an invalid program; then nothing changes, and the memory is given back.
    pub fn accept_program(&mut self, loan: Loan) -> Result<(), ProgramError<'static>> {
        let length = loan.as_ref().len();
        let region = self.arena.keep_lent(loan);
        match Program::new_checked(self.lasting(region, length)) {
            Ok(program) => {
                self.revise();
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

    /// Removes an uploaded mesh, and closes the gap by moving other uploads, so no frame may be in progress. Returns whether the mesh
    /// existed.
    pub fn remove(&mut self, name: &str) -> bool {
        let Some(position) = self.meshes.iter().position(|(named, _)| named.name == name) else {
            return false;
        };
        let (_, region) = self.meshes.remove(position);
        self.arena.release(region);
        self.compact();
        true
    }

    /// Moves all uploads so that one gap remains.
    fn compact(&mut self) {
        self.revise();
        let cube = self.shapes.cube();
        // No references into the arena may exist while it moves its regions.
        let lengths: Vec<usize, MAX_MESHES> = self
            .meshes
            .iter_mut()
            .map(|(named, _)| {
                let length = named.mesh.bytes().len();
                named.mesh = cube;
                length
            })
            .collect();
        let program = self.program.take();
        let program = program.map(|(program, region)| (program.bytes().len(), region));

        self.arena.compact();
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
    }

    /// The first `length` bytes of a region, for a mesh or a program that borrows them.
    fn lasting(&self, region: Region, length: usize) -> &'static [u8] {
        let bytes = self.arena.bytes(region, length);
        // SAFETY: the memory is 'static. All borrowers of these bytes are dropped, or are in the private fields `meshes`, `program`,
        // `objects` and `shown`. `accept`, `accept_program` and `remove` take a borrower out of these fields before they release its
        // region, and `compact` before it moves the regions; the arena lends only gaps mutably.
        unsafe { slice::from_raw_parts(bytes.as_ptr(), bytes.len()) }
    }
}

fn known(meshes: &[(Named, Region)], shapes: &Shapes, name: &str) -> Option<Mesh<'static>> {
    let mut uploads = meshes.iter().map(|(named, _)| named);
    let upload = uploads.find(|named| named.name == name);
    upload.map_or_else(|| shapes.made(name), |named| Some(named.mesh))
}

/// A mesh and its name, which has at most [`MAX_NAME`] bytes.
fn named(name: &str, mesh: Mesh<'static>) -> Named {
    Named {
        name: Name::try_from(name).unwrap_or_default(),
        mesh,
    }
}
