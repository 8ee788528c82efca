//! The end of a ray, in the form that a picture needs of rays by exits and of marching rays.

use glint_core::field::Surface;

/// Result of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Surface reached.
    Hit(Surface),
    /// Far limit reached, or the solid or its bounding box left.
    Miss,
    /// Step limit reached, by a marching ray.
    Undecided,
}

/// The end of a ray as a picture shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayEnd {
    /// Whether the ray hit a surface, missed or ended undecided.
    pub state: State,
    /// Depth along the camera's forward axis n of a hit, in field units times 2^e with the exponent e of the frame: u19.21.
    pub depth: u64,
    /// Number of steps.
    pub steps: u32,
    /// Number of evaluations of the field: with several spheres, a step of a marching ray takes one for each sphere. Includes those of a
    /// ray to the light.
    pub evaluations: u32,
    /// Whether a face is in the shadow of the first light.
    pub shadow: bool,
    /// How far up a ray leads: the component along z of its direction, divided by the largest component; u0.8, rounded down, 0 for a ray that
    /// leads down. The colour of the sky depends on it.
    pub height: u8,
    /// At a hit on a sphere or fillet, the vector from the sphere's centre to the hit, in field units with 12 fraction bits. It is about
    /// as long as the radius. At a hit on the lateral face of a cone, the vector from the apex.
    pub normal: Option<[i32; 3]>,
}
