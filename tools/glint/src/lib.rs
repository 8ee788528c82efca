//! The host side of Glint: mesh files and generators, serial and simulated boards, pictures.
//!
//! | module | purpose |
//! |---|---|
//! | [`formats`], [`polygons`] | reads OBJ, STL, PLY, glTF and GLM, and writes all but glTF |
//! | [`generate`] | generates models |
//! | [`mod@convert`], [`triangulate`], [`normals`] | scaling, triangulation and rounding to a board's mesh |
//! | [`model`], [`view`], [`picture`] | models, cameras and frames of the command line |
//! | [`render`], [`scene`] | renders a frame by the model or by a board; frames of scene files |
//! | [`image`] | images for a board's SPI flash |
//! | [`board`] | boards: serial port, or simulation |
//! | [`program`] | checks program files for boards |
//! | [`mod@flash`], [`console`], [`transfer`] | protocols of the serial line: serial boot, commands, uploads |
//! | [`wireframe`] | programs of the wireframe simulator |
//! | [`imu`] | logs of a gyroscope and an accelerometer, and their attitudes |
//! | [`gesture`] | the hand in front of a board's camera, and the camera of simulated boards |
//! | [`web`] | the live page: a board in a web browser |
//! | [`fuzz`] | fuzz targets for everything that parses external bytes |
#![forbid(unsafe_code)]

pub mod board;
pub mod counters;
pub mod field;
pub mod fuzz;
pub mod gesture;
pub mod image;
pub mod imu;
pub mod object;
pub mod picture;
pub mod program;
pub mod project;
pub mod render;
pub mod scene;
pub mod view;
pub mod web;
pub mod wireframe;

pub use glint_board_api::{console, flash, transfer};
pub use glint_mesh::{
    convert, error, formats, generate, model, normals, polygons, texture, triangulate,
};
