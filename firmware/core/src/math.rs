//! Fixed-point numbers, vectors and matrices.

pub mod cordic;
pub mod division;
pub mod fixed;
pub mod matrix;
pub mod root;
pub mod trig;
pub mod vector;
