//! Tests of pictures of wireframe programs.

use glint_core::camera::View;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::picture::Size;
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{Key, Motion, Program};
use glint_model::wireframe::LINE_COLOUR;
use glint_model::{Frame, FrameStats, Subject, WireframeStats, WireframeSubject};
use glint_vectors::Picture;

/// The window ±2 × ±1.125 at z = 2, seen from z = 4: 160 pixels per world unit at the view plane of a picture 640 pixels wide.
const HEAD: &str = "eye 0 0 4\nplane 2\nwindow -2 -1.125 2 1.125\n";

fn draw(segments: &str, size: Size, keys: &[Key]) -> (Picture, WireframeStats) {
    let bytes = assemble(&format!("{HEAD}{segments}end\n")).unwrap();
    let mut motion = Motion::default();
    for key in keys {
        assert!(motion.apply(key.step(false)));
    }
    let subject = Subject::Wireframe(WireframeSubject {
        program: Program::new_checked(&bytes).unwrap(),
        pose: motion.pose(),
    });
    let view = View::spherical(Q32_32::lit("3"), Turns(0), Turns::QUARTER).unwrap();
    let frame = Frame::new(subject, view, size);
    let [width, height] = size.pixels();
    let mut picture = Picture::blank((width, height));
    let mut calls = 0;
    let constants = frame.constants().unwrap();
    let stats = frame.draw(&constants, &mut picture.target(), &mut [], &mut || {
        calls += 1;
    });
    let FrameStats {
        mesh: None,
        field: None,
        wireframe: Some(stats),
        edges: None,
    } = stats.unwrap()
    else {
        panic!("expected only the counts of a wireframe");
    };
    assert_eq!(calls, stats.segments.div_ceil(16));
    (picture, stats)
}

/// Column and row of each drawn pixel.
fn pixels(picture: &Picture, width: usize) -> Vec<[usize; 2]> {
    let drawn = picture.colour.iter().enumerate();
    drawn
        .filter(|&(_, &colour)| colour != 0)
        .map(|(at, &colour)| {
            assert_eq!(colour, LINE_COLOUR.0);
            [at % width, at / width]
        })
        .collect()
}

#[test]
fn a_horizontal_and_a_vertical_segment() {
    let (picture, stats) = draw("segment -1 0.5 2 1 0.5 2\n", Size::W640, &[]);
    // The segment is on the border between rows 99 and 100; the diamond-exit rule selects the upper row.
    let row: Vec<_> = (160..480).map(|x| [x, 99]).collect();
    assert_eq!(pixels(&picture, 640), row);
    assert_eq!((stats.segments, stats.lines, stats.pixels), (1, 1, 320));
    let (picture, _) = draw("segment 0.25 -1.125 2 0.25 1.125 2\n", Size::W640, &[]);
    assert_eq!(pixels(&picture, 640).len(), 360);
}

#[test]
fn keys_move_the_picture() {
    let segment = "segment -1 0.5 2 1 0.5 2\n";
    let shifted = |keys: &[Key]| {
        let found = pixels(&draw(segment, Size::W640, keys).0, 640);
        found.first().copied().unwrap()
    };
    let [x, y] = shifted(&[]);
    // A pan of 0.0625 is 10 pixels for a segment in the view plane.
    assert_eq!(shifted(&[Key::Up]), [x, y - 10]);
    assert_eq!(shifted(&[Key::Right, Key::Right]), [x + 20, y]);
    // A segment that a zoom moves in front of the view plane disappears.
    let (picture, stats) = draw(segment, Size::W640, &[Key::ZoomIn]);
    assert!(pixels(&picture, 640).is_empty());
    assert_eq!((stats.segments, stats.lines, stats.pixels), (1, 0, 0));
}

#[test]
fn the_order_of_segments_does_not_matter() {
    let [a, b] = ["segment -1 0.3 0 1 -0.7 1\n", "segment 0 1 0 0.5 -1 2\n"];
    let [one, other] = [[a, b], [b, a]].map(|both| draw(&both.concat(), Size::W1280, &[]).0);
    assert!(one.colour == other.colour && one.depth == other.depth);
}
