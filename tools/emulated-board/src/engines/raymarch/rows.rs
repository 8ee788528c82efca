//! Drawing of a field in strips of rows, on all CPU cores of the host.

use std::sync::{Mutex, PoisonError};
use std::thread;

use glint_model::FrameBuffer;
use glint_model::raymarch::{FieldStats, Palette, Tracer, render_rows};

/// Number of rows of a strip.
const ROWS: usize = 16;

/// Draws a field into a picture without triangles. Returns the counts of its rays.
pub fn render(tracer: &Tracer, palette: &Palette, target: &mut FrameBuffer) -> FieldStats {
    let rounding = target.rounding;
    let pixels = ROWS * target.width as usize;
    let strips = target.colour.chunks_mut(pixels);
    let strips = strips.zip(target.depth.chunks_mut(pixels));
    let strips = Mutex::new((0..).step_by(ROWS).zip(strips));
    let sum = Mutex::new(FieldStats::default());
    let work = || {
        loop {
            let next = strips.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((first, (colour, depth))) = next else {
                return;
            };
            let stats = render_rows(
                tracer,
                palette,
                rounding,
                first,
                colour,
                depth,
                &mut |_, _, _| {},
            );
            let mut sum = sum.lock().unwrap_or_else(PoisonError::into_inner);
            sum.add(&stats);
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    sum.into_inner().unwrap_or_else(PoisonError::into_inner)
}
