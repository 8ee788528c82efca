//! Scenes by their names.

use std::fs;
use std::path::Path;

use crate::built_in::{NAMES, TEXTS};
use crate::error::{SceneError, Source};
use crate::scene::Scene;

/// The built-in scene with this name; `None` for another name.
pub fn built_in(name: &str) -> Option<Scene> {
    let (name, text) = NAMES.iter().zip(TEXTS).find(|(known, _)| **known == name)?;
    // A test parses all of them.
    Scene::parse(name, &format!("scenes/{name}.toml"), text).ok()
}

/// Reads a scene: a built-in one by its name, or a scene file by its path, which ends in `.toml`.
///
/// # Errors
/// No built-in scene has the name, the file cannot be read, or it is no scene file.
pub fn read(name: &str) -> Result<Scene, SceneError> {
    if let Some(scene) = built_in(name) {
        return Ok(scene);
    }
    let path = Path::new(name);
    let file = &name.escape_debug().to_string();
    let source = Source { file, text: "" };
    if path.extension().is_none_or(|extension| extension != "toml") {
        let message = format!(
            "expected a scene file FILE.toml or one of {}",
            NAMES.join(", ")
        );
        return Err(source.whole(message));
    }
    let text = fs::read_to_string(path).map_err(|error| source.whole(error.to_string()))?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Scene::parse(&stem, file, &text)
}
