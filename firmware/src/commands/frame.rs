//! Commands for frames: settings, drawing, and download of pictures.

use glint_core::choice::switch_name;
use glint_core::colour::{Shading, Winding};
use glint_core::console::FrameCommands;
use glint_core::fixed::U8_28;
use glint_core::picture::{Backend, Edges, Size};
use glint_core::quality::Quality;
use glint_model::Clip;
use litex_pac::cpu;

use super::{bench, statistics};
use crate::error::CommandError;
use crate::format::OrOff;
use crate::job::{Job, Outcome, Reply};
use crate::machine::Machine;

impl<'l> FrameCommands<'l> for Machine {
    fn quality(&mut self, quality: Option<Quality>) -> Outcome<'l> {
        let Some(quality) = quality else {
            let quality = self.scene.quality();
            self.terminal.print_entry("quality", &quality);
            return Ok(Reply::Done);
        };
        // The largest size of this board up to that of the quality.
        let sizes = Size::ALL.into_iter().rev();
        let mut sizes = sizes.skip_while(|size| *size != quality.size());
        if let Some(size) = sizes.find(|size| self.renderer.has_size(*size)) {
            self.scene.set_size(size);
        }
        self.scene.set_quality(quality);
        Ok(Reply::Done)
    }

    fn size(&mut self, size: Size) -> Outcome<'l> {
        if !self.renderer.has_size(size) {
            return Err(CommandError::Size(size));
        }
        self.scene.set_size(size);
        Ok(Reply::Done)
    }

    fn backend(&mut self, backend: Option<Backend>) -> Outcome<'l> {
        match backend {
            Some(Backend::Gateware) if self.renderer.gateware.is_none() => {
                return Err(CommandError::NoEngine);
            }
            Some(backend) => self.scene.set_backend(backend),
            None => {
                let backend = self.scene.backend();
                self.terminal.print_entry("backend", &backend);
            }
        }
        Ok(Reply::Done)
    }

    fn shading(&mut self, shading: Option<Shading>) -> Outcome<'l> {
        match shading {
            Some(shading) => self.scene.set_shading(shading),
            None => {
                let shading = self.scene.shading();
                self.terminal.print_entry("shading", &shading);
            }
        }
        Ok(Reply::Done)
    }

    fn cull(&mut self, on: bool) -> Outcome<'l> {
        self.scene.set_cull(on);
        Ok(Reply::Done)
    }

    fn clip(&mut self, far: Option<U8_28>) -> Outcome<'l> {
        let clip = far.map_or(Clip::Guard, |far| Clip::View { far });
        self.scene.set_clip(clip);
        Ok(Reply::Done)
    }

    fn winding(&mut self, winding: Winding) -> Outcome<'l> {
        self.scene.set_winding(winding);
        Ok(Reply::Done)
    }

    fn edges(&mut self, edges: Option<Option<Edges>>) -> Outcome<'l> {
        match edges {
            Some(edges) if self.scene.set_edges(edges) => {}
            Some(_) => return Err(CommandError::EdgesOfOthers),
            None => {
                let edges = OrOff(self.scene.edges());
                self.terminal.print_entry("edges", &edges);
            }
        }
        Ok(Reply::Done)
    }

    fn overlay(&mut self, on: Option<bool>) -> Outcome<'l> {
        match on {
            Some(on) => self.scene.set_overlay(on),
            None => {
                let on = switch_name(self.scene.has_overlay());
                self.terminal.print_entry("overlay", &on);
            }
        }
        Ok(Reply::Done)
    }

    fn prepass(&mut self, on: bool) -> Outcome<'l> {
        self.scene.set_prepass(on);
        Ok(Reply::Done)
    }

    fn render(&mut self, depth: bool) -> Outcome<'l> {
        self.scene.touch();
        self.scene.want_depth(depth);
        Ok(Reply::After(Job::Render))
    }

    fn frame(&mut self, depth: bool) -> Outcome<'l> {
        self.scene.want_depth(depth);
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
        renderer,
        downloads,
        ..
    } = machine;
    scene
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
