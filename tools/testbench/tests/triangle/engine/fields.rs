//! Tests of frames with a field, above all of the triangle engine's build without triangles, which draws only a raymarcher's pixels. The
//! model replaces the raymarcher, and sends the pixels of each band in a random order.

use glint_core::appearance::Appearance;
use glint_core::colour::Rounding;
use glint_core::field::Field;
use glint_core::fixed::Q32_32;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};
use glint_model::triangle::descriptor::band_rows;
use glint_model::{FieldConstants, FieldSubject, Frame, Subject};
use glint_testbench::raymarch::{Pixel, RayPlace, pixel};
use glint_vectors::{Camera, Picture as Drawn};
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{Expected, picture};

/// The picture of a field, and the pixels of each band.
struct Picture {
    expected: Expected,
    /// Value of `compose`: the conversion of two eyes' luminances to colours.
    compose: u64,
    bands: Vec<Vec<Pixel>>,
}

impl Picture {
    fn new(text: &str, size: Size, tint: Option<Tint>) -> Self {
        let subject = FieldSubject {
            field: &Field::parse(text).unwrap(),
            appearance: &Appearance::default(),
            quality: Quality::default(),
        };
        let view = Camera::looking([2.2, 1.7, 1.3], [0.0; 3], 0.9, 0.1).rounded();
        let frame = Frame {
            stereo: tint.map(|tint| Stereo {
                half_separation: Q32_32::lit("0.03"),
                zero_parallax: Q32_32::lit("1.5"),
                tint,
            }),
            ..Frame::new(Subject::Field(subject), view, size)
        };
        let image = Drawn::of_frame(&frame);
        let constants = frame.constants().unwrap();
        let field = constants.field().unwrap();
        let eyes = if tint.is_some() { 2 } else { 1 };
        let bands = bands(field, frame.rounding, eyes);
        Self {
            expected: picture(
                (field.setup.width, field.setup.height),
                &view,
                image.colour,
                image.depth,
            ),
            compose: tint.map_or(0, |tint| 1 + tint as u64),
            bands,
        }
    }
}

/// The pixels of each band of a field, for one eye or two.
pub fn bands(field: &FieldConstants, rounding: Rounding, eyes: usize) -> Vec<Vec<Pixel>> {
    let setup = &field.setup;
    let tracer = setup.tracer();
    let lines = band_rows(setup.width);
    let mut bands = vec![vec![]; (setup.height / lines) as usize];
    for (y, x) in (0..setup.height).flat_map(|y| (0..setup.width).map(move |x| (y, x))) {
        for eye in 0..eyes {
            let place = RayPlace {
                odd: y / lines % 2 == 1,
                line: y % lines,
                column: x,
                eye,
            };
            let end = tracer.trace(eye, x, y);
            let pixel = pixel(setup, &field.palette, rounding, place, y, &end);
            bands[(y / lines) as usize].push(pixel);
        }
    }
    bands
}

fn start(bench: &mut Bench, picture: &Picture) {
    bench.configure(&[], &picture.expected);
    bench.set("field_source.enable", 1);
    bench.set("field_source.compose", picture.compose);
    bench.wait_for("status.ready");
    bench.pulse("raster_start");
}

/// Sends pixels, each in the first clock in which the engine is ready, with occasional pauses.
fn send(bench: &mut Bench, random: &mut Pcg64Mcg, eyes: bool, pixels: &[Pixel]) {
    let member = |name: &str| format!("field_source.{name}");
    for pixel in pixels {
        if random.random_ratio(1, 50) {
            (0..random.random_range(0..30)).for_each(|_| bench.clock());
        }
        let halves = if eyes { 1 << pixel.eye } else { 3 };
        for (name, value) in [
            ("valid", 1),
            ("halves", halves),
            ("row", pixel.row),
            ("line", pixel.line),
            ("column", pixel.column),
            ("mask", pixel.mask),
            ("code", pixel.code),
            ("colour", pixel.colour),
        ] {
            bench.set(&member(name), value);
        }
        bench.module.settle();
        bench.wait_for("field_sink.ready");
        bench.clock();
        bench.set(&member("valid"), 0);
    }
}

/// Draws a picture and compares it with the model's.
fn draw(bench: &mut Bench, random: &mut Pcg64Mcg, name: &str, picture: &mut Picture) {
    start(bench, picture);
    send_bands(bench, random, picture.compose > 0, &mut picture.bands);
    bench.finish(name, &picture.expected);
}

/// Sends the pixels of all bands of a frame.
pub fn send_bands(bench: &mut Bench, random: &mut Pcg64Mcg, eyes: bool, bands: &mut [Vec<Pixel>]) {
    for pixels in bands {
        bench.wait_for("field_sink.open");
        pixels.shuffle(random);
        send(bench, random, eyes, pixels);
        bench.set("field_source.done", 1);
        bench.wait_for("field_sink.next");
        bench.clock();
        bench.set("field_source.done", 0);
    }
}

#[test]
fn fields_are_drawn_without_triangles() {
    let mut random = Pcg64Mcg::new(3);
    let mut pictures = [
        ("one eye", "menger:2", None),
        ("red and blue", "box:1,0.5,0.25", Some(Tint::RedBlue)),
        ("red and cyan", "sphere:1", Some(Tint::RedCyan)),
    ]
    .map(|(name, text, tint)| (name, Picture::new(text, Size::W320, tint)));
    for (seed, stalls) in [(1, 0.0), (2, 0.4)] {
        let mut bench = Bench::of("fields_alone", seed, stalls);
        for (name, picture) in &mut pictures {
            bench.slot = random.random_range(0..2);
            bench.with_depth = random.random();
            draw(&mut bench, &mut random, name, picture);
        }
        let read = bench.reads.each_ref().map(|port| port.given);
        assert_eq!(read, [0; 4], "words read");
    }
    // Without the depth buffer the colours are unchanged, and depths are written as 0.
    let mut bench = Bench::of("no_depths", 3, 0.4);
    for (name, picture) in &mut pictures {
        picture.expected.depth.fill(0);
        for with_depth in [false, true] {
            bench.with_depth = with_depth;
            draw(&mut bench, &mut random, name, picture);
        }
    }
}

/// Without a field the picture has the clear colour, even after a field that was cancelled.
#[test]
fn pictures_without_a_field_are_clear() {
    let mut random = Pcg64Mcg::new(4);
    let mut bench = Bench::of("fields_alone", 3, 0.2);
    let mut field = Picture::new("menger:1", Size::W320, None);
    let clear = Expected::clear(field.expected.size);
    for sent in [1, 500, 10_000] {
        start(&mut bench, &field);
        bench.wait_for("field_sink.open");
        send(&mut bench, &mut random, false, &field.bands[0][..sent]);
        bench.pulse("cancel");
        assert_eq!(bench.read("status.raster_busy"), 0, "after {sent} pixels");

        bench.configure(&[], &clear);
        bench.set("field_source.enable", 0);
        bench.wait_for("status.ready");
        bench.pulse("raster_start");
        bench.finish(&format!("clear after {sent} pixels"), &clear);
        draw(&mut bench, &mut random, "a field", &mut field);
    }
}
