//! Glint's host side: mesh files and models, the board behind a serial line or in simulation, pictures.
//!
//! | module | what it does |
//! |---|---|
//! | [`formats`], [`polygons`] | reads and writes OBJ, STL, PLY and GLM |
//! | [`generate`] | makes models without a file |
//! | [`mod@convert`] | scales, cuts into triangles, rounds to the mesh a board holds |
#![forbid(unsafe_code)]

pub mod convert;
pub mod error;
pub mod formats;
pub mod generate;
pub mod normals;
pub mod picture;
pub mod polygons;
pub mod triangulate;
pub mod view;
