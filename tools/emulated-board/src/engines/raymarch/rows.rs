//! Drawing of a field in strips of rows, on all CPU cores of the host.

use std::sync::{Mutex, PoisonError};
use std::thread;

use glint_model::FrameBuffer;
use glint_model::raymarch::{FieldStats, Palette, RayEnd, Tracer, render_rows};

/// Number of rows of a strip.
const ROWS: usize = 16;

/// Draws a field into a picture that already contains the triangles of the frame. Returns the
/// counts of its rays, and the number of pixels that triangles hide.
pub fn render(tracer: &Tracer, palette: &Palette, target: &mut FrameBuffer) -> (FieldStats, u32) {
    let pixels = ROWS * target.width as usize;
    let strips = target.colour.chunks_mut(pixels);
    let strips = strips.zip(target.depth.chunks_mut(pixels));
    let strips = Mutex::new((0..).step_by(ROWS).zip(strips));
    let sums = Mutex::new((FieldStats::default(), 0));
    let work = || {
        loop {
            let next = strips.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((first, (colour, depth))) = next else {
                return;
            };
            let (stats, hidden) = strip(tracer, palette, first, colour, depth);
            let mut sums = sums.lock().unwrap_or_else(PoisonError::into_inner);
            sums.0.add(&stats);
            sums.1 += hidden;
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    sums.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// Draws the rows from row `first` on.
fn strip(
    tracer: &Tracer,
    palette: &Palette,
    first: u32,
    colour: &mut [u16],
    depth: &mut [u32],
) -> (FieldStats, u32) {
    // At pixels with triangles, the ray's depth test is repeated here, because the model does not count the rays that fail this test.
    let before = depth.to_vec();
    let setup = tracer.setup;
    let mut hidden = 0;
    let mut show = |x, y, end: &RayEnd| {
        let stored = before.get(((y - first) * setup.width + x) as usize);
        let stored = stored.copied().unwrap_or(0);
        if stored > 0 && setup.stereo.is_none() {
            hidden += u32::from(setup.depth_code(end) < stored);
        }
    };
    let stats = render_rows(tracer, palette, first, colour, depth, &mut show);
    (stats, hidden)
}
