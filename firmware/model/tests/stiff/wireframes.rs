//! Segments of the wireframe simulator, from the program to the picture.

use glint_core::colour::Rgb565;
use glint_core::picture::Size;
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{GUARD, MAX_SEGMENTS, Motion, Program, Projection, ScreenLine};
use glint_model::wireframe::render_wireframe;
use glint_model::{WireframeStats, WireframeSubject};
use glint_vectors::Picture;

use crate::case::{Case, refused};

pub const CASES: &[Case] = &[
    ("segment in the view plane", || {
        assert_eq!(projected("-1 0 2 1 0 2"), Some([LEFT, RIGHT]));
        "drawn: it is projected to itself".to_owned()
    }),
    ("segment across the whole window", || {
        let corners = [pixels(0.0, 360.0), pixels(640.0, 0.0)];
        assert_eq!(projected("-2 -1.125 2 2 1.125 2"), Some(corners));
        assert_eq!(drawn("-2 -1.125 2 2 1.125 2").pixels, 640);
        "drawn from corner to corner".to_owned()
    }),
    ("segment along the line of sight", || {
        assert_eq!(projected("0 0 -8 0 0 2"), Some([MIDDLE, MIDDLE]));
        assert_eq!(drawn("0 0 -8 0 0 2").pixels, 0);
        "both ends are one point of the screen: no pixel".to_owned()
    }),
    ("segment wholly in front of the view plane", || {
        left_out("-1 0 2.5 1 0 3")
    }),
    ("segment wholly behind the viewer", || {
        left_out("1 0 5 -1 0 8")
    }),
    ("z = z_eye at both ends", || left_out("-1 0 4 1 0 4")),
    ("z = z_eye at one end", || {
        assert_eq!(projected("2 0 4 0 0 0"), Some([RIGHT, MIDDLE]));
        assert_eq!(drawn("2 0 4 0 0 0").pixels, 160);
        "cut at the view plane".to_owned()
    }),
    ("segment from the eye itself", || {
        assert_eq!(projected("0 0 4 0 0 0"), Some([MIDDLE, MIDDLE]));
        "cut at the view plane".to_owned()
    }),
    ("view plane at z_eye", || {
        refused(assembled("eye 0 0 2\nplane 2\n", ""))
    }),
    ("view plane 1/2048 behind z_eye", smallest_divisor),
    ("segment that leaves the guard band", || {
        // The guard band ends 1727 pixels right of the middle.
        let limit = [GUARD, 180 << 8];
        assert_eq!(projected("0 0 2 15.9995 0 2"), Some([MIDDLE, limit]));
        assert_eq!(drawn("-16 -9 2 15.9995 9 2").pixels, 640);
        "cut there in exact arithmetic".to_owned()
    }),
    ("segment wholly beyond the guard band", || {
        left_out("-16 15 2 15 15 2")
    }),
    ("65,535 segments", || {
        let stats = draw(
            &assembled(HEAD, &parallels(MAX_SEGMENTS)).unwrap(),
            Size::W320,
        );
        let segments = u64::from(MAX_SEGMENTS);
        assert_eq!((stats.segments, stats.lines), (MAX_SEGMENTS, MAX_SEGMENTS));
        // A line from border to border through the centres of its pixels lacks one of them, by the rule of the diamonds.
        assert!((319 * segments..=320 * segments).contains(&stats.pixels));
        "all are drawn".to_owned()
    }),
    ("65,536 segments", || {
        refused(assembled(HEAD, &parallels(MAX_SEGMENTS + 1)))
    }),
];

/// The eye at z = 4 and the view plane at z = 2, with 160 pixels a unit there in a picture 640 wide.
const HEAD: &str = "eye 0 0 4\nplane 2\n";

const MIDDLE: [i32; 2] = pixels(320.0, 180.0);
const RIGHT: [i32; 2] = pixels(480.0, 180.0);
const LEFT: [i32; 2] = pixels(160.0, 180.0);

const fn pixels(x: f64, y: f64) -> [i32; 2] {
    [(256.0 * x) as i32, (256.0 * y) as i32]
}

/// A program in binary form, with a window of ±2 × ±1.125, or the text of its error.
fn assembled(head: &str, segments: &str) -> Result<Vec<u8>, String> {
    let text = format!("{head}window -2 -1.125 2 1.125\n{segments}end\n");
    assemble(&text).map_err(|error| error.to_string())
}

fn line(head: &str, segment: &str) -> Option<ScreenLine> {
    let bytes = assembled(head, &format!("segment {segment}\n")).unwrap();
    let program = Program::new_checked(&bytes).unwrap();
    let segment = program.segments().next().unwrap();
    let moved = Motion::default().pose().segment(segment);
    Projection::new(program.viewing(), Size::W640).line(moved)
}

/// The ends of a segment on a picture 640 wide.
fn projected(segment: &str) -> Option<ScreenLine> {
    line(HEAD, segment)
}

fn draw(bytes: &[u8], size: Size) -> WireframeStats {
    let subject = WireframeSubject {
        program: Program::new_checked(bytes).unwrap(),
        pose: Motion::default().pose(),
    };
    let [width, height] = size.pixels();
    let mut picture = Picture::blank((width, height));
    render_wireframe(&subject, Rgb565(0), &mut picture.target(), &mut || {}).unwrap()
}

/// Counts of the picture of one segment, 640 wide.
fn drawn(segment: &str) -> WireframeStats {
    let bytes = assembled(HEAD, &format!("segment {segment}\n")).unwrap();
    draw(&bytes, Size::W640)
}

fn left_out(segment: &str) -> String {
    assert_eq!(projected(segment), None);
    assert_eq!(drawn(segment).lines, 0);
    "left out".to_owned()
}

/// Horizontal segments across the window, 1/1024 apart.
fn parallels(count: u32) -> String {
    let y = |i: u32| f64::from(i % 2304) / 1024.0 - 1.125;
    (0..count)
        .map(|i| format!("segment -2 {y} 2 2 {y} 2\n", y = y(i)))
        .collect()
}

fn smallest_divisor() -> String {
    // 4 − 1/2048; the far end is nearly at the eye's own position on the screen.
    let near = "3.99951171875";
    let found = line(
        &format!("eye 0 0 4\nplane {near}\n"),
        &format!("1 0 {near} -16 0 -16"),
    );
    // −16·(1/2048)/20 of a unit is 0.0625 pixels left of the middle.
    assert_eq!(found, Some([RIGHT, pixels(319.9375, 180.0)]));
    "drawn exactly: the divisor is the smallest one".to_owned()
}
