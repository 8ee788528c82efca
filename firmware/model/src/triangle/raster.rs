//! The walker, which finds the pixels of a triangle row by row, tests their depth and writes them.
//!
//! A triangle is convex, so each row has one span of covered pixels. The span starts at the first pixel that is inside all edges of the
//! left side, and ends at the last pixel that is inside all edges of the right side. From row to row the walker moves both ends of the span
//! along the edges, pixel by pixel. Horizontal edges need no test, because the bounds only contain rows at or below a top edge and above a
//! bottom edge.

use core::ops::{Add, BitOr, Sub};

use glint_core::colour::{Rgb565, Rounding};
use glint_core::texture::Blend;

use crate::fog::Fog;
use crate::frame_buffer::FrameBuffer;
use crate::triangle::descriptor::GROUP;
use crate::triangle::quotient;
use crate::triangle::setup::{Edge, Plane, Setup};
use crate::triangle::textured::Textured;

/// Counts of the pixels of one triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Number of pixels tested: covered pixels, and pixels just outside the ends of a span.
    pub tested: u32,
    /// Number of pixels covered by the triangle.
    pub covered: u32,
    /// Number of covered pixels that passed the depth test and were written.
    pub drawn: u32,
}

/// Draws a triangle without a texture; `colour` is the triangle's colour under flat shading.
pub fn draw(setup: &Setup, colour: Rgb565, target: &mut FrameBuffer) -> Coverage {
    match &setup.light {
        None => draw_with(setup, colour, target),
        Some(light) => draw_smooth(setup, light, target),
    }
}

/// Draws a triangle, with a texture or without one, in fog. The brush is a trait object, so that the code size for fog is small.
#[inline(never)]
pub fn draw_in_fog(
    setup: &Setup,
    colour: Rgb565,
    textured: Option<&Textured>,
    fog: &Fog,
    target: &mut FrameBuffer,
) -> Coverage {
    let rounding = target.rounding;
    let mut draw =
        |brush: &mut dyn Brush<Colour = [u8; 3]>| draw_with(setup, Fogged::new(brush, fog), target);
    match (textured, &setup.light) {
        (Some(textured), _) => draw(&mut Textures::new(setup, textured, rounding)),
        (None, Some(light)) => draw(&mut Smooth::new(setup, light, rounding)),
        (None, None) => draw(&mut Flat::new(colour, rounding)),
    }
}

/// Draws a triangle as [`draw`] and [`draw_in_fog`] do. For each row with a covered pixel, calls `visit` with the row and with the first
/// and the last group of eight columns that contains a covered pixel. The engine's lanes process these groups and all groups between them.
pub fn draw_groups(
    setup: &Setup,
    colour: Rgb565,
    textured: Option<&Textured>,
    fog: Option<&Fog>,
    target: &mut FrameBuffer,
    visit: &mut dyn FnMut(i32, [i32; 2]),
) -> Coverage {
    let rounding = target.rounding;
    match (textured, &setup.light) {
        (Some(textured), _) => {
            let brush = Textures::new(setup, textured, rounding);
            grouped(setup, brush, fog, target, visit)
        }
        (None, Some(light)) => {
            let brush = Smooth::new(setup, light, rounding);
            grouped(setup, brush, fog, target, visit)
        }
        (None, None) => grouped(setup, Flat::new(colour, rounding), fog, target, visit),
    }
}

fn grouped(
    setup: &Setup,
    mut brush: impl Brush<Colour = [u8; 3]>,
    fog: Option<&Fog>,
    target: &mut FrameBuffer,
    visit: &mut dyn FnMut(i32, [i32; 2]),
) -> Coverage {
    let row = setup.bounds.top;
    match fog {
        None => draw_with(setup, Grouped { brush, row, visit }, target),
        Some(fog) => {
            let brush = Fogged::new(&mut brush, fog);
            draw_with(setup, Grouped { brush, row, visit }, target)
        }
    }
}

/// Draws a triangle with smooth shading. Not inlined, so that flat triangles do not load this code
/// into the instruction cache.
#[inline(never)]
fn draw_smooth(setup: &Setup, light: &[Plane; 3], target: &mut FrameBuffer) -> Coverage {
    let brush = Smooth::new(setup, light, target.rounding);
    draw_with(setup, brush, target)
}

