//! Wireframes, and the edges of meshes: the CPU makes segments, and the line engine draws them.

use glint_core::picture::Size;
use glint_core::wireframe::Projection;
use glint_engines::triangle::size_code;
use glint_hal::triangle::{EngineError, Error, Prepared};
use glint_model::line::Segment;
use glint_model::{Frame, Stats, Subject, WireframeSubject};

use super::GatewareRenderer;
use crate::gateware::fallback::Fallback;
use crate::gateware::geometry::Cpu;

/// Number of words of a program that one call of `project` projects.
const WORDS_A_CALL: usize = 16;

/// Error: the memory is too small for all segments of a frame.
const FULL: EngineError = EngineError::Status(Error::Full);

impl GatewareRenderer {
    /// Projects the next words of a program to segments in `self.buffers[place]`. Returns whether all words have been projected.
    pub(super) fn project(
        &mut self,
        subject: &WireframeSubject,
        frame: &Frame,
        place: usize,
    ) -> Result<bool, EngineError> {
        let done = &mut self.projected;
        let projection = Projection::new(subject.program.viewing(), frame.window());
        let records = self.buffers[place].segments_mut();
        let Some((header, records)) = records.split_first_mut() else {
            return Err(FULL);
        };
        for _ in 0..WORDS_A_CALL {
            if done.words == subject.program.word_count() {
                *header = Segment::header(done.lines);
                return Ok(true);
            }
            if let Some(segment) = subject.program.segment(done.words) {
                done.stats.segments += 1;
                if let Some(line) = subject.line(&projection, segment) {
                    done.stats.lines += 1;
                    for line in line.strokes(frame.drawn_samples()) {
                        let record = records.get_mut(done.lines as usize);
                        *record.ok_or(FULL)? = line.words();
                        done.lines += 1;
                    }
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
        let count = 1 + self.projected.lines as usize;
        let segments = segments.get(..count).unwrap_or(segments);
        let lists = buffers.lists(self.layout, size);
        self.engine.prepare_lines(segments, size_code(size), &lists)
    }

    /// Stores the set of descriptors that a geometry pass of lines has written to `self.buffers[place]`.
    pub(super) fn take_lines(&mut self, frame: &Frame, place: usize) {
        let buffers = &mut self.buffers[place];
        let count = self.engine.counts().descriptors;
        if let Subject::Edges(..) = frame.subject {
            buffers.sets[1] = Some(buffers.clipped_set(count));
        } else {
            let set = buffers.set(count);
            (buffers.sets, buffers.stats) = ([Some(set), None], Stats::default());
        }
    }

    /// Makes the segments of a mesh's edges in the memory of a benchmark's next frame, while the geometry pass of the faces runs. Does
    /// nothing for other subjects.
    pub(super) fn project_edges(&mut self, frame: &Frame, cpu: &mut Cpu) -> Result<(), Fallback> {
        let Subject::Edges(subject, _) = &frame.subject else {
            return Ok(());
        };
        let setup = self.constants[0].mesh();
        let setup = setup.ok_or(EngineError::from(Error::Size))?;
        let records = self.buffers[1].segments_mut();
        let (header, records) = records.split_first_mut().ok_or(FULL)?;
        let scratch = cpu.scratch.vertices(frame.scratch_vertices());
        let samples = frame.drawn_samples();
        let mut is_full = false;
        let mut lines = 0;
        let mut put = |segment: &Segment| {
            for line in segment.strokes(samples) {
                match records.get_mut(lines as usize) {
                    Some(record) => *record = line.words(),
                    None => is_full = true,
                }
                lines += 1;
            }
        };
        let (mesh, culls) = (&subject.mesh, subject.culls());
        self.edges = cpu
            .edges
            .segments(mesh, culls, setup, scratch, cpu.progress, &mut put)?;
        if is_full {
            return Err(FULL.into());
        }
        *header = Segment::header(lines);
        self.projected.lines = lines;
        Ok(())
    }

    /// Starts the geometry pass of the segments that [`project_edges`](Self::project_edges) has made.
    pub(super) fn start_edges(&mut self, size: Size) {
        let [drawn, other] = &self.buffers;
        let segments = other.segments();
        let count = 1 + self.projected.lines as usize;
        let segments = segments.get(..count).unwrap_or(segments);
        let lists = drawn.edge_lists(self.layout, size);
        let prepared = self.engine.prepare_lines(segments, size_code(size), &lists);
        self.start_pass(prepared);
    }
}
