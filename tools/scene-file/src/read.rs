//! Reads scenes by name or path.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::built_in::{NAMES, TEXTS};
use crate::error::{SceneError, Source, resembled};
use crate::scene::SceneFile;

/// The name of standard input.
const STDIN: &str = "-";
/// Maximum length of a scene file in bytes.
pub const MAX_BYTES: u64 = 1 << 20;

/// The built-in scene `name`; `None` for another name.
pub fn built_in(name: &str) -> Option<SceneFile> {
    let (name, text) = NAMES.iter().zip(TEXTS).find(|(known, _)| **known == name)?;
    // A test parses all built-in scenes.
    SceneFile::parse(name, &format!("scenes/{name}.toml"), text).ok()
}

/// Reads a scene: a built-in scene by its name, or a scene file by its path, which ends in `.toml`; `-` is standard input.
///
/// # Errors
/// No built-in scene has the name, the file cannot be read, or the text is not a scene file.
pub fn read(name: &str) -> Result<SceneFile, SceneError> {
    if let Some(scene) = built_in(name) {
        return Ok(scene);
    }
    let path = Path::new(name);
    let file = &name.escape_debug().to_string();
    let source = Source { file, text: "" };
    let is_stdin = name == STDIN;
    if !is_stdin && path.extension().is_none_or(|extension| extension != "toml") {
        let expected = "expected a scene file FILE.toml or";
        return Err(source.whole(match resembled(name, NAMES) {
            Some(known) => format!("{expected} a built-in scene, did you mean `{known}`?"),
            None => format!("{expected} one of {}", NAMES.join(", ")),
        }));
    }
    let text = match is_stdin {
        true => contents(io::stdin().lock()),
        false => File::open(path).and_then(contents),
    };
    let text = text.map_err(|error| source.whole(error.to_string()))?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    SceneFile::parse(&stem, file, &text)
}

/// The text of a scene file.
fn contents(file: impl Read) -> io::Result<String> {
    let mut text = String::new();
    file.take(MAX_BYTES + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MAX_BYTES {
        let message = format!("expected at most {MAX_BYTES} bytes, found more");
        return Err(io::Error::other(message));
    }
    Ok(text)
}
