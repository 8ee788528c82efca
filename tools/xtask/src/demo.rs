//! `cargo xtask demo`: builds everything that the demo needs, then runs `glint demo`.

use anyhow::Result;

use crate::gateware::{self, Board};
use crate::{bootstrap, firmware, run};

/// Builds everything and runs `glint demo` with `arguments`.
///
/// # Errors
/// A build or the demo fails.
pub fn demo(arguments: &[String]) -> Result<()> {
    bootstrap::bootstrap()?;
    gateware::build(Board::Virtual)?;
    firmware::build(Board::Virtual, &[])?;
    // Only the demo writes to its default folder, so it may replace the files there.
    let mut arguments = arguments.to_vec();
    if !arguments
        .iter()
        .any(|argument| argument.starts_with("--out"))
    {
        arguments.push("--force".to_owned());
    }
    run::program("glint", "glint", "demo", &arguments)
}
