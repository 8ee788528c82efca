//! Commands that show and set the camera.

use glint_core::camera::View;
use glint_core::console::CameraCommands;
use glint_core::fixed::{Q32_32, Turns, U8_28};

use crate::error::CommandError;
use crate::job::{Job, Orbit, Outcome, Reply};
use crate::machine::Machine;
use crate::scene::Sphere;

impl<'l> CameraCommands<'l> for Machine {
    fn camera(&mut self, r: Q32_32, theta: Turns, phi: Turns) -> Outcome<'l> {
        self.scene
            .set_sphere(Sphere { r, theta, phi })
            .map_err(CommandError::View)?;
        Ok(Reply::Done)
    }

    fn view(&mut self, view: Option<View>) -> Outcome<'l> {
        match view {
            Some(view) => self.scene.set_view(view),
            None => self.terminal.print_entry("view", self.scene.view()),
        }
        Ok(Reply::Done)
    }

    fn look(&mut self, yaw: Turns, pitch: Turns, roll: Turns) -> Outcome<'l> {
        let eye = self.scene.view().eye();
        let view = View::look(eye, yaw, pitch, roll).map_err(CommandError::View)?;
        self.scene.move_view(view);
        Ok(Reply::Done)
    }

    fn lookat(&mut self, view: View) -> Outcome<'l> {
        self.scene.move_view(view);
        Ok(Reply::Done)
    }

    fn fov(&mut self, angle: Turns) -> Outcome<'l> {
        let view = self.scene.view().with_field_of_view(angle);
        self.scene.set_view(view.map_err(CommandError::View)?);
        Ok(Reply::Done)
    }

    fn orthographic(&mut self, width: U8_28) -> Outcome<'l> {
        let view = self.scene.view().with_width(width);
        self.scene.set_view(view.map_err(CommandError::View)?);
        Ok(Reply::Done)
    }

    fn orbit(&mut self, frames: Option<u32>) -> Outcome<'l> {
        let orbit = Orbit::new(self.scene.sphere(), frames);
        Ok(Reply::After(Job::Orbit(orbit)))
    }
}
