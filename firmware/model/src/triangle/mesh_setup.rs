//! The frame constants of a mesh, computed once from the camera and the size of the picture.

use glint_core::camera::{Lens, Projection, View, is_within};
use glint_core::fixed::{Q2_23, Q4_28, Q32_32, U4_28, U8_28};
use glint_core::picture::Window;

use crate::depth::DepthScale;
use crate::error::{MAX_EYE, RenderError, whole_picture};
use crate::triangle::rounding::nearest;
use crate::triangle::volume::{Clip, Volume};

/// The frame constants of the vertex stage (docs/formats/camera.md, "Frame constants").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshSetup {
    /// Width of the window in pixels.
    pub width: u32,
    /// Height of the window in pixels.
    pub height: u32,
    /// Width and height of the picture in pixels.
    pub picture: [u32; 2],
    /// Column and line of the middle of the picture, relative to the first column and line of the window.
    pub middle: [u32; 2],
    /// Scale shift f: the number of fraction bits of `u` and `v`, 6 to 18.
    pub scale_shift: u32,
    /// Perspective or orthographic projection.
    pub projection: Projection,
    /// The row of the camera's right axis u, scaled to pixels at distance 1: 25 bits, f of which are fraction bits (f is `scale_shift`). In
    /// perspective, the middle of the window times n is subtracted before scaling.
    pub u: [i32; 3],
    /// The row of the camera's down axis v, in the format of `u`.
    pub v: [i32; 3],
    /// The camera's forward axis, s2.23.
    pub n: [i32; 3],
    /// The translation for the eye C: −C·u and −C·v with 14 + f fraction bits, −C·n with 37 fraction bits; each s44. In orthographic
    /// projection, −C·n is reduced by the depth whose code is 2^18.
    pub translation: [i64; 3],
    /// The smallest coordinate Z that is not clipped, 37 fraction bits: in perspective `near_plane`, in orthographic projection the
    /// depth of the code 2^18 − 4.
    pub near: i64,
    /// Distance of the near plane from the eye, 37 fraction bits.
    pub near_plane: i64,
    /// The scale K of depth codes.
    pub depth: DepthScale,
    /// The volume to which triangles are clipped.
    pub volume: Volume,
    /// Whether the mesh is an object, which has its own model matrix and colour.
    pub is_placed: bool,
    /// The row of the light, s2.23: `n` for a light at the camera, otherwise the direction from the light. For an object, in the
    /// coordinates of the object's mesh.
    pub light: [i32; 3],
    /// Whether the model matrix mirrors the mesh, so that front faces are clockwise on the screen.
    pub mirrors: bool,
}

impl MeshSetup {
    /// Computes the constants for a camera whose eye is within 8 world units of the origin, a picture of one of the
    /// [`SIZES`](crate::SIZES), and a mesh with the given `radius` (14 fraction bits).
    ///
    /// # Errors
    /// [`RenderError::Size`], [`RenderError::Eye`], [`RenderError::Window`] or [`RenderError::Near`].
    pub fn new(view: &View, width: u32, height: u32, radius: u32) -> Result<Self, RenderError> {
        let mut setup = Self::default();
        let window = whole_picture((width, height))?;
        setup.update(view, window, radius, &mut Scale::default())?;
        Ok(setup)
    }

