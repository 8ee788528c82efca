//! A simple interface to the model of the triangle engine, which draws a scene and stores the picture and the drawn triangles.

use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_model::{
    DrawnTriangle, FrameBuffer, MeshLight, Options, Projected, ScreenVertex, Stats, trace,
};
use glint_reference::camera::Size;
use glint_reference::triangle::exact::{ExactTriangle, SnappedVertex};

use super::scenes::Scene;

/// Draws scenes with the model, and stores the last picture. The buffers are reused for the next picture.
#[derive(Default)]
pub struct Renderer {
    /// Colours of the last picture, in RGB565.
    pub colour: Vec<u16>,
    /// Depth codes of the last picture.
    pub depth: Vec<u32>,
    /// Light on the mesh; `None` for white light at the camera.
    pub light: Option<MeshLight>,
    /// Triangles drawn in the last picture.
    pub drawn: Vec<DrawnTriangle>,
    scratch: Vec<Projected>,
}

impl Renderer {
    /// Clears the buffers and draws a scene.
    pub fn draw(&mut self, scene: &Scene, view: &View, size: Size, cull: bool) -> Stats {
        let bytes = scene.encode();
        let mesh = Mesh::new_checked(&bytes).expect("a valid encoded mesh");
        let pixels = size.width as usize * size.height as usize;
        self.colour.resize(pixels, 0);
        self.depth.resize(pixels, 0);
        self.scratch.resize(
            scene.positions.len().max(self.scratch.len()),
            Projected::Behind,
        );
        self.drawn.clear();
        let drawn = &mut self.drawn;
        let mut target = FrameBuffer {
            width: size.width,
            height: size.height,
            colour: &mut self.colour,
            depth: &mut self.depth,
        };
        let options = Options {
            cull,
            light: self.light.as_ref(),
            ..Options::default()
        };
        trace(
            &mesh,
            view,
            &mut target,
            &mut self.scratch,
            &options,
            |triangle| drawn.push(*triangle),
        )
        .expect("buffers of the right size")
    }
}

/// Converts a vertex of the model to a vertex of the exact rasterizer.
pub fn snapped(vertex: ScreenVertex) -> SnappedVertex {
    SnappedVertex {
        x: vertex.x.into(),
        y: vertex.y.into(),
        w: vertex.w.into(),
    }
}

/// Converts a drawn triangle to a triangle of the exact rasterizer, or returns `None` if its area is 0.
pub fn exact(drawn: &DrawnTriangle) -> Option<ExactTriangle> {
    ExactTriangle::new(drawn.vertices.map(snapped))
}
