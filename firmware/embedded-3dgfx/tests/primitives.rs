//! Each kind of primitive, drawn by the model.

use embedded_3dgfx::pipeline::assemble::primitive::DrawPrimitive;
use embedded_3dgfx::pipeline::command_buffer::{CommandBuffer, RenderCommand};
use embedded_graphics::pixelcolor::{Rgb565, RgbColor};
use glint_embedded_3dgfx::Outcome;
use glint_program::core::light::Background;
use glint_program::core::picture::{Samples, Size};
use glint_program::core::texture::Blend;
use glint_program::host::Host;
use glint_program::triangles::{Triangle, Triangles};
use glint_program::{Board, Picture, PictureError, Program};
use std::cell::RefCell;

const SIZE: Size = Size::W320;
const GREY: [u16; 2] = [0x8410, 0x4208];

thread_local! {
    /// The primitives that [`Drawing`] shows.
    static PRIMITIVES: RefCell<Vec<DrawPrimitive>> = const { RefCell::new(Vec::new()) };
}

struct Drawing(Triangles<3>);

impl Program for Drawing {
    fn start(_: &mut Board) -> Self {
        let mut commands = CommandBuffer::<64>::new();
        for primitive in PRIMITIVES.take() {
            commands.push(RenderCommand::Draw(primitive)).unwrap();
        }
        let mut list = Triangles::new();
        let outcome = glint_embedded_3dgfx::convert(&commands, &mut list, SIZE);
        assert_eq!(outcome, Outcome::default());
        Self(list)
    }

    fn update(&mut self, _: &mut Board) {}

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.appearance.background = Some(Background::Colour([0; 3]));
        picture.samples = Samples::One;
        picture.triangles(&self.0)?;
        Ok(())
    }
}

/// The pixels of the primitives.
fn drawn(primitives: impl Into<Vec<DrawPrimitive>>) -> impl Fn(usize, usize) -> u16 {
    PRIMITIVES.set(primitives.into());
    let mut host = Host::<Drawing>::start();
    host.run(1).unwrap();
    let pixels = host.picture().to_vec();
    move |x, y| pixels[320 * y + x]
}

/// A triangle with its right angle at (10, 10) and sides of 80 pixels.
fn points() -> [nalgebra::Point2<i32>; 3] {
    [[10, 10], [90, 10], [10, 90]].map(Into::into)
}

fn with_depth(depth: f32, color: Rgb565) -> DrawPrimitive {
    DrawPrimitive::ColoredTriangleWithDepth {
        points: points(),
        depths: [depth; 3],
        color,
    }
}

#[test]
fn the_nearest_triangle_is_visible_and_the_later_one_of_equal_depth() {
    let [red, green] = [Rgb565::RED, Rgb565::GREEN];
    for (first, second, expected) in [(3.0, 5.0, red), (5.0, 3.0, green), (3.0, 3.0, green)] {
        let at = drawn([with_depth(first, red), with_depth(second, green)]);
        assert_eq!(at(30, 30), u16::from_be_bytes(bytes(expected)));
        assert_eq!([at(9, 30), at(80, 80)], [0; 2]);
    }
}

#[test]
fn depths_of_a_fraction_and_of_thousands_differ() {
    for (near, far) in [(0.25, 0.5), (4_000.0, 4_001.0), (60_000.0, 60_001.0)] {
        let at = drawn([
            with_depth(near, Rgb565::RED),
            with_depth(far, Rgb565::GREEN),
        ]);
        assert_eq!(at(30, 30), 0xf800, "{near} before {far}");
    }
}

#[test]
fn an_infinite_depth_is_farthest_and_leaves_the_others_apart() {
    let behind = with_depth(f32::INFINITY, Rgb565::BLUE);
    let at = drawn([
        with_depth(0.25, Rgb565::RED),
        with_depth(0.5, Rgb565::GREEN),
        behind,
    ]);
    assert_eq!(at(30, 30), 0xf800);
}

#[test]
fn a_list_is_used_again_for_fewer_and_other_triangles() {
    let mut list = Triangles::<3>::new();
    let triangle = |blend| Triangle {
        corners: [[40, 40], [360, 40], [40, 360]],
        depths: [0; 3],
        colours: [glint_program::core::colour::Rgb565::WHITE; 3],
        blend,
    };
    let [opaque, half] = [Blend::Opaque, Blend::ALL[4]].map(triangle);
    // Textures behind the first chunk, then a second chunk in their place.
    for triangles in [
        vec![half; 20],
        vec![opaque; 33],
        vec![half; 1],
        vec![opaque; 64],
        vec![],
    ] {
        let (count, is_empty) = (triangles.len(), triangles.is_empty());
        assert_eq!(list.set(SIZE, triangles), 0);
        LIST.set(Some(list));
        let mut host = Host::<Listed>::start();
        host.run(1)
            .unwrap_or_else(|error| panic!("{count} triangles: {error}"));
        assert_eq!(
            host.picture()[30 * 320 + 30] == 0,
            is_empty,
            "{count} triangles"
        );
        drop(host);
        list = LIST.take().unwrap();
    }
}

