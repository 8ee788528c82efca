//! Commands for options of the scene, and the properties of the board on which these options depend.

use glint_core::console::{Executor, ObjectAction, OptionName, Setting};
use glint_core::feature::Feature;
use glint_core::flash::Kind;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_program::renderer::Renderer;
use glint_scene::Board;

use super::upload;
use crate::error::CommandError;
use crate::job::{CommandResult, Reply};
use crate::machine::Machine;
use crate::models::Models;

struct ThisBoard<'m> {
    renderer: &'m Renderer,
    models: &'m mut Models,
}

/// The properties of this board on which options of a scene depend.
pub const fn board<'m>(renderer: &'m Renderer, models: &'m mut Models) -> impl Board + 'm {
    ThisBoard { renderer, models }
}

impl Board for ThisBoard<'_> {
    fn has_size(&self, size: Size) -> bool {
        self.renderer.has_size(size)
    }

    fn has_engine(&self) -> bool {
        self.renderer.gateware.is_some()
    }

    fn has_mesh(&mut self, name: &str) -> bool {
        self.models.prepare(name)
    }

    fn mesh(&self, name: &str) -> Option<Mesh<'_>> {
        self.models.known(name)
    }

    fn has_texture(&self, name: &str) -> bool {
        self.models.has_texture(name)
    }

    fn has_program(&self, name: &str) -> bool {
        self.models.has_program(name)
    }
}

impl<'l> Executor<'l> for Machine {
    type Output = CommandResult<'l>;

    fn set(&mut self, setting: Setting<'l>) -> CommandResult<'l> {
        if let Setting::Object { action } = setting {
            match action {
                ObjectAction::List => return self.show(OptionName::Object),
                ObjectAction::Add { mesh, .. } => {
                    upload::from_flash(self, Kind::Mesh, mesh)?;
                }
                ObjectAction::Show | ObjectAction::Change { .. } | ObjectAction::Remove(_) => {}
            }
        }
        if let Setting::Texture {
            texture: Some(texture),
        } = setting
        {
            upload::from_flash(self, Kind::Texture, texture)?;
        }
        let Self {
            scene,
            renderer,
            models,
            ..
        } = self;
        scene.apply(&setting, &mut board(renderer, models))?;
        if let Some(note) = setting.note() {
            self.terminal.print(format_args!("note: {note}\n"));
        }
        if matches!(setting, Setting::Texture { .. }) {
            self.note_texture();
        }
        Ok(Reply::Done)
    }

    fn show(&mut self, option: OptionName) -> CommandResult<'l> {
        // Writing fails only if the line accepts no text.
        let _ = self.scene.show(option, self.terminal.output());
        Ok(Reply::Done)
    }

    fn left_out(&mut self, feature: Feature) -> CommandResult<'l> {
        Err(CommandError::LeftOut(feature))
    }
}
