//! Benchmark: one frame drawn repeatedly, back to back.

use glint_core::picture::Quarter;
use glint_hal::triangle::{EngineError, Error, PassResult, TriangleEngine};
use glint_model::{Frame, Subject, WireframeSubject};
use heapless::Vec;
use litex_pac::cpu;

use super::{GatewareRenderer, Output};
use crate::gateware::buffers::Projected;
use crate::gateware::fallback::Fallback;
use crate::gateware::geometry::Cpu;
use crate::gateware::rendered::Rendered;

/// The parts of a frame that are drawn separately: the quarters, or the whole frame.
type Parts<'a> = Vec<Frame<'a>, { Quarter::ALL.len() }>;

/// An iterator that repeats the parts in order, from the second part on; and the first part.
fn first<'p, 'a>(
    parts: &'p [Frame<'a>],
) -> Result<(impl Iterator<Item = &'p Frame<'a>>, &'p Frame<'a>), Fallback> {
    let mut parts = parts.iter().cycle();
    let first = parts.next().ok_or(EngineError::from(Error::Size))?;
    Ok((parts, first))
}

/// Number of polls for the end of a pass between two checks of progress.
const POLLS: u32 = 1000;

impl GatewareRenderer {
    /// Draws a frame `count` times. The geometry passes run during the raster pass of the previous frame. The result covers the
    /// work of `count` frames: with a mesh, the measurement begins when the geometry passes of the first frame have ended. The console
    /// does not answer during this call.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn repeat(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        let parts: Parts = frame.parts().collect();
        let count = count * parts.len() as u32;
        match (&frame.subject, frame.subject.meshes().next()) {
            (Subject::Wireframe(wireframe), _) => {
                self.repeat_lines(wireframe, &parts, output, count)
            }
            (Subject::Edges(..), _) => self.repeat_edges(&parts, output, cpu, count),
            (_, Some(_)) => self.repeat_meshes(&parts, output, cpu, count),
            (_, None) => self.repeat_field(&parts, output, count),
        }
    }

    // The functions below draw `count` parts of a frame, from the endless iterator `parts`.

    // Not inlined, so that memory.x can place it beside the functions that it calls for each mesh.
    #[inline(never)]
    fn repeat_meshes(
        &mut self,
        parts: &[Frame],
        output: &mut Output,
        cpu: &mut Cpu,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        let (mut parts, mut frame) = first(parts)?;
        self.start_measurement(frame);
        self.update_constants(frame, 0)?;
        self.set_field(0, false)?;
        self.prepare_geometry(frame, 0)?;
        let (mut now, mut next) = (0, 1);
        for number in 0..=count {
            let runs = self.start_geometry(frame, now, cpu);
            let mut runs = self.check(runs, output)?;
            while runs && !self.geometry.is_last() {
                runs = self.await_geometry(frame, now, output)?;
            }
            let drawn = frame;
            frame = parts.next().unwrap_or(frame);
            // Computes the constants for the next frame only during the last geometry pass, because this code evicts the code for the
            // geometry passes from the instruction cache.
            self.update_constants(frame, next)?;
            while runs {
                runs = self.await_geometry(drawn, now, output)?;
            }
            // A raster pass may still read the buffers at `next`. This call only writes registers, and the same table of textures again.
            // The geometry pass, which overwrites these buffers, starts after the end of the raster pass.
            self.prepare_geometry(frame, next)?;
            if number > 0 {
                self.wait(TriangleEngine::raster, output)?;
            }
            if number == 0 {
                self.start_measurement(frame);
            }
            if number == count {
                break;
            }
            // The raymarcher uses its registers during a raster pass, so they are written between two raster passes.
            if drawn.subject.field_part().is_some() {
                self.set_field(now, false)?;
            }
            let started = self.start_raster(drawn, output, now);
            self.check(started, output)?;
            (now, next) = (next, now);
        }
        Ok(self.rendered(frame, now))
    }

    /// Waits for the end of a geometry pass, and starts the next pass. Returns whether another pass runs.
    // Not inlined, for the reason given at `repeat_meshes`.
    #[inline(never)]
    fn await_geometry(
        &mut self,
        frame: &Frame,
        place: usize,
        output: &mut Output,
    ) -> Result<bool, Fallback> {
        self.wait(TriangleEngine::geometry, output)?;
        let runs = self.continue_geometry(frame, place);
        self.check(runs, output)
    }

    /// Draws a frame without a mesh repeatedly. The constants of the next frame are computed during the raster pass. The raymarcher uses
    /// its registers during this pass, so they are written after the pass.
    fn repeat_field(
        &mut self,
        parts: &[Frame],
        output: &mut Output,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        let (mut parts, mut frame) = first(parts)?;
        self.update_constants(frame, 0)?;
        let mut has_tables = false;
        self.start_measurement(frame);
        for _ in 0..count {
            self.buffers[0].clear();
            self.set_field(0, has_tables)?;
            let started = self.start_raster(frame, output, 0);
            self.check(started, output)?;
            frame = parts.next().unwrap_or(frame);
            self.update_constants(frame, 0)?;
            has_tables = self.has_tables(0);
            self.wait(TriangleEngine::raster, output)?;
        }
        Ok(self.rendered(frame, 0))
    }

    /// Draws the edges of a mesh `count` times, one frame after the other.
    fn repeat_edges(
        &mut self,
        parts: &[Frame],
        output: &mut Output,
        cpu: &mut Cpu,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        let (mut parts, mut frame) = first(parts)?;
        self.update_constants(frame, 0)?;
        self.set_field(0, false)?;
        self.start_measurement(frame);
        for _ in 0..count {
            self.prepare_geometry(frame, 0)?;
            let mut runs = self.start_geometry(frame, 0, cpu);
            let projected = self.project_edges(frame, cpu);
            self.check(projected, output)?;
            while self.check(runs, output)? {
                self.wait(TriangleEngine::geometry, output)?;
                runs = self.continue_geometry(frame, 0);
            }
            self.start_edges(frame.window().size);
            self.wait(TriangleEngine::geometry, output)?;
            self.take_lines(frame, 0);
            let started = self.start_raster(frame, output, 0);
            self.check(started, output)?;
            self.wait(TriangleEngine::raster, output)?;
            if frame.is_divided() {
                frame = parts.next().unwrap_or(frame);
                self.update_constants(frame, 0)?;
            }
        }
        Ok(self.rendered(frame, 0))
    }

    /// Draws a wireframe `count` times. Segments are projected and cut into pieces during the raster pass of the previous frame.
    fn repeat_lines(
        &mut self,
        subject: &WireframeSubject,
        parts: &[Frame],
        output: &mut Output,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        let (mut parts, mut frame) = first(parts)?;
        for place in [0, 1] {
            self.update_constants(frame, place)?;
        }
        self.set_field(0, false)?;
        self.start_measurement(frame);
        let (mut now, mut next) = (0, 1);
        for number in 0..count {
            self.projected = Projected::default();
            while !self.project(subject, frame, now)? {}
            let prepared = self.prepare_lines(frame.window().size, now);
            self.start_pass(prepared);
            self.wait(TriangleEngine::geometry, output)?;
            self.take_lines(frame, now);
            if number > 0 {
                self.wait(TriangleEngine::raster, output)?;
            }
            let started = self.start_raster(frame, output, now);
            self.check(started, output)?;
            (now, next) = (next, now);
            frame = parts.next().unwrap_or(frame);
        }
        if count > 0 {
            self.wait(TriangleEngine::raster, output)?;
        }
        Ok(self.rendered(frame, next))
    }

    /// Cancels the frame if `result` is an error.
    fn check<T>(&mut self, result: Result<T, Fallback>, output: &Output) -> Result<T, Fallback> {
        result.map_err(|error| self.cancel(output, error))
    }

    /// Waits for the end of a pass; the function `result` polls the result of the pass.
    fn wait(
        &mut self,
        result: fn(&TriangleEngine) -> PassResult,
        output: &mut Output,
    ) -> Result<(), Fallback> {
        // A wait is shorter than 2^32 cycles, because the watchdog ends the pass.
        let start = cpu::cycles_low();
        loop {
            for _ in 0..POLLS {
                match result(&self.engine) {
                    Some(Ok(())) => {
                        self.waited += u64::from(cpu::cycles_low().wrapping_sub(start));
                        return Ok(());
                    }
                    Some(Err(error)) => return Err(self.cancel(output, error.into())),
                    None => {}
                }
            }
            self.check_progress(output)?;
        }
    }
}
