//! The built-in scenes: console commands that set everything a picture depends on.

mod built_in;
#[rustfmt::skip]
mod table;

pub use built_in::BuiltIn;
pub use table::SCENES;

/// Name of the scene at start, which every gateware has.
pub const DEFAULT: &str = "default";

/// The built-in scene with this name.
pub fn named(name: &str) -> Option<&'static BuiltIn> {
    SCENES.iter().find(|scene| scene.name == name)
}
