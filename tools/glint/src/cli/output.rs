//! Output files. Each file is checked before the work begins, and is written completely or not at
//! all. A file that is not empty is replaced only with `--force`. The name `-` is standard output.

use super::common::bad_value;
use super::messages::reserve_stdout;
use anyhow::Context;
use glint_core::wireframe::EXTENSIONS;
use rustix::termios::isatty;
use serde::Serialize;
use std::fs::{File, Permissions};
use std::io::{self, BufWriter, Write};
use std::os::fd::AsFd;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Extensions of a picture file.
pub const PICTURE: &[&str] = &["png"];
/// Extensions of an animation file.
pub const ANIMATION: &[&str] = &["png", "gif"];
/// Extensions of a file of distances: little-endian numbers, or a picture.
pub const DEPTH: &[&str] = &["f32", "bin", "raw", "png"];
/// Extensions of a statistics file.
pub const STATISTICS: &[&str] = &["json"];
/// Extensions of a mesh file.
pub const MESH: &[&str] = &["obj", "stl", "ply", "glm"];
/// Extensions of a texture file and of a picture of a texture.
pub const TEXTURE: &[&str] = &["glt", "png"];
/// Extensions of a program file of the wireframe simulator.
pub const PROGRAM: &[&str] = &EXTENSIONS;
/// Extensions of a flash image file.
pub const IMAGE: &[&str] = &["bin", "img"];
/// Extensions of a table file.
pub const TABLE: &[&str] = &["csv"];

/// The file name that stands for standard output.
pub const STDOUT: &str = "-";

/// Whether files that are not empty are replaced.
static REPLACE: AtomicBool = AtomicBool::new(false);

/// Sets whether outputs replace files that are not empty.
pub fn set_replace(replace: bool) {
    REPLACE.store(replace, Ordering::Relaxed);
}

/// An output file that has been checked.
pub struct Output {
    path: PathBuf,
    /// The open device or pipe, such as /dev/null, which is written directly; `None` for a regular
    /// file, which is replaced.
    device: Option<File>,
}

impl Output {
    /// Checks that the file at `path` can be written, and opens it if it is a device or a pipe.
    /// `inputs` are the files that the command reads.
    ///
    /// # Errors
    /// The extension is not one of `extensions`, or the file is one of `inputs`, is not empty and
    /// may not be replaced, or cannot be written.
    pub fn open<P: AsRef<Path>>(
        path: &Path,
        extensions: &[&str],
        inputs: impl IntoIterator<Item = P>,
    ) -> anyhow::Result<Self> {
        if path == Path::new(STDOUT) {
            return Self::stdout();
        }
        let present = path.metadata().ok();
        let device = match &present {
            Some(present) if !present.is_file() => {
                Some(File::create(path).with_context(|| unwritable(path))?)
            }
            _ => {
                check_extension(path, extensions)?;
                None
            }
        };
        if let (None, Some(present)) = (&device, &present) {
            let identity = (present.dev(), present.ino());
            let same = |input: &P| {
                let input = input.as_ref().metadata();
                input.is_ok_and(|input| (input.dev(), input.ino()) == identity)
            };
            if let Some(input) = inputs.into_iter().find(same) {
                let found = format!("the input {}", input.as_ref().display());
                return Err(
                    bad_value(&path.display().to_string(), "another file to write", found).into(),
                );
            }
        }
        if let (None, Some(present)) = (&device, &present)
            && present.len() > 0
            && !REPLACE.load(Ordering::Relaxed)
        {
            let found = format!("a file of {} bytes", present.len());
            let expected = "a new file, or --force to replace it";
            return Err(bad_value(&path.display().to_string(), expected, found).into());
        }
        if device.is_none() {
            // Creating an unnamed file shows that the folder is writable. The system deletes the
            // file when it is closed.
            tempfile::tempfile_in(folder(&target(path))).with_context(|| unwritable(path))?;
        }
        Ok(Self {
            path: path.to_owned(),
            device,
        })
    }

    /// Uses standard output as the output file; the command's messages go to standard error instead.
    fn stdout() -> anyhow::Result<Self> {
        let stdout = io::stdout();
        if isatty(&stdout) {
            let expected = "standard output that is a file or a pipe";
            return Err(bad_value(STDOUT, expected, "a terminal").into());
        }
        if !reserve_stdout() {
            return Err(bad_value(STDOUT, "one output to standard output", "two").into());
        }
        let copy = stdout.as_fd().try_clone_to_owned();
        Ok(Self {
            path: STDOUT.into(),
            device: Some(File::from(copy.context("standard output")?)),
        })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Opens the file for an output that grows while the command runs, such as a log.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn into_file(self) -> anyhow::Result<File> {
        match self.device {
            Some(device) => Ok(device),
            None => File::create(&self.path).with_context(|| unwritable(&self.path)),
        }
    }

    /// Creates an unnamed temporary file for contents that take a long time to produce;
    /// [`write`](Self::write) copies them at the end. The system deletes the file when it is
    /// closed, also if the program is killed.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn spool(&self) -> anyhow::Result<File> {
        let file = match self.device {
            Some(_) => tempfile::tempfile(),
            None => tempfile::tempfile_in(folder(&target(&self.path))),
        };
        file.with_context(|| self.unwritable())
    }

    /// Start of the error message of an output that cannot be written.
    pub fn unwritable(&self) -> String {
        unwritable(&self.path)
    }

    /// Writes the file completely or not at all: `write` fills a new file in the same folder, which then replaces the output.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> anyhow::Result<()> {
        let written = match self.device {
            Some(device) => fill(&device, write),
            None => replace(&self.path, write),
        };
        written.with_context(|| unwritable(&self.path))
    }
}

impl Output {
    /// Writes a value as JSON, indented.
    ///
    /// # Errors
    /// As for [`write`](Self::write).
    pub fn write_json(self, value: &impl Serialize) -> anyhow::Result<()> {
        let json = serde_json::to_string_pretty(value)?;
        self.write(|out| writeln!(out, "{json}"))
    }
}

fn unwritable(path: &Path) -> String {
    format!("{}: cannot be written", path.display())
}

/// Rejects a name with an extension other than `extensions`, unless `extensions` is empty. A name without an extension is
/// accepted.
fn check_extension(path: &Path, extensions: &[&str]) -> anyhow::Result<()> {
    let Some(found) = path.extension() else {
        return Ok(());
    };
    let found = found.to_string_lossy();
    if extensions.is_empty()
        || extensions
            .iter()
            .any(|known| found.eq_ignore_ascii_case(known))
    {
        return Ok(());
    }
    let expected = format!("a name that ends in .{}", extensions.join(", ."));
    let found = format!("'.{}'", found.escape_debug());
    Err(bad_value(&path.display().to_string(), &expected, found).into())
}

/// The file to replace: for a symbolic link its target, so that the link stays.
fn target(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

fn folder(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let path = target(path);
    let permissions = match path.metadata() {
        Ok(present) => present.permissions(),
        Err(_) => Permissions::from_mode(0o666),
    };
    let file = tempfile::Builder::new()
        .permissions(permissions)
        .tempfile_in(folder(&path))?;
    fill(file.as_file(), write)?;
    // Some file systems report a full disk only at this call.
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

fn fill(file: &File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()
}