    /// Computes the constants for a window of a picture as [`new`](Self::new) does, in place, because copying them is slow on the soft
    /// core. `scale` is kept from one frame to the next.
    ///
    /// # Errors
    /// As [`new`](Self::new); the constants must then not be used.
    pub(crate) fn update(
        &mut self,
        view: &View,
        window: Window,
        radius: u32,
        scale: &mut Scale,
    ) -> Result<(), RenderError> {
        let eye = view.eye_of_middle();
        if !is_within(eye, MAX_EYE) {
            return Err(RenderError::Eye(eye));
        }
        scale.update(window.picture(), view.lens());
        if scale.shift < LEAST_SHIFT {
            return Err(RenderError::Window);
        }
        let projection = view.projection();
        if projection == Projection::Perspective {
            // The vertex stage shifts X and Y right by at least 6 bits.
            let least = U4_28::from_bits(1 << (31 - scale.shift));
            if view.near() < least {
                let near = view.near();
                return Err(RenderError::Near { near, least });
            }
        }
        [self.width, self.height] = window.size.pixels();
        (self.picture, self.middle) = (window.picture(), window.middle());
        self.scale_shift = scale.shift;
        self.projection = projection;
        [self.u, self.v] = scale.rows(view);
        self.n = view.n().map(Q2_23::to_bits);
        // The eye C is within 8 world units of the origin, which is 2^35 with its 32 fraction bits, and a row is shorter
        // than 2^24.5: |C·row| < 2^60.
        let eye = view.eye().map(Q32_32::to_bits);
        self.translation = [&self.u, &self.v, &self.n].map(|row| nearest(-dot(eye, row), 18));
        if projection == Projection::Orthographic {
            scale.place(view, &mut self.translation);
        }
        self.near = i64::from(view.near().to_bits()) << 9;
        self.near_plane = self.near;
        self.volume = Volume::Guard;
        self.is_placed = false;
        self.light = self.n;
        self.mirrors = false;
        let origin = self.translation[2];
        match projection {
            Projection::Perspective => self.depth = DepthScale::new(origin, self.near, radius),
            Projection::Orthographic => {
                self.depth.origin = None;
                let reach = DepthScale::reach(radius);
                self.set_linear(origin - reach, origin + reach, LEAST_EXPONENT);
            }
        }
        Ok(())
    }

    /// Replaces the scale of depth codes by the scale for a frame with several meshes. `depths` are the smallest and the largest depth of
    /// all meshes, with 37 fraction bits; without a mesh, both are the depth of the near plane.
    pub(crate) fn set_depths(&mut self, depths: Option<[i64; 2]>) {
        let [nearest, farthest] = depths.unwrap_or([self.near_plane; 2]);
        match self.projection {
            Projection::Perspective => {
                self.depth = DepthScale::from_nearest(nearest.max(self.near_plane));
            }
            Projection::Orthographic => self.set_linear(nearest, farthest, LEAST_OF_OBJECTS),
        }
    }

    /// Sets linear depth codes for an orthographic frame, and makes depths relative to the depth of the code 2^18.
    #[inline(never)]
    fn set_linear(&mut self, nearest: i64, farthest: i64, least: i32) {
        let depth = self.depth_of_world();
        self.depth = DepthScale::linear(nearest.max(self.near_plane), farthest, least);
        let origin = self.depth.origin.unwrap_or_default();
        self.translation[2] = depth - origin;
        self.near = 4 << (18 + self.depth.exponent);
    }

    /// The depth of the world's origin along the camera's forward axis, 37 fraction bits.
    pub(crate) fn depth_of_world(&self) -> i64 {
        self.translation[2] + self.depth.origin.unwrap_or_default()
    }

    /// The value of the triangle engine's register `scale_shift`: the scale shift f, or f + 1 − ke in orthographic projection, where ke is
    /// the exponent of the depth codes.
    pub fn engine_shift(&self) -> u32 {
        match self.projection {
            Projection::Perspective => self.scale_shift,
            // ke is in −6…5 for the engine, and f is at least 6.
            Projection::Orthographic => (self.scale_shift as i32 + 1 - self.depth.exponent) as u32,
        }
    }

    /// Returns these constants with another volume to which triangles are clipped.
    ///
    /// # Errors
    /// [`RenderError::Far`] for a far plane that is not beyond the near plane.
    pub fn with_clip(self, clip: Clip) -> Result<Self, RenderError> {
        let volume = self.volume_of(clip)?;
        Ok(Self { volume, ..self })
    }

    /// The volume for a kind of clipping, with the errors of [`with_clip`](Self::with_clip).
    pub(crate) fn volume_of(&self, clip: Clip) -> Result<Volume, RenderError> {
        match clip {
            Clip::Guard => Ok(Volume::Guard),
            Clip::View { far } => {
                let distance = (far.to_bits() as i64) << 9;
                if distance <= self.near_plane {
                    return Err(RenderError::Far(far));
                }
                let far = distance - self.depth.origin.unwrap_or_default();
                Ok(Volume::View { far })
            }
        }
    }
}

/// The smallest exponent ke of the depth codes of an orthographic frame with one mesh. The vertex stage uses the 24 highest bits of a depth
/// below 2^(35 + ke) units, and only has bits 6 to 40 of the depth.
const LEAST_EXPONENT: i32 = -6;
/// The smallest exponent ke of an orthographic frame with objects. Each object subtracts up to 6 from ke.
const LEAST_OF_OBJECTS: i32 = 0;

