//! Textures for boards, from the pictures of image files.
//!
//! | module | purpose |
//! |---|---|
//! | [`picture`] | pictures of PNG and JPEG files in memory, and PNG files of pictures |
//! | [`mod@convert`] | converts a picture to a texture in a board's memory layout, and reports on the conversion |
//! | [`options`] | options of a conversion, and their names on command lines |
//! | [`levels`] | resizing and mip levels, in linear light |
//! | [`palette`] | palettes for the colours of a picture |
//! | [`sheet`] | the levels of a texture side by side, as a board shows them |
//! | [`error`] | errors in image files |
//! | [`example`] | example files for tests and fuzzing |
#![forbid(unsafe_code)]

pub mod convert;
pub mod error;
pub mod example;
pub mod levels;
pub mod options;
pub mod palette;
pub mod picture;
pub mod sheet;
