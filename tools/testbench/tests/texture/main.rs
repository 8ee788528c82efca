//! Compares the modules of the texture unit with the model.

mod sampler;
