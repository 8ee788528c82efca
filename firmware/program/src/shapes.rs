//! The built-in meshes: the cube, and shapes that are made on first use.

use core::mem;

use glint_core::deviation::Deviation;
use glint_core::mesh::Mesh;
use glint_core::shape::Shape;
use glint_scene::CUBE;

use crate::cube;

/// The built-in meshes, and memory for shapes that have not been made.
pub struct Shapes {
    cube: Mesh<'static>,
    shapes: [Option<Mesh<'static>>; Shape::ALL.len()],
    memory: &'static mut [u8],
}

impl Shapes {
    /// The built-in meshes, with `memory` for the shapes, aligned to 16 bytes.
    ///
    /// # Errors
    /// [`Deviation`] for a damaged cube.
    pub fn new(memory: &'static mut [u8]) -> Result<Self, Deviation> {
        Ok(Self {
            cube: Mesh::new_checked(&cube::BYTES.0)?,
            shapes: [None; Shape::ALL.len()],
            memory,
        })
    }

    /// The cube.
    pub const fn cube(&self) -> Mesh<'static> {
        self.cube
    }

    /// Names of all built-in meshes.
    pub fn names() -> impl Iterator<Item = &'static str> {
        [CUBE].into_iter().chain(Shape::NAMES)
    }

    /// The built-in mesh with this name.
    pub fn named(&mut self, name: &str) -> Option<Mesh<'static>> {
        if name == CUBE {
            return Some(self.cube);
        }
        let shape = Shape::ALL.into_iter().find(|shape| shape.name() == name)?;
        self.shape(shape)
    }

    /// The built-in mesh with this name, if it has been made.
    pub fn made(&self, name: &str) -> Option<Mesh<'static>> {
        if name == CUBE {
            return Some(self.cube);
        }
        let shape = Shape::ALL.into_iter().find(|shape| shape.name() == name)?;
        *self.shapes.get(shape as usize)?
    }

    /// A shape, made on first use; `None` if its memory is too small, which the sizes of the memory windows exclude.
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