/// Draws a triangle with a texture. Not inlined, so that other triangles do not load this code into the instruction cache.
#[inline(never)]
pub fn draw_textured(setup: &Setup, textured: &Textured, target: &mut FrameBuffer) -> Coverage {
    let brush = Textures::new(setup, textured, target.rounding);
    draw_with(setup, brush, target)
}

fn draw_with(setup: &Setup, brush: impl Brush, target: &mut FrameBuffer) -> Coverage {
    if setup.narrow {
        walk::<i32>(setup, brush, target)
    } else {
        walk::<i64>(setup, brush, target)
    }
}

/// The source of pixel colours. The walker moves the brush over the triangle together with the depth.
trait Brush {
    /// A colour: RGB565, or channels with fraction bits, as [`Rgb565::with_fractions`] returns them.
    type Colour;
    /// Moves to the first of the covered columns of a row. `columns` are the first and the last covered column, and `offset` is the number
    /// of columns from the start column to the first one.
    fn go_to(&mut self, offset: u32, columns: [i32; 2]);
    /// Moves one pixel to the right.
    fn go_right(&mut self);
    /// Moves to the next row. The column is unspecified until the next `go_to`.
    fn go_down(&mut self);
    /// The colour of the current pixel; `depth` is the pixel's depth accumulator plus half a code. `None` for a transparent pixel.
    fn colour(&self, depth: u32) -> Option<Self::Colour>;
    /// Writes a pixel that passed the depth test, with the given `colour` and depth `code`; `place` is the pixel's column and row.
    fn write(
        &self,
        colour: Self::Colour,
        code: u32,
        place: [u32; 2],
        pixel: &mut u16,
        stored: &mut u32,
    );
    /// Whether pixels are blended by addition, so that fog darkens them.
    fn is_added(&self) -> bool {
        false
    }
}

/// Flat shading: every pixel has the triangle's colour.
impl Brush for Rgb565 {
    type Colour = Self;
    fn go_to(&mut self, _: u32, _: [i32; 2]) {}
    fn go_right(&mut self) {}
    fn go_down(&mut self) {}
    fn colour(&self, _: u32) -> Option<Self> {
        Some(*self)
    }
    fn write(&self, colour: Self, code: u32, _: [u32; 2], pixel: &mut u16, stored: &mut u32) {
        *stored = code;
        *pixel = colour.0;
    }
}

/// Flat shading, with the fraction bits that fog requires.
struct Flat {
    colour: [u8; 3],
    rounding: Rounding,
}

impl Flat {
    const fn new(colour: Rgb565, rounding: Rounding) -> Self {
        Self {
            colour: colour.fractions(),
            rounding,
        }
    }
}

impl Brush for Flat {
    type Colour = [u8; 3];
    fn go_to(&mut self, _: u32, _: [i32; 2]) {}
    fn go_right(&mut self) {}
    fn go_down(&mut self) {}
    fn colour(&self, _: u32) -> Option<[u8; 3]> {
        Some(self.colour)
    }
    fn write(
        &self,
        colour: [u8; 3],
        code: u32,
        place: [u32; 2],
        pixel: &mut u16,
        stored: &mut u32,
    ) {
        *stored = code;
        *pixel = Rgb565::rounded(colour, self.rounding, place).0;
    }
}

/// A brush that reports the groups of columns to `visit`.
struct Grouped<'a, B> {
    brush: B,
    row: i32,
    visit: &'a mut dyn FnMut(i32, [i32; 2]),
}

impl<B: Brush> Brush for Grouped<'_, B> {
    type Colour = B::Colour;
    fn go_to(&mut self, offset: u32, columns: [i32; 2]) {
        (self.visit)(self.row, columns.map(|column| column / GROUP));
        self.brush.go_to(offset, columns);
    }
    fn go_right(&mut self) {
        self.brush.go_right();
    }
    fn go_down(&mut self) {
        self.brush.go_down();
        self.row += 1;
    }
    fn colour(&self, depth: u32) -> Option<B::Colour> {
        self.brush.colour(depth)
    }
    fn write(
        &self,
        colour: B::Colour,
        code: u32,
        place: [u32; 2],
        pixel: &mut u16,
        stored: &mut u32,
    ) {
        self.brush.write(colour, code, place, pixel, stored);
    }
}

