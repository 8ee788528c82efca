//! Compares the modules of the texture unit with the model.

mod filter;
mod loader;
mod place;
mod sampler;
