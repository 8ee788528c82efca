//! Where frames are drawn: two frames with their display, one depth buffer, room for vertices.

use glint_core::mesh::Mesh;
use glint_model::{Options, RenderError, Target};
use litex_hal::display::Display;
use litex_pac::cpu;

use crate::memory::Scratch;
use crate::scene::{Drawn, Scene};

/// The frames and what drawing them needs.
pub struct Canvas {
    /// Two frames, one of which is shown.
    pub display: Display,
    /// Depth codes, one a pixel, of the frame drawn last.
    pub depth: &'static mut [u32],
    /// Room for projected vertices.
    pub scratch: Scratch,
}

/// How many triangles are drawn between two looks at what else there is to do.
const TRIANGLES_A_LOOK: u32 = 32;

impl Canvas {
    /// Draws `mesh` as `scene` wants it, and shows it from the next vertical blanking on. Now and then it calls `look`.
    /// Returns nothing while the frame to draw on is still on the screen.
    pub fn draw(
        &mut self,
        mesh: &Mesh,
        scene: &Scene,
        mut look: impl FnMut(),
    ) -> Option<Result<Drawn, RenderError>> {
        let [width, height] = scene.scale().size();
        let pixels = width as usize * height as usize;
        let mut target = Target {
            width,
            height,
            colour: self.display.back()?.get_mut(..pixels).unwrap_or_default(),
            depth: self.depth.get_mut(..pixels).unwrap_or_default(),
        };
        let vertices = mesh
            .chunks()
            .map(|chunk| chunk.vertex_count())
            .max()
            .unwrap_or(0);
        let scratch = self.scratch.vertices(vertices);
        let options = Options {
            cull: scene.cull(),
            ..Options::default()
        };
        let start = cpu::cycles();
        let result = glint_model::trace(
            mesh,
            scene.view(),
            &mut target,
            scratch,
            &options,
            |triangle| {
                if triangle.index % TRIANGLES_A_LOOK == 0 {
                    look();
                }
            },
        );
        let cycles = cpu::cycles() - start;
        if result.is_ok() {
            self.display.show(scene.scale());
        }
        Some(result.map(|stats| Drawn { cycles, stats }))
    }

    /// The frame drawn last: RGB565, row by row.
    pub fn colours(&self, scene: &Scene) -> &[u16] {
        self.display
            .front()
            .get(..pixels(scene))
            .unwrap_or_default()
    }

    /// The depth codes of the frame drawn last, row by row.
    pub fn depths(&self, scene: &Scene) -> &[u32] {
        self.depth.get(..pixels(scene)).unwrap_or_default()
    }
}

fn pixels(scene: &Scene) -> usize {
    let [width, height] = scene.scale().size();
    width as usize * height as usize
}