/// A brush whose colours are mixed with fog.
struct Fogged<'a> {
    brush: &'a mut dyn Brush<Colour = [u8; 3]>,
    fog: &'a Fog,
    /// Colour of the fog; black for pixels that are blended by addition.
    colour: [u8; 3],
}

impl<'a> Fogged<'a> {
    fn new(brush: &'a mut dyn Brush<Colour = [u8; 3]>, fog: &'a Fog) -> Self {
        let colour = if brush.is_added() { [0; 3] } else { fog.colour };
        Self { brush, fog, colour }
    }
}

impl Brush for Fogged<'_> {
    type Colour = [u8; 3];
    fn go_to(&mut self, offset: u32, columns: [i32; 2]) {
        self.brush.go_to(offset, columns);
    }
    fn go_right(&mut self) {
        self.brush.go_right();
    }
    fn go_down(&mut self) {
        self.brush.go_down();
    }
    fn colour(&self, depth: u32) -> Option<[u8; 3]> {
        self.brush.colour(depth)
    }
    fn write(
        &self,
        colour: [u8; 3],
        code: u32,
        place: [u32; 2],
        pixel: &mut u16,
        stored: &mut u32,
    ) {
        let colour = self.fog.over(self.colour, colour, code);
        self.brush.write(colour, code, place, pixel, stored);
    }
}

/// A plane, with the value at the current pixel (`value`) and the value at the start column of the current row (`row`).
#[derive(Clone, Copy)]
struct Accumulation {
    plane: Plane,
    row: u32,
    value: u32,
}

impl Accumulation {
    fn new(plane: Plane) -> Self {
        Self {
            plane,
            row: plane.start,
            value: plane.start,
        }
    }

    fn go_to(&mut self, offset: u32) {
        self.value = self
            .row
            .wrapping_add(self.plane.step_x.wrapping_mul(offset));
    }

    fn go_right(&mut self) {
        self.value = self.value.wrapping_add(self.plane.step_x);
    }

    fn go_down(&mut self) {
        self.row = self.row.wrapping_add(self.plane.step_y);
    }
}

/// Smooth shading: the colour comes from the planes of red, green and blue.
struct Smooth {
    light: [Accumulation; 3],
    /// The weight of the light in all pixels; `None` if each pixel's depth is the weight.
    weight: Option<u32>,
    rounding: Rounding,
}

impl Smooth {
    fn new(setup: &Setup, light: &[Plane; 3], rounding: Rounding) -> Self {
        Self {
            light: light.map(Accumulation::new),
            weight: setup.weight,
            rounding,
        }
    }
}

impl Brush for Smooth {
    type Colour = [u8; 3];
    fn go_to(&mut self, offset: u32, _: [i32; 2]) {
        self.light.iter_mut().for_each(|light| light.go_to(offset));
    }
    fn go_right(&mut self) {
        self.light.iter_mut().for_each(Accumulation::go_right);
    }
    fn go_down(&mut self) {
        self.light.iter_mut().for_each(Accumulation::go_down);
    }
    fn colour(&self, depth: u32) -> Option<[u8; 3]> {
        let depth = self.weight.unwrap_or(depth);
        let light = self.light.map(|light| light.value);
        Some(quotient::colour(light, depth, self.rounding))
    }
    fn write(
        &self,
        colour: [u8; 3],
        code: u32,
        place: [u32; 2],
        pixel: &mut u16,
        stored: &mut u32,
    ) {
        *stored = code;
        *pixel = Rgb565::rounded(colour, self.rounding, place).0;
    }
}

/// A texture, whose colour is multiplied by the light of the triangle or, under smooth shading, by the light of each pixel.
struct Textures<'a> {
    setup: &'a Setup,
    textured: &'a Textured<'a>,
    /// The texture coordinates, each multiplied by the depth.
    places: [Accumulation; 2],
    light: Option<[Accumulation; 3]>,
    /// The depth plus half a code.
    depth: Accumulation,
    column: i32,
    /// The mip level of the current group of columns.
    level: u32,
    rounding: Rounding,
}

