//! Rectangles of the screen in front of frames of meshes with textures.

use glint_core::colour::{Rgb565, Rounding};
use glint_core::field::Field;
use glint_core::font::Font;
use glint_core::picture::{Samples, Size, Window};
use glint_core::quality::Quality;
use glint_core::rectangle::{Part, Rectangle};
use glint_core::texture::{Blend, Filter, Sampler, Source, Texture, encode};
use glint_model::triangle::descriptor::Descriptor;
use glint_model::triangle::raster;
use glint_model::triangle::rectangle::set_up;
use glint_model::triangle::setup::Bounds;
use glint_model::{FieldSubject, FrameBuffer};
use glint_vectors::meshes::textured_layers;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{Expected, gradient};
use super::fields::send_bands;
use super::textured::{BEFORE, Kinds, Shown, texture};

/// A rectangle, and the number of its texture among the textures of the frame.
type Numbered<'a> = (Rectangle<'a>, usize);

/// Draws rectangles over a frame, and returns their descriptors.
fn draw_over(expected: &mut Expected, rectangles: &[Numbered]) -> Vec<(Descriptor, Bounds)> {
    let (width, height) = expected.size;
    let window = Window::whole(Size::of(width, height).unwrap());
    let mut target = FrameBuffer {
        width,
        height,
        colour: &mut expected.colour,
        depth: &mut expected.depth,
        rounding: expected.rounding,
    };
    let placed = rectangles.iter().filter_map(|(rectangle, number)| {
        let (setup, textured) = set_up(rectangle, window, Samples::One)?;
        raster::draw_textured(&setup, &textured, &mut target);
        let texture = textured.numbered(BEFORE + 1 + *number as u8);
        let descriptor = Descriptor::new(&setup, Rgb565::default(), Some(&texture));
        Some((descriptor, setup.bounds))
    });
    placed.collect()
}

/// Random rectangles in a picture 320 pixels wide: some of them unscaled, with one texel per pixel.
fn some_rectangles<'a>(random: &mut Pcg64Mcg, textures: &'a [Vec<u8>]) -> Vec<Numbered<'a>> {
    let count = random.random_range(1..12);
    let rectangles = (0..count).map(|_| {
        let number = random.random_range(0..textures.len());
        let texture = Texture::new_checked(&textures[number]).unwrap();
        let sides = texture.size_log2().map(|side| 1 << side);
        let size = sides.map(|side| random.random_range(1..=side));
        let place = [0, 1].map(|axis: usize| random.random_range(0..=sides[axis] - size[axis]));
        let at = [random.random_range(-60..320), random.random_range(-60..180)];
        let mut rectangle = Rectangle::new(texture, Part { place, size }, at);
        rectangle.is_mirrored = random.random();
        if random.random() {
            rectangle.size = [(); 2].map(|()| random.random_range(1..200));
        }
        if random.random() {
            rectangle.colour = Rgb565(random.random());
        }
        (rectangle, number)
    });
    rectangles.collect()
}

/// Rectangles are drawn in front of meshes, also in orthographic projection, in fields, and before skies.
#[test]
fn frames_with_rectangles() {
    let (mut drawn, mut kinds) = (0, Kinds::default());
    for seed in 0..6 {
        let mut random = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        let mut bench = Bench::of("texture_fields", seed, [0.0, 0.3, 0.7][seed as usize % 3]);
        bench.set("field_source.enable", 0);
        for count in 0..4 {
            let sources = [(); 3].map(|()| kinds.add(texture(&mut random)));
            let is_blended = sources.iter().any(|source| source.blend != Blend::Opaque);
            let textures = sources.map(|source| encode(&source).unwrap());
            let mesh = textured_layers(&textures, 1.0, 0.3);
            let eye = [0.4, random.random_range(-4.0..-1.0), 1.0];
            let sky = (count == 1).then(|| gradient(&mut random));
            let rounding = Rounding::new(random.random());
            let mut shown = if count == 0 {
                Shown::orthographic(mesh, eye, rounding)
            } else {
                Shown::before(mesh, eye, None, sky, 0.0, rounding)
            };
            let rectangles = some_rectangles(&mut random, &textures);
            let over = draw_over(&mut shown.expected, &rectangles);
            drawn += over.len();
            let clipped = [shown.clipped, over].concat();
            bench.set("raster_flags.sky_first", u64::from(is_blended));
            let name = format!("frame {count} of seed {seed}");
            bench.draw_textured(&name, &shown.expected, &shown.mesh, &clipped);
        }
    }
    println!("{drawn} rectangles");
    assert!(drawn > 75);
    kinds.assert_complete();
}

