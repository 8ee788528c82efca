//! Where frames are drawn: two frames with their display, one depth buffer, room for vertices, and who draws.

use glint_core::mesh::Mesh;
use glint_core::picture::Backend;
use glint_hal::display::Display;
use glint_model::raymarch::{Ray, RayResult, render_field};
use glint_model::{FrameBuffer, MeshSetup, Options, RenderError, Stats, trace_frame};
use litex_pac::cpu;

use crate::memory::Scratch;
use crate::painter::{self, Constants, Marched, Painted, Painter, Triangles, What};
use crate::scene::{self, Counts, Drawn, Fallback, Scene};

/// The frames and what drawing them needs.
pub struct Canvas {
    /// Two frames, one of which is shown.
    pub display: Display,
    /// Depth codes, one a pixel, of the last frame that has any.
    pub depth: &'static mut [u32],
    /// Room for projected vertices.
    pub scratch: Scratch,
    /// The triangle engine, where there is one.
    pub painter: Option<Painter>,
}

/// How many triangles are drawn between two looks at what else there is to do.
const TRIANGLES_A_LOOK: u32 = 32;
/// How many pixels of a field.
const PIXELS_A_LOOK: u32 = 16;

impl Canvas {
    /// Draws `mesh`, the scene's field, or both, as `scene` wants it, and shows it from the next vertical blanking on. Returns
    /// nothing while the engine is at work, and while the frame to draw on is still on the screen; `mesh` and `scene` have
    /// to stay the same then. What takes long calls `look` now and then.
    pub fn draw(
        &mut self,
        mesh: &Mesh,
        scene: &Scene,
        look: impl FnMut(),
    ) -> Option<Result<Drawn, RenderError>> {
        let drawn = match self.paint(mesh, scene)? {
            Ok(Painted {
                cycles,
                stats,
                counters,
            }) => Ok(Drawn {
                cycles,
                stats,
                by: scene::Painter::Engine(counters),
                has_depth: scene.wants_depth(),
            }),
            Err(fallback) => self.draw_by_cpu(mesh, scene, fallback, look)?,
        };
        if drawn.is_ok() {
            self.display.show(scene.scale());
        }
        Some(drawn)
    }

    /// Makes room for another frame, at the cost of one that has not been seen yet.
    pub fn hurry(&mut self) {
        if !self.is_busy() {
            self.display.withdraw();
        }
    }

    /// Whether the engine is drawing.
    pub fn is_busy(&self) -> bool {
        self.painter.as_ref().is_some_and(Painter::is_busy)
    }

    /// Whether [`draw`](Self::draw) would get on with `scene`.
    pub fn is_ready(&mut self, scene: &Scene) -> bool {
        match &self.painter {
            Some(painter) if painter.is_busy() => painter.has_news(),
            _ => scene.changed() && self.display.back().is_some(),
        }
    }

    /// Draws by the engine. `Err` is the CPU's: because there is no engine, it is not wanted, or it failed.
    fn paint(&mut self, mesh: &Mesh, scene: &Scene) -> Option<Result<Painted, Option<Fallback>>> {
        let colour = self.display.back()?;
        let Some(painter) = &mut self.painter else {
            return Some(Err(None));
        };
        if scene.backend() == Backend::Cpu && !painter.is_busy() {
            return Some(Err(None));
        }
        let depth = scene.wants_depth().then_some(&mut *self.depth);
        let mut target = target(mesh, scene, colour, depth);
        Some(painter.advance(&mut target)?.map_err(Some))
    }