impl<'a> Textures<'a> {
    fn new(setup: &'a Setup, textured: &'a Textured, rounding: Rounding) -> Self {
        let mut depth = Accumulation::new(setup.depth);
        depth.row = depth.row.wrapping_add(1 << 13);
        Self {
            setup,
            textured,
            places: textured.axes.map(|axis| Accumulation::new(axis.plane)),
            light: setup.light.map(|light| light.map(Accumulation::new)),
            depth,
            column: 0,
            level: 0,
            rounding,
        }
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Accumulation> {
        let light = self.light.iter_mut().flatten();
        let places = self.places.iter_mut();
        places.chain(light).chain(core::iter::once(&mut self.depth))
    }

    /// Computes the mip level of the current group from the group's first covered pixel.
    fn set_level(&mut self) {
        let places = self.places.map(|place| place.value);
        self.level = self.textured.level(self.setup, self.depth.value, places);
    }
}

impl Brush for Textures<'_> {
    type Colour = [u8; 3];
    fn go_to(&mut self, offset: u32, [first, _]: [i32; 2]) {
        self.all().for_each(|plane| plane.go_to(offset));
        self.column = first;
        self.set_level();
    }
    fn go_right(&mut self) {
        self.all().for_each(Accumulation::go_right);
        self.column += 1;
        if self.column % GROUP == 0 {
            self.set_level();
        }
    }
    fn go_down(&mut self) {
        self.all().for_each(Accumulation::go_down);
    }
    fn colour(&self, depth: u32) -> Option<[u8; 3]> {
        let light = self.light.map(|light| light.map(|light| light.value));
        let places = self.places.map(|place| place.value);
        self.textured
            .colour(depth, places, self.level, light, self.rounding)
    }
    /// A blended pixel does not change the stored depth code.
    fn write(
        &self,
        colour: [u8; 3],
        code: u32,
        place: [u32; 2],
        pixel: &mut u16,
        stored: &mut u32,
    ) {
        let colour = Rgb565::rounded(colour, self.rounding, place);
        match self.textured.texture.blend() {
            Blend::Opaque => {
                *stored = code;
                *pixel = colour.0;
            }
            blend => *pixel = blend.over(colour, Rgb565(*pixel)).0,
        }
    }
    fn is_added(&self) -> bool {
        self.textured.texture.blend() == Blend::Additive
    }
}

/// The number type of an edge function E' (docs/formats/triangle.md, "Triangle setup"): `i32` for a narrow setup, else `i64`.
trait Accumulator:
    Copy
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + BitOr<Output = Self>
    + From<i32>
    + TryFrom<i64>
{
}
impl Accumulator for i32 {}
impl Accumulator for i64 {}

fn walk<A: Accumulator>(
    setup: &Setup,
    mut brush: impl Brush,
    target: &mut FrameBuffer,
) -> Coverage {
    let bounds = setup.bounds;
    let mut left = End::<A>::new(
        setup,
        |edge| edge.step_x > 0,
        -1,
        [bounds.left, bounds.right],
    );
    let mut right = End::<A>::new(
        setup,
        |edge| edge.step_x < 0,
        1,
        [bounds.right - 1, bounds.left - 1],
    );
    let mut row_depth = setup.depth.start.wrapping_add(1 << 13);
    let mut coverage = Coverage::default();
    for row in bounds.top..bounds.bottom {
        coverage.tested += left.settle() + right.settle();
        if left.column <= right.column {
            let offset = (left.column - setup.start_column) as u32;
            let depth = row_depth.wrapping_add(setup.depth.step_x.wrapping_mul(offset));
            brush.go_to(offset, [left.column, right.column]);
            coverage.drawn += fill(
                target,
                row,
                left.column,
                right.column,
                depth,
                setup.depth.step_x,
                &mut brush,
            );
            coverage.covered += (right.column - left.column + 1) as u32;
        }
        left.go_down();
        right.go_down();
        row_depth = row_depth.wrapping_add(setup.depth.step_y);
        brush.go_down();
    }
    coverage.tested += coverage.covered;
    coverage
}

