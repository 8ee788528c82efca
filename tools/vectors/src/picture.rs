//! Pictures drawn by the bit-exact model of the triangle engine.

use glint_core::camera::View;
use glint_core::colour::Rounding;
use glint_core::mesh::Mesh;
use glint_model::edges::EdgeList;
use glint_model::{DrawnTriangle, Frame, FrameBuffer, Options, Projected, Stats, Subject, trace};

use crate::model::Model;

/// A picture drawn by the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Number of columns.
    pub width: u32,
    /// Number of lines.
    pub height: u32,
    /// RGB565 colours of the pixels, line by line.
    pub colour: Vec<u16>,
    /// Depth codes of the pixels, line by line; 0 where no triangle covers the pixel.
    pub depth: Vec<u32>,
    /// The model's counts of triangles and pixels.
    pub stats: Stats,
    /// The triangles that reached the walker (the stage that finds pixels), in drawing order.
    pub drawn: Vec<DrawnTriangle>,
}

/// Background colour, RGB565.
pub const CLEAR: u16 = 0x0841;

impl Picture {
    /// A cleared picture.
    pub fn blank((width, height): (u32, u32)) -> Self {
        let pixels = (width * height) as usize;
        Self {
            width,
            height,
            colour: vec![CLEAR; pixels],
            depth: vec![0; pixels],
            stats: Stats::default(),
            drawn: vec![],
        }
    }

    /// Borrows the picture as the renderer's frame buffer.
    pub fn target(&mut self) -> FrameBuffer<'_> {
        FrameBuffer {
            width: self.width,
            height: self.height,
            colour: &mut self.colour,
            depth: &mut self.depth,
            rounding: Rounding::Dithered,
        }
    }

    /// Renders a mesh.
    ///
    /// # Panics
    /// If the bytes are not a valid mesh, or if the renderer's statistics contradict each other.
    pub fn of_bytes(bytes: &[u8], view: &View, size: (u32, u32), cull: bool) -> Self {
        let options = Options {
            cull,
            clear: CLEAR,
            ..Options::default()
        };
        Self::with_options(bytes, view, size, &options)
    }

    /// Renders a mesh with these options.
    ///
    /// # Panics
    /// As [`Self::of_bytes`].
    pub fn with_options(bytes: &[u8], view: &View, size: (u32, u32), options: &Options) -> Self {
        let mesh = Mesh::new_checked(bytes).unwrap();
        let mut scratch = vec![Projected::Behind; mesh.largest_chunk()];
        let mut picture = Self::blank(size);
        // Initial values that the renderer must overwrite in every pixel, the background included.
        picture.colour.fill(0xDEAD);
        picture.depth.fill(0xDEAD);
        let (mut drawn, target) = (Vec::new(), &mut picture.target());
        let show = |triangle: &DrawnTriangle| drawn.push(*triangle);
        let stats = trace(&mesh, view, target, &mut scratch, options, show).unwrap();
        assert_eq!(stats.triangles_in, mesh.triangle_count());
        assert_eq!(stats.culled + stats.drawn, stats.triangles_in);
        assert!(stats.pixels_tested >= Some(stats.pixels_covered));
        assert!(stats.pixels_covered >= stats.pixels_drawn);
        picture.stats = stats;
        picture.drawn = drawn;
        picture
    }

    /// Renders a model.
    pub fn of(model: &Model, view: &View, size: (u32, u32), cull: bool) -> Self {
        Self::of_bytes(&model.encoded(), view, size, cull)
    }

    /// Renders a frame. Leaves the list of drawn triangles empty.
    ///
    /// # Panics
    /// If the renderer refuses the frame.
    pub fn of_frame(frame: &Frame) -> Self {
        let [width, height] = frame.window().size.pixels();
        let mut picture = Self::blank((width, height));
        picture.depth.fill(0xDEAD);
        let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
        let constants = frame.constants().unwrap();
        let target = &mut picture.target();
        let stats = frame.draw(&constants, target, &mut scratch, &mut || {});
        let mut stats = stats.unwrap();
        if let Subject::Edges(subject, _) = &frame.subject {
            let mut memory = vec![0; EdgeList::words(&subject.mesh)];
            let list = &mut EdgeList::new(&mut memory);
            let (scratch, stats) = (&mut scratch, &mut stats);
            let drawn = frame.draw_edges(&constants, list, target, scratch, &mut || {}, stats);
            drawn.unwrap();
        }
        picture.stats = stats.mesh.unwrap_or_default();
        picture
    }

    /// Whether each pixel is covered by a triangle, line by line.
    pub fn coverage(&self) -> Vec<bool> {
        self.depth.iter().map(|&code| code != 0).collect()
    }

    /// Number of pixels covered by a triangle.
    pub fn covered(&self) -> usize {
        self.depth.iter().filter(|&&code| code != 0).count()
    }
}
