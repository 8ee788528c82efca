//! The objects of the scene: several meshes, each with a position and a colour.

use core::fmt::{self, Display};
use core::slice;

use glint_core::matrix::{MatrixError, Normals};
use glint_core::mesh::{MAX_NAME, Mesh};
use glint_core::object::{MAX_OBJECTS, Place};
use glint_core::regions::Region;
use glint_model::{MeshSubject, Object, Placement};
use heapless::{String, Vec};

use crate::arena::Arena;

/// Text for objects instead of the name of a mesh.
pub const OBJECTS: &str = "objects";

/// Number of normals that are turned between two calls of `progress` in [`Objects::turn_normals`].
const NORMALS_A_CALL: u32 = 8;

/// Reason why the list of objects cannot be changed.
#[derive(Clone, Copy, Debug)]
pub enum ObjectError {
    /// The list is full.
    Full,
    /// The list is empty.
    None,
    /// No object has this number.
    Number {
        /// The number.
        number: u32,
        /// Number of objects.
        count: usize,
    },
    /// The matrix of an object would be out of range or singular.
    Matrix {
        /// The number of the object.
        number: u32,
        /// The row, and the condition that it violates.
        error: MatrixError,
    },
}

impl Display for ObjectError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Full => write!(
                f,
                "object: expected at most {MAX_OBJECTS} objects, `object remove` removes one"
            ),
            Self::None => f.write_str("object: no objects, expected `object add MESH` first"),
            Self::Number { number, count: 0 } => write!(
                f,
                "object {number}: no objects, expected `object add MESH` first"
            ),
            Self::Number { number, count } => write!(
                f,
                "object {number}: expected 1 to {count}, `object list` lists the objects"
            ),
            Self::Matrix { number, error } => write!(f, "object {number}: {error}"),
        }
    }
}

/// A bounded list of objects. Placements, and copies of meshes with turned normals, are made when an object changes, not for each frame.
pub struct Objects {
    /// The mesh of each object.
    sources: Vec<Source, MAX_OBJECTS>,
    /// The objects as drawn.
    objects: Vec<Object<'static>, MAX_OBJECTS>,
    /// Memory for the copies.
    memory: Arena,
    /// Whether every object has a copy that needs one and for which there is memory.
    is_turned: bool,
}

/// The mesh of an object.
struct Source {
    name: String<MAX_NAME>,
    mesh: Mesh<'static>,
    /// The copy that is drawn instead of the mesh.
    copy: Option<Copy>,
}

/// A copy of a mesh with turned normals.
struct Copy {
    /// The memory of the copy.
    region: Region,
    /// The matrix that has turned the normals.
    normals: Normals,
}

impl Objects {
    /// No objects. `memory` is for copies of meshes with turned normals.
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

    /// Names of the meshes, and places, of all objects in order.
    pub fn list(&self) -> impl Iterator<Item = (&str, Place)> {
        let names = self.sources.iter().map(|source| source.name.as_str());
        names.zip(self.objects.iter().map(place))
    }

    /// Adds an object at the end of the list.
    ///
    /// # Errors
    /// [`ObjectError::Full`].
    pub fn add(
        &mut self,
        name: &String<MAX_NAME>,
        mesh: Mesh<'static>,
        at: &Place,
    ) -> Result<(), ObjectError> {
        let object = Object {
            subject: MeshSubject::new(mesh),
            placement: Placement::new(at.matrix),
            colour: at.colour,
        };
        let source = Source {
            name: name.clone(),
            mesh,
            copy: None,
        };
        self.objects.push(object).map_err(|_| ObjectError::Full)?;
        self.is_turned = false;
        // Both lists have the same length and capacity.
        self.sources.push(source).map_err(|_| ObjectError::Full)
    }

    /// Changes the object with this number, from 1: applies `next` to its place.
    ///
    /// # Errors
    /// The number or the new matrix is out of range; the object is then unchanged.
    pub fn change(&mut self, number: u32, next: &Place) -> Result<(), ObjectError> {
        let index = self.index(number)?;
        let Some(object) = self.objects.get_mut(index) else {
            return Ok(());
        };
        let place = place(object).then(next);
        let place = place.map_err(|error| ObjectError::Matrix { number, error })?;
        object.colour = place.colour;
        let placement = Placement::new(place.matrix);
        let source = self.sources.get(index);
        let copy = source.and_then(|source| source.copy.as_ref());
        match copy {
            // The object has moved, and its normals have not turned.
            Some(copy) if placement.normals() == Some(&copy.normals) => {
                object.placement = placement.of_turned_mesh();
            }
            _ => self.drop_copy(index, placement),
        }
        Ok(())
    }

