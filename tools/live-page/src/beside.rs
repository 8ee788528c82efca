//! The files that come with a mesh, such as materials, buffers and pictures.

use glint_mesh::error::quote;
use std::path::{Component, Path, PathBuf};

/// Maximum total size in bytes of the files of an upload.
pub const MAX_UPLOAD: usize = 64 << 20;

/// Maximum number of missing files that [`Beside::hint`] names.
const MAX_NAMED: usize = 4;

/// The auxiliary files of an upload. Records which files the mesh requests and which of them are
/// missing.
#[derive(Default)]
pub struct Beside {
    /// Path of the mesh.
    mesh: PathBuf,
    /// The files with their paths, relative to the same folder as the path of the mesh.
    files: Vec<(PathBuf, Vec<u8>)>,
    /// The requested names, and whether a file was found for each.
    asked: Vec<(String, bool)>,
}

impl Beside {
    /// The auxiliary files of the mesh with the path `mesh`. Paths have the separator `/`.
    pub fn new(mesh: &str, files: impl IntoIterator<Item = (String, Vec<u8>)>) -> Self {
        let files = files.into_iter();
        let mut files: Vec<_> = files.map(|(name, data)| (flat(&name), data)).collect();
        // If several files have the requested name, `read` takes the first of them, which is
        // nearest to the top folder.
        files.sort_by_cached_key(|(path, _)| (path.components().count(), path.clone()));
        Self {
            mesh: flat(mesh),
            files,
            asked: Vec::new(),
        }
    }

    /// Returns the file that the mesh requests: the file with this path relative to the folder of
    /// the mesh or, if none exists, a file with the same last part of the path, because files that
    /// are dropped without their folders have no paths.
    pub fn read(&mut self, name: &str) -> Option<Vec<u8>> {
        let name = name.replace('\\', "/");
        let path = flat(&self.mesh.with_file_name("").join(&name).to_string_lossy());
        let last = path.file_name();
        let files = &self.files;
        let found = files.iter().find(|(other, _)| *other == path);
        let found = found.or_else(|| {
            files
                .iter()
                .find(|(other, _)| last.is_some() && other.file_name() == last)
        });
        let data = found.map(|(_, data)| data.clone());
        if self.asked.iter().all(|(earlier, _)| *earlier != name) {
            self.asked.push((name, data.is_some()));
        }
        data
    }

    /// The requested names for which no file was found. A statement of an OBJ may name several
    /// files, or one file whose name has spaces, so parsers request the whole text and each word.
    /// If all of them are missing, only the whole text is reported.
    fn missing(&self) -> Vec<&str> {
        let is_found = |word: &str| {
            self.asked
                .iter()
                .any(|(name, found)| *found && name == word)
        };
        let is_word = |word: &str| {
            let mut others = self.asked.iter().filter(|(name, _)| name != word);
            others.any(|(name, _)| name.split_whitespace().any(|other| other == word))
        };
        let missing = self.asked.iter().filter(|(name, found)| {
            !found && !name.split_whitespace().any(is_found) && !is_word(name)
        });
        missing.map(|(name, _)| name.as_str()).collect()
    }

    /// If files are missing, tells the user which files to drop on the page.
    pub fn hint(&self) -> Option<String> {
        let missing = self.missing();
        let (first, rest) = missing
            .split_at_checked(MAX_NAMED)
            .unwrap_or((&missing, &[]));
        if first.is_empty() {
            return None;
        }
        let mesh = self.mesh.file_name().unwrap_or_default();
        let mesh = quote(mesh.as_encoded_bytes());
        let names: Vec<_> = first.iter().map(|name| quote(name.as_bytes())).collect();
        let names = names.join(", ");
        let more = match rest.len() {
            0 => String::new(),
            count => format!(" and {count} more"),
        };
        Some(format!(
            "drop {mesh} together with {names}{more}, or drop their folder"
        ))
    }
}

/// Resolves `.` and, as far as possible, `..` in a path.
fn flat(path: &str) -> PathBuf {
    let mut flat = PathBuf::new();
    for component in Path::new(path).components() {
        match component {
            Component::Normal(name) => flat.push(name),
            Component::ParentDir => {
                flat.pop();
            }
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beside(mesh: &str, names: &[&str]) -> Beside {
        let files = names.iter().map(|&name| (name.into(), name.into()));
        Beside::new(mesh, files)
    }

    #[test]
    fn files_by_their_path_or_their_last_part() {
        let mut files = beside(
            "m/a/a.gltf",
            &["m/a/x.png", "m/x.png", "m/textures/x.png", "m/a/y/z.bin"],
        );
        for (name, expected) in [
            ("x.png", "m/a/x.png"),
            ("./../x.png", "m/x.png"),
            ("..\\textures\\x.png", "m/textures/x.png"),
            ("/elsewhere/x.png", "m/x.png"),
            ("C:\\z.bin", "m/a/y/z.bin"),
        ] {
            assert_eq!(files.read(name), Some(expected.into()), "{name}");
        }
        assert_eq!(files.hint(), None);
        for name in ["", "..", "/", "y.png", "a.gltf"] {
            assert_eq!(files.read(name), None, "{name}");
        }
    }

    #[test]
    fn missing_files_are_named() {
        let hint = |names: &[&str], asked: &[&str]| {
            let mut files = beside("m/a.obj", names);
            for name in asked {
                files.read(name);
            }
            files.hint()
        };
        assert_eq!(hint(&["m/a.mtl"], &["a.mtl"]), None);
        assert_eq!(
            hint(&[], &["a.mtl", "sub\\b.png", "sub/b.png"]).unwrap(),
            "drop 'a.obj' together with 'a.mtl', 'sub/b.png', or drop their folder"
        );
        // The requests for the statement `mtllib a b.mtl`.
        let asked = ["a b.mtl", "a", "b.mtl"];
        assert_eq!(
            hint(&[], &asked).unwrap(),
            "drop 'a.obj' together with 'a b.mtl', or drop their folder"
        );
        assert_eq!(hint(&["b.mtl"], &asked), None);
        let asked = ["1.png", "2.png", "3.png", "4.png", "5.png", "6.png"];
        assert_eq!(
            hint(&[], &asked).unwrap(),
            "drop 'a.obj' together with '1.png', '2.png', '3.png', '4.png' and 2 more, or drop their folder"
        );
    }
}
