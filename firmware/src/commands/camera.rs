//! Commands that show and set the camera.

use glint_core::camera::View;
use glint_core::console::CameraCommands;
use glint_core::fixed::{Q32_32, Turns, U8_28};
use glint_core::matrix::Axis;

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

    fn zoom(&mut self, factor: U8_28) -> Outcome<'l> {
        let view = self.scene.view();
        // Rounded down. A factor that is too small makes a half width out of range.
        let half_width = view.half_width().checked_div(factor);
        let half_width = half_width.unwrap_or(U8_28::lit("256"));
        let view = view.with_half_width(half_width);
        self.scene.set_view(view.map_err(CommandError::View)?);
        Ok(Reply::Done)
    }

    fn fit(&mut self, lens: Option<(Axis, Option<Turns>)>) -> Outcome<'l> {
        let (up, angle) = lens.unwrap_or((Axis::Z, None));
        let sphere = self.scene.frame(&self.models).subject.sphere();
        let sphere = sphere.ok_or(CommandError::FitOfOthers)?;
        let view = sphere.framed(up, Turns::default(), angle);
        self.scene.set_view(view.map_err(CommandError::Fit)?);
        Ok(Reply::Done)
    }

    fn orbit(&mut self, frames: Option<u32>) -> Outcome<'l> {
        let orbit = Orbit::new(self.scene.sphere(), frames);
        Ok(Reply::After(Job::Orbit(orbit)))
    }
}
