//! Meshes, textures and wireframe programs, built-in and uploaded, and the staging memory for the next upload.

use core::{fmt, mem, slice};

use glint_core::allocator::Region;
use glint_core::deviation::Deviation;
use glint_core::feature::{TEXTURE, WIREFRAME};
use glint_core::flash::Kind;
use glint_core::mesh::Mesh;
use glint_core::shape::Shape;
use glint_core::texture::{self, Texture};
use glint_core::wireframe::{CUBE_NAME, Program, ProgramError};
use glint_model::Frame;
use glint_program::shapes::Shapes;
use glint_scene::{Assets, CUBE, Name, Scene};
use heapless::Vec;

use crate::arena::{Arena, Loan, MAX_UPLOADS};
use crate::objects::Objects;

/// Default name of a mesh or a texture, used if the command `load` states none.
pub const MODEL: &str = "model";
/// Default name of a wireframe program, used if the command `program` states none.
pub const PROGRAM: &str = "program";

/// A mesh, a texture or a wireframe program, with its name and its memory.
struct Upload {
    name: Name,
    content: Content,
    region: Region,
}

/// The mesh, the texture or the wireframe program of an upload.
#[derive(Clone, Copy)]
enum Content {
    Mesh(Mesh<'static>),
    Texture(Texture<'static>),
    Program(Program<'static>),
}

impl Content {
    /// The kind of an upload by its first bytes: a texture, or else a mesh. A program has no mark in its first bytes, so the command states
    /// this kind.
    fn stated_kind(bytes: &[u8]) -> Kind {
        if bytes.starts_with(&texture::MAGIC) {
            Kind::Texture
        } else {
            Kind::Mesh
        }
    }

    /// Checks an upload as a texture or a program, or as a mesh for any other kind.
    fn new_checked(
        kind: Kind,
        bytes: &'static [u8],
        most_triangles: u32,
    ) -> Result<Self, UploadError> {
        if TEXTURE.is_built && kind == Kind::Texture {
            let texture = Texture::new_alone(bytes);
            return texture.map(Self::Texture).map_err(UploadError::Content);
        }
        if WIREFRAME.is_built && kind == Kind::Program {
            let program = Program::new_checked(bytes);
            return program.map(Self::Program).map_err(UploadError::Program);
        }
        let mesh = Mesh::new_checked(bytes).and_then(|mesh| mesh.with_at_most(most_triangles));
        mesh.map(Self::Mesh).map_err(UploadError::Content)
    }

    const fn kind(&self) -> Kind {
        match self {
            Self::Mesh(_) => Kind::Mesh,
            Self::Texture(_) => Kind::Texture,
            Self::Program(_) => Kind::Program,
        }
    }

    const fn bytes(&self) -> &'static [u8] {
        match self {
            Self::Mesh(mesh) => mesh.bytes(),
            Self::Texture(texture) => texture.bytes(),
            Self::Program(program) => program.bytes(),
        }
    }
}

/// Reason why a name is not allowed for an upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameError {
    /// A scene has this name.
    Scene,
    /// The name is the keyword for the own textures of meshes.
    Own,
    /// An upload of another kind (mesh, texture or program) has this name.
    OtherKind,
    /// There are already [`MAX_UPLOADS`] uploads with other names.
    Full,
}

/// Reason why an upload is refused.
#[derive(Clone, Copy, Debug)]
pub enum UploadError {
    /// The data are not a mesh or a texture, or a mesh of too many triangles.
    Content(Deviation),
    /// The data are not a wireframe program.
    Program(ProgramError<'static>),
    /// An upload of another kind would replace a mesh that the object with this number, from 1, shows.
    Object(u32),
}

impl fmt::Display for UploadError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Content(error) => error.fmt(f),
            Self::Program(error) => WIREFRAME.when_built(|| error.fmt(f)),
            Self::Object(number) => write!(
                f,
                "object {number} shows this mesh, expected `object remove {number}` first"
            ),
        }
    }
}

/// The built-in meshes and program, the uploads in an arena, and the objects with their meshes. An uploaded mesh or program replaces a
/// built-in one with the same name.
pub struct Models {
    arena: Arena,
    /// The uploaded meshes, textures and programs.
    uploads: Vec<Upload, MAX_UPLOADS>,
    shapes: Shapes,
    /// The built-in program.
    cube_program: Program<'static>,
    objects: Objects,
    /// The mesh of the scene at the last [`update`](Models::update). The mesh is stored, because every step of drawing a frame needs the
    /// mesh, and the search by name takes a thousand clock cycles.
    shown: Mesh<'static>,
    /// The replacement texture of the scene at the last [`update`](Models::update).
    replacement_texture: Option<Texture<'static>>,
    /// The wireframe program of the scene at the last [`update`](Models::update).
    program: Program<'static>,
    revision: u32,
    /// Largest number of triangles of an uploaded mesh.
    most_triangles: u32,
}

