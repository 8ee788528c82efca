//! Cameras, sines, mesh and wire formats and the console's grammar.
#![no_std]
#![forbid(unsafe_code)]
