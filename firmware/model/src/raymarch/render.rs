//! Drawing of all pixels of a frame with a distance field.

use glint_core::colour::{Rgb565, Rounding};

use super::end::{RayEnd, State};
use super::paint::paint;
use super::palette::Palette;
use super::setup::FieldSetup;
use super::tracer::Tracer;
use crate::error::RenderError;
use crate::frame_buffer::FrameBuffer;
use crate::triangle::reciprocal::Reciprocal;

/// Counts of the rays of a drawn field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FieldStats {
    /// Number of rays: one per pixel and eye.
    pub rays: u32,
    /// Number of evaluations of the field. With several spheres, a step of a marching ray counts as one evaluation per sphere.
    pub evaluations: u64,
    /// Number of rays that hit a surface.
    pub hits: u32,
    /// Number of rays that missed.
    pub misses: u32,
    /// Number of rays that ended undecided, at the step limit.
    pub undecided: u32,
}

impl FieldStats {
    /// Adds the counts of other rows or of another frame.
    pub const fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.evaluations += other.evaluations;
        self.hits += other.hits;
        self.misses += other.misses;
        self.undecided += other.undecided;
    }

    /// Adds a ray to the counts.
    pub fn count(&mut self, end: &RayEnd) {
        self.rays += 1;
        self.evaluations += u64::from(end.evaluations);
        *match end.state {
            State::Hit(_) => &mut self.hits,
            State::Miss => &mut self.misses,
            State::Undecided => &mut self.undecided,
        } += 1;
    }
}

/// Draws a field into `target`. A pixel of the target changes if the field's depth code is at least the code stored
/// there. With two eyes every pixel changes.
///
/// With two eyes `palette` must be grey, and the depth codes are those of the left eye. `show` receives the column, the row and the end of
/// every ray. Not inlined, so that the loop and its callees do not evict each other from the instruction cache.
///
/// # Errors
/// [`RenderError`] if the target's size differs from the setup's; the target is then unchanged.
#[inline(never)]
pub fn render_field(
    setup: &FieldSetup,
    palette: &Palette,
    target: &mut FrameBuffer,
    show: &mut dyn FnMut(u32, u32, &RayEnd),
) -> Result<FieldStats, RenderError> {
    target.check()?;
    target.check_size((setup.width, setup.height))?;
    let rounding = target.rounding;
    let (colour, depth) = (&mut *target.colour, &mut *target.depth);
    Ok(render_rows(
        &setup.tracer(),
        palette,
        rounding,
        0,
        colour,
        depth,
        show,
    ))
}

/// Draws the rows of a field from `first` on, as many as `colour` and `depth` have, as [`render_field`] does.
#[inline(always)]
pub fn render_rows(
    tracer: &Tracer,
    palette: &Palette,
    rounding: Rounding,
    first: u32,
    colour: &mut [u16],
    depth: &mut [u32],
    show: &mut dyn FnMut(u32, u32, &RayEnd),
) -> FieldStats {
    let setup = tracer.setup;
    let width = setup.width;
    let mut stats = FieldStats::default();
    let mut cast = |eye, x, y| {
        let end = tracer.trace(eye, x, y);
        stats.count(&end);
        show(x, y, &end);
        (paint(setup, palette, &end), setup.depth_code(&end))
    };
    let pixels = core::iter::zip(colour.iter_mut(), depth.iter_mut());
    let places = (first..setup.height).flat_map(|y| (0..width).map(move |x| (x, y)));
    for ((x, y), (colour, depth)) in core::iter::zip(places, pixels) {
        let (left, code) = cast(0, x, y);
        match setup.stereo {
            None => {
                if code >= *depth {
                    let left = Rgb565::with_fractions(left);
                    *colour = Rgb565::rounded(left, rounding, [x, y]).0;
                    *depth = code;
                }
            }
            Some(tint) => {
                let (right, _) = cast(1, x, y);
                (*colour, *depth) = (tint.compose(left[1], right[1]), code);
            }
        }
    }
    stats
}

impl FieldSetup {
    /// The depth code of a hit; 0 for any other end of a ray.
    pub fn depth_code(&self, end: &RayEnd) -> u32 {
        let State::Hit(_) = end.state else {
            return 0;
        };
        let Reciprocal { y, lead } = Reciprocal::of(end.depth);
        // The reciprocal of the depth, taken as an integer, has 24 + `lead` fraction bits. The depth has 21 fraction bits, so 21 is
        // subtracted.
        let shift = lead as i32 + 3 - self.depth.exponent;
        const MOST: u32 = (1 << 18) - 1;
        if shift < 22 {
            // The code is at least 2^(16 + 23 − 21), which does not fit 18 bits, and saturates.
            return MOST;
        }
        let product = u64::from(self.depth.mantissa) * u64::from(y);
        ((((product >> (shift - 1)) + 1) >> 1) as u32).clamp(1, MOST)
    }
}
