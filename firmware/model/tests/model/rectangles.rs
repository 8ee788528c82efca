//! Tests of rectangles of the screen, compared with integer arithmetic and f64.

use glint_core::appearance::Appearance;
use glint_core::camera::Projection;
use glint_core::colour::Rgb565;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, U4_28};
use glint_core::light::Background;
use glint_core::picture::{Edges, Samples, Size};
use glint_core::quality::Quality;
use glint_core::rectangle::{Part, Rectangle};
use glint_core::stereo::{Stereo, Tint};
use glint_core::texture::{Blend, Filter, Format, Sampler, Source, Texture, Wrap, encode};
use glint_model::triangle::rectangle::set_up;
use glint_model::{FieldSubject, Frame, MeshSubject, Subject};
use glint_vectors::{Camera, Picture, Random};

use crate::cube;

/// The depth code of an opaque rectangle.
const NEAREST: u32 = (1 << 18) - 1;

/// A texture with transparent texels, in which neighbouring texels differ.
fn texture(size_log2: [u8; 2], filter: Filter, blend: Blend) -> Vec<u8> {
    let [width, height] = size_log2.map(|side| 1 << side);
    let texels = (0..width * height).map(|i: u32| (37 * (i % width) + 2011 * (i / width)) as u16);
    encode(&Source {
        format: Format::Rgb565,
        size_log2,
        sampler: Sampler {
            wrap: [Wrap::Repeat; 2],
            filter,
        },
        key: Some(37 * 5),
        blend,
        levels: vec![texels.collect()],
        ..Source::default()
    })
    .unwrap()
}

/// A rectangle with a random part and position, possibly mirrored, `scale` times as large as the part.
fn random_rectangle<'a>(random: &mut Random, texture: Texture<'a>, scale: i64) -> Rectangle<'a> {
    let (mut part_place, mut part_size) = ([0; 2], [0; 2]);
    for axis in 0..2 {
        let side = 1 << texture.size_log2()[axis];
        part_size[axis] = random.integer(1, side.min(200)) as u16;
        part_place[axis] = random.integer(0, side - i64::from(part_size[axis])) as u16;
    }
    let part = Part {
        place: part_place,
        size: part_size,
    };
    let size = part_size.map(|side| side * scale as u16);
    let picture = [320, 180];
    let place = [0, 1]
        .map(|axis: usize| random.integer(-i64::from(size[axis]) - 2, picture[axis] + 2) as i16);
    Rectangle {
        size,
        is_mirrored: [(); 2].map(|()| random.coin()),
        ..Rectangle::new(texture, part, place)
    }
}

/// The texel that a pixel shows, for a rectangle enlarged by an integer factor; `None` outside of the rectangle.
fn texel(rectangle: &Rectangle, pixel: [usize; 2]) -> Option<[u32; 2]> {
    let mut found = [0; 2];
    for axis in 0..2 {
        let (part, size) = (rectangle.part.size[axis], rectangle.size[axis]);
        let inside = pixel[axis] as i32 - i32::from(rectangle.place[axis]);
        let inside = u16::try_from(inside).ok().filter(|&inside| inside < size)?;
        let inside = if rectangle.is_mirrored[axis] {
            size - 1 - inside
        } else {
            inside
        };
        found[axis] = u32::from(rectangle.part.place[axis] + inside / (size / part));
    }
    Some(found)
}

