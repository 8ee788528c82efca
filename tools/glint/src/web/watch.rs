//! Starts a program again whenever its file changes.

use crate::program;
use glint_live_page::channels::{Channels, Program};
use std::fs;
use std::path::Path;
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

/// Looks at the file at `path` for ever. After a change, when two looks have found the same file, the board gets the new program, or the
/// pages the reason why the file is no program.
pub fn watch(path: &Path, channels: &Channels) {
    let mut known = stamp(path);
    let mut last = known;
    loop {
        sleep(PERIOD);
        let found = stamp(path);
        let is_settled = found == last;
        last = found;
        if found == known || found.is_none() || !is_settled {
            continue;
        }
        known = found;
        match program::read(path) {
            Ok(image) => {
                let name = path.file_name().unwrap_or_default();
                let name = name.to_string_lossy().into_owned();
                channels.start(Program { name, image });
            }
            Err(error) => channels.hub.notify(error.to_string(), true),
        }
    }
}
