//! Experiments on smooth shading: errors, clocks and FPGA resources of Glint's form and of other forms.

pub mod clocks;
pub mod engines;
pub mod forms;
pub mod scenes;