    fn draw_by_cpu(
        &mut self,
        mesh: &Mesh,
        scene: &Scene,
        fallback: Option<Fallback>,
        look: impl FnMut(),
    ) -> Option<Result<Drawn, RenderError>> {
        let [width, height] = scene.scale().size();
        let pixels = width as usize * height as usize;
        let back = self.display.back()?;
        if let Some(painter) = &mut self.painter {
            painter.forget(back);
        }
        let mut target = FrameBuffer {
            width,
            height,
            colour: back.get_mut(..pixels).unwrap_or_default(),
            depth: self.depth.get_mut(..pixels).unwrap_or_default(),
        };
        let start = cpu::cycles();
        let result = draw_all(&what(mesh, scene), &mut target, &mut self.scratch, look);
        let cycles = cpu::cycles() - start;
        Some(result.map(|stats| Drawn {
            cycles,
            stats,
            by: scene::Painter::Cpu(fallback),
            has_depth: true,
        }))
    }

    /// Draws `mesh` `count` times by the engine, back to back and without showing it.
    pub fn repeat(
        &mut self,
        mesh: &Mesh,
        scene: &Scene,
        count: u32,
    ) -> Option<Result<Painted, Fallback>> {
        let colour = self.display.back()?;
        let painter = self.painter.as_mut()?;
        Some(painter.repeat(&mut target(mesh, scene, colour, None), count))
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

/// Draws a frame by the CPU.
fn draw_all(
    what: &What,
    target: &mut FrameBuffer,
    scratch: &mut Scratch,
    mut look: impl FnMut(),
) -> Result<Counts, RenderError> {
    let Constants { frame, field } = what.constants((target.width, target.height))?;
    let triangles = match (what.triangles(), frame) {
        (Some(triangles), Some(frame)) => {
            Some(draw_mesh(triangles, frame, target, scratch, &mut look)?)
        }
        _ => {
            target.depth.fill(0);
            None
        }
    };
    let mut rays = None;
    if let Some((setup, palette)) = field {
        let mut show = |x, _, _: &Ray, _: &RayResult| {
            if x % PIXELS_A_LOOK == 0 {
                look();
            }
        };
        rays = Some(render_field(&setup, &palette, target, &mut show)?);
    }
    Ok(Counts { triangles, rays })
}

fn draw_mesh(
    triangles: &Triangles,
    frame: MeshSetup,
    target: &mut FrameBuffer,
    scratch: &mut Scratch,
    look: &mut impl FnMut(),
) -> Result<Stats, RenderError> {
    let mesh = triangles.mesh;
    let vertices = mesh
        .chunks()
        .map(|chunk| chunk.vertex_count())
        .max()
        .unwrap_or(0);
    let scratch = scratch.vertices(vertices);
    let options = Options {
        cull: triangles.cull,
        shading: triangles.shading,
        ..Options::default()
    };
    trace_frame(mesh, frame, target, scratch, &options, |triangle| {
        if triangle.index % TRIANGLES_A_LOOK == 0 {
            look();
        }
    })
}

/// What is to be drawn of a scene.
fn what<'a>(mesh: &'a Mesh<'a>, scene: &'a Scene) -> What<'a> {
    let triangles = Triangles {
        mesh,
        view: scene.view(),
        cull: scene.cull(),
        shading: scene.shading(),
    };
    let Some(field) = scene.field() else {
        return What::Triangles(triangles);
    };
    let marched = Marched {
        field,
        view: scene.view(),
        stereo: scene.stereo(),
        appearance: scene.appearance(),
        prepass: scene.prepass(),
    };
    if scene.with_mesh() {
        What::Both(triangles, marched)
    } else {
        What::Field(marched)
    }
}

/// Where the engine is to draw a scene.
fn target<'a>(
    mesh: &'a Mesh<'a>,
    scene: &'a Scene,
    colour: &'a mut [u16],
    depth: Option<&'a mut [u32]>,
) -> painter::Target<'a> {
    let [width, height] = scene.scale().size();
    painter::Target {
        what: what(mesh, scene),
        size: (width, height),
        colour,
        depth,
    }
}

fn pixels(scene: &Scene) -> usize {
    let [width, height] = scene.scale().size();
    width as usize * height as usize
}
