//! Fixed-point numbers, vectors and matrices.

pub mod cordic;
pub mod division;
pub mod fixed;
pub mod matrix;
#[cfg(test)]
mod random;
pub mod root;
pub mod trig;
pub mod vector;