impl Models {
    /// Creates the initial models. `shapes` is memory for the built-in meshes, `turned` is memory for copies of meshes with transformed
    /// normals, `cube_program` is the built-in wireframe program, and `most_triangles` is the largest number of triangles of an uploaded
    /// mesh.
    pub fn new(
        arena: Arena,
        shapes: &'static mut [u8],
        turned: Arena,
        cube_program: Program<'static>,
        most_triangles: u32,
    ) -> Self {
        let shapes = Shapes::new(shapes);
        Self {
            arena,
            uploads: Vec::new(),
            program: cube_program,
            shown: shapes.cube(),
            replacement_texture: None,
            shapes,
            cube_program,
            objects: Objects::new(turned),
            revision: 0,
            most_triangles,
        }
    }

    /// Largest number of triangles of an uploaded mesh.
    pub const fn most_triangles(&self) -> u32 {
        self.most_triangles
    }

    /// A number that changes with each change of the uploads.
    pub const fn revision(&self) -> u32 {
        self.revision
    }

    /// The mesh that `scene` shows, with or without a field; the cube if the mesh does not exist.
    pub fn mesh(&self, scene: &Scene) -> Mesh<'_> {
        self.known(&scene.mesh).unwrap_or(self.shapes.cube())
    }

    /// The frame of `scene`, with the mesh, the objects, the texture and the program of the last [`update`](Self::update).
    pub fn frame<'a>(&'a self, scene: &'a Scene) -> Frame<'a> {
        scene.frame(Assets {
            mesh: Some(self.shown),
            objects: self.objects.all(),
            replacement_texture: self.replacement_texture,
            program: self.program,
        })
    }

    /// Prepares mesh, objects, texture and program of `scene` for the next frame. Calls `progress` at short intervals.
    pub fn update(&mut self, scene: &Scene, progress: &mut dyn FnMut()) {
        let mesh = known(&self.uploads, &self.shapes, &scene.mesh);
        self.shown = mesh.unwrap_or(self.shapes.cube());
        let texture = scene.texture.as_ref().filter(|_| TEXTURE.is_built);
        self.replacement_texture = texture.and_then(|name| of_name(&self.uploads, name)?.texture());
        if scene.wireframe().is_some() {
            let name = scene.program.as_deref().unwrap_or(PROGRAM);
            let program = of_name(&self.uploads, name).and_then(Upload::program);
            self.program = program.unwrap_or(self.cube_program);
        }
        if scene.shows_objects() {
            let Self {
                objects,
                uploads,
                shapes,
                ..
            } = self;
            objects.update(scene, |name| known(uploads, shapes, name), progress);
        }
    }

    /// The uploaded meshes with their names.
    pub fn meshes(&self) -> impl Iterator<Item = (&str, Mesh<'_>)> + Clone {
        let uploads = self.uploads.iter();
        uploads.filter_map(|upload| Some((upload.name.as_str(), upload.mesh()?)))
    }

    /// The uploaded textures with their names.
    pub fn textures(&self) -> impl Iterator<Item = (&str, Texture<'_>)> + Clone {
        let uploads = self.uploads.iter().filter(|_| TEXTURE.is_built);
        uploads.filter_map(|upload| Some((upload.name.as_str(), upload.texture()?)))
    }

    /// The uploaded wireframe programs with their names.
    pub fn programs(&self) -> impl Iterator<Item = (&str, Program<'_>)> + Clone {
        let uploads = self.uploads.iter().filter(|_| WIREFRAME.is_built);
        uploads.filter_map(|upload| Some((upload.name.as_str(), upload.program()?)))
    }

    /// The names of all uploads with their kinds.
    pub fn names(&self) -> impl Iterator<Item = (&Name, Kind)> {
        let uploads = self.uploads.iter();
        uploads.map(|upload| (&upload.name, upload.content.kind()))
    }

    /// Names of the built-in meshes that no upload replaces.
    pub fn built_in(&self) -> impl Iterator<Item = &'static str> {
        Shapes::names().filter(move |built_in| self.meshes().all(|(name, _)| name != *built_in))
    }

    /// Number of uploads.
    pub fn upload_count(&self) -> usize {
        self.uploads.len()
    }

    /// Number of free bytes for uploads.
    pub fn free(&self) -> usize {
        self.arena.free()
    }

    /// A built-in shape; `None` if its memory is too small.
    pub fn shape(&mut self, shape: Shape) -> Option<Mesh<'static>> {
        self.shapes.shape(shape)
    }

    /// Whether an upload of this kind has this name.
    pub fn has_upload(&self, kind: Kind, name: &str) -> bool {
        of_name(&self.uploads, name).is_some_and(|upload| upload.content.kind() == kind)
    }

    /// Whether an uploaded mesh has this name.
    pub fn has_mesh(&self, name: &str) -> bool {
        self.has_upload(Kind::Mesh, name)
    }

    /// Whether an uploaded texture has this name.
    pub fn has_texture(&self, name: &str) -> bool {
        TEXTURE.is_built && self.has_upload(Kind::Texture, name)
    }

    /// Whether an uploaded wireframe program or the built-in one has this name.
    pub fn has_program(&self, name: &str) -> bool {
        name == CUBE_NAME || self.has_upload(Kind::Program, name)
    }

    /// Whether an uploaded or a built-in mesh has this name.
    pub fn has(&self, name: &str) -> bool {
        self.has_mesh(name) || Shapes::names().any(|built_in| built_in == name)
    }

    /// Whether there is a mesh with this name. Makes a built-in shape on first use.
    pub fn prepare(&mut self, name: &str) -> bool {
        self.has_mesh(name) || self.shapes.named(name).is_some()
    }

    /// The mesh with this name, if it is an upload or a built-in mesh that has been made.
    pub fn known(&self, name: &str) -> Option<Mesh<'_>> {
        known(&self.uploads, &self.shapes, name)
    }

    /// The staging memory for the next upload, which is separate from all uploads.
    pub fn staging(&mut self) -> &mut [u8] {
        self.arena.staging()
    }

    /// Checks that the list of uploads has a free place for an upload with this name. An upload in progress takes a place.
    ///
    /// # Errors
    /// [`NameError::Full`].
    pub fn check_capacity(&self, name: &str) -> Result<(), NameError> {
        let is_new = of_name(&self.uploads, name).is_none();
        if self.uploads.len() + self.arena.lent() >= MAX_UPLOADS && is_new {
            return Err(NameError::Full);
        }
        Ok(())
    }

    /// Checks that a mesh, a texture or a program of the flash can become an upload with this name. Unlike an upload by the host, the copy
    /// must not replace another upload, because the demo also makes such copies.
    ///
    /// # Errors
    /// [`NameError::OtherKind`] or [`NameError::Full`].
    pub fn check_copy(&self, name: &str) -> Result<(), NameError> {
        if of_name(&self.uploads, name).is_some() {
            return Err(NameError::OtherKind);
        }
        self.check_capacity(name)
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

    /// Takes back memory that [`lend`](Self::lend) has lent. The bytes in the staging memory are unchanged.
    pub fn give_back(&mut self, loan: Loan) {
        self.arena.give_back(loan);
    }

    /// The number of the first object of `scene`, from 1, whose mesh is the upload with this name.
    pub fn object_of(&self, name: &str, scene: &Scene) -> Option<u32> {
        scene.first_object_of(name).filter(|_| self.has_mesh(name))
    }

    /// Checks lent memory as an upload of this kind, or for `None` of the kind that the first bytes indicate, and stores the upload under
    /// `name`. The upload replaces an earlier upload with this name; `scene` then no longer shows an earlier upload of another kind. No
    /// frame may be in progress.
    ///
    /// # Errors
    /// [`UploadError`]; nothing changes then, and the memory is given back.
    pub fn accept(
        &mut self,
        name: &str,
        kind: Option<Kind>,
        loan: Loan,
        scene: &mut Scene,
    ) -> Result<(), UploadError> {
        let length = loan.as_ref().len();
        let region = self.arena.keep_lent(loan);
        let bytes = self.lasting(region, length);
        let kind = kind.unwrap_or_else(|| Content::stated_kind(bytes));
        let content = Content::new_checked(kind, bytes, self.most_triangles);
        let content = content.and_then(|content| {
            let is_mesh = content.kind() == Kind::Mesh;
            match self.object_of(name, scene).filter(|_| !is_mesh) {
                Some(number) => Err(UploadError::Object(number)),
                None => Ok(content),
            }
        });
        let content = match content {
            Ok(content) => content,
            Err(error) => {
                self.arena.release(region);
                return Err(error);
            }
        };
        self.revise();
        let new = Upload {
            name: Name::try_from(name).unwrap_or_default(),
            content,
            region,
        };
        match self.uploads.iter_mut().find(|old| old.name == name) {
            Some(old) => {
                let unused = mem::replace(old, new);
                if unused.content.kind() != content.kind() {
                    unused.leave(scene);
                }
                self.arena.release(unused.region);
            }
            // The caller has checked that the list is not full.
            None => drop(self.uploads.push(new)),
        }
        Ok(())
    }

    /// Records a change of the uploads. Drops every reference to an upload outside of the list of uploads: empties the list of objects, and
    /// shows the cube with its own textures, or the built-in program.
    fn revise(&mut self) {
        self.revision = self.revision.wrapping_add(1);
        self.objects.truncate(0);
        self.shown = self.shapes.cube();
        self.replacement_texture = None;
        self.program = self.cube_program;
    }

    /// Removes an upload, which `scene` then no longer shows, and closes the gap by moving other uploads. No frame may be in progress.
    /// Returns whether the upload existed.
    pub fn remove(&mut self, name: &str, scene: &mut Scene) -> bool {
        let Some(position) = self.uploads.iter().position(|upload| upload.name == name) else {
            return false;
        };
        let removed = self.uploads.remove(position);
        removed.leave(scene);
        self.revise();
        self.arena.release(removed.region);
        self.compact();
        true
    }

    /// Moves all uploads so that one gap remains.
    fn compact(&mut self) {
        self.revise();
        let cube = Content::Mesh(self.shapes.cube());
        // No references into the arena may exist while the arena moves its regions.
        let contents: Vec<(Kind, usize), MAX_UPLOADS> = self
            .uploads
            .iter_mut()
            .map(|upload| mem::replace(&mut upload.content, cube))
            .map(|content| (content.kind(), content.bytes().len()))
            .collect();

        self.arena.compact();
        for (index, (kind, length)) in contents.iter().enumerate() {
            let region = self.uploads.get(index).map(|upload| upload.region);
            let content = region.map(|region| {
                let bytes = self.lasting(region, *length);
                Content::new_checked(*kind, bytes, self.most_triangles)
            });
            if let (Some(upload), Some(Ok(content))) = (self.uploads.get_mut(index), content) {
                upload.content = content;
            }
        }
    }

    /// The first `length` bytes of a region, for a mesh, a texture or a program that borrows them.
    fn lasting(&self, region: Region, length: usize) -> &'static [u8] {
        let bytes = self.arena.bytes(region, length);
        // SAFETY: the memory is 'static. All borrowers of these bytes are dropped, or are in the private fields `uploads`, `program`,
        // `objects`, `shown` and `replacement_texture`. `accept` and `remove` take a borrower out of these fields before they release its
        // region, and `compact` before it moves the regions; the arena lends only gaps mutably.
        unsafe { slice::from_raw_parts(bytes.as_ptr(), bytes.len()) }
    }
}