thread_local! {
    /// The list that [`Listed`] shows.
    static LIST: std::cell::Cell<Option<Triangles<3>>> = const { std::cell::Cell::new(None) };
}

/// Shows a list, and returns it at the end.
struct Listed(Option<Triangles<3>>);

impl Program for Listed {
    fn start(_: &mut Board) -> Self {
        Self(LIST.take())
    }

    fn update(&mut self, _: &mut Board) {}

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.appearance.background = Some(Background::Colour([0; 3]));
        if let Some(list) = &self.0 {
            picture.triangles(list)?;
        }
        Ok(())
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        LIST.set(self.0.take());
    }
}

#[test]
fn primitives_without_depth_are_behind_before_the_first_depth_and_in_front_after_it() {
    let flat = |color| DrawPrimitive::ColoredTriangle(points(), color);
    let at = drawn([flat(Rgb565::BLUE), with_depth(3.0, Rgb565::RED)]);
    assert_eq!(at(30, 30), 0xf800);
    let at = drawn([
        with_depth(0.0, Rgb565::RED),
        flat(Rgb565::BLUE),
        flat(Rgb565::GREEN),
    ]);
    assert_eq!(at(30, 30), 0x07e0);
}

#[test]
fn translucent_triangles_are_blended_by_eighths() {
    let glass = |alpha| DrawPrimitive::TranslucentTriangleWithDepth {
        points: points(),
        depths: [1.0; 3],
        color: Rgb565::WHITE,
        alpha,
    };
    for (alpha, expected) in [
        (0, 0),
        (15, 0),
        (128, GREY[0]),
        (64, GREY[1]),
        (255, 0xffff),
    ] {
        assert_eq!(drawn([glass(alpha)])(30, 30), expected, "{alpha}");
    }
    // A triangle blends with what has been recorded before it.
    let at = drawn([with_depth(2.0, Rgb565::BLACK), glass(128)]);
    assert_eq!(at(30, 30), GREY[0]);
}

#[test]
fn points_and_lines_are_one_pixel_wide() {
    let at = drawn([
        DrawPrimitive::ColoredPoint([100, 50].into(), Rgb565::WHITE),
        DrawPrimitive::Line([[20, 20].into(), [60, 20].into()], Rgb565::RED),
        DrawPrimitive::Line([[200, 90].into(), [200, 30].into()], Rgb565::GREEN),
        DrawPrimitive::Line([[20, 100].into(), [60, 140].into()], Rgb565::BLUE),
    ]);
    let lit = |xs: std::ops::Range<usize>, ys: std::ops::Range<usize>| {
        let places = ys.flat_map(|y| xs.clone().map(move |x| (x, y)));
        places.filter(|&(x, y)| at(x, y) != 0).collect::<Vec<_>>()
    };
    assert_eq!(lit(90..110, 40..60), [(100, 50)]);
    assert!(lit(0..80, 0..40).into_iter().eq((20..=60).map(|x| (x, 20))));
    assert!(
        lit(190..210, 0..110)
            .into_iter()
            .eq((30..=90).map(|y| (200, y)))
    );
    assert!(
        lit(0..80, 90..150)
            .into_iter()
            .eq((0..=40).map(|i| (20 + i, 100 + i)))
    );
}

#[test]
fn a_gouraud_triangle_has_its_mean_colour() {
    let at = drawn([DrawPrimitive::GouraudTriangleWithDepth {
        points: points(),
        depths: [1.0; 3],
        colors: [Rgb565::RED, Rgb565::GREEN, Rgb565::BLUE],
    }]);
    assert_eq!(at(30, 30), 10 << 11 | 21 << 5 | 10);
}

#[test]
fn coordinates_far_outside_of_the_picture_saturate() {
    let far = i32::MAX;
    let points = [[0, -far], [far, far], [-far, far]].map(Into::into);
    let at = drawn([DrawPrimitive::ColoredTriangle(points, Rgb565::RED)]);
    assert_eq!([at(160, 90), at(0, 179), at(319, 179)], [0xf800; 3]);
}

/// The bytes of a colour, the most significant one first.
fn bytes(colour: Rgb565) -> [u8; 2] {
    use embedded_graphics::pixelcolor::raw::ToBytes;
    colour.to_be_bytes()
}
