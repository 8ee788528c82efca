//! Progress bars.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

/// A bar of `steps` steps with a message and the time left.
///
/// # Errors
/// When the terminal's template is refused.
pub fn bar(steps: u64) -> Result<ProgressBar> {
    let style = ProgressStyle::with_template("{msg:28} {wide_bar} {percent:>3} %, {eta} left")?;
    Ok(ProgressBar::new(steps).with_style(style))
}
