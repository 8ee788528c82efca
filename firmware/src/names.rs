//! The names of scenes, meshes, textures and wireframe programs, for the completion on the console.

use glint_core::console::{NameList, Names};
use glint_core::flash::Kind;
use glint_core::wireframe::CUBE_NAME;
use glint_program::shapes::Shapes;
use glint_scene::Name;
use heapless::Vec;

use crate::arena::MAX_UPLOADS;
use crate::models::Models;
use crate::scenes::{DEFAULT, Library, SCENES, SceneItem};

/// The names of this machine. The names of uploads are copies, because the console also completes names while meshes are drawn and the
/// uploads are borrowed.
#[derive(Default)]
pub struct MachineNames {
    library: Library,
    /// The uploads with their kinds.
    uploads: Vec<(Name, Kind), MAX_UPLOADS>,
    /// [`Models::revision`] of the copies.
    revision: u32,
}

impl MachineNames {
    /// The names of a machine with this library of scenes, without uploads.
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
            let names = models.names();
            self.uploads = names.map(|(name, kind)| (name.clone(), kind)).collect();
        }
    }

    /// Whether there is an upload of this kind and name.
    fn is_uploaded(&self, kind: Kind, name: &str) -> bool {
        let mut uploads = self.uploads.iter();
        uploads.any(|(known, of)| *of == kind && known == name)
    }
}

impl Names for MachineNames {
    fn visit(&self, list: NameList, visit: &mut dyn FnMut(&str)) {
        if matches!(list, NameList::Scenes | NameList::Meshes) {
            let built_in = Shapes::names().filter(|name| !self.is_uploaded(Kind::Mesh, name));
            built_in.for_each(&mut *visit);
        }
        if list == NameList::Programs && !self.is_uploaded(Kind::Program, CUBE_NAME) {
            visit(CUBE_NAME);
        }
        for (name, kind) in &self.uploads {
            if list == NameList::Uploads || is_listed(list, *kind) {
                visit(name);
            }
        }
        for item in self.library.items() {
            if is_listed(list, item.kind) && !self.is_uploaded(item.kind, item.name) {
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

/// Whether a list of names includes the items of this kind in the flash.
fn is_listed(list: NameList, kind: Kind) -> bool {
    match list {
        NameList::Scenes => !matches!(kind, Kind::Texture | Kind::Program),
        NameList::Meshes => kind == Kind::Mesh,
        NameList::Textures => kind == Kind::Texture,
        NameList::Programs => kind == Kind::Program,
        NameList::Uploads => false,
    }
}
