//! Creates projects for new programs from templates.

use glint_board_api::built;
use serde_json::Value;
use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folder of the package `glint-program`, the library of programs, in a clone of Glint.
const LIBRARY: &str = "firmware/program";

/// The lock file with which this program was built.
const LOCK: &str = include_str!("../../../Cargo.lock");

/// Names of folders that cargo creates; a program cannot have such a name.
const RESERVED: [&str; 4] = ["build", "deps", "examples", "incremental"];

/// Files of a project and their templates.
const FILES: [(&str, &str); 6] = [
    (
        "Cargo.toml",
        include_str!("../templates/program/Cargo.toml.in"),
    ),
    (
        ".cargo/config.toml",
        include_str!("../templates/program/config.toml.in"),
    ),
    (
        "src/main.rs",
        include_str!("../templates/program/main.rs.in"),
    ),
    (
        "tests/board.rs",
        include_str!("../templates/program/board.rs.in"),
    ),
    (
        "README.md",
        include_str!("../templates/program/README.md.in"),
    ),
    (".gitignore", "/target\n"),
];

/// Reason why a project cannot be created.
#[derive(Debug, thiserror::Error)]
pub enum ProjectError {
    /// The name is not a valid package name.
    #[error(
        "the name {0:?}: expected letters a to z, digits, - and _, beginning with a letter, and none of cargo's own names"
    )]
    Name(String),
    /// A file or folder of this name exists.
    #[error("{0}: exists, expected a new folder")]
    Exists(PathBuf),
    /// No clone of Glint was found.
    #[error(
        "the library of programs: no {LIBRARY} in {searched}; --glint states the path of a clone of Glint, or the URL of its git repository"
    )]
    NoGlint {
        /// The folders that were searched.
        searched: String,
    },
    /// The Rust compiler did not run.
    #[error("rustc -vV: {0}; expected an installed Rust compiler")]
    Rust(io::Error),
    /// A file cannot be written.
    #[error("{path}: {source}")]
    Write {
        /// Path of the file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
}

/// Source of the library of programs for a project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A clone of Glint.
    Clone(PathBuf),
    /// The URL of a git repository.
    Git(String),
}

impl Source {
    /// Parses a source: the path of a clone, or a URL.
    ///
    /// # Errors
    /// No clone of Glint is at the path.
    pub fn stated(text: &str) -> Result<Self, ProjectError> {
        if text.contains("://") {
            return Ok(Self::Git(text.to_owned()));
        }
        let path = PathBuf::from(text);
        clone_in([path.clone()]).ok_or(ProjectError::NoGlint {
            searched: path.display().to_string(),
        })
    }

    /// Finds a clone of Glint: in `GLINT_HOME`, in the folders above this program or the current folder, or the clone from which
    /// `cargo install` has built this program.
    ///
    /// # Errors
    /// No clone was found.
    pub fn found() -> Result<Self, ProjectError> {
        let folders: Vec<_> = built::folders()
            .into_iter()
            .chain(installed_from())
            .collect();
        clone_in(folders.clone()).ok_or_else(|| {
            let searched: Vec<_> = folders
                .iter()
                .map(|path| path.display().to_string())
                .collect();
            ProjectError::NoGlint {
                searched: searched.join(", "),
            }
        })
    }

    /// The dependency in a manifest.
    fn dependency(&self) -> String {
        // For paths and URLs, a string has the same syntax in TOML as in JSON.
        match self {
            Self::Clone(path) => format!(
                "path = {}",
                Value::from(path.join(LIBRARY).display().to_string())
            ),
            Self::Git(url) => format!("git = {}", Value::from(url.as_str())),
        }
    }
}

/// The first of the folders that contains the library of programs, as an absolute path.
fn clone_in(folders: impl IntoIterator<Item = PathBuf>) -> Option<Source> {
    let mut folders = folders.into_iter();
    let found = folders.find(|path| path.join(LIBRARY).join("Cargo.toml").exists())?;
    Some(Source::Clone(found.canonicalize().ok()?))
}

/// The clone from which `cargo install --path` has installed this program, according to cargo's list of installed programs.
fn installed_from() -> Option<PathBuf> {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(env::home_dir()?.join(".cargo")))?;
    let text = fs::read_to_string(home.join(".crates2.json")).ok()?;
    let list: Value = serde_json::from_str(&text).ok()?;
    let mut names = list["installs"].as_object()?.keys();
    let path = names.find_map(|name| {
        let source = name.strip_prefix("glint ")?.split_once("(path+file://")?.1;
        source.strip_suffix(')').map(PathBuf::from)
    })?;
    // The program lies in tools/glint.
    Some(path.parent()?.parent()?.to_owned())
}

