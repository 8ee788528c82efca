//! `cargo xtask demo`: writes a first picture, builds everything that the demo needs, then runs `glint demo`.

use anyhow::Result;

use crate::gateware::{self, Board};
use crate::{bootstrap, firmware, run};

/// Writes the first picture of `glint demo`, builds everything, and runs `glint demo` with `arguments`.
///
/// # Errors
/// A build or the demo fails.
pub fn demo(arguments: &[String]) -> Result<()> {
    // Only the demo writes to its default folder, so it may replace the files there.
    let mut arguments = arguments.to_vec();
    if !arguments
        .iter()
        .any(|argument| argument.starts_with("--out"))
    {
        arguments.push("--force".to_owned());
    }
    let mut first = arguments.clone();
    first.push("--first".to_owned());
    // The first picture needs only the host program, so it is drawn before the SoC is built, which takes minutes.
    run::program("glint", "glint", "demo", &first)?;
    bootstrap::bootstrap()?;
    gateware::build(Board::Virtual)?;
    firmware::build(Board::Virtual, &[])?;
    run::program("glint", "glint", "demo", &arguments)
}