/// The smallest scale shift: with fewer fraction bits the products of the clipper do not fit 64 bits.
const LEAST_SHIFT: u32 = 6;

/// The scales s·2^f across and down (docs/formats/camera.md, "Frame constants").
///
/// The scales are cached, because their computation takes divisions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scale {
    key: Key,
    shift: u32,
    axes: [Axis; 2],
}

/// The inputs from which the scales are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Key {
    /// Across and down: a number of pixels, and their total length in the window.
    scales: [(u32, U8_28); 2],
    /// The largest integer whose product with c of [`Scale::new`] is below 2^24.
    largest: i64,
}

impl Key {
    fn new(size: [u32; 2], lens: &Lens) -> Self {
        /// The largest integer whose product with 1 + 2^−12 is below 2^24.
        const LARGEST: i64 = ((1 << 36) - 1) / 4097;
        // In orthographic projection, an off-axis window changes the translations and not the rows.
        let [across, down] = match lens.projection() {
            Projection::Perspective => lens.middle().map(Q4_28::unsigned_abs),
            Projection::Orthographic => [U4_28::ZERO; 2],
        };
        let middle = across.max(down);
        let mut largest = LARGEST;
        if middle != 0 {
            // 29/41 is slightly less than 1/√2.
            largest = LARGEST * 29 / 41;
            largest >>= (0..3).take_while(|k| middle > 1 << k).count();
        }
        Self {
            scales: lens.scales(size),
            largest,
        }
    }
}

/// A scale s·2^f as the fraction P·2^(28 + f)/h, where P is a number of pixels, and h is the total length of these pixels in the window,
/// with 28 fraction bits.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    numerator: i64,
    length: i64,
    /// ceil(s·2^24), below 2^41.
    whole: i64,
    /// ceil(s·2^(f + 6)), below 2^30.
    ceil: i64,
}

impl Scale {
    /// Updates the scales for a picture of this size and a lens, if either has changed.
    fn update(&mut self, size: [u32; 2], lens: &Lens) {
        let key = Key::new(size, lens);
        if self.key != key {
            *self = Self::new(key);
        }
    }

    /// Finds the largest f up to 18 with ceil(s·2^f)·c < 2^24 for both scales. c is 1 + 2^−12 for a window whose middle is on the camera's
    /// axis. Otherwise c is √2·2^k·(1 + 2^−12), with the smallest k for which the middle is within 2^k of the axis.
    ///
    /// s is in [1.39, 147128], so f is in 6…18 for a window whose middle is within 1 of the axis. A component of the basis is at most 1 +
    /// 10^−4, which is below 1 + 2^−12. A component of u − m·n is at most √2·2^k times this bound for |m| ≤ 2^k.
    // Not inlined, because most frames reuse the scales of the previous frame.
    #[inline(never)]
    fn new(key: Key) -> Self {
        let [(pixels, length), other] = key.scales;
        let across = Axis::whole(pixels, length);
        let down = if key.scales[0] == other {
            across
        } else {
            Axis::whole(other.0, other.1)
        };
        // `whole` is ceil(s·2^24), which has at least 25 bits. Shifted right and rounded up, `whole` is ceil(s·2^f) for a smaller f. Its
        // leading 24 bits or its leading 23 bits are at most LARGEST; for a smaller limit, fewer leading bits are.
        let whole = across.whole.max(down.whole);
        let mut cut = (whole.ilog2() - 23).max(6);
        while whole > key.largest << cut {
            cut += 1;
        }
        let axes = [(across, pixels), (down, other.0)].map(|(axis, pixels)| axis.cut(pixels, cut));
        Self {
            key,
            shift: 24 - cut,
            axes,
        }
    }

    /// The scaled rows of the camera's axes u and v.
    fn rows(&self, view: &View) -> [[i32; 3]; 2] {
        let [u, v] = aside(view);
        let [across, down] = &self.axes;
        [u.map(|r| across.scaled(r)), v.map(|r| down.scaled(r))]
    }

