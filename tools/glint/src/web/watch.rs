//! Starts a program again whenever its file changes.

use crate::error::InputError;
use crate::program;
use glint_live_page::channels::{Channels, Program};
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Interval between two polls of the file.
const PERIOD: Duration = Duration::from_millis(250);

/// Modification time and length of a file; `None` while the file does not exist.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(path: &Path) -> Stamp {
    let data = fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// Reads a program for the page.
///
/// # Errors
/// Those of [`program::read`].
pub fn read_program(path: &Path) -> Result<Program, InputError> {
    let program::Program { image, places } = program::read(path)?;
    let name = path.file_name().unwrap_or_default();
    Ok(Program {
        name: name.to_string_lossy().into_owned(),
        image,
        places,
    })
}

/// The file of a program that is watched.
pub struct Watched {
    path: PathBuf,
    /// The stamp of the file from which the running program was read.
    known: Stamp,
}

impl Watched {
    /// Watches the file at `path` for changes from now on. Call this before the program is read, so that no change is missed.
    #[must_use]
    pub fn new(path: PathBuf) -> Self {
        let known = stamp(&path);
        Self { path, known }
    }

    /// Polls the file in an endless loop. After a change, and when two polls in a row have found the same stamp, starts the new program on
    /// the board, or sends the pages the reason why the file is not a program.
    pub(super) fn watch(mut self, channels: &Channels) {
        let mut last = self.known;
        loop {
            sleep(PERIOD);
            let found = stamp(&self.path);
            let is_settled = found == last;
            last = found;
            if found == self.known || found.is_none() || !is_settled {
                continue;
            }
            self.known = found;
            match read_program(&self.path) {
                Ok(program) => channels.start(program),
                Err(error) => channels.hub.notify(error.to_string(), true),
            }
        }
    }
}
