//! Each quality sets a size and a precision, on the model and on a board.

use crate::common::{console, drawn_alike, emulator, info, renderer};
use glint::render::{self, FieldSubject, Frame, Subject};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::colour::Rounding;
use glint_core::field::Field;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_model::FrameBuffer;
use glint_model::raymarch::{FieldOptions, FieldSetup, Tuning, render_field};

/// The size of each quality, and the threshold and the footprint of its marching rays.
const STATED: [(Quality, Size, [u32; 2]); 3] = [
    (Quality::Fast, Size::W320, [28, 14]),
    (Quality::Balanced, Size::W640, [4, 15]),
    (Quality::Exact, Size::W1280, [2, 15]),
];

/// A field whose rays step from cell exit to cell exit and have no threshold, and a field whose
/// rays march.
const FIELDS: [&str; 2] = ["menger:3", "smooth:0.3,box:1,1,0.2+sphere:0.7"];

fn frame<'a>(field: &'a Field, appearance: &'a Appearance, quality: Quality) -> Frame<'a> {
    let subject = Subject::Field(FieldSubject {
        field,
        appearance,
        quality,
    });
    let view = view::spherical("3,25,70").unwrap();
    Frame::new(subject, view, quality.size())
}

#[test]
fn a_quality_is_a_size_and_a_threshold() {
    let appearance = Appearance::default();
    for (quality, size, [threshold, footprint]) in STATED {
        for text in FIELDS {
            let field = Field::parse(text).unwrap();
            let frame = frame(&field, &appearance, quality);
            let found = render::on_model(&frame).unwrap();
            let tuning = Tuning {
                threshold,
                footprint,
                ..Tuning::default()
            };
            let options = FieldOptions {
                tuning,
                ..FieldOptions::of(&field)
            };
            let setup =
                FieldSetup::new(&field, &frame.view, size.pixels().into(), &options).unwrap();
            let (mut colour, mut depth) =
                (vec![0; size.pixel_count()], vec![0; size.pixel_count()]);
            let mut target = FrameBuffer {
                width: size.width(),
                height: size.height(),
                colour: &mut colour,
                depth: &mut depth,
                rounding: Rounding::Dithered,
            };
            let stats = render_field(&setup, &options.palette, &mut target, &mut |_, _, _| {});
            let evaluations = stats.unwrap().evaluations;
            assert_eq!(found.stats.rays.unwrap().evaluations, evaluations, "{text}");
            assert!(found.image.colour == colour, "{quality}, {text}");
        }
    }
}

#[test]
fn a_board_has_the_qualities_of_the_model() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let appearance = Appearance::default();
    let mut evaluations = Vec::new();
    for quality in Quality::ALL {
        for text in FIELDS {
            let field = Field::parse(text).unwrap();
            // Each quality with its own size, and with another size.
            let own = frame(&field, &appearance, quality);
            let small = Frame {
                size: Size::W320,
                ..own
            };
            let own = (text == FIELDS[0]).then_some(own);
            for frame in own.iter().chain([&small]) {
                let drawn = drawn_alike(&mut renderer, frame, &format!("{quality}, {text}"));
                let [found, expected] =
                    drawn.map(|rendered| rendered.stats.rays.unwrap().evaluations);
                assert_eq!(found, expected, "{quality}, {text}");
                evaluations.push(found);
            }
        }
    }
    // If rays march, a higher quality takes more evaluations for a picture of the same size.
    let [fast, balanced, exact] = [1, 4, 7].map(|place| evaluations[place]);
    assert!(fast == balanced && balanced == exact, "{evaluations:?}");
    let [fast, balanced, exact] = [2, 5, 8].map(|place| evaluations[place]);
    assert!(fast < balanced && balanced < exact, "{evaluations:?}");
}

#[test]
fn a_later_size_replaces_that_of_the_quality() {
    let mut board = emulator();
    let mut console = console(&mut board);
    let mut state = |lines: &[&str]| {
        for line in lines {
            console.command(line).unwrap();
        }
        let quality = console.command("quality").unwrap();
        (quality.concat(), info::<u32>(&mut console, "size"))
    };
    let is = |name: &str, width| (format!("quality {name}"), width);
    assert_eq!(state(&[]), is("balanced", 1280));
    for (quality, size, ..) in STATED {
        let line = format!("quality {quality}");
        assert_eq!(state(&[&line]), is(quality.name(), size.width()));
        assert_eq!(state(&["size 320 180"]), is(quality.name(), 320));
    }
    assert_eq!(state(&["scene cubes"]), is("balanced", 640));
    assert_eq!(state(&["scene default"]), is("balanced", 1280));
}
