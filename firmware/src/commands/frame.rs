//! Commands for frames: drawing, and download of pictures.

use glint_core::console::FrameCommands;
use litex_pac::cpu;

use super::{bench, statistics};
use crate::error::CommandError;
use crate::job::{Job, Outcome, Reply};
use crate::machine::Machine;

impl<'l> FrameCommands<'l> for Machine {
    fn render(&mut self, depth: bool) -> Outcome<'l> {
        self.picture.request();
        self.picture.wants_depth = depth;
        Ok(Reply::After(Job::Render))
    }

    fn frame(&mut self, depth: bool) -> Outcome<'l> {
        self.picture.wants_depth = depth;
        Ok(Reply::After(Job::Frame { depth }))
    }

    fn stats(&mut self, json: bool) -> Outcome<'l> {
        statistics::print(self, json)?;
        Ok(Reply::Done)
    }

    fn bench(&mut self, benchmark: Option<(&'l str, Option<u32>)>) -> Outcome<'l> {
        bench::run(self, benchmark)?;
        Ok(Reply::Done)
    }
}

/// Sends the last frame to the host: its depth codes if `depth` is true, otherwise its colours.
///
/// # Errors
/// No frame was drawn, its drawing failed, or the transfer fails.
pub fn send_frame(machine: &mut Machine, depth: bool) -> Result<(), CommandError<'static>> {
    let Machine {
        scene,
        picture,
        renderer,
        downloads,
        ..
    } = machine;
    picture
        .drawn()
        .ok_or(CommandError::NoFrame)?
        .map_err(CommandError::Render)?;
    // The triangle engine writes to memory and not to the CPU's data cache, which may hold older data.
    cpu::flush_data_cache();
    let bytes = if depth {
        bytemuck::cast_slice(renderer.depths(scene))
    } else {
        bytemuck::cast_slice(renderer.colours(scene))
    };
    downloads
        .send(&mut machine.terminal, bytes)
        .map_err(CommandError::Transfer)
}
