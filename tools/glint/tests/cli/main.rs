//! Tests of the program `glint`: exit codes, messages, files.

mod attitudes;
mod cameras;
mod common;
mod conversions;
mod fields;
mod images;
mod input;
mod meshes;
mod orbits;
mod output;
mod package;
mod scene_options;
mod scenes;
mod settings;
mod standard_input;
mod textures;
mod tolerance;
mod wireframes;
