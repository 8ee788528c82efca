//! Animations of a camera that goes around a model.

use crate::common::{SQUARE, folder, glint, picture, refused, succeed};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The frames of an animated PNG.
fn frames_of_png(path: &Path) -> Vec<Vec<u8>> {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let count = reader.info().animation_control().unwrap().num_frames;
    let mut frame = || {
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        pixels
    };
    (0..count).map(|_| frame()).collect()
}

/// The frames of a GIF, and the time of the first one in 1/100 s.
fn frames_of_gif(path: &Path) -> (Vec<Vec<u8>>, u16) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(path).unwrap()).unwrap();
    let mut frames = Vec::new();
    let mut delay = 0;
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        delay = frame.delay;
        let pixels = frame.buffer.chunks_exact(4);
        frames.push(pixels.flat_map(|pixel| pixel[..3].to_vec()).collect());
    }
    (frames, delay)
}

#[test]
fn both_forms_show_one_turn() {
    let folder = folder("orbit");
    for out in ["orbit.png", "orbit.gif"] {
        let arguments = [
            "orbit",
            "icosphere:2",
            "--frames",
            "5",
            "--out",
            out,
            "--rate",
            "10",
        ];
        let said = succeed(&folder, &arguments);
        assert_eq!(said, "5 frames around icosphere:2, 320x180, by model\n");
    }
    let frames = frames_of_png(&folder.join("orbit.png"));
    assert_eq!(frames.len(), 5);
    for (i, frame) in frames.iter().enumerate() {
        assert!(!frames[..i].contains(frame), "frame {i}");
    }
    // With at most 256 colours in a frame the GIF is exact.
    assert!(frames_of_gif(&folder.join("orbit.gif")) == (frames.clone(), 10));
    // The turn begins with the camera of a picture.
    succeed(&folder, &["render", "icosphere:2", "--out", "a.png"]);
    assert!(picture(&folder.join("a.png")) == frames[0]);
    // Another axis and field of view.
    let quarters = [
        "orbit", "cube", "--frames", "4", "--out", "a.png", "--up", "y", "--fov", "30",
    ];
    succeed(&folder, &quarters);
    assert_eq!(frames_of_png(&folder.join("a.png")).len(), 4);
}

#[test]
fn notes_warnings_and_errors() {
    let folder = folder("orbit-errors");
    std::fs::write(folder.join("square.obj"), SQUARE).unwrap();
    let arguments = ["orbit", "square.obj", "--frames", "8", "--out", "a.gif"];
    let output = glint(&folder, &arguments);
    assert!(output.status.success());
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        error,
        "note: y is up, as usual in .obj; --up z changes it\n"
    );
    assert_eq!(
        refused(&folder, &["orbit", "cube", "--out", "a.jpg"]),
        "error: a.jpg: expected a name that ends in .png, .gif, found '.jpg'"
    );
    for frames in ["0", "361"] {
        let output = glint(
            &folder,
            &["orbit", "cube", "--out", "b.gif", "--frames", frames],
        );
        assert_eq!(output.status.code(), Some(2));
    }
    assert!(!folder.join("b.gif").exists());
}
