//! Mesh files: formats, reading, writing.

pub mod glm;
pub mod gltf;
pub mod mtl;
pub mod obj;
pub mod ply;
pub mod stl;
pub mod text;
pub mod write;

use crate::error::{FormatError, InputError, MAX_FILE, USUAL_COORDINATE};
use crate::polygons::Polygons;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use text::BYTE_ORDER_MARK;

/// A mesh file's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// STL; written as binary.
    Stl,
    /// PLY; written as binary, little-endian.
    Ply,
    /// glTF 2.0, JSON or binary; not written.
    Gltf,
    /// Glint's own format, GLM: a mesh in a board's memory layout.
    Glm,
}

impl Format {
    /// Selects the format by a file's extension.
    ///
    /// # Errors
    /// The extension is not obj, stl, ply, gltf, glb or glm.
    pub fn of(path: &Path) -> Result<Self, InputError> {
        let extension = path
            .extension()
            .map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("obj") => Ok(Self::Obj),
            Some("stl") => Ok(Self::Stl),
            Some("ply") => Ok(Self::Ply),
            Some("gltf" | "glb") => Ok(Self::Gltf),
            Some("glm") => Ok(Self::Glm),
            other => {
                let found = other.map_or("no extension".into(), |other| {
                    format!("'.{}'", other.escape_default())
                });
                let expected = "a name that ends in .obj, .stl, .ply, .gltf, .glb or .glm";
                Err(FormatError::whole(expected, found).in_path(path))
            }
        }
    }

    /// Detects the format from a file's contents: from the first word or, for a binary STL, from the length; otherwise OBJ.
    pub fn of_contents(bytes: &[u8]) -> Self {
        let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        let text = text.trim_ascii_start();
        let is_binary_stl = || {
            let count = bytes.get(80..84).and_then(<[u8]>::first_chunk);
            let count = count.map(|count| u64::from(u32::from_le_bytes(*count)));
            count.is_some_and(|count| bytes.len() as u64 >= 84 + 50 * count && count > 0)
        };
        let begins_with =
            |words: &[&str]| words.iter().any(|word| text.starts_with(word.as_bytes()));
        let is_ascii_stl = || {
            let first = text.split(u8::is_ascii_whitespace).next();
            first.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        };
        if begins_with(&["glTF", "{"]) {
            Self::Gltf
        } else if begins_with(&["GLM"]) {
            Self::Glm
        } else if begins_with(&["ply\n", "ply\r", "ply "]) {
            Self::Ply
        } else if is_ascii_stl() || is_binary_stl() {
            Self::Stl
        } else {
            Self::Obj
        }
    }
}

/// The name of standard input.
pub const STDIN: &str = "-";

/// Reads a whole file, or standard input for [`STDIN`].
///
/// # Errors
/// The file cannot be read, or is larger than [`MAX_FILE`].
pub fn read_file(path: &Path) -> Result<Vec<u8>, InputError> {
    read_up_to(path, MAX_FILE)
}

/// Reads a whole file, or standard input for [`STDIN`], of at most `most` bytes.
///
/// # Errors
/// The file cannot be read, or has more than `most` bytes.
pub fn read_up_to(path: &Path, most: usize) -> Result<Vec<u8>, InputError> {
    let mut bytes = Vec::new();
    let limit = most as u64 + 1;
    let read = if path == Path::new(STDIN) {
        io::stdin().lock().take(limit).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes))
    };
    read.map_err(|error| FormatError::whole("a file to read", error.to_string()).in_path(path))?;
    if bytes.len() > most {
        return Err(FormatError::whole(format!("at most {most} bytes"), "more").in_path(path));
    }
    Ok(bytes)
}

/// Reads a mesh file of any format. Auxiliary files, such as the material files of an OBJ and the
/// buffers of a glTF, are read only from the file's folder.
///
/// # Errors
/// The file cannot be read, or violates its format.
pub fn read(path: &Path) -> Result<Polygons, InputError> {
    let (format, bytes) = read_mesh(path)?;
    parse(path, format, &bytes, &mut in_folder_of(path))
}

/// Reads the bytes of a mesh file, and detects its format from the file's name, or from its contents for standard input.
///
/// # Errors
/// The name does not have the extension of a mesh format, or the file cannot be read.
pub fn read_mesh(path: &Path) -> Result<(Format, Vec<u8>), InputError> {
    if path == Path::new(STDIN) {
        let bytes = read_file(path)?;
        return Ok((Format::of_contents(&bytes), bytes));
    }
    Ok((Format::of(path)?, read_file(path)?))
}

/// A function that reads an auxiliary file of a mesh file by its name; `None` if it cannot be read.
pub type Beside<'a> = dyn FnMut(&str) -> Option<Vec<u8>> + 'a;

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// The file cannot be read, or is larger.
pub fn read_at_most(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let message = format!("expected at most {limit} bytes, found more");
        return Err(io::Error::other(message));
    }
    Ok(bytes)
}

/// Returns a function that reads auxiliary files from the folder of `path` and its subfolders. If
/// no file has the path that a name states, the last part of the name is tried in the folder. A
/// link to a file outside of the folder is not followed, because an untrusted mesh file could then
/// read any file.
pub fn in_folder_of(path: &Path) -> impl FnMut(&str) -> Option<Vec<u8>> {
    move |name| {
        let folder = Path::new(".").join(path.parent()?).canonicalize().ok()?;
        let within = |name: &Path| {
            let file = folder.join(name);
            let parent = file.parent()?.canonicalize().ok()?;
            let file = file.canonicalize().ok()?;
            let is_within = parent.starts_with(&folder) && file.parent() == Some(&parent);
            // Reading a device or a pipe could block or never end.
            let is_file = file.metadata().is_ok_and(|data| data.is_file());
            (is_within && is_file).then_some(file)
        };
        let name = Path::new(name);
        let file = within(name).or_else(|| within(Path::new(name.file_name()?)))?;
        read_file(&file).ok()
    }
}

/// Parses a mesh file; errors name the file `path`.
///
/// # Errors
/// The file violates its format.
pub fn parse(
    path: &Path,
    format: Format,
    bytes: &[u8],
    beside: &mut Beside,
) -> Result<Polygons, InputError> {
    let parsed = match format {
        Format::Obj => match obj::parse(bytes, beside) {
            Err(obj::ObjError::Mtl(error)) => return Err(error),
            Err(obj::ObjError::Obj(error)) => Err(error),
            Ok(polygons) => Ok(polygons),
        },
        Format::Gltf => gltf::parse(bytes, beside),
        Format::Stl => stl::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Glm => glm::parse(bytes),
    };
    let mut polygons = parsed.map_err(|error| error.in_path(path))?;
    if format != Format::Glm && bytes.starts_with(BYTE_ORDER_MARK) {
        polygons.remark("the byte order mark at the start is skipped");
    }
    let largest = polygons.points.as_flattened().iter();
    let largest = largest.fold(0.0, |largest: f64, c| largest.max(c.abs()));
    if largest > USUAL_COORDINATE {
        polygons.remark(format!(
            "a coordinate of magnitude {largest:e}: the file may be damaged"
        ));
    }
    Ok(polygons)
}
