//! Drawing of the scene's frames, with the marker of the hand and the text overlay.

use glint_core::picture::Backend;
use glint_program::drawn::{DrawError, Drawn, RenderedBy};
use glint_program::renderer::Renderer;
use glint_scene::Scene;

use crate::models::Models;
use crate::overlay::Overlay;
use crate::picture::Picture;

/// Draws the frame of `scene` with the mesh or program of `models`, and shows the frame from the next vertical blanking on. Returns `None`
/// while the gateware draws, or while the frame buffer to draw into is still on the screen; `models` and `scene` must not change until the
/// function returns a result. Drawing by the CPU is slow, and calls `progress` at short intervals.
pub fn draw(
    renderer: &mut Renderer,
    models: &Models,
    scene: &Scene,
    picture: &Picture,
    progress: impl FnMut(),
) -> Option<Result<Drawn, DrawError>> {
    let wants_depth = picture.wants_depth && scene.has_depths();
    let frame = models.frame(scene);
    let drawn = renderer.draw(&frame, scene.backend, wants_depth, progress)?;
    if let Ok(drawn) = &drawn {
        draw_marker(renderer, scene, picture);
        draw_overlay(renderer, scene, drawn);
        renderer.show(scene.size);
    }
    Some(drawn)
}

// The parts of `draw` that few frames need are separate functions, so that the code of `draw` takes few lines of the instruction cache.

/// Draws the marker of the hand's position, if any, into the frame that was just drawn.
#[inline(never)]
fn draw_marker(renderer: &mut Renderer, scene: &Scene, picture: &Picture) {
    let Some(marker) = picture.marker else {
        return;
    };
    if let Some(frame) = renderer.drawn_frame() {
        marker.draw(frame, scene.size);
    }
}

/// Writes the scene's subject and the drawing speed on the frame that was just drawn.
#[inline(never)]
fn draw_overlay(renderer: &mut Renderer, scene: &Scene, drawn: &Drawn) {
    if !scene.has_overlay() {
        return;
    }
    let rate = drawn.rate(renderer.frequency);
    let size = scene.size;
    let mut overlay = Overlay::new(renderer, size);
    overlay.line(format_args!("{}", scene.subject()));
    let by = match drawn.by {
        RenderedBy::Cpu(_) => Backend::Cpu,
        RenderedBy::Gateware(..) => Backend::Gateware,
    };
    let cycles = drawn.cycles;
    overlay.line(format_args!("{size} by {by}: {cycles} cycles, {rate} fps"));
}
