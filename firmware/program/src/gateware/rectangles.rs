//! Descriptors of a frame's rectangles, which the CPU makes.

use glint_core::colour::Rgb565;
use glint_hal::triangle::{EngineError, Error};
use glint_model::Frame;
use glint_model::triangle::descriptor::{Layout, ListCounts, ListWriter};
use glint_model::triangle::rectangle::set_up;
use litex_pac::cpu;

use super::buffers::Buffers;
use super::fallback::Fallback;

impl Buffers {
    /// Appends the rectangles of a frame to the second set, after the end of all geometry passes, so that they are drawn last.
    ///
    /// Not inlined, because few frames have rectangles.
    #[inline(never)]
    pub fn put_rectangles(&mut self, frame: &Frame, layout: Layout) -> Result<(), Fallback> {
        self.clipped_counts = match &self.sets[1] {
            None => ListCounts::EMPTY,
            Some(set) => {
                // The engine may have written the lists.
                cpu::flush_data_cache();
                ListCounts::of(self.clipped_lists, set.count)
            }
        };
        let window = frame.window();
        let list_shift = self.list_shift(window.size).into();
        let mut writer = ListWriter::new(
            self.clipped_descriptors,
            self.clipped_lists,
            &mut self.clipped_counts,
            window.size.width(),
            list_shift,
            layout,
        );
        for rectangle in frame.drawn_rectangles() {
            if let Some((setup, textured)) = set_up(rectangle, window, frame.drawn_samples()) {
                let number = self.textures.number(&textured.texture);
                let texture = textured.numbered(number.ok_or(Fallback::TooManyTextures)?);
                writer.put(&setup, Rgb565::default(), Some(&texture));
            }
        }
        let count = writer.finish();
        let count = count.map_err(|_| EngineError::from(Error::Full))?;
        self.sets[1] = (count > 0).then(|| self.clipped_set(count));
        Ok(())
    }
}
