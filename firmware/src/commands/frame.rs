//! Commands that draw frames and download pictures.

use glint_core::console::FrameCommands;
use litex_pac::cpu;

use super::{bench, statistics};
use crate::error::CommandError;
use crate::job::{CommandResult, Job, Reply};
use crate::machine::Machine;

impl<'l> FrameCommands<'l> for Machine {
    fn render(&mut self, depth: bool) -> CommandResult<'l> {
        check_depth(self, depth)?;
        self.picture.request();
        self.picture.wants_depth = depth;
        Ok(Reply::After(Job::Render))
    }

    fn frame(&mut self, depth: bool) -> CommandResult<'l> {
        check_depth(self, depth)?;
        self.picture.wants_depth = depth;
        Ok(Reply::After(Job::Frame { depth }))
    }

    fn stats(&mut self, json: bool) -> CommandResult<'l> {
        statistics::print(self, json)?;
        Ok(Reply::Done)
    }

    fn bench(&mut self, benchmark: Option<(&'l str, Option<u32>)>) -> CommandResult<'l> {
        bench::run(self, benchmark)?;
        Ok(Reply::Done)
    }
}

/// Checks that the picture has depth codes, if they are requested.
fn check_depth(machine: &Machine, is_requested: bool) -> Result<(), CommandError<'static>> {
    if is_requested && !machine.scene.has_depths() {
        return Err(CommandError::DepthsOfSamples);
    }
    Ok(())
}

/// Begins to send a copy of the last frame to the host: the depth codes if `depth` is true, otherwise the colours. The display continues
/// during the transfer.
///
/// # Errors
/// No frame has been drawn, or the drawing of the last frame failed.
pub fn begin_download(machine: &mut Machine, depth: bool) -> CommandResult<'static> {
    let Machine {
        scene,
        picture,
        renderer,
        downloads,
        terminal,
        ..
    } = machine;
    picture
        .drawn()
        .ok_or(CommandError::NoFrame)?
        .map_err(CommandError::Render)?;
    // From now on, frames need no depth codes in memory.
    picture.wants_depth = false;
    // The triangle engine writes to memory and not to the CPU's data cache, which may hold older data.
    cpu::flush_data_cache();
    let bytes = if depth {
        bytemuck::cast_slice(renderer.depths(scene.size))
    } else {
        bytemuck::cast_slice(renderer.colours(scene.size))
    };
    let transfer = downloads.send_copy(bytes, terminal);
    Ok(Reply::After(Job::Transfer(transfer)))
}
