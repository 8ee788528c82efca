//! Scenes and lists in the firmware.

use glint_core::feature::Feature;

use super::content::{Content, List};

/// A built-in scene or list of scenes.
#[derive(Debug)]
pub struct BuiltIn {
    /// Name of the scene or list on the console.
    pub name: &'static str,
    /// The parts of the firmware that the scene requires.
    pub features: &'static [Feature],
    /// The lines of the scene, or the names in the list.
    pub content: Content,
}

impl BuiltIn {
    /// A scene. A build that lacks one of the features does not include the lines of the scene.
    pub const fn picture(
        name: &'static str,
        features: &'static [Feature],
        lines: &'static str,
    ) -> Self {
        let lines = if all_built(features) { lines } else { "" };
        Self {
            name,
            features,
            content: Content::Lines(lines),
        }
    }

    /// Defines a list of scenes.
    pub const fn list(
        name: &'static str,
        features: &'static [Feature],
        scenes: &'static [&'static str],
    ) -> Self {
        Self {
            name,
            features,
            content: Content::Scenes(List::BuiltIn(scenes)),
        }
    }

    /// The parts of the firmware that the scene requires and this build does not include.
    pub fn lacks_features(&self) -> impl Iterator<Item = &'static Feature> {
        self.features.iter().filter(|feature| !feature.is_built)
    }
}

const fn all_built(features: &[Feature]) -> bool {
    let mut number = 0;
    while number < features.len() {
        if !features[number].is_built {
            return false;
        }
        number += 1;
    }
    true
}
