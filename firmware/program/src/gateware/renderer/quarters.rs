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

/// Quarter `number` of a frame; the last quarter if `number` is too large.
fn quarter_of<'a>(frame: &Frame<'a>, number: usize) -> Frame<'a> {
    let [.., last] = Quarter::ALL;
    Frame {
        quarter: *Quarter::ALL.get(number).unwrap_or(&last),
        ..*frame
    }
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
            let quarter = quarter_of(frame, self.quarters.count);
            let drawn = self.advance_part(&quarter, output, cpu)?;
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

    /// Starts a divided frame without lines, or continues the frame after the end of a pass.
    // Not inlined, so that other frames do not load this code into the instruction cache.
    #[inline(never)]
    pub(super) fn step_quarters(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        let result = if self.stage == Stage::Idle {
            self.quarters = Quarters::default();
            self.start_measurement(frame);
            self.start_quarter(frame, cpu).map(|()| false)
        } else {
            self.continue_quarters(frame, output, cpu)
        };
        match result {
            Ok(false) => self.check_progress(output).err().map(Err),
            Ok(true) => {
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
    fn start_quarter(&mut self, frame: &Frame, cpu: &mut Cpu) -> Result<(), Fallback> {
        let number = self.quarters.count;
        let (quarter, place) = (&quarter_of(frame, number), number % 2);
        self.update_constants(quarter, place)?;
        self.prepare_geometry(quarter, place)?;
        self.quarters.is_listed = !self.start_geometry(quarter, place, cpu)?;
        self.stage = Stage::Quarters;
        self.pass_start = cpu::cycles_low();
        Ok(())
    }

    /// Continues after the end of a pass. Returns whether the frame is complete.
    fn continue_quarters(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Result<bool, Fallback> {
        let number = self.quarters.count;
        let (quarter, place) = (&quarter_of(frame, number), number % 2);
        if self.quarters.lists()
            && let Some(result) = self.engine.geometry()
        {
            result?;
            self.quarters.is_listed = !self.continue_geometry(quarter, place)?;
        }
        if self.quarters.rasters
            && let Some(result) = self.engine.raster()
        {
            result?;
            self.quarters.rasters = false;
            if number == Quarter::ALL.len() {
                return Ok(true);
            }
        }
        if self.quarters.rasters || self.quarters.lists() {
            return Ok(false);
        }
        // The raymarcher uses its registers during a raster pass, so they are written between two raster passes.
        self.set_field(place, number > 0)?;
        self.start_raster(quarter, output, place)?;
        self.quarters.rasters = true;
        self.quarters.count = number + 1;
        self.quarters.is_listed = false;
        if number + 1 < Quarter::ALL.len() {
            self.quarters.triangles.add(&self.buffers[place].stats);
            self.start_quarter(frame, cpu)?;
        }
        Ok(false)
    }
}
