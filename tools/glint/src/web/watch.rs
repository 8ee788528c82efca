//! Starts a program again whenever its file changes.

use crate::program;
use glint_live_page::channels::{Channels, Program};
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Time between two looks at the file.
const PERIOD: Duration = Duration::from_millis(250);

/// Time of the last change and length of a file; `None` while it does not exist.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(path: &Path) -> Stamp {
    let data = fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// The file of a program that is watched.
pub struct Watched {
    path: PathBuf,
    /// The stamp of the file from which the running program was read.
    known: Stamp,
}

impl Watched {
    /// The file at `path`, as it is now. Call this before the program is read.
    #[must_use]
    pub fn new(path: PathBuf) -> Self {
        let known = stamp(&path);
        Self { path, known }
    }

    /// Looks at the file for ever. After a change, when two looks have found the same file, the board gets the new program, or the pages
    /// the reason why the file is no program.
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
            match program::read(&self.path) {
                Ok(program::Program { image, places }) => {
                    let name = self.path.file_name().unwrap_or_default();
                    let name = name.to_string_lossy().into_owned();
                    channels.start(Program {
                        name,
                        image,
                        places,
                    });
                }
                Err(error) => channels.hub.notify(error.to_string(), true),
            }
        }
    }
}
