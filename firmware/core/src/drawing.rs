//! Parameters of a picture besides meshes and fields: size, camera, colours, lights, objects and their motion.

pub mod animation;
pub mod appearance;
pub mod camera;
pub mod colour;
pub mod font;
pub mod framing;
pub mod light;
pub mod object;
pub mod picture;
pub mod quality;
pub mod rectangle;
pub mod stereo;
pub mod texture;
