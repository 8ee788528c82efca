//! Parses distance fields of the command line, and reads lists of spheres from JSON files.

use crate::error::{FormatError, InputError};
use crate::formats::read_file;
use glint_core::field::MAX_SPHERES;
use std::borrow::Cow;
use std::path::Path;

/// The kind of field that can be read from a file.
const KIND: &str = "spheres:";

/// The file of a field `spheres:FILE.json`, alone or in a union.
pub fn file(text: &str) -> Option<&str> {
    let at = text.find(KIND).filter(|_| text.ends_with(".json"))?;
    text.get(at + KIND.len()..)
}

/// Replaces `spheres:FILE.json` in the text of a field, alone or in a union, by
/// `spheres:X,Y,Z,R;...`. The rest of the text does not change.
///
/// # Errors
/// The file cannot be read, or [`spheres`] rejects it.
pub fn with_files(text: &str) -> Result<Cow<'_, str>, InputError> {
    let Some(file) = file(text) else {
        return Ok(text.into());
    };
    let kind = text.strip_suffix(file).unwrap_or(text);
    let list = spheres(&read_file(Path::new(file))?)
        .map_err(|error| error.in_file(file.escape_debug().to_string()))?;
    Ok(format!("{kind}{list}").into())
}

/// Reads spheres, `[[cx,cy,cz,r],...]` in world units, and returns them as `X,Y,Z,R;...`.
///
/// # Errors
/// The JSON has another form, no sphere, or more than [`MAX_SPHERES`] spheres. The field parser checks the numbers.
pub fn spheres(bytes: &[u8]) -> Result<String, FormatError> {
    let list: Vec<[f64; 4]> = serde_json::from_slice(bytes).map_err(|error| {
        let found = error.to_string().escape_debug().to_string();
        FormatError::whole("[[cx,cy,cz,r],...]", found)
    })?;
    if list.is_empty() || list.len() > MAX_SPHERES {
        let expected = format!("1 to {MAX_SPHERES} spheres");
        return Err(FormatError::whole(expected, list.len().to_string()));
    }
    let typed = |numbers: [f64; 4]| numbers.map(|x| x.to_string()).join(",");
    Ok(list.into_iter().map(typed).collect::<Vec<_>>().join(";"))
}