/// Writes those pixels in columns `from` to `to` of a row that pass the depth test. `depth` is the depth accumulator plus half a code, so
/// that truncation rounds to nearest. Returns the number of pixels written.
fn fill(
    target: &mut FrameBuffer,
    row: i32,
    from: i32,
    to: i32,
    mut depth: u32,
    step: u32,
    brush: &mut impl Brush,
) -> u32 {
    let start = row as usize * target.width as usize;
    let span = start + from as usize..start + to as usize + 1;
    // The bounds are in the picture, so both slices exist.
    let colours = target.colour.get_mut(span.clone()).unwrap_or_default();
    let depths = target.depth.get_mut(span).unwrap_or_default();
    let mut drawn = 0;
    for (column, (pixel, stored)) in (from as u32..).zip(colours.iter_mut().zip(depths)) {
        let code = (depth >> 14).max(1);
        if code >= *stored
            && let Some(colour) = brush.colour(depth)
        {
            brush.write(colour, code, [column, row as u32], pixel, stored);
            drawn += 1;
        }
        depth = depth.wrapping_add(step);
        brush.go_right();
    }
    drawn
}

/// One end of a row's span: the outermost column that is inside the one or two edges on this side of the triangle.
///
/// The edge functions E' of these edges decrease by |dy| per pixel in the direction away from the triangle. On a side with one edge the
/// second E' is always 0, which means inside.
struct End<A> {
    /// E' of the edges at `column` in the current row.
    value: [A; 2],
    /// Increment of E' for one column towards the triangle, |dy|.
    inwards: [A; 2],
    /// Increment of E' for one row down.
    down: [A; 2],
    column: i32,
    /// Change of `column` for a step away from the triangle: −1 on the left side, 1 on the right side.
    outwards: i32,
    /// Outermost column of the bounds on this side.
    outermost: i32,
    /// The first column beyond the bounds on the opposite side. If the end of the span reaches this column, the row has no covered pixel.
    nowhere: i32,
}

impl<A: Accumulator> End<A> {
    fn new(
        setup: &Setup,
        on_this_side: impl Fn(&Edge) -> bool,
        outwards: i32,
        [outermost, nowhere]: [i32; 2],
    ) -> Self {
        let zero = A::default();
        let mut end = Self {
            value: [zero; 2],
            inwards: [zero; 2],
            down: [zero; 2],
            column: setup.start_column,
            outwards,
            outermost,
            nowhere,
        };
        let slots = end
            .value
            .iter_mut()
            .zip(&mut end.inwards)
            .zip(&mut end.down);
        for (((value, inwards), down), edge) in
            slots.zip(setup.edges.iter().filter(|edge| on_this_side(edge)))
        {
            // The values of a narrow setup fit 32 bits.
            *value = A::try_from(edge.start).unwrap_or_default();
            *inwards = A::from(edge.step_x.abs());
            *down = A::from(edge.step_y);
        }
        end
    }

    /// Moves `column` to the end of the span in the current row. Returns the number of pixels tested outside of the span.
    fn settle(&mut self) -> u32 {
        let mut missed = 0;
        if passes(self.value) {
            while self.column != self.outermost {
                let next = pairwise(self.value, self.inwards, A::sub);
                if !passes(next) {
                    return 1;
                }
                self.value = next;
                self.column += self.outwards;
            }
        } else {
            while self.column != self.nowhere && !passes(self.value) {
                self.value = pairwise(self.value, self.inwards, A::add);
                self.column -= self.outwards;
                missed += 1;
            }
        }
        missed
    }

    fn go_down(&mut self) {
        self.value = pairwise(self.value, self.down, A::add);
    }
}

/// Whether no value is negative. The bitwise OR is negative if any value is negative.
fn passes<A: Accumulator>([a, b]: [A; 2]) -> bool {
    a | b >= A::default()
}

fn pairwise<A: Copy>([a, b]: [A; 2], [c, d]: [A; 2], operation: impl Fn(A, A) -> A) -> [A; 2] {
    [operation(a, c), operation(b, d)]
}