    /// Removes the object with this number, from 1; `None` removes all objects.
    ///
    /// # Errors
    /// The number is out of range.
    pub fn remove(&mut self, number: Option<u32>) -> Result<(), ObjectError> {
        let removed = match number {
            Some(number) => {
                let index = self.index(number)?;
                index..index + 1
            }
            None => 0..self.objects.len(),
        };
        self.objects.drain(removed.clone());
        for source in self.sources.drain(removed) {
            if let Some(copy) = source.copy {
                self.memory.release(copy.region);
            }
        }
        // There may be memory for further copies now.
        self.is_turned = false;
        Ok(())
    }

    /// Gives the objects whose mesh has this name another mesh.
    pub fn replace(&mut self, name: &str, mesh: Mesh<'static>) {
        self.replace_all(|other| (other == name).then_some(mesh));
    }

    /// Gives each object the mesh that `find` returns for the name of its mesh; with `None` it keeps its mesh.
    pub fn replace_all(&mut self, find: impl Fn(&str) -> Option<Mesh<'static>>) {
        for index in 0..self.sources.len() {
            if let Some(source) = self.sources.get_mut(index)
                && let Some(mesh) = find(&source.name)
            {
                source.mesh = mesh;
                self.restore(index);
            }
        }
    }

    /// The number of the first object whose mesh has this name, from 1.
    pub fn first_of(&self, name: &str) -> Option<u32> {
        let mut numbered = (1..).zip(&self.sources);
        numbered
            .find(|(_, source)| source.name == name)
            .map(|(number, _)| number)
    }

    /// Sets the options of all objects: `options` returns the subject for a mesh.
    pub fn set_options(&mut self, options: impl Fn(Mesh<'static>) -> MeshSubject<'static>) {
        for object in &mut self.objects {
            object.subject = options(object.subject.mesh);
        }
    }

    /// Gives each object whose normals a matrix turns a copy of its mesh with turned normals, as long as there is memory, so that the
    /// gateware can draw it. Calls `progress` at short intervals. No frame may be in progress.
    ///
    /// An object that has not changed since the last call keeps its copy.
    pub fn turn_normals(&mut self, progress: &mut dyn FnMut()) {
        if self.is_turned {
            return;
        }
        let has_gaps = self.sources.iter().any(|source| source.copy.is_some());
        if !self.make_copies(progress) && has_gaps {
            for index in 0..self.sources.len() {
                self.restore(index);
            }
            self.make_copies(progress);
        }
        self.is_turned = true;
    }

    /// Makes the missing copies. Returns whether there was memory for all of them.
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

    /// Draws the object with its own mesh from now on, at the same position.
    fn restore(&mut self, index: usize) {
        if let Some(object) = self.objects.get(index) {
            let placement = Placement::new(*object.placement.matrix());
            self.drop_copy(index, placement);
        }
    }

    /// Draws the object with its own mesh, at `placement`, from now on, and releases the memory of the copy if there is one.
    fn drop_copy(&mut self, index: usize, placement: Placement) {
        if let (Some(source), Some(object)) =
            (self.sources.get_mut(index), self.objects.get_mut(index))
        {
            object.subject.mesh = source.mesh;
            object.placement = placement;
            if let Some(copy) = source.copy.take() {
                self.memory.release(copy.region);
            }
            self.is_turned = false;
        }
    }

    fn index(&self, number: u32) -> Result<usize, ObjectError> {
        let count = self.objects.len();
        let index = (number as usize).checked_sub(1);
        index
            .filter(|&index| index < count)
            .ok_or(ObjectError::Number { number, count })
    }
}

fn place(object: &Object) -> Place {
    Place {
        matrix: *object.placement.matrix(),
        colour: object.colour,
    }
}

/// Copies a mesh into a region of `memory`, with normals that `normals` has turned; `None` without memory for it.
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
    // SAFETY: the memory is 'static, and the region that holds these bytes is written only after its release. `Objects`, whose fields
    // are private, takes the copy out of its list before it releases the region.
    let bytes: &'static [u8] = unsafe { slice::from_raw_parts(bytes.as_ptr(), bytes.len()) };
    let mesh = Mesh::new_checked(bytes).ok()?;
    Some((mesh, memory.keep(bytes.len())?))
}
