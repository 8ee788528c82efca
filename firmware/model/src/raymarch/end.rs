//! The end of a ray, with all that the colour and the depth code of a pixel need, for rays by exits and for marching rays.

use glint_core::field::Surface;

/// Whether a ray hit a surface, and which one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The ray reached this surface.
    Hit(Surface),
    /// The ray reached the far limit, or left the solid or its bounding box.
    Miss,
    /// A marching ray reached its step limit.
    Undecided,
}

/// The end of a ray, with all that the colour and the depth code of a pixel need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayEnd {
    /// Whether the ray hit a surface, missed or ended undecided.
    pub state: State,
    /// Depth along the camera's forward axis n of a hit, in field units times 2^e with the exponent e of the frame: u19.21.
    pub depth: u64,
    /// Number of steps of the ray.
    pub steps: u32,
    /// Number of evaluations of the field, including those of the shadow ray. With several spheres, each step of a marching ray takes one
    /// evaluation per sphere.
    pub evaluations: u32,
    /// Whether the hit point is in the shadow of the first light; true only for hits on faces.
    pub shadow: bool,
    /// Height of the direction: its component along z, divided by its largest component; u0.8, rounded down, 0 for a ray that points down.
    /// The colour of the sky depends on it.
    pub height: u8,
    /// At a hit on a sphere or fillet, the vector from the sphere's centre to the hit, in field units with 12 fraction bits. The length of
    /// the vector is about the radius. At a hit on the lateral surface of a cone, the vector from the cone's apex to the hit. `None` at
    /// other ends.
    pub normal: Option<[i32; 3]>,
}
