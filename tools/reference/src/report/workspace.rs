//! Paths in the workspace.

use std::path::{Path, PathBuf};

/// Converts a path relative to the workspace's root to an absolute path.
pub fn path(relative: &str) -> PathBuf {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = reference.ancestors().nth(2).unwrap_or(reference);
    root.join(relative)
}
