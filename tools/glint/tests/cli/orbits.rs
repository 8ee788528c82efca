//! Animations in which the camera turns around a model.

use crate::common::{SQUARE, all_refused, drawn, failed, folder, refused, said, succeed};
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

/// The frames of a GIF, and the duration of the last frame in 1/100 s.
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
        let orbit = format!(
            "orbit icosphere:2 --frames 5 --out {out} --rate 10 --quality fast --shading flat"
        );
        let said = succeed(&folder, &orbit);
        assert_eq!(said, "5 frames around icosphere:2, 320x180, by model\n");
    }
    let frames = frames_of_png(&folder.join("orbit.png"));
    assert_eq!(frames.len(), 5);
    for (i, frame) in frames.iter().enumerate() {
        assert!(!frames[..i].contains(frame), "frame {i}");
    }
    // With at most 256 colours per frame, the GIF is exact.
    assert!(frames_of_gif(&folder.join("orbit.gif")) == (frames.clone(), 10));
    // The animation begins with the camera of `glint render`.
    assert!(drawn(&folder, "render icosphere:2 --quality fast --shading flat") == frames[0]);
    // Another axis, and another field of view.
    let quarters = "orbit cube --frames 4 --out a.png --up y --fov 30 --quality fast";
    succeed(&folder, quarters);
    assert_eq!(frames_of_png(&folder.join("a.png")).len(), 4);
}

/// The frames of an animation with four samples a pixel equal pictures with four samples a pixel.
#[test]
fn animations_with_four_samples_a_pixel() {
    let folder = folder("orbit-samples");
    let orbit = "orbit gear --frames 2 --size 320x180 --out a.png";
    succeed(&folder, orbit);
    let frames = frames_of_png(&folder.join("a.png"));
    assert!(frames[0] == drawn(&folder, "render gear --size 320x180 --aa 4"));
    assert_eq!(frames[1].len(), 3 * 320 * 180);
}

/// An animation of a field or a scene begins with the picture of `glint render`, and turns about the z axis.
#[test]
fn fields_and_scenes() {
    let folder = folder("orbit-fields");
    let lamp = "title = \"Lamp\"\nfield = \"union:box:2,2,0.1+sphere:0.6\"\ncamera = \"4 0 70\"\nbackground = \"sky\"\n";
    std::fs::write(folder.join("lamp.toml"), lamp).unwrap();
    for (subject, quarter) in [
        ("--field menger:2 --material clay", None),
        ("--field cubes:2,0.3 --fog 0.2 --fov 40", None),
        ("--field menger:1 --camera 4,0,60", Some("4,90,60")),
        ("torus-knot --field box:1,1,0.1", None),
        ("teapot --camera 3,0,40", Some("3,90,40")),
        ("cube --stereo 0.1,2.5 --camera 3,0,40", Some("3,90,40")),
        ("torus-knot --material jade --background sky", None),
        ("--scene lamp.toml", Some("4,90,70")),
        ("--scene objects", None),
    ] {
        let subject = format!("--size 320x180 {subject}");
        succeed(&folder, &format!("orbit --frames 4 --out a.png {subject}"));
        let frames = frames_of_png(&folder.join("a.png"));
        assert_eq!(frames.len(), 4);
        // Some subjects look the same after a quarter or half turn, so only one frame must differ.
        assert!(frames.iter().any(|frame| *frame != frames[0]), "{subject}");
        // The lens of an automatic camera shows the model in all frames.
        if subject.contains("--camera")
            || subject.contains("--field")
            || subject.contains("--scene")
        {
            let first = drawn(&folder, &format!("render {subject}"));
            assert!(first == frames[0], "{subject}");
        }
        if let Some(camera) = quarter {
            let (kept, _) = subject.split_once("--camera").unwrap_or((&subject, ""));
            let second = drawn(&folder, &format!("render {kept} --camera {camera}"));
            assert!(second == frames[1], "{subject}");
        }
    }
    let orbit = "orbit --scene lamp.toml --frames 2 --out a.gif --json";
    let expected = r#"{"scene":"lamp.toml","board":"model","size":[640,360],"frames":2}"#;
    assert_eq!(succeed(&folder, orbit).trim_end(), expected);
    all_refused(
        &folder,
        "
        orbit --out b.gif
            MODEL: expected a mesh file or a generator such as teapot, or --field or --scene in its place, found none
        orbit --scene wireframe --out b.gif
            --scene: expected a scene with a camera, found a wireframe program
        orbit cube --occlusion --out b.gif
            --occlusion: expected a --field, found a mesh
        ",
    );
    assert!(!folder.join("b.gif").exists());
}

#[test]
fn notes_warnings_and_errors() {
    let folder = folder("orbit-errors");
    std::fs::write(folder.join("square.obj"), SQUARE).unwrap();
    let [_, note] = said(&folder, "orbit square.obj --frames 8 --out a.gif");
    assert_eq!(note, "note: y is up, as usual in .obj; --up z changes it\n");
    let error = refused(&folder, "orbit cube --out a.jpg");
    let expected = "error: a.jpg: expected a name that ends in .png, .gif, found '.jpg'";
    assert_eq!(error, expected);
    for frames in ["0", "361"] {
        let orbit = format!("orbit cube --out b.gif --frames {frames}");
        failed(&folder, &orbit, 2);
    }
    assert!(!folder.join("b.gif").exists());
}
