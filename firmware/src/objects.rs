//! The objects of the scene: several meshes, each with a place and a colour.

use core::fmt::{self, Display};

use glint_core::matrix::MatrixError;
use glint_core::mesh::{MAX_NAME, Mesh};
use glint_core::object::{MAX_OBJECTS, Place};
use glint_model::{MeshSubject, Object, Placement};
use heapless::{String, Vec};

/// Name of the scene on the console.
pub const OBJECTS: &str = "objects";

/// Reason why the list of objects cannot be changed.
#[derive(Clone, Copy, Debug)]
pub enum ObjectError {
    /// The list is full.
    Full,
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

/// A bounded list of objects. Placements are made when an object changes, not for each frame.
#[derive(Default)]
pub struct Objects {
    /// The name of each object's mesh.
    names: Vec<String<MAX_NAME>, MAX_OBJECTS>,
    objects: Vec<Object<'static>, MAX_OBJECTS>,
}

impl Objects {
    /// The objects as the subject of a frame.
    pub fn all(&self) -> &[Object<'_>] {
        &self.objects
    }

    /// Names of the meshes, and places, of all objects in order.
    pub fn list(&self) -> impl Iterator<Item = (&str, Place)> {
        let names = self.names.iter().map(String::as_str);
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
        self.objects.push(object).map_err(|_| ObjectError::Full)?;
        // Both lists have the same length and capacity.
        self.names.push(name.clone()).map_err(|_| ObjectError::Full)
    }

    /// Changes the object with this number, from 1: applies `next` to its place.
    ///
    /// # Errors
    /// The number or the new matrix is out of range; the object is then unchanged.
    pub fn change(&mut self, number: u32, next: &Place) -> Result<(), ObjectError> {
        let index = self.index(number)?;
        if let Some(object) = self.objects.get_mut(index) {
            let place = place(object).then(next);
            let place = place.map_err(|error| ObjectError::Matrix { number, error })?;
            object.placement = Placement::new(place.matrix);
            object.colour = place.colour;
        }
        Ok(())
    }

    /// Removes the object with this number, from 1; `None` removes all objects.
    ///
    /// # Errors
    /// The number is out of range.
    pub fn remove(&mut self, number: Option<u32>) -> Result<(), ObjectError> {
        match number {
            Some(number) => {
                let index = self.index(number)?;
                self.objects.remove(index);
                self.names.remove(index);
            }
            None => *self = Self::default(),
        }
        Ok(())
    }

    /// Gives the objects whose mesh has this name another mesh.
    pub fn replace(&mut self, name: &str, mesh: Mesh<'static>) {
        self.replace_all(|other| (other == name).then_some(mesh));
    }

    /// Gives each object the mesh that `find` returns for the name of its mesh; with `None` it keeps its mesh.
    pub fn replace_all(&mut self, find: impl Fn(&str) -> Option<Mesh<'static>>) {
        for (name, object) in self.names.iter().zip(&mut self.objects) {
            if let Some(mesh) = find(name) {
                object.subject.mesh = mesh;
            }
        }
    }

    /// The number of the first object whose mesh has this name, from 1.
    pub fn first_of(&self, name: &str) -> Option<u32> {
        let mut numbered = (1..).zip(&self.names);
        numbered
            .find(|(_, known)| *known == name)
            .map(|(number, _)| number)
    }

    /// Sets the options of all objects: `options` returns the subject for a mesh.
    pub fn set_options(&mut self, options: impl Fn(Mesh<'static>) -> MeshSubject<'static>) {
        for object in &mut self.objects {
            object.subject = options(object.subject.mesh);
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
