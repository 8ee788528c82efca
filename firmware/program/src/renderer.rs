//! Drawing of frames, by the gateware or by the CPU, into two frame buffers and one buffer of depth codes.

use glint_core::feature::CPU;
use glint_core::picture::{Backend, Samples, Size};
use glint_core::wire::crc32;
use glint_hal::frequency::Frequency;
use glint_hal::scanout::Display;
use glint_model::edges::EdgeList;
use glint_model::{Eyes, Frame, RenderError};
use glint_scene::Defaults;
use litex_pac::cpu;

use crate::drawn::{DrawError, Drawn, RenderedBy};
use crate::gateware::{self, Cpu, Fallback, GatewareRenderer, Output, RightEye};
use crate::memory::Scratch;
use crate::soft_core::SoftCore;

/// The gateware renderer and the CPU renderer, and the memory of both.
pub struct Renderer {
    /// Two frame buffers, one of which is shown.
    pub display: Display,
    /// Samples of a frame with four samples per pixel that the CPU draws.
    pub samples: &'static mut [u16],
    /// Depth codes of the last frame that was drawn with depth codes in memory, one per pixel or sample.
    pub depth: &'static mut [u32],
    /// The right eye's part of a stereo picture that is being drawn.
    pub right: RightEye,
    /// Memory for projected vertices.
    pub scratch: Scratch,
    /// The edge list of the last mesh that was shown with edges.
    pub edges: EdgeList<'static>,
    /// Clock frequency, for the frames per second in the overlay.
    pub frequency: Frequency,
    /// The renderer of the gateware, if the SoC has a triangle engine.
    pub gateware: Option<GatewareRenderer>,
}

impl Renderer {
    /// Draws `frame` into the frame buffer that [`show`](Self::show) will show. Returns `None` while the gateware draws, or while this
    /// frame buffer is still on the screen; the frame must not change until the function returns a result. Drawing by the CPU is slow, and
    /// calls `progress` at short intervals.
    pub fn draw(
        &mut self,
        frame: &Frame,
        backend: Backend,
        wants_depth: bool,
        mut progress: impl FnMut(),
    ) -> Option<Result<Drawn, DrawError>> {
        let eyes = frame.eyes();
        // Matched by reference, because the frames of two eyes are large.
        let eyes = match &eyes {
            Ok(eyes) => eyes.as_ref(),
            Err(error) => return Some(Err(DrawError::Render(*error))),
        };
        Some(
            match self.draw_by_gateware(frame, eyes, backend, wants_depth, &mut progress)? {
                Ok(gateware::Rendered {
                    cycles,
                    stats,
                    counters,
                    unsupported,
                    ..
                }) => Ok(Drawn {
                    cycles,
                    stats,
                    by: RenderedBy::Gateware(counters, unsupported),
                    has_depth: wants_depth,
                }),
                Err(fallback) if CPU.is_built => self
                    .draw_by_cpu(frame, eyes, fallback, progress)?
                    .map_err(DrawError::Render),
                Err(fallback) => Err(DrawError::NoCpu(fallback)),
            },
        )
    }

    /// The frame that was just drawn, for changes by the CPU; `None` while the frame's buffer is still on the screen.
    pub fn drawn_frame(&mut self) -> Option<&mut [u16]> {
        let back = self.display.back()?;
        if let Some(gateware) = &mut self.gateware {
            gateware.invalidate(back);
        }
        Some(back)
    }

    /// Shows the frame that was just drawn from the next vertical blanking on.
    pub fn show(&mut self, size: Size) {
        self.display.show(size.width());
    }

    /// The options of the start scene: the largest size, and the options that the gateware supports, if there is a gateware renderer.
    pub fn defaults(&self) -> Defaults {
        let Some(gateware) = &self.gateware else {
            return Defaults::SOFT_CORE;
        };
        let mut sizes = Size::ALL.into_iter().rev();
        let largest = sizes.find(|size| self.has_size(*size));
        Defaults {
            size: largest.unwrap_or_default(),
            ..gateware.defaults()
        }
    }

    /// Whether this board draws and shows pictures of this size.
    pub fn has_size(&self, size: Size) -> bool {
        self.display.has_size(size.pixels()) && size.pixel_count() <= self.right.colour.len()
    }

    /// Drops a frame that waits for the next vertical blanking, so that another frame can be drawn into its buffer.
    pub fn drop_pending(&mut self) {
        if !self.is_busy() {
            self.display.withdraw();
        }
    }

    /// Whether the gateware is drawing a frame.
    pub fn is_busy(&self) -> bool {
        self.gateware
            .as_ref()
            .is_some_and(GatewareRenderer::is_busy)
    }

    /// Whether the gateware has ended the pass that [`draw`](Self::draw) waits for.
    pub fn is_ready(&self) -> bool {
        self.gateware
            .as_ref()
            .is_some_and(GatewareRenderer::is_ready)
    }

    /// Whether [`draw`](Self::draw) can continue while the gateware draws.
    pub fn is_due(&self) -> bool {
        self.gateware.as_ref().is_some_and(GatewareRenderer::is_due)
    }