fn scene(subject: Subject<'_>) -> Frame<'_> {
    let camera = Camera::looking([1.3, -1.5, 0.9], [0.0; 3], 0.8, 0.1);
    Frame {
        clear: Rgb565(0x001F),
        ..Frame::new(subject, camera.rounded(), Size::W320)
    }
}

/// Checks that rectangles show the correct texels over a frame, and that all other pixels are unchanged. Returns the number of pixels
/// shown.
fn check(frame: &Frame, rectangles: &[Rectangle]) -> usize {
    let mut expected = Picture::of_frame(frame);
    let mut shown = 0;
    for rectangle in rectangles {
        for i in 0..expected.colour.len() {
            let Some(texel) = texel(rectangle, [i % 320, i / 320]) else {
                continue;
            };
            let Some(colour) = rectangle.texture.colour(0, texel) else {
                continue;
            };
            let pixel = &mut expected.colour[i];
            *pixel = rectangle.texture.blend().over(colour, Rgb565(*pixel)).0;
            if rectangle.texture.blend() == Blend::Opaque {
                expected.depth[i] = NEAREST;
            }
            shown += 1;
        }
    }
    let found = Picture::of_frame(&Frame {
        rectangles,
        ..*frame
    });
    for i in 0..expected.colour.len() {
        let pixel = |picture: &Picture| (picture.colour[i], picture.depth[i]);
        let place = [i % 320, i / 320];
        assert_eq!(
            pixel(&found),
            pixel(&expected),
            "{place:?}: {rectangles:#?}"
        );
    }
    shown
}

/// Each texel of a part covers exactly its pixel or its square of pixels, for any position, part, filter and blending, in front of a mesh
/// in each projection, and in front of other rectangles.
#[test]
fn each_texel_is_on_its_pixels() {
    let mut random = Random(5);
    let subject = Subject::mesh(cube());
    let mut shown = 0;
    for round in 0..120 {
        let size_log2 = [(); 2].map(|()| random.integer(3, 10) as u8);
        let scale = [1, 1, 2, 3, 16][round % 5];
        let filter = Filter::ALL[usize::from(scale == 1 && round % 2 == 0)];
        let blends = [Blend::Opaque, Blend::Opaque, Blend::ALL[3], Blend::Additive];
        let bytes = texture(size_log2, filter, blends[round % 4]);
        let texture = Texture::new_checked(&bytes).unwrap();
        let rectangles = [(); 3].map(|()| random_rectangle(&mut random, texture, scale));
        let frame = scene(subject);
        let view = frame.view.with_projection(Projection::ALL[round % 2]);
        shown += check(&Frame { view, ..frame }, &rectangles);
    }
    println!("{shown} pixels");
    assert!(shown > 500_000);
}

/// Positions are within 1/128 texel of the exact positions in rectangles of up to 2048 pixels, and within 1/27 texel in larger rectangles.
/// No pixel shows a texel beyond the part.
#[test]
fn positions_are_those_of_pixel_centres() {
    let mut random = Random(6);
    let (mut worst, mut pixels) = ([0.0_f64; 2], 0);
    for round in 0..30_000 {
        let size_log2 = [random.integer(3, 10) as u8, 3];
        let bytes = encode(&Source {
            size_log2,
            levels: vec![vec![]],
            ..Source::default()
        });
        let bytes = bytes.unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        let is_large = round % 2 == 1;
        let most = if is_large { 65_535 } else { 2048 };
        let magnitude = random.integer(0, 16);
        let width = random.integer(1, 1 << magnitude).min(most);
        let mut rectangle = random_rectangle(&mut random, texture, 1);
        rectangle.size = [width as u16, 8];
        rectangle.place = [random.integer((-width).max(-32_768), 1279) as i16, 0];
        let Some((setup, textured)) = set_up(&rectangle, Size::W1280.into(), Samples::One) else {
            continue;
        };
        let (first, last) = (setup.bounds.left, setup.bounds.right - 1);
        for column in [
            first,
            last,
            random.integer(first.into(), last.into()) as i32,
        ] {
            let [s, t] = textured.axes.map(|axis| axis.plane);
            let s = s
                .start
                .wrapping_add(s.step_x.wrapping_mul((column - first) as u32));
            let [found, _] = textured.places(0, [s, t.start]);
            let across = (f64::from(column - i32::from(rectangle.place[0])) + 0.5) / width as f64;
            let across = if rectangle.is_mirrored[0] {
                1.0 - across
            } else {
                across
            };
            let [from, size] = [rectangle.part.place[0], rectangle.part.size[0]].map(f64::from);
            let error = (from + across * size - found as f64 / 256.0).abs();
            worst[usize::from(is_large)] = worst[usize::from(is_large)].max(error);
            let texel = (found >> 8) as f64;
            assert!(
                from <= texel && texel < from + size,
                "{rectangle:?}: {texel}"
            );
            pixels += 1;
        }
    }
    println!("{pixels} pixels, largest error in texels {worst:.4?}");
    assert!(pixels > 50_000);
    assert!(worst[0] < 1.0 / 128.0 && worst[1] < 1.0 / 27.0, "{worst:?}");
}

/// A rectangle whose texels are smaller than pixels shows the mip level whose texels have the size of pixels.
#[test]
fn small_rectangles_show_smaller_levels() {
    let bytes = encode(&Source {
        size_log2: [6; 2],
        levels: (0..=6)
            .map(|level| vec![level << 11; 4096 >> (2 * level)])
            .collect(),
        ..Source::default()
    });
    let bytes = bytes.unwrap();
    let part = Part {
        place: [0; 2],
        size: [64; 2],
    };
    let whole = Rectangle::new(Texture::new_checked(&bytes).unwrap(), part, [3, 5]);
    for level in 0..=6 {
        let frame = Frame {
            rectangles: &[Rectangle {
                size: [64 >> level; 2],
                ..whole
            }],
            ..scene(Subject::Objects(&[]))
        };
        let picture = Picture::of_frame(&frame);
        for (&colour, &code) in picture.colour.iter().zip(&picture.depth) {
            assert_eq!(colour, if code == 0 { 0x001F } else { level << 11 });
        }
        assert_eq!(picture.covered(), 4096 >> (2 * level));
    }
}

/// A rectangle without pixels or texels, or with a part beyond the texture, is not drawn.
#[test]
fn invalid_rectangles_are_not_drawn() {
    let bytes = texture([3, 3], Filter::Nearest, Blend::Opaque);
    let texture = Texture::new_checked(&bytes).unwrap();
    let part = |place, size| Part { place, size };
    let whole = Rectangle::new(texture, part([0; 2], [8; 2]), [0; 2]);
    assert!(set_up(&whole, Size::W320.into(), Samples::One).is_some());
    for rectangle in [
        Rectangle {
            size: [0, 8],
            ..whole
        },
        Rectangle {
            part: part([0; 2], [0, 8]),
            ..whole
        },
        Rectangle {
            part: part([8, 0], [0, 8]),
            ..whole
        },
        Rectangle {
            part: part([1, 0], [8, 8]),
            ..whole
        },
        Rectangle {
            part: part([u16::MAX; 2], [u16::MAX; 2]),
            ..whole
        },
        Rectangle {
            place: [-8, 0],
            ..whole
        },
        Rectangle {
            place: [i16::MIN; 2],
            ..whole
        },
        Rectangle {
            place: [320, 0],
            ..whole
        },
        Rectangle {
            place: [0, 180],
            ..whole
        },
    ] {
        assert!(
            set_up(&rectangle, Size::W320.into(), Samples::One).is_none(),
            "{rectangle:?}"
        );
    }
}

/// White texels are shown in the colour of the rectangle.
#[test]
fn texels_are_multiplied_by_the_colour() {
    let bytes = encode(&Source {
        size_log2: [3; 2],
        levels: vec![vec![0xFFFF; 64]],
        ..Source::default()
    });
    let bytes = bytes.unwrap();
    let part = Part {
        place: [0; 2],
        size: [8; 2],
    };
    let whole = Rectangle::new(Texture::new_checked(&bytes).unwrap(), part, [0; 2]);
    for colour in (0..=u16::MAX).step_by(2113).map(Rgb565) {
        let frame = Frame {
            rectangles: &[Rectangle { colour, ..whole }],
            ..scene(Subject::Objects(&[]))
        };
        assert_eq!(Picture::of_frame(&frame).colour[0], colour.0);
    }
}

/// Rectangles are in front of fields, meshes in fields, and skies, and have no fog.
#[test]
fn rectangles_are_in_front_of_everything() {
    let appearance = Appearance {
        fog: U4_28::from_num(0.5),
        ..Appearance::default()
    };
    let field = FieldSubject {
        field: &Field::parse("menger:1").unwrap(),
        appearance: &appearance,
        quality: Quality::default(),
    };
    let mesh = MeshSubject::new(cube());
    let foggy = Frame {
        sky: Background::Sky.gradient(),
        fog: U4_28::from_num(2.0),
        ..scene(Subject::Mesh(mesh))
    };
    let frames = [
        scene(Subject::Field(field)),
        scene(Subject::MeshInField(mesh, field)),
        foggy,
        scene(Subject::Objects(&[])),
    ];
    let mut random = Random(7);
    for (frame, blend) in frames.iter().zip([3, 0, 8, 0]) {
        let bytes = texture([5, 6], Filter::Nearest, Blend::ALL[blend]);
        let texture = Texture::new_checked(&bytes).unwrap();
        let rectangles = [(); 4].map(|()| random_rectangle(&mut random, texture, 2));
        assert!(check(frame, &rectangles) > 1000);
    }
}

/// Both eyes of a stereo picture show the rectangles at the same position, also in front of a field.
#[test]
fn both_eyes_have_the_rectangles() {
    let bytes = texture([5, 6], Filter::Nearest, Blend::Opaque);
    let texture = Texture::new_checked(&bytes).unwrap();
    let mut random = Random(8);
    let rectangles = [(); 4].map(|()| random_rectangle(&mut random, texture, 2));
    let field = FieldSubject {
        field: &Field::parse("sphere:1").unwrap(),
        appearance: &Appearance::default(),
        quality: Quality::default(),
    };
    for subject in [Subject::mesh(cube()), Subject::Field(field)] {
        let frame = Frame {
            stereo: Some(Stereo {
                half_separation: Q32_32::lit("0.03"),
                zero_parallax: Q32_32::lit("1.5"),
                tint: Tint::RedCyan,
            }),
            rectangles: &rectangles,
            ..scene(subject)
        };
        assert!(frame.constants().is_err());
        let eyes = frame.eyes().unwrap().unwrap();
        for eye in [eyes.left, eyes.right] {
            assert_eq!(eye.rectangles, rectangles);
            let without = Frame {
                rectangles: &[],
                ..eye
            };
            assert!(check(&without, &rectangles) > 1000);
        }
    }
}

/// Rectangles are blended with the edges of a mesh behind them.
#[test]
fn edges_are_drawn_before_rectangles() {
    let bytes = texture([5, 6], Filter::Nearest, Blend::ALL[4]);
    let rectangle = Rectangle::new(
        Texture::new_checked(&bytes).unwrap(),
        Part {
            place: [0; 2],
            size: [32, 64],
        },
        [130, 60],
    );
    let draw = |rectangles: &[Rectangle]| {
        Picture::of_frame(&Frame {
            rectangles,
            ..scene(Subject::edges(MeshSubject::new(cube()), Edges::Hidden))
        })
    };
    let (behind, found) = (draw(&[]), draw(&[rectangle]));
    let mut edges = 0;
    for i in 0..behind.colour.len() {
        let texel = texel(&rectangle, [i % 320, i / 320]);
        let colour = texel.and_then(|texel| rectangle.texture.colour(0, texel));
        let colour = colour.map_or(behind.colour[i], |colour| {
            edges += usize::from(behind.colour[i] != 0);
            Blend::ALL[4].over(colour, Rgb565(behind.colour[i])).0
        });
        assert_eq!(found.colour[i], colour);
    }
    assert!(edges > 30, "{edges}");
}
