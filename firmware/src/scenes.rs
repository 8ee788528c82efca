//! Scenes and lists of scenes by name: those in the flash, and the built-in ones.

mod built_in;
mod content;
#[rustfmt::skip]
mod table;

use glint_core::deviation::{Deviation, Expected};
use glint_core::feature::DEMO;
use glint_core::flash::{Contents, Item, Kind};

pub use built_in::BuiltIn;
pub use content::{Content, List};
pub use table::SCENES;

/// Name of the default scene, which every gateware can show.
pub const DEFAULT: &str = "default";
/// Name of the built-in demo list.
const ALONE: &str = "demo";

/// The built-in scene or list with this name.
pub fn named(name: &str) -> Option<&'static BuiltIn> {
    SCENES.iter().find(|scene| scene.name == name)
}

/// A scene or a list of scenes.
#[derive(Clone, Copy, Debug)]
pub enum SceneItem {
    /// A scene or list in the flash.
    Flash(Item<'static>),
    /// A scene or list in the firmware.
    BuiltIn(&'static BuiltIn),
}

impl SceneItem {
    /// Returns the content of the scene or list.
    ///
    /// # Errors
    /// The flash is damaged.
    pub fn content(&self) -> Result<Content, Deviation> {
        match self {
            Self::Flash(item) if item.kind == Kind::List => {
                Ok(Content::Scenes(List::Flash(item.text()?)))
            }
            Self::Flash(item) => Ok(Content::Lines(item.text()?)),
            Self::BuiltIn(built_in) => Ok(built_in.content),
        }
    }
}

/// The built-in demo list, for a board without a list in its flash.
pub fn built_in_list() -> List {
    match named(ALONE).map(|built_in| built_in.content) {
        Some(Content::Scenes(list)) => list,
        Some(Content::Lines(_)) | None => List::BuiltIn(&[]),
    }
}

/// The contents of the flash, which have priority over built-in scenes, lists and meshes with the same names.
#[derive(Clone, Copy, Default)]
pub struct Library {
    contents: Option<Contents<'static>>,
    error: Option<Deviation>,
}

impl Library {
    /// Creates the library of a board from the flash's bytes at the address of the contents; pass `None` without a flash. Bytes without the
    /// header of contents count as no contents, because the flash is then erased or holds other data.
    pub fn new(flash: Option<&'static [u8]>) -> Self {
        let flash = flash.filter(|_| DEMO.is_built);
        let (contents, error) = match flash.map(Contents::new_checked) {
            Some(Ok(contents)) => (Some(contents), None),
            Some(Err(Deviation {
                expected: Expected::Magic(_),
                ..
            }))
            | None => (None, None),
            Some(Err(error)) => (None, Some(error)),
        };
        Self { contents, error }
    }

    /// The error in the contents of the flash, because of which the contents are not used.
    pub const fn error(&self) -> Option<Deviation> {
        self.error
    }

    /// All items of the flash: scenes, lists, meshes, textures and wireframe programs.
    pub fn items(&self) -> impl Iterator<Item = Item<'static>> + use<> {
        self.contents
            .into_iter()
            .flat_map(|contents| contents.items())
    }

    /// The scene or list with this name.
    pub fn find(&self, name: &str) -> Option<SceneItem> {
        let kinds = [Kind::Scene, Kind::List].into_iter();
        let mut found = kinds.filter_map(|kind| self.contents?.find(kind, name));
        let built_in = || named(name).map(SceneItem::BuiltIn);
        found.next().map(SceneItem::Flash).or_else(built_in)
    }

    /// The mesh, texture or wireframe program of the flash with this name.
    pub fn item(&self, kind: Kind, name: &str) -> Option<Item<'static>> {
        self.contents?.find(kind, name)
    }

    /// The first list of scenes in the flash.
    pub fn first_list(&self) -> Option<Item<'static>> {
        self.items().find(|item| item.kind == Kind::List)
    }
}
