//! Experiments on smooth shading: errors, clocks and FPGA resources of Glint's method and of other methods.

pub mod clocks;
pub mod colours;
pub mod engines;
pub mod forms;
pub mod scenes;