    /// Replaces the translations −C·u·s and −C·v·s by translations relative to the middle of the window. They are computed from the exact
    /// axes, with errors below 2^−20 pixel.
    ///
    /// In orthographic projection the rounding error of a row is not divided by the distance to the eye. With exact translations, the
    /// resulting error is proportional to the position in the mesh, and not to the distance of the mesh from the eye.
    #[inline(never)]
    fn place(&self, view: &View, translation: &mut [i64; 3]) {
        let eye = view.eye().map(Q32_32::to_bits);
        let axes = [view.u(), view.v()].into_iter().zip(view.lens().middle());
        for ((axis, middle), (scale, translation)) in axes.zip(self.axes.iter().zip(translation)) {
            // |C·axis| is below 2^58.1 in units of 2^−55 and is rounded to 40 fraction bits; s·2^24 is below 2^41.
            let along = nearest(-dot(eye, &axis.map(Q2_23::to_bits)), 15);
            let along = along - (i64::from(middle.to_bits()) << 12);
            let pixels = i128::from(along) * i128::from(scale.whole);
            let shift = 50 - self.shift;
            *translation = ((pixels + (1 << (shift - 1))) >> shift) as i64;
        }
    }
}

impl Axis {
    /// The scale of `pixels` pixels, at most 2^11, with this total length, before f is chosen.
    fn whole(pixels: u32, length: U8_28) -> Self {
        let length = length.to_bits() as i64;
        let whole = (Self::numerator(pixels, 24) + length - 1) / length;
        Self {
            length,
            whole,
            ..Self::default()
        }
    }

    const fn numerator(pixels: u32, shift: u32) -> i64 {
        (pixels as i64) << (28 + shift)
    }

    /// The scale for f = 24 − `cut`.
    const fn cut(self, pixels: u32, cut: u32) -> Self {
        let spare = cut - 6;
        Self {
            numerator: Self::numerator(pixels, 24 - cut),
            ceil: (self.whole + (1 << spare) - 1) >> spare,
            ..self
        }
    }

    /// Scales a component r of a row of the view: nearest(r·s·2^f), the quotient of 2·r·(numerator/2^23) + h and 2h, rounded
    /// down.
    ///
    /// The soft core divides 64-bit numbers in software, in 1,200 clocks, so only `ceil` is computed by a division. The product
    /// r·ceil(s·2^(f + 6)) differs from r·s·2^(f + 6) by at most |r| < 2^27, which is a quarter of the quotient's last place. Rounded down,
    /// it is therefore the quotient, or 1 less; the remainder distinguishes the two cases.
    // Not inlined: the soft core fetches code that runs once per frame from main memory, so smaller code is faster.
    #[inline(never)]
    fn scaled(&self, r: Q2_23) -> i32 {
        let divisor = 2 * self.length;
        let r = i64::from(r.to_bits());
        let quotient = (r * self.ceil) >> (23 + 6);
        // |r|·s·2^f is below 2^47, so the dividend is below 2^25·h + h, and h below 2^35.
        let dividend = 2 * r * (self.numerator >> 23) + self.length;
        let is_less = dividend - quotient * divisor >= divisor;
        (quotient + i64::from(is_less)) as i32
    }
}

/// In perspective, the rows u − m·n and v − m·n, with which the middle m of the window is at x = 0 and y = 0. For a window whose middle is
/// on the axis n, and in orthographic projection, the camera's axes u and v.
fn aside(view: &View) -> [[Q2_23; 3]; 2] {
    let (rows, n) = ([view.u(), view.v()], view.n());
    let middle = view.lens().middle();
    if middle == [Q4_28::ZERO; 2] || view.projection() == Projection::Orthographic {
        return rows;
    }
    [0, 1].map(|row: usize| {
        [0, 1, 2].map(|i: usize| {
            // The product has 28 + 23 fraction bits and is rounded to nearest.
            let aside = i64::from(middle[row].to_bits()) * i64::from(n[i].to_bits());
            let aside = (aside + (1 << 27)) >> 28;
            Q2_23::from_bits(rows[row][i].to_bits() - aside as i32)
        })
    })
}

/// The scalar product. Not inlined, for the reason given at [`Axis::scaled`].
#[inline(never)]
fn dot(a: [i64; 3], b: &[i32; 3]) -> i64 {
    core::iter::zip(a, b).map(|(a, &b)| a * i64::from(b)).sum()
}
