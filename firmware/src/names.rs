//! The names of scenes and meshes, for the completion on the console.

use glint_core::console::{NameList, Names};
use glint_core::flash::Kind;
use glint_scene::Name;
use heapless::Vec;

use crate::models::{MAX_MESHES, Models};
use crate::scenes::{DEFAULT, Library, SCENES, SceneItem};
use crate::shapes::Shapes;

/// The names of this machine. The uploads' names are copies, because the console also completes while meshes are drawn.
#[derive(Default)]
pub struct MachineNames {
    library: Library,
    uploads: Vec<Name, MAX_MESHES>,
    /// [`Models::revision`] of the copies.
    revision: u32,
}

impl MachineNames {
    /// The names of a machine with this library, without uploads.
    pub const fn new(library: Library) -> Self {
        Self {
            library,
            uploads: Vec::new(),
            revision: 0,
        }
    }

    /// Copies the uploads' names, if the uploads have changed.
    pub fn update(&mut self, models: &Models) {
        if self.revision != models.revision() {
            self.revision = models.revision();
            let names = models.uploads().map(|(name, _)| name);
            self.uploads = names.filter_map(|name| Name::try_from(name).ok()).collect();
        }
    }

    fn is_uploaded(&self, name: &str) -> bool {
        self.uploads.iter().any(|upload| upload == name)
    }
}

impl Names for MachineNames {
    fn visit(&self, list: NameList, visit: &mut dyn FnMut(&str)) {
        if list != NameList::Uploads {
            let built_in = Shapes::names().filter(|name| !self.is_uploaded(name));
            built_in.for_each(&mut *visit);
        }
        self.uploads.iter().for_each(|name| visit(name));
        for item in self.library.items() {
            let is_listed = match list {
                NameList::Scenes => item.kind != Kind::Mesh || !self.is_uploaded(item.name),
                NameList::Meshes => item.kind == Kind::Mesh && !self.is_uploaded(item.name),
                NameList::Uploads => false,
            };
            if is_listed {
                visit(item.name);
            }
        }
        if list == NameList::Scenes {
            let names = SCENES.iter().map(|scene| scene.name);
            names
                .filter(|name| matches!(self.library.find(name), Some(SceneItem::BuiltIn(_))))
                .for_each(&mut *visit);
            visit(DEFAULT);
        }
    }
}
