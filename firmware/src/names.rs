//! The names of scenes, meshes and textures, for the completion on the console.

use glint_core::console::{NameList, Names};
use glint_core::flash::Kind;
use glint_scene::Name;
use heapless::Vec;

use crate::models::{MAX_UPLOADS, Models};
use crate::scenes::{DEFAULT, Library, SCENES, SceneItem};
use crate::shapes::Shapes;

/// The names of this machine. The uploads' names are copies, because the console also completes while meshes are drawn.
#[derive(Default)]
pub struct MachineNames {
    library: Library,
    meshes: Vec<Name, MAX_UPLOADS>,
    textures: Vec<Name, MAX_UPLOADS>,
    /// [`Models::revision`] of the copies.
    revision: u32,
}

impl MachineNames {
    /// The names of a machine with this library, without uploads.
    pub const fn new(library: Library) -> Self {
        Self {
            library,
            meshes: Vec::new(),
            textures: Vec::new(),
            revision: 0,
        }
    }

    /// Copies the uploads' names, if the uploads have changed.
    pub fn update(&mut self, models: &Models) {
        if self.revision != models.revision() {
            self.revision = models.revision();
            let copy = |name| Name::try_from(name).ok();
            let meshes = models.meshes();
            self.meshes = meshes.filter_map(|(name, _)| copy(name)).collect();
            let textures = models.textures();
            self.textures = textures.filter_map(|(name, _)| copy(name)).collect();
        }
    }

    /// Whether an uploaded mesh has this name.
    fn is_uploaded(&self, name: &str) -> bool {
        self.meshes.iter().any(|mesh| mesh == name)
    }
}

impl Names for MachineNames {
    fn visit(&self, list: NameList, visit: &mut dyn FnMut(&str)) {
        if matches!(list, NameList::Scenes | NameList::Meshes) {
            let built_in = Shapes::names().filter(|name| !self.is_uploaded(name));
            built_in.for_each(&mut *visit);
        }
        if list != NameList::Textures {
            self.meshes.iter().for_each(|name| visit(name));
        }
        if matches!(list, NameList::Textures | NameList::Uploads) {
            self.textures.iter().for_each(|name| visit(name));
        }
        for item in self.library.items() {
            let is_listed = match list {
                NameList::Scenes => match item.kind {
                    Kind::Mesh => !self.is_uploaded(item.name),
                    Kind::Scene | Kind::List => true,
                    Kind::Texture => false,
                },
                NameList::Meshes => item.kind == Kind::Mesh && !self.is_uploaded(item.name),
                NameList::Textures => {
                    item.kind == Kind::Texture
                        && self.textures.iter().all(|texture| texture != item.name)
                }
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
