//! Wireframes: the CPU projects the segments of a program, and the line engine draws them.

use glint_core::picture::Size;
use glint_core::wireframe::Projection;
use glint_hal::triangle::{EngineError, Error, Prepared, TriangleEngine};
use glint_model::line::Segment;
use glint_model::{Frame, Stats, WireframeSubject};

use super::buffers::Projected;
use super::fallback::Fallback;
use super::renderer::{GatewareRenderer, Output, Rendered};

/// Words of a program that are projected between two samples of the buttons.
const WORDS_A_CALL: usize = 16;

impl GatewareRenderer {
    /// Projects further words of a program to segments in `self.buffers[place]`. Returns whether no word is left.
    pub(super) fn project(
        &mut self,
        subject: &WireframeSubject,
        size: Size,
        place: usize,
    ) -> Result<bool, EngineError> {
        let done = &mut self.projected;
        let projection = Projection::new(subject.program.viewing(), size);
        let records = self.buffers[place].segments_mut();
        let Some((header, records)) = records.split_first_mut() else {
            return Err(Error::Full.into());
        };
        for _ in 0..WORDS_A_CALL {
            if done.words == subject.program.word_count() {
                *header = Segment::header(done.stats.lines);
                return Ok(true);
            }
            if let Some(segment) = subject.program.segment(done.words) {
                done.stats.segments += 1;
                if let Some(line) = subject.line(&projection, segment) {
                    let record = records.get_mut(done.stats.lines as usize);
                    *record.ok_or(Error::Full)? = line.words();
                    done.stats.lines += 1;
                }
            }
            done.words += 1;
        }
        Ok(false)
    }

    /// Writes the registers of the geometry pass of the segments in `self.buffers[place]`.
    pub(super) fn prepare_lines(&mut self, size: Size, place: usize) -> Prepared {
        let buffers = &self.buffers[place];
        let segments = buffers.segments();
        let count = 1 + self.projected.stats.lines as usize;
        let segments = segments.get(..count).unwrap_or(segments);
        let lists = buffers.lists(self.shading, size);
        self.engine.prepare_lines(segments, size, &lists)
    }

    /// Takes the descriptors of a geometry pass of lines, which wrote to `self.buffers[place]`.
    pub(super) fn take_lines(&mut self, place: usize) {
        let buffers = &mut self.buffers[place];
        let set = buffers.set(self.engine.counts().descriptors);
        (buffers.sets, buffers.stats) = ([Some(set), None], Stats::default());
    }

    /// Draws a wireframe `count` times. Segments are projected and cut into pieces during the raster pass of the frame before.
    pub(super) fn repeat_lines(
        &mut self,
        subject: &WireframeSubject,
        frame: &Frame,
        output: &mut Output,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        self.update_constants(frame, 0)?;
        self.set_field(0, false)?;
        self.start_measurement(frame);
        let (mut now, mut next) = (0, 1);
        for number in 0..count {
            self.projected = Projected::default();
            while !self.project(subject, frame.size, now)? {}
            let prepared = self.prepare_lines(frame.size, now);
            self.start_pass(prepared);
            self.wait(TriangleEngine::geometry, output)?;
            self.take_lines(now);
            if number > 0 {
                self.wait(TriangleEngine::raster, output)?;
            }
            self.start_raster(frame, output, self.sets(now));
            (now, next) = (next, now);
        }
        if count > 0 {
            self.wait(TriangleEngine::raster, output)?;
        }
        Ok(self.rendered(frame, next))
    }
}