#[test]
fn rectangles_in_front_of_a_field() {
    let mut random = Pcg64Mcg::new(5);
    let mut bench = Bench::of("texture_fields", 5, 0.3);
    let textures = [(); 3].map(|()| encode(&texture(&mut random)).unwrap());
    let field = FieldSubject {
        field: &Field::parse("menger:2").unwrap(),
        appearance: &Default::default(),
        quality: Quality::default(),
    };
    let mesh = textured_layers(&textures, 1.0, 0.3);
    let mut shown = Shown::before(
        mesh,
        [0.4, -3.5, 2.0],
        Some(&field),
        None,
        0.0,
        Rounding::Nearest,
    );
    let rectangles = some_rectangles(&mut random, &textures);
    let over = draw_over(&mut shown.expected, &rectangles);
    let triangles = [shown.whole, shown.clipped, over].concat();
    bench.set("field_source.enable", 1);
    bench.set("field_source.compose", 0);
    bench.start_set(&shown.expected, &triangles, &textures);
    send_bands(&mut bench, &mut random, false, &mut shown.bands);
    bench.finish("rectangles in front of a field", &shown.expected);
}

/// Bounds the clocks that text and pictures add to an empty frame of 1280x720.
#[test]
fn rectangles_are_drawn_fast() {
    let mut memory = vec![0; Font::BYTES];
    let font = Font::draw(&mut memory).unwrap();
    let picture = |filter, blend| {
        let source = Source {
            size_log2: [7; 2],
            sampler: Sampler {
                filter,
                ..Sampler::default()
            },
            blend,
            levels: vec![(0..1 << 14).map(|i: u16| i.wrapping_mul(40_503)).collect()],
            ..Source::default()
        };
        encode(&source).unwrap()
    };
    let pictures = [
        picture(Filter::Nearest, Blend::Opaque),
        picture(Filter::Bilinear, Blend::Opaque),
        picture(Filter::Nearest, Blend::ALL[4]),
    ];
    let text: String = ('!'..='~').cycle().take(100).collect();
    let lines = |scale: u8| {
        let lines = (0..6).flat_map(|line| {
            let place = [5, 20 + i16::from(scale) * 12 * line];
            font.line(&text, place, scale, Rgb565::WHITE)
        });
        lines.collect::<Vec<_>>()
    };
    let whole = |bytes, side: u16| {
        let part = Part {
            place: [0; 2],
            size: [128; 2],
        };
        let texture = Texture::new_checked(bytes).unwrap();
        vec![Rectangle {
            size: [side; 2],
            ..Rectangle::new(texture, part, [101, 53])
        }]
    };
    let mut bench = Bench::of("texture", 9, 0.0);
    bench.with_depth = false;
    let textures = [&[font.texture().bytes().to_vec()][..], &pictures].concat();
    // Draws rectangles, and returns the mean number of clocks for each of them.
    let mut cost = |name: &str, number: usize, rectangles: Vec<Rectangle>| {
        let rectangles: Vec<_> = rectangles.into_iter().map(|each| (each, number)).collect();
        let [clear, all] = [&[], &rectangles[..]].map(|shown| {
            let mut expected = Expected::clear(Size::W1280.pixels().into());
            let over = draw_over(&mut expected, shown);
            // The second of two equal frames writes only what differs from the clear colour.
            bench.draw_set(name, &expected, &over, &textures);
            bench.draw_set(name, &expected, &over, &textures)
        });
        let (count, [width, height]) = (rectangles.len() as u64, rectangles[0].0.size);
        let clocks = (all - clear) / count;
        println!("{name}: {clocks} clocks for each of {count} rectangles of {width}x{height}");
        clocks
    };
    let text = [1, 2].map(|scale| cost("text", 0, lines(scale)));
    assert!(text[0] < 30 && text[1] < 90, "{text:?}");
    for (name, number, [small, large]) in [
        ("nearest", 1, [7_700, 73_000]),
        ("bilinear", 2, [11_900, 139_000]),
        ("blended", 3, [35_000, 535_000]),
    ] {
        for (side, most) in [(128, small), (512, large)] {
            let clocks = cost(name, number, whole(&pictures[number - 1], side));
            assert!(clocks < most, "{name}: {clocks}");
        }
    }
}
