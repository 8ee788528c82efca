//! Glint's host side: mesh files and models, the board behind a serial line or in simulation, pictures.
//!
//! | module | what it does |
//! |---|---|
//! | [`formats`], [`polygons`] | reads and writes OBJ, STL, PLY and GLM |
//! | [`generate`] | makes models without a file |
//! | [`mod@convert`], [`triangulate`], [`normals`] | scales, cuts into triangles, rounds to the mesh a board holds |
//! | [`model`], [`view`], [`picture`] | models, cameras and frames as the command line names them |
//! | [`render`] | a scene into a frame, by the model or by a board |
//! | [`board`] | a board behind its serial line, simulated or real |
//! | [`mod@flash`], [`console`], [`transfer`] | what is said on that line: serial boot, commands, uploads |
//! | [`imu`] | logs of a gyroscope and an accelerometer, and the attitudes that follow from them |
//! | [`fuzz`] | inputs for everything above that takes bytes from outside |
#![forbid(unsafe_code)]

pub mod board;
pub mod console;
pub mod convert;
pub mod counters;
pub mod error;
pub mod field;
pub mod flash;
pub mod formats;
pub mod fuzz;
pub mod generate;
pub mod imu;
pub mod model;
pub mod normals;
pub mod picture;
pub mod polygons;
pub mod render;
pub mod transfer;
pub mod triangulate;
pub mod view;
