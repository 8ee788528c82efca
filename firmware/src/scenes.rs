//! The built-in scenes: console commands that set everything a picture depends on.

mod built_in;
#[rustfmt::skip]
mod table;

pub use built_in::BuiltIn;
use built_in::Content;
pub use table::SCENES;

/// Name of the scene at start, which every gateware has.
pub const DEFAULT: &str = "default";

/// The console commands of a built-in scene, a line each; of a list of scenes, those of the first one.
pub fn lines(scene: &BuiltIn) -> &'static str {
    match scene.content {
        Content::Lines(lines) => lines,
        Content::Scenes(names) => match names.first().and_then(|name| named(name)) {
            Some(BuiltIn {
                content: Content::Lines(lines),
                ..
            }) => lines,
            _ => "",
        },
    }
}

/// The built-in scene with this name.
pub fn named(name: &str) -> Option<&'static BuiltIn> {
    SCENES.iter().find(|scene| scene.name == name)
}
