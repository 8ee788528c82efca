//! The objects of the scene in the form for drawing: meshes with placements, and copies of meshes with transformed normals.

use core::{ptr, slice};

use glint_core::allocator::Region;
use glint_core::matrix::Normals;
use glint_core::mesh::Mesh;
use glint_core::object::MAX_OBJECTS;
use glint_model::{Object, Placement};
use glint_scene::{PlacedMesh, Scene};
use heapless::Vec;

use crate::arena::Arena;

/// Number of normals transformed between two calls of `progress` in [`Objects::update`].
const NORMALS_A_CALL: u32 = 8;

/// The objects in the form for drawing. Placements, and copies of meshes with transformed normals, are made when an object changes, not for
/// each frame.
pub struct Objects {
    /// The original mesh of each object.
    sources: Vec<Source, MAX_OBJECTS>,
    /// The objects that are drawn.
    objects: Vec<Object<'static>, MAX_OBJECTS>,
    /// Memory for the copies.
    memory: Arena,
    /// Whether no further copy is needed, or no further copy fits the memory.
    is_turned: bool,
}

/// The original mesh of an object.
struct Source {
    mesh: Mesh<'static>,
    /// The copy that is drawn in place of the mesh, if any.
    copy: Option<Copy>,
}

/// A copy of a mesh with transformed normals.
struct Copy {
    /// The region of memory with the copy.
    region: Region,
    /// The matrix by which the normals have been transformed.
    normals: Normals,
}

impl Objects {
    /// Creates an empty list of objects; `memory` is for copies of meshes with transformed normals.
    pub const fn new(memory: Arena) -> Self {
        Self {
            sources: Vec::new(),
            objects: Vec::new(),
            memory,
            is_turned: true,
        }
    }

    /// The objects as the subject of a frame.
    pub fn all(&self) -> &[Object<'_>] {
        &self.objects
    }

    /// Removes the objects from this index on, and frees their copies.
    pub fn truncate(&mut self, count: usize) {
        self.objects.truncate(count);
        while self.sources.len() > count {
            let copy = self.sources.pop().and_then(|source| source.copy);
            if let Some(copy) = copy {
                self.memory.release(copy.region);
            }
            // Further copies may fit the freed memory.
            self.is_turned = false;
        }
    }

    /// Updates the objects to those of `scene`; `find` returns a mesh by its name. For each object whose matrix requires transformed
    /// normals, makes a copy of the mesh with transformed normals, so that the gateware can draw the object, as long as memory is free.
    /// Calls `progress` at short intervals. No frame may be in progress.
    ///
    /// An object that has not changed since the last call keeps its copy.
    pub fn update(
        &mut self,
        scene: &Scene,
        find: impl Fn(&str) -> Option<Mesh<'static>>,
        progress: &mut dyn FnMut(),
    ) {
        self.truncate(scene.objects.len());
        for (index, placed) in scene.objects.iter().enumerate() {
            // Every object of a scene has a mesh.
            if let Some(mesh) = find(&placed.mesh) {
                self.set(index, scene, placed, mesh);
            }
        }
        if self.is_turned {
            return;
        }
        let has_gaps = self.sources.iter().any(|source| source.copy.is_some());
        if !self.make_copies(progress) && has_gaps {
            for (source, object) in self.sources.iter_mut().zip(&mut self.objects) {
                if let Some(copy) = source.copy.take() {
                    self.memory.release(copy.region);
                    object.subject.mesh = source.mesh;
                    object.placement = Placement::new(*object.placement.matrix());
                }
            }
            self.make_copies(progress);
        }
        self.is_turned = true;
    }

    /// Sets the object with this index to `placed`, and keeps the copy of the object's mesh if the copy is still valid.
    fn set(&mut self, index: usize, scene: &Scene, placed: &PlacedMesh, mesh: Mesh<'static>) {
        let (Some(source), Some(old)) = (self.sources.get_mut(index), self.objects.get_mut(index))
        else {
            let source = Source { mesh, copy: None };
            // The capacity of both lists suffices for all objects of a scene.
            let _ = self.sources.push(source);
            let _ = self.objects.push(scene.object(&placed.place, mesh));
            self.is_turned = false;
            return;
        };
        let is_same = ptr::eq(source.mesh.bytes(), mesh.bytes());
        if is_same && *old.placement.matrix() == placed.place.matrix {
            old.colour = placed.place.colour;
            old.subject = scene.options.subject(old.subject.mesh);
            return;
        }
        let mut object = scene.object(&placed.place, mesh);
        match source.copy.take() {
            // The object has moved, but its normals are unchanged.
            Some(copy) if is_same && object.placement.normals() == Some(&copy.normals) => {
                object.placement = object.placement.of_turned_mesh();
                object.subject.mesh = old.subject.mesh;
                source.copy = Some(copy);
            }
            unfit => {
                if let Some(copy) = unfit {
                    self.memory.release(copy.region);
                }
                source.mesh = mesh;
                self.is_turned = false;
            }
        }
        *old = object;
    }

    /// Makes the missing copies. Returns whether all copies fit the memory.
    fn make_copies(&mut self, progress: &mut dyn FnMut()) -> bool {
        let mut is_complete = true;
        for (source, object) in self.sources.iter_mut().zip(&mut self.objects) {
            let Some(&normals) = object.placement.normals() else {
                continue;
            };
            match copy(&source.mesh, &normals, &mut self.memory, progress) {
                Some((mesh, region)) => {
                    source.copy = Some(Copy { region, normals });
                    object.subject.mesh = mesh;
                    object.placement = object.placement.of_turned_mesh();
                }
                None => is_complete = false,
            }
        }
        is_complete
    }
}

/// Copies a mesh into a region of `memory`, with normals transformed by `normals`; `None` if the copy does not fit.
fn copy(
    mesh: &Mesh,
    normals: &Normals,
    memory: &mut Arena,
    progress: &mut dyn FnMut(),
) -> Option<(Mesh<'static>, Region)> {
    let mut count = 0_u32;
    let mut turn = |normal| {
        if count.is_multiple_of(NORMALS_A_CALL) {
            progress();
        }
        count += 1;
        normals.apply(normal)
    };
    let copy = mesh.copy_with_normals(memory.staging(), &mut turn)?;
    let bytes = copy.bytes();
    // SAFETY: the memory is 'static, and the region of these bytes is only written after its release. `Objects`, whose fields
    // are private, takes the copy out of its list before it releases the region.
    let bytes: &'static [u8] = unsafe { slice::from_raw_parts(bytes.as_ptr(), bytes.len()) };
    let mesh = Mesh::new_checked(bytes).ok()?;
    Some((mesh, memory.allocate(bytes.len())?))
}
