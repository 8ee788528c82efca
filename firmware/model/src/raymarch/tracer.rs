//! Finds the ends of the rays of a frame.

use super::end::RayEnd;
use super::exits::{Cones, Exits};
use super::setup::{FieldSetup, Form};

/// The constants of a frame, and the cones in which the eyes see the spheres. The cones are separate from the constants, because the cones
/// are large.
#[derive(Clone, Copy, Debug)]
pub struct Tracer<'a> {
    /// The constants of the frame.
    pub setup: &'a FieldSetup,
    cones: [Cones; 2],
}

impl FieldSetup {
    /// Returns the tracer, which finds the ends of the frame's rays.
    pub fn tracer(&self) -> Tracer<'_> {
        let cones = self.exits().map(Exits::cones).unwrap_or_default();
        Tracer::new(self, cones)
    }
}

impl<'a> Tracer<'a> {
    /// A tracer with the constants of a frame and the cones of its spheres.
    pub const fn new(setup: &'a FieldSetup, cones: [Cones; 2]) -> Self {
        Self { setup, cones }
    }

    /// Finds the end of the ray of pixel (x, y) for an eye.
    pub fn trace(&self, eye: usize, x: u32, y: u32) -> RayEnd {
        match &self.setup.form {
            Form::Exits(exits) => {
                let beam = exits.ray(eye, x, y);
                exits.seen(&beam, &exits.end(&self.cones, &beam))
            }
            Form::Marching(marching) => {
                let ray = marching.ray(eye, x, y);
                marching.seen(&ray, &marching.march(&ray))
            }
        }
    }
}