    /// Draws a frame by the gateware. `None` means that the frame is not complete, and `Err` that the CPU must draw the frame. The error
    /// contains no reason if the backend is the CPU, or if the SoC has no triangle engine.
    fn draw_by_gateware(
        &mut self,
        frame: &Frame,
        eyes: Option<&Eyes>,
        backend: Backend,
        wants_depth: bool,
        progress: &mut dyn FnMut(),
    ) -> Option<Result<gateware::Rendered, Option<Fallback>>> {
        let colour = self.display.back()?;
        let Some(gateware) = &mut self.gateware else {
            return Some(Err(None));
        };
        if backend == Backend::Cpu && !gateware.is_busy() {
            return Some(Err(None));
        }
        let depth = wants_depth.then_some(&mut *self.depth);
        let mut output = Output { colour, depth };
        let mut cpu = Cpu {
            scratch: &mut self.scratch,
            edges: &mut self.edges,
            progress,
        };
        let advanced = match eyes {
            Some(eyes) => self.right.advance(gateware, eyes, &mut output, &mut cpu)?,
            None => gateware.advance(frame, &mut output, &mut cpu)?,
        };
        Some(advanced.map_err(Some))
    }

    #[inline(never)]
    fn draw_by_cpu(
        &mut self,
        frame: &Frame,
        eyes: Option<&Eyes>,
        fallback: Option<Fallback>,
        mut progress: impl FnMut(),
    ) -> Option<Result<Drawn, RenderError>> {
        let progress: &mut dyn FnMut() = &mut progress;
        let pixels = frame.size.pixel_count();
        let back = self.display.back()?;
        if let Some(gateware) = &mut self.gateware {
            gateware.invalidate(back);
        }
        let back = back.get_mut(..pixels).unwrap_or_default();
        let right = self.right.colour.get_mut(..pixels).unwrap_or_default();
        let has_depth = frame.drawn_samples() == Samples::One;
        let mut cpu = SoftCore {
            samples: self.samples,
            depth: self.depth,
            scratch: self.scratch.vertices(frame.scratch_vertices()),
            edges: &mut self.edges,
        };
        let mut draw = |frame: &Frame, colour: &mut [u16], progress: &mut dyn FnMut()| {
            cpu.draw(frame, colour, progress)
        };
        let start = cpu::cycles();
        let stats = match eyes {
            // The left eye is drawn last, so that the depth codes in memory are those of the left eye.
            Some(eyes) => draw(&eyes.right, right, progress).and_then(|of_right| {
                let of_left = draw(&eyes.left, back, progress)?;
                self.right.join(eyes, back, progress);
                Ok(of_left + of_right)
            }),
            None => draw(frame, back, progress),
        };
        let cycles = cpu::cycles() - start;
        Some(stats.map(|stats| Drawn {
            cycles,
            stats,
            by: RenderedBy::Cpu(fallback),
            has_depth,
        }))
    }

    /// Draws `frame` by the gateware `count` times, back to back, without showing it. Returns `None` if the gateware has no triangle
    /// engine, or while no frame buffer is free.
    pub fn repeat(
        &mut self,
        frame: &Frame,
        count: u32,
    ) -> Option<Result<gateware::Rendered, Fallback>> {
        self.off_screen(|gateware, right, output, cpu| match frame.eyes()? {
            Some(eyes) => right.repeat(gateware, &eyes, output, cpu, count),
            None => gateware.repeat(frame, output, cpu, count),
        })
    }

    /// Draws `frame` by the gateware without showing it, waits until the frame is complete, and returns the CRC-32 of its colours. Returns
    /// `None` if the gateware has no triangle engine, or while no frame buffer is free.
    pub fn checksum(&mut self, frame: &Frame) -> Option<Result<u32, Fallback>> {
        self.off_screen(|gateware, right, output, cpu| {
            let eyes = frame.eyes()?;
            let drawn = loop {
                let advanced = match &eyes {
                    Some(eyes) => right.advance(gateware, eyes, output, cpu),
                    None => gateware.advance(frame, output, cpu),
                };
                if let Some(drawn) = advanced {
                    break drawn;
                }
            };
            // The engine writes to memory and not to the CPU's data cache, which may hold older data.
            cpu::flush_data_cache();
            let pixels = output.colour.get(..frame.size.pixel_count());
            drawn.map(|_| crc32(bytemuck::cast_slice(pixels.unwrap_or_default())))
        })
    }

    /// Calls `draw` with the gateware, the right eye, a free frame buffer without depth codes, and the resources of the CPU. Returns
    /// `None` if the gateware has no triangle engine, or while no frame buffer is free.
    fn off_screen<T>(
        &mut self,
        draw: impl FnOnce(&mut GatewareRenderer, &mut RightEye, &mut Output, &mut Cpu) -> T,
    ) -> Option<T> {
        let mut output = Output {
            colour: self.display.back()?,
            depth: None,
        };
        let mut cpu = Cpu {
            scratch: &mut self.scratch,
            edges: &mut self.edges,
            progress: &mut || {},
        };
        let gateware = self.gateware.as_mut()?;
        Some(draw(gateware, &mut self.right, &mut output, &mut cpu))
    }

    /// Colours of the last frame: RGB565, row by row.
    pub fn colours(&self, size: Size) -> &[u16] {
        let pixels = size.pixel_count();
        self.display.front().get(..pixels).unwrap_or_default()
    }

    /// Depth codes of the last frame, row by row.
    pub fn depths(&self, size: Size) -> &[u32] {
        let pixels = size.pixel_count();
        self.depth.get(..pixels).unwrap_or_default()
    }
}
