//! Starts a program from its file, and again whenever the file changes.

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

/// The file of a program that is watched.
pub struct Watched {
    path: PathBuf,
    /// The stamp of the file from which the running program was read.
    known: Stamp,
    /// Whether only the first program is started.
    is_once: bool,
}

impl Watched {
    /// Watches the file of the running program for changes from now on. Call this before the program is read, so that no change is missed.
    #[must_use]
    pub fn loaded(path: PathBuf) -> Self {
        let known = stamp(&path);
        Self {
            path,
            known,
            is_once: false,
        }
    }

    /// Starts the program at `path`, and with `is_watched` again whenever its file changes.
    #[must_use]
    pub fn to_load(path: PathBuf, is_watched: bool) -> Self {
        Self {
            path,
            known: None,
            is_once: !is_watched,
        }
    }

    /// Polls the file, in an endless loop if it is watched. After a change, and when two polls in a row have found the same stamp, starts
    /// the new program on the board, or sends the pages the reason why the file is not a program.
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
            if self.is_once {
                return;
            }
        }
    }
}