/// Writes a project into the new folder `path`, whose last part is the project's name.
///
/// The folder is written under a temporary name and renamed at the end, so that a failure leaves no incomplete project.
///
/// # Errors
/// [`ProjectError`].
pub fn write(path: &Path, source: &Source) -> Result<(), ProjectError> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.filter(|name| is_name(name)).ok_or_else(|| {
        let text = path.file_name().unwrap_or(path.as_os_str());
        ProjectError::Name(text.to_string_lossy().into_owned())
    })?;
    if path.exists() {
        return Err(ProjectError::Exists(path.to_owned()));
    }
    let host = host()?;
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| ProjectError::Write { path, source }
    };
    let parent = path
        .parent()
        .filter(|parent| !parent.as_os_str().is_empty());
    let parent = parent.unwrap_or(Path::new("."));
    let folder = tempfile::tempdir_in(parent).map_err(failed(parent))?;
    for (file, template) in FILES {
        let text = template
            .replace("@NAME@", name)
            .replace("@SOURCE@", &source.dependency())
            .replace("@HOST@", &host);
        put(&folder.path().join(file), text.as_bytes())?;
    }
    // The lock file selects the versions with which Glint is tested. Cargo removes the packages that the project does not use.
    let lock = match source {
        Source::Clone(clone) => fs::read_to_string(clone.join("Cargo.lock")).ok(),
        Source::Git(_) => None,
    };
    let lock = lock.as_deref().unwrap_or(LOCK);
    put(&folder.path().join("Cargo.lock"), lock.as_bytes())?;
    fs::rename(folder.path(), path).map_err(failed(path))?;
    // The folder has moved, so there is nothing to remove.
    let _ = folder.keep();
    open(path).map_err(failed(path))
}

/// Lets all users read a folder, because only its owner can read a temporary folder.
fn open(path: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o755))
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), ProjectError> {
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = folder.and_then(|()| fs::write(path, bytes));
    written.map_err(|source| ProjectError::Write {
        path: path.to_owned(),
        source,
    })
}

/// Whether cargo accepts this name for a package.
fn is_name(name: &str) -> bool {
    let is_part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    let is_made_of_parts = name.chars().all(is_part) && !RESERVED.contains(&name);
    name.starts_with(|c: char| c.is_ascii_lowercase()) && is_made_of_parts
}

/// The compiler's target for this computer.
fn host() -> Result<String, ProjectError> {
    let output = Command::new("rustc").arg("-vV").output();
    let output = output.map_err(ProjectError::Rust)?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| {
        ProjectError::Rust(io::Error::other(format!("no line `host: ` in {text:?}")))
    })
}

/// Whether the libraries of the soft core's target are installed; true if rustc does not run.
#[must_use]
pub fn has_target(target: &str) -> bool {
    let arguments = ["--print", "target-libdir", "--target", target];
    let output = Command::new("rustc").args(arguments).output();
    output.map_or(true, |output| {
        let path = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        Path::new(&path).exists()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_packages() {
        for name in ["hello", "a1", "star-fighter", "x_2"] {
            assert!(is_name(name), "{name}");
        }
        for name in ["", "1up", "Hello", "a b", "é", "-a", "a/b", "deps"] {
            assert!(!is_name(name), "{name}");
        }
    }

    #[test]
    fn a_project_is_whole_and_is_not_written_twice() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hello");
        let source = Source::stated("https://example.org/glint.git").unwrap();
        write(&path, &source).unwrap();
        let manifest = fs::read_to_string(path.join("Cargo.toml")).unwrap();
        let manifest: toml::Table = toml::from_str(&manifest).unwrap();
        assert_eq!(manifest["package"]["name"].as_str(), Some("hello"));
        assert_eq!(
            manifest["dependencies"]["glint-program"]["git"].as_str(),
            Some("https://example.org/glint.git")
        );
        for (file, _) in FILES {
            let text = fs::read_to_string(path.join(file)).unwrap();
            assert!(!text.contains('@'), "{file}: {text}");
        }
        let error = write(&path, &source).unwrap_err().to_string();
        assert!(
            error.ends_with("hello: exists, expected a new folder"),
            "{error}"
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_without_the_library_is_refused() {
        let error = Source::stated("/nowhere").unwrap_err().to_string();
        assert!(
            error.contains("no firmware/program in /nowhere; --glint"),
            "{error}"
        );
    }
}
