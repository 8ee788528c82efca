//! The command `object`: several meshes in a frame, each with its own position.

use glint_core::console::{ObjectAction, ObjectCommands};

use super::upload;
use crate::error::CommandError;
use crate::job::{Outcome, Reply};
use crate::machine::Machine;
use crate::objects::ObjectError;

impl<'l> ObjectCommands<'l> for Machine {
    fn object(&mut self, action: Option<ObjectAction<'l>>) -> Outcome<'l> {
        if let Some(ObjectAction::Add { mesh, .. }) = action {
            upload::from_flash(self, mesh)?;
        }
        let Self {
            terminal,
            models,
            scene,
            ..
        } = self;
        match action.unwrap_or(ObjectAction::List) {
            ObjectAction::List => {
                for (number, (name, place)) in (1..).zip(models.objects().list()) {
                    terminal.print(format_args!("object {number} {name} {place}\n"));
                }
                return Ok(Reply::Done);
            }
            ObjectAction::Show if models.objects().all().is_empty() => {
                return Err(CommandError::Object(ObjectError::None));
            }
            ObjectAction::Show => scene.show_objects(),
            ObjectAction::Add { mesh: name, place } => {
                let added = models.add_object(name, &place);
                let added = added.ok_or(CommandError::ObjectMesh(name))?;
                added.map_err(CommandError::Object)?;
                scene.show_objects();
            }
            ObjectAction::Change { number, next } => models
                .objects_mut()
                .change(number, &next)
                .map_err(CommandError::Object)?,
            ObjectAction::Remove(number) => {
                let removed = models.objects_mut().remove(number);
                removed.map_err(CommandError::Object)?;
                if models.objects().all().is_empty() && scene.shows_objects() {
                    scene.set_field(None);
                }
            }
        }
        if scene.shows_objects() {
            scene.touch();
        }
        Ok(Reply::Done)
    }
}
