//! Paths in the checkout.

use std::path::PathBuf;

/// The checkout's root.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("xtask lies two levels below the root")
        .to_path_buf()
}

/// Folder of all build output: cargo's target directory.
pub fn target() -> PathBuf {
    root().join("target")
}

/// A program of the Python environment.
pub fn venv_program(name: &str) -> PathBuf {
    venv().join("bin").join(name)
}

/// The Python environment of `cargo xtask bootstrap`.
pub fn venv() -> PathBuf {
    root().join(".venv")
}