impl Upload {
    const fn mesh(&self) -> Option<Mesh<'static>> {
        match self.content {
            Content::Mesh(mesh) => Some(mesh),
            Content::Texture(_) | Content::Program(_) => None,
        }
    }

    const fn texture(&self) -> Option<Texture<'static>> {
        match self.content {
            Content::Texture(texture) => Some(texture),
            Content::Mesh(_) | Content::Program(_) => None,
        }
    }

    const fn program(&self) -> Option<Program<'static>> {
        match self.content {
            Content::Program(program) => Some(program),
            Content::Mesh(_) | Content::Texture(_) => None,
        }
    }

    /// Shows the cube, the own textures of meshes, or the program that was uploaded without a name, if `scene` shows this upload.
    fn leave(&self, scene: &mut Scene) {
        match self.content {
            Content::Mesh(_) if scene.mesh == self.name => scene.set_mesh(CUBE),
            Content::Mesh(_) => {}
            Content::Texture(_) => {
                scene.texture.take_if(|texture| *texture == self.name);
            }
            Content::Program(_) => {
                scene.program.take_if(|program| *program == self.name);
            }
        }
    }
}

fn of_name<'u>(uploads: &'u [Upload], name: &str) -> Option<&'u Upload> {
    uploads.iter().find(|upload| upload.name == name)
}

fn known(uploads: &[Upload], shapes: &Shapes, name: &str) -> Option<Mesh<'static>> {
    let upload = of_name(uploads, name).and_then(Upload::mesh);
    upload.or_else(|| shapes.made(name))
}
