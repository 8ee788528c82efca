//! Progress bars for measurements that take minutes.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

/// Creates a progress bar with `steps` steps, which displays a message and the remaining time.
///
/// # Errors
/// When the terminal refuses the bar's template.
pub fn bar(steps: u64) -> Result<ProgressBar> {
    let style = ProgressStyle::with_template("{msg:28} {wide_bar} {percent:>3} %, {eta} left")?;
    Ok(ProgressBar::new(steps).with_style(style))
}
