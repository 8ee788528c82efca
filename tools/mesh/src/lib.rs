//! Meshes: files and generators, and their conversion to a board's memory layout.
//!
//! | module | purpose |
//! |---|---|
//! | [`formats`], [`polygons`] | reads OBJ, STL, PLY, glTF and GLM, and writes all but glTF |
//! | [`generate`] | generates models |
//! | [`mod@convert`], [`triangulate`], [`normals`] | scaling, triangulation and rounding to a board's mesh |
//! | [`model`] | loads a mesh for boards by the name of a file or a generator |
//! | [`error`] | errors and limits of input files |
#![forbid(unsafe_code)]

pub mod convert;
pub mod error;
pub mod formats;
pub mod generate;
pub mod model;
pub mod normals;
pub mod polygons;
pub mod texture;
pub mod triangulate;
