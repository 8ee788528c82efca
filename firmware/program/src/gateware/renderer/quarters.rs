//! Frames that are drawn in quarters.
//!
//! The geometry passes of a quarter run during the raster pass of the previous quarter. Passes of lines do not overlap, because their
//! segments need the memory of both quarters. For a frame of a mesh:
//!
//! ```text
//! geometry  ░0░ ░1░      ░2░      ░3░
//! raster        ▓▓▓▓0▓▓▓ ▓▓▓▓1▓▓▓ ▓▓▓▓2▓▓▓ ▓▓▓▓3▓▓▓
//! ```

use core::mem;

use glint_core::picture::Quarter;
use glint_model::Frame;
use litex_pac::cpu;

use super::{GatewareRenderer, Output, Stage};
use crate::gateware::fallback::Fallback;
use crate::gateware::geometry::Cpu;
use crate::gateware::quarters::Quarters;
use crate::gateware::rendered::Rendered;

/// Quarter `number`; the last quarter if `number` is too large.
fn quarter(number: usize) -> Quarter {
    let [.., last] = Quarter::ALL;
    *Quarter::ALL.get(number).unwrap_or(&last)
}

/// Progress of a divided frame in one step.
enum Progress {
    /// No pass has ended.
    Waiting,
    /// A pass has ended, or was started.
    Continued,
    /// The frame is complete.
    Complete,
}

impl GatewareRenderer {
    /// Starts or continues the drawing of a divided frame with lines, one quarter after the other.
    // Not inlined, because few frames are divided and have lines.
    #[inline(never)]
    pub(super) fn advance_quarters(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        loop {
            let part = Frame {
                quarter: quarter(self.quarters.count),
                ..*frame
            };
            let drawn = self.advance_part(&part, output, cpu)?;
            let Quarters {
                count, rendered, ..
            } = mem::take(&mut self.quarters);
            let sum = match (drawn, rendered) {
                (Err(fallback), _) => return Some(Err(fallback)),
                (Ok(drawn), None) => drawn,
                (Ok(drawn), Some(others)) => drawn.plus(others, 0),
            };
            if count + 1 == Quarter::ALL.len() {
                return Some(Ok(sum));
            }
            self.quarters = Quarters {
                count: count + 1,
                rendered: Some(sum),
                ..Quarters::default()
            };
        }
    }

    /// Starts a divided frame without lines, or continues the frame after the end of a pass. Sets the frame's quarter.
    // Not inlined, so that other frames do not load this code into the instruction cache.
    #[inline(never)]
    pub(super) fn step_quarters(
        &mut self,
        frame: &mut Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        let progress = if self.stage == Stage::Idle {
            self.quarters = Quarters::default();
            self.start_measurement(frame);
            self.start_quarter(frame, cpu).map(|()| Progress::Continued)
        } else {
            self.continue_quarters(frame, output, cpu)
        };
        match progress {
            Ok(Progress::Continued) => None,
            Ok(Progress::Waiting) => self.check_progress(output).err().map(Err),
            Ok(Progress::Complete) => {
                self.stage = Stage::Idle;
                let Quarters { triangles, .. } = mem::take(&mut self.quarters);
                let mut rendered = self.rendered(frame, (Quarter::ALL.len() - 1) % 2);
                if let Some(mesh) = &mut rendered.stats.mesh {
                    mesh.add(&triangles);
                }
                Some(Ok(rendered))
            }
            Err(error) => Some(Err(self.cancel(output, error))),
        }
    }

    /// Computes the constants of the next quarter, and starts its geometry passes.
    fn start_quarter(&mut self, frame: &mut Frame, cpu: &mut Cpu) -> Result<(), Fallback> {
        let number = self.quarters.count;
        frame.quarter = quarter(number);
        let place = number % 2;
        self.update_constants(frame, place)?;
        self.prepare_geometry(frame, place)?;
        self.quarters.is_listed = !self.start_geometry(frame, place, cpu)?;
        self.stage = Stage::Quarters;
        self.pass_start = cpu::cycles_low();
        Ok(())
    }

    /// Continues after the end of a pass.
    fn continue_quarters(
        &mut self,
        frame: &mut Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Result<Progress, Fallback> {
        let number = self.quarters.count;
        frame.quarter = quarter(number);
        let place = number % 2;
        let mut progress = Progress::Waiting;
        if self.quarters.lists()
            && let Some(result) = self.engine.geometry()
        {
            result?;
            self.quarters.is_listed = !self.continue_geometry(frame, place)?;
            self.pass_start = cpu::cycles_low();
            progress = Progress::Continued;
        }
        if self.quarters.rasters
            && let Some(result) = self.engine.raster()
        {
            result?;
            self.quarters.rasters = false;
            if number == Quarter::ALL.len() {
                return Ok(Progress::Complete);
            }
            progress = Progress::Continued;
        }
        if self.quarters.rasters || self.quarters.lists() {
            return Ok(progress);
        }
        // The raymarcher uses its registers during a raster pass, so they are written between two raster passes.
        self.set_field(place, number > 0)?;
        self.start_raster(frame, output, place)?;
        self.quarters.rasters = true;
        self.quarters.count = number + 1;
        self.quarters.is_listed = false;
        if number + 1 < Quarter::ALL.len() {
            self.quarters.triangles.add(&self.buffers[place].stats);
            self.start_quarter(frame, cpu)?;
        }
        Ok(Progress::Continued)
    }
}
