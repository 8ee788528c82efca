//! Test inputs shared by several crates: random numbers, cameras in `f64`, models, meshes, scenes, and triangles and segments in
//! screen coordinates.

pub mod camera;
pub mod math;
pub mod meshes;
pub mod model;
pub mod picture;
pub mod random;
pub mod rays;
pub mod scenes;
pub mod segments;
pub mod triangles;

pub use camera::Camera;
pub use model::Model;
pub use picture::Picture;
pub use random::Random;
