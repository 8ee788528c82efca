//! `glint man`.

use super::messages::say;
use super::output::Output;
use anyhow::Context;
use clap::{Args, Command};
use std::path::PathBuf;

/// Write the manual pages of this program: glint.1, and a page for each command.
///
/// For `man`: `glint man ~/.local/share/man/man1`.
#[derive(Args)]
pub struct ManArguments {
    /// Output folder; it is created if it does not exist.
    folder: PathBuf,
}

impl ManArguments {
    /// Writes the manual pages of `program`.
    pub fn run(self, program: Command) -> anyhow::Result<()> {
        let made = tempfile::tempdir().context("creating a temporary folder")?;
        clap_mangen::generate_to(program, made.path()).context("generating the manual pages")?;
        let pages = made.path().read_dir().context("listing the manual pages")?;
        let mut pages = pages
            .map(|page| Ok(page?.path()))
            .collect::<std::io::Result<Vec<_>>>()
            .context("listing the manual pages")?;
        pages.sort();
        std::fs::create_dir_all(&self.folder)
            .with_context(|| format!("{}: cannot be made", self.folder.display()))?;
        let names = pages
            .iter()
            .map(|page| page.file_name().unwrap_or_default());
        let outputs = names.map(|name| Output::open(&self.folder.join(name), &["1"], [""; 0]));
        let outputs = outputs.collect::<anyhow::Result<Vec<_>>>()?;
        for (page, out) in pages.iter().zip(outputs) {
            let text = std::fs::read(page).context("reading a manual page")?;
            out.write(|out| out.write_all(&text))?;
        }
        say(format_args!(
            "{}: {} pages",
            self.folder.display(),
            pages.len()
        ))
    }
}
