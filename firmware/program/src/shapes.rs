//! The built-in meshes: the cube, and shapes that are made on first use.

use core::mem;

use glint_core::mesh::Mesh;
use glint_core::shape::Shape;
use glint_scene::CUBE as CUBE_NAME;

use crate::cube::CUBE;

/// The built-in meshes that have been made, and the memory for those that have not.
///
/// ```
/// # let memory = vec![0; 6 * glint_program::core::shape::MAX_BYTES].leak();
/// use glint_program::core::shape::Shape;
/// use glint_program::shapes::Shapes;
///
/// let mut shapes = Shapes::new(memory);
/// let torus = shapes.shape(Shape::Torus).expect("there is memory for each shape");
/// assert_eq!(shapes.made("torus"), Some(torus));
/// ```
pub struct Shapes {
    shapes: [Option<Mesh<'static>>; Shape::ALL.len()],
    memory: &'static mut [u8],
}

impl Shapes {
    /// The built-in meshes, with `memory` for the shapes, aligned to 16 bytes.
    ///
    /// ```
    /// use glint_program::core::shape::{MAX_BYTES, Shape};
    /// use glint_program::shapes::Shapes;
    ///
    /// let memory = vec![0; MAX_BYTES * Shape::ALL.len()].leak();
    /// let mut shapes = Shapes::new(memory);
    /// assert!(Shape::ALL.iter().all(|&shape| shapes.shape(shape).is_some()));
    /// ```
    ///
    pub const fn new(memory: &'static mut [u8]) -> Self {
        Self {
            shapes: [None; Shape::ALL.len()],
            memory,
        }
    }

    /// The built-in cube, which needs no memory.
    ///
    /// ```
    /// let shapes = glint_program::shapes::Shapes::new(&mut []);
    /// assert_eq!(shapes.cube().triangle_count(), 12);
    /// ```
    pub const fn cube(&self) -> Mesh<'static> {
        CUBE
    }

    /// Names of all built-in meshes.
    ///
    /// ```
    /// let names: Vec<_> = glint_program::shapes::Shapes::names().collect();
    /// assert_eq!(names[..3], ["cube", "sphere", "torus"]);
    /// ```
    pub fn names() -> impl Iterator<Item = &'static str> {
        [CUBE_NAME].into_iter().chain(Shape::NAMES)
    }

    /// The built-in mesh with this name.
    ///
    /// ```
    /// # let memory = vec![0; 6 * glint_program::core::shape::MAX_BYTES].leak();
    /// let mut shapes = glint_program::shapes::Shapes::new(memory);
    /// assert!(shapes.named("crate").is_some_and(|mesh| mesh.has_textures()));
    /// assert!(shapes.named("teapot").is_none());
    /// ```
    pub fn named(&mut self, name: &str) -> Option<Mesh<'static>> {
        if name == CUBE_NAME {
            return Some(CUBE);
        }
        let shape = Shape::ALL.into_iter().find(|shape| shape.name() == name)?;
        self.shape(shape)
    }

    /// The built-in mesh with this name, if it has been made.
    ///
    /// ```
    /// # let memory = vec![0; 6 * glint_program::core::shape::MAX_BYTES].leak();
    /// let mut shapes = glint_program::shapes::Shapes::new(memory);
    /// assert!(shapes.made("sphere").is_none());
    /// let sphere = shapes.named("sphere");
    /// assert_eq!(shapes.made("sphere"), sphere);
    /// ```
    pub fn made(&self, name: &str) -> Option<Mesh<'static>> {
        if name == CUBE_NAME {
            return Some(CUBE);
        }
        let shape = Shape::ALL.into_iter().find(|shape| shape.name() == name)?;
        *self.shapes.get(shape as usize)?
    }

    /// A shape, made on first use; `None` if the memory is too small, which the sizes of the memory windows exclude.
    ///
    /// ```
    /// # let memory = vec![0; 6 * glint_program::core::shape::MAX_BYTES].leak();
    /// use glint_program::core::shape::Shape;
    ///
    /// let mut shapes = glint_program::shapes::Shapes::new(memory);
    /// let sphere = shapes.shape(Shape::Sphere).unwrap();
    /// assert_eq!(sphere.triangle_count(), 1024);
    /// ```
    pub fn shape(&mut self, shape: Shape) -> Option<Mesh<'static>> {
        let place = self.shapes.get_mut(shape as usize)?;
        if place.is_none() {
            let memory = mem::take(&mut self.memory);
            let length = shape.write(memory)?;
            let (bytes, rest) = memory.split_at_mut_checked(length)?;
            self.memory = rest;
            *place = Mesh::new_checked(bytes).ok();
        }
        *place
    }
}
