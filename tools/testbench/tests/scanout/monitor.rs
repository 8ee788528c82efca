//! Model of a monitor, which checks video timing and picture by the module's outputs alone.
//!
//! At each pixel clock, the monitor compares hsync and vsync with the values expected at its position in the frame, counted from the first
//! edge of vsync. At the end of each line, it checks that the line shows the expected source line, or the previous source line if memory
//! was late.

use glint_testbench::{Module, Port};

use crate::memory::WORD;
use crate::raster::{Raster, pixel_at, rgb888};
use crate::settings::Settings;

pub struct Monitor {
    raster: Raster,
    hsync: Port,
    vsync: Port,
    de: Port,
    rgb: [Port; 3],
    /// Pixel clocks since the leading edge of vsync; `None` before the first vsync.
    position: Option<u64>,
    vsync_before: bool,
    line: Vec<u32>,
    /// Whether to skip the check of the current line, because a reset disturbed it.
    pub line_unchecked: bool,
    /// Last source line (line of the frame in memory) shown in this video frame.
    pub line_shown: Option<u64>,
    /// Whether late source lines are accepted.
    pub may_be_late: bool,
    /// Number of frames shown up to their last line.
    pub frames: u64,
    /// Number of late source lines, which are missing in their first output line.
    pub late: u64,
    /// Number of late source lines that appeared in a later one of their `scale` output lines.
    pub late_again: u64,
}

impl Monitor {
    pub fn new(module: &Module, raster: Raster) -> Self {
        Self {
            raster,
            hsync: module.port("video_hsync"),
            vsync: module.port("video_vsync"),
            de: module.port("video_de"),
            rgb: ["video_r", "video_g", "video_b"].map(|name| module.port(name)),
            position: None,
            vsync_before: true,
            line: Vec::new(),
            line_unchecked: false,
            line_shown: None,
            may_be_late: false,
            frames: 0,
            late: 0,
            late_again: 0,
        }
    }

    /// Drops the synchronisation; the next vsync restores it.
    pub fn reset(&mut self) {
        self.position = None;
        self.line.clear();
        self.vsync_before = true;
    }

    /// Checks the outputs of one pixel clock; returns whether its pixel was the last pixel of a frame.
    pub fn watch(&mut self, module: &Module, in_force: &Settings) -> bool {
        let vsync = module.is_high(self.vsync);
        let position = match self.position {
            None if vsync && !self.vsync_before => 0,
            None => {
                self.vsync_before = vsync;
                return false;
            }
            Some(position) => (position + 1) % self.raster.frame(),
        };
        self.position = Some(position);
        // Lines begin with the leading edge of hsync, frames with the leading edge of vsync.
        let raster = &self.raster;
        let (x, y) = (position % raster.h_total(), position / raster.h_total());
        let (left, top) = (raster.h_sync + raster.h_back, raster.v_sync + raster.v_back);
        let picture = top..top + raster.v_active;
        let visible = top - raster.border..picture.end + raster.border;
        let de = visible.contains(&y) && (left..left + raster.h_active).contains(&x);
        let hsync = module.is_high(self.hsync);
        assert_eq!(hsync, x < raster.h_sync, "hsync at x {x}, y {y}");
        assert_eq!(vsync, y < raster.v_sync, "vsync at x {x}, y {y}");
        let found = module.is_high(self.de);
        assert_eq!(found, de, "de at x {x}, y {y}");
        let [r, g, b] = self.rgb.map(|port| module.value(port) as u32);
        let rgb = r << 16 | g << 8 | b;
        if !de {
            assert_eq!(rgb, 0, "colour in the blanking at x {x}, y {y}");
            return false;
        }
        self.line.push(rgb);
        if self.line.len() as u64 == raster.h_active {
            if !picture.contains(&y) {
                assert!(self.line_is_black(), "line {y} of the border is not black");
                self.line.clear();
                return false;
            }
            self.check_line(y - top, in_force);
            self.line.clear();
            return y - top == self.raster.v_active - 1;
        }
        false
    }

    fn line_is(&self, source_line: u64, in_force: &Settings) -> bool {
        let scale = in_force.scale;
        let width = self.raster.h_active / scale;
        let start = in_force.base * WORD + source_line * width * 2;
        let pixels = (0..).zip(self.line.chunks(scale as usize));
        let mut pixels = pixels.map(|(x, run)| (rgb888(pixel_at(start + 2 * x)), run));
        pixels.all(|(pixel, run)| run.iter().all(|&shown| shown == pixel))
    }

    fn line_is_black(&self) -> bool {
        self.line.iter().all(|&pixel| pixel == 0)
    }

    fn check_line(&mut self, y: u64, in_force: &Settings) {
        self.frames += u64::from(y == self.raster.v_active - 1);
        if std::mem::take(&mut self.line_unchecked) {
            return;
        }
        if !in_force.enable {
            assert!(self.line_is_black(), "line {y} is not black while disabled");
            return;
        }
        let needed = y / in_force.scale;
        let first_use = y.is_multiple_of(in_force.scale);
        if self.line_is(needed, in_force) {
            self.late_again += u64::from(!first_use && self.line_shown != Some(needed));
            self.line_shown = Some(needed);
            return;
        }
        assert!(
            self.may_be_late,
            "line {y} does not show source line {needed} (first pixel {:06x})",
            self.line[0]
        );
        self.late += u64::from(first_use);
        let before = match self.line_shown {
            Some(shown) => self.line_is(shown, in_force),
            None => self.line_is_black(),
        };
        assert!(
            before,
            "line {y} shows neither source line {needed} nor the previous source line"
        );
    }
}
