//! Pictures and depths of meshes are bit-identical to the model's: on the monitor, in memory, and over the serial line.

use crate::common::{
    assert_has, drawn_alike, emulator, emulator_with, mesh, mesh_frame, object, plain, renderer,
    running_board, sky, timeless,
};
use glint::board::{Board, SimulatedBoard, Simulation};
use glint::render::{self, BoardRenderer, Frame, MeshSubject, Rendered, Route, Subject};
use glint::view;
use glint_core::camera::View;
use glint_core::colour::{Rgb565, Shading};
use glint_core::fixed::{U4_28, U8_28};
use glint_core::light::{Light, MeshLighting};
use glint_core::picture::{Backend, Size};
use glint_core::texture::{self, Blend, Filter, Sampler, Source, Texture};
use glint_vectors::meshes::textured_layers;
use std::path::Path;
use std::process::Command;

/// The reason why the soft core draws smooth shading.
const NO_SMOOTH: &str = "triangle engine: this gateware has no smooth shading, expected a build by `cargo xtask gateware --smooth`";

/// The triangle engine draws smooth shading if the gateware supports it, otherwise the CPU draws it, with a note in `stats`.
#[test]
fn smooth_shading_is_the_models_on_every_backend() {
    for (capability, backend) in [
        (Shading::Smooth, None),
        (Shading::Flat, None),
        (Shading::Smooth, Some(Backend::Cpu)),
    ] {
        let mut board = emulator_with(capability);
        let mut renderer = renderer(&mut board);
        let mesh = mesh("icosphere:2");
        let subject = Subject::Mesh(MeshSubject {
            shading: Shading::Smooth,
            ..plain(&mesh)
        });
        let frame = Frame::new(subject, view::spherical("2,30,60").unwrap(), Size::W320);
        renderer.set_backend(backend);
        let [Rendered { stats, .. }, _] = drawn_alike(&mut renderer, &frame, "smooth");
        let notes = renderer.console().command("stats").unwrap();
        let fell_back = notes.contains(&format!("fallback {NO_SMOOTH}"));
        assert_eq!(fell_back, capability == Shading::Flat, "{notes:#?}");
        let json = renderer.console().command("stats json").unwrap().concat();
        let in_json = json.contains(&format!(r#","fallback":"{NO_SMOOTH}"}}"#));
        assert_eq!(in_json, fell_back);
        let by_cpu = fell_back || backend.is_some();
        let by = if by_cpu { "cpu" } else { "gateware" };
        assert_eq!(stats.backend.as_deref(), Some(by));
        let info = renderer.console().command("info").unwrap();
        assert!(info.contains(&"shading smooth".into()), "{info:#?}");
    }
}

/// The triangle engine draws textures with flat shading if the gateware supports textures.
/// Otherwise the soft core draws them, and `stats` has a note.
#[test]
fn textures_are_the_models_on_every_backend() {
    // A window in front of a picture.
    let textures = [Blend::Opaque, Blend::ALL[3]].map(|blend| {
        let texture = texture::encode(&Source {
            size_log2: [4, 4],
            sampler: Sampler {
                filter: Filter::Bilinear,
                ..Sampler::default()
            },
            key: Some(0),
            blend,
            levels: vec![(0..256).map(|i| i * 0x101).collect()],
            ..Source::default()
        });
        texture.unwrap()
    });
    let mesh = textured_layers(&textures, 0.5, 0.1);
    const NO_TEXTURES: &str = "fallback triangle engine: this gateware has no textures; `textures off` draws the mesh without them, fast, expected a build by `cargo xtask gateware --texture`";
    const SMOOTH: &str = "fallback triangle engine: no textures with smooth shading, expected `shading flat` or `textures off`";
    for (has_textures, shading, textures, by, fallback) in [
        (true, Shading::Flat, true, "gateware", None),
        (true, Shading::Smooth, true, "cpu", Some(SMOOTH)),
        (false, Shading::Flat, true, "cpu", Some(NO_TEXTURES)),
        (false, Shading::Flat, false, "gateware", None),
    ] {
        let mut board = emulator();
        board.inner().state_textures(has_textures);
        let mut renderer = renderer(&mut board);
        let subject = Subject::Mesh(MeshSubject {
            shading,
            textures,
            ..plain(&mesh)
        });
        let view = view::spherical("2,30,60").unwrap();
        // The sky behind the window is drawn first; the window has its own fog.
        let before_sky = Frame {
            sky: Some(sky()),
            fog: U4_28::from_num(0.2),
            ..Frame::new(subject, view, Size::W320)
        };
        let [found, expected] = drawn_alike(&mut renderer, &before_sky, "textures before a sky");
        let drawn = [found.stats, expected.stats].map(|stats| stats.triangles().pixels_drawn);
        assert_eq!(drawn[0], drawn[1], "pixels drawn");
        let frame = Frame::new(subject, view, Size::W320);
        let [Rendered { stats, .. }, _] = drawn_alike(&mut renderer, &frame, "textures");
        let notes = renderer.console().command("stats").unwrap();
        assert_eq!(stats.backend.as_deref(), Some(by), "{notes:#?}");
        let found = notes.iter().find(|line| line.starts_with("fallback "));
        assert_eq!(found.map(String::as_str), fallback, "{notes:#?}");
    }
}

/// Gateware and soft core draw a replacement texture, also on clipped triangles, and name it once.
#[test]
fn a_replacement_texture_is_the_models() {
    let texture = |colour: u16, blend| {
        let texture = texture::encode(&Source {
            size_log2: [4, 4],
            blend,
            levels: vec![(0..256).map(|i| i * colour).collect()],
            ..Source::default()
        });
        texture.unwrap()
    };
    let layers = |count: u16| {
        let own: Vec<_> = (0..count).map(|i| texture(i, Blend::Opaque)).collect();
        textured_layers(&own, 0.5, 0.1)
    };
    let (few, more) = (layers(2), layers(7));
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    for blend in [Blend::Opaque, Blend::Additive] {
        let other = texture(0x101, blend);
        let other = Some(Texture::new_checked(&other).unwrap());
        for backend in [Backend::Gateware, Backend::Cpu] {
            renderer.set_backend(backend);
            let view = view::spherical("2,30,60").unwrap();
            let frame = Frame {
                replacement_texture: other,
                ..Frame::new(Subject::Mesh(plain(&few)), view, Size::W320)
            };
            drawn_alike(&mut renderer, &frame, "a texture on a mesh");
            let objects = [object(&few, "move 0.5,0.5,0.5"), object(&more, "scale 0.4")];
            let objects = Frame {
                subject: Subject::Objects(&objects),
                ..frame
            };
            let [Rendered { stats, .. }, _] =
                drawn_alike(&mut renderer, &objects, "a texture on objects");
            assert!(stats.triangles().triangles_clipped > 0);
            assert_eq!(stats.backend, Some(backend.to_string()));
        }
    }
}

/// The reason of a fallback is printed above the prompt once, not after each command.
#[test]
fn the_console_notes_a_fallback_once() {
    let mut board = emulator_with(Shading::Flat);
    let note = format!("note: drawn by the soft core: {NO_SMOOTH}\r\n");
    let mut said = |command: &str| {
        board.write(format!("{command}\r").as_bytes()).unwrap();
        let mut bytes = Vec::new();
        for _ in 0..100 {
            board.read(&mut bytes, 50).unwrap();
        }
        String::from_utf8(bytes).unwrap()
    };
    said("size 320 180");
    for (command, is_noted) in [
        ("scene sphere", false),
        ("shading smooth", true),
        ("camera 3 20 60", false),
        ("shading flat", false),
        ("shading smooth", true),
    ] {
        let text = said(command);
        let notes = text.matches(&note).count();
        assert_eq!(notes, usize::from(is_noted), "{text:?}");
        assert!(text.ends_with("glint> "), "{text:?}");
    }
}

/// For a patch that is seen from behind, the console and the statistics have a hint. With `cull
/// off`, or from the front, there is no hint.
#[test]
fn a_mesh_seen_from_behind_has_a_hint() {
    const SIDE: usize = 40;
    let line = |i: usize| (0..=SIDE).map(move |j| format!("v {i} {j} 0\n"));
    let mut obj: String = (0..=SIDE).flat_map(line).collect();
    for i in 0..SIDE {
        for j in 0..SIDE {
            let first = i * (SIDE + 1) + j + 1;
            let next = first + SIDE + 1;
            obj += &format!("f {first} {} {} {next}\n", first + 1, next + 1);
        }
    }
    let options = glint::convert::Options::default();
    let patch = glint::model::of_file("a.obj", obj.into(), options, &mut |_| None).unwrap();
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    renderer.upload(&patch.mesh, Some("patch")).unwrap();
    let console = renderer.console();
    console.command("size 320 180").unwrap();
    for (command, is_hinted) in [
        ("camera 3 20 30", true),
        ("cull off", false),
        ("cull on", true),
        ("camera 3 20 150", false),
        ("scene sphere", false),
        ("camera 3 20 30", false),
    ] {
        console.command(command).unwrap();
        let hint = "hint 0 of 3200 triangles are drawn";
        let lines = console.command("render").unwrap();
        let found = lines.iter().any(|line| line.starts_with(hint));
        assert_eq!(found, is_hinted, "{command}: {lines:#?}");
        let json = console.command("stats json").unwrap().concat();
        assert_eq!(json.contains(r#","hint":"0 of 3200 "#), is_hinted, "{json}");
    }
    console.command("scene patch").unwrap();
    drop(renderer);
    let mut bytes = Vec::new();
    for _ in 0..10 {
        board.read(&mut bytes, 50).unwrap();
    }
    let text = String::from_utf8(bytes).unwrap();
    assert_has(&text, "note: 0 of 3200 triangles are drawn");
}

/// After a change of the camera, drawing a mesh takes few cycles of the soft core in addition to the engine's passes.
#[test]
fn a_new_camera_takes_few_cycles_of_the_soft_core() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let mesh = mesh("icosphere:6");
    let frame = mesh_frame(&mesh, "2,30,60", Size::W320);
    renderer.show(&frame).unwrap();
    let mut counts = ["2.5,40,65", "3,130,80", "2.5,43,65"].map(|camera| {
        let stats = renderer.look(&view::spherical(camera).unwrap()).unwrap();
        let cycles = stats.engine.get("cycles_soft_core").unwrap();
        println!("{camera}: {cycles} of {:?} cycles", stats.cycles);
        cycles
    });
    // The search for a motion sensor, by interrupts, may take cycles of one of the frames.
    counts.sort_unstable();
    assert!(counts[1] <= 15_000, "{counts:?} cycles");
}

/// A coloured directional light, a light at the camera, ambient light and a background, also a sky, with and without fog, with each
/// backend. The default is tested last, because its commands must remove light and background. The
/// board draws each frame into both frame buffers.
#[test]
fn light_and_background_of_meshes_are_the_models_on_every_backend() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let mesh = mesh("icosphere:2");
    let lights = ["1,-2,3,ffc080", "camera,80ff40"].map(|text| MeshLighting {
        ambient: [0x20, 0x10, 0x60],
        light: Light::parse(text).unwrap(),
    });
    let default = (MeshLighting::CAMERA, Rgb565(0), None);
    for (lighting, clear, sky) in [
        (lights[0], Rgb565(0), None),
        (lights[1], Rgb565(0x1234), None),
        (lights[1], Rgb565(0), Some(sky())),
        (lights[1], Rgb565(0xFEDC), None),
        default,
    ] {
        for backend in [None, Some(Backend::Cpu)] {
            let subject = Subject::Mesh(plain(&mesh));
            let frame = Frame {
                lighting,
                clear,
                sky,
                fog: U4_28::from_num(if sky.is_some() { 0.3 } else { 0.0 }),
                ..Frame::new(subject, view::spherical("2,30,60").unwrap(), Size::W320)
            };
            renderer.set_backend(backend);
            let name = format!("{lighting:?} {clear:?} {sky:?}");
            let [_, expected] = drawn_alike(&mut renderer, &frame, &name);
            for _ in 0..2 {
                let colour = renderer.colour(frame.size).unwrap();
                assert!(colour == expected.image.colour, "{name}");
                renderer.redraw().unwrap();
            }
        }
    }
}

/// In orthographic projection, the pictures of the triangle engine and of the CPU, also with smooth shading, equal the model's.
#[test]
fn orthographic_pictures_are_the_models_on_every_backend() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let mesh = mesh("icosphere:3");
    let view = view::spherical("2,30,60").unwrap();
    let view = view.with_width(U8_28::lit("1.2")).unwrap();
    for (backend, shading) in [
        (None, Shading::Flat),
        (Some(Backend::Cpu), Shading::Flat),
        (None, Shading::Smooth),
    ] {
        let subject = Subject::Mesh(MeshSubject {
            shading,
            ..plain(&mesh)
        });
        let frame = Frame::new(subject, view, Size::W320);
        renderer.set_backend(backend);
        let name = format!("{backend:?} {shading}");
        let [Rendered { stats, .. }, _] = drawn_alike(&mut renderer, &frame, &name);
        let by_gateware = stats.backend.as_deref() == Some("gateware");
        assert_eq!(by_gateware, backend.is_none() && shading == Shading::Flat);
    }
}

/// Renders a mesh on the board from three camera positions, one of them inside the mesh, and compares the picture on the monitor,
/// the depth buffer and the counts with the model's.
fn the_monitor_shows_what_the_model_renders<S: Simulation>(
    board: &mut SimulatedBoard<S>,
    name: &str,
) {
    let size = Size::W320;
    let outside = |camera: &str| (view::spherical(camera).unwrap(), true);
    let inside = r#"{"eye":[0.21,-0.1,0.05],"u":[0.6,0.8,0],"v":[0,0,-1],"n":[-0.8,0.6,0],"half_width":1.5,"near":0.3}"#;
    let inside: View = view::parse(inside.as_bytes()).unwrap();
    // A flag with each camera turns back-face culling on. A camera inside a mesh sees mostly back
    // faces, so its flag is off.
    let cameras = [outside("2,30,60"), outside("2.5,200,130"), (inside, false)];

    let mut renderer = renderer(board).with_backend(Backend::Cpu);
    let mesh = mesh(name);
    for (number, &(view, cull)) in cameras.iter().enumerate() {
        let subject = Subject::Mesh(MeshSubject {
            cull,
            ..plain(&mesh)
        });
        let frame = Frame::new(subject, view, size);
        let [found, expected] = drawn_alike(&mut renderer, &frame, &format!("camera {number}"));
        assert_eq!(timeless(found.stats), expected.stats, "camera {number}");
        let clipped = expected.stats.triangles().triangles_clipped;
        assert!(number < 2 || clipped > 0, "nothing was clipped");
        let shown = renderer.board().inner().monitor_frame(4).unwrap();
        assert!(
            shown == expected.image.colour,
            "camera {number}: the monitor's picture"
        );
    }
}

#[test]
fn the_monitor_shows_the_cube() {
    let mut board = running_board();
    the_monitor_shows_what_the_model_renders(&mut board, "cube");
    assert_eq!(board.inner().monitor().errors(), []);
}

#[test]
fn the_monitor_shows_the_icosphere() {
    the_monitor_shows_what_the_model_renders(&mut emulator(), "icosphere:4");
}

#[test]
fn the_monitor_shows_the_sponge() {
    the_monitor_shows_what_the_model_renders(&mut emulator(), "sponge:1");
}

#[test]
fn the_monitor_shows_the_larger_sizes() {
    let mesh = mesh("cube");
    let mut board = emulator();
    let mut renderer = renderer(&mut board).with_backend(Backend::Cpu);
    for (size, scale) in [(Size::W640, 2), (Size::W1280, 1)] {
        let frame = mesh_frame(&mesh, "2,30,60", size);
        renderer.show(&frame).unwrap();
        let expected = render::on_model(&frame).unwrap().image;
        let shown = renderer.board().inner().monitor_frame(scale).unwrap();
        assert!(shown == expected.colour, "{size:?}");
    }
}

/// The monitor shows the old frame until the new frame is complete: no picture contains parts of both frames.
#[test]
fn no_frame_is_torn() {
    let mesh = mesh("cube");
    let mut board = running_board();
    let mut renderer = renderer(&mut board).with_backend(Backend::Cpu);
    let [old, new] = ["2,30,60", "2,200,100"].map(|camera| mesh_frame(&mesh, camera, Size::W320));
    renderer.show(&old).unwrap();
    let [old, new] = [old, new].map(|frame| render::on_model(&frame).unwrap().image.colour);
    renderer.board().inner().monitor().turn_on();
    assert!(captured(&mut renderer, 4) == old);
    renderer.board().write(b"camera 2 200 100\r").unwrap();
    let mut shown = 0;
    while captured_is(&mut renderer, &old, &new) {
        shown += 1;
        assert!(shown < 20, "the new frame does not come");
    }
    assert!(shown > 0, "the frame changed before it can have been drawn");
}

/// Returns whether the next picture on the monitor is the old frame; any other picture must be the new frame.
fn captured_is(renderer: &mut BoardRenderer<SimulatedBoard>, old: &[u16], new: &[u16]) -> bool {
    let shown = captured(renderer, 4);
    assert!(shown == old || shown == new, "a torn frame");
    shown == old
}

/// Captures the picture on the monitor, scaled down by `scale` to the frame's size; checks the video timing.
fn captured(renderer: &mut BoardRenderer<SimulatedBoard>, scale: usize) -> Vec<u16> {
    let board = renderer.board().inner();
    let picture = board.capture().unwrap();
    assert_eq!(board.monitor().errors(), []);
    picture.scaled_back(scale).unwrap()
}

#[test]
fn colours_and_depths_come_over_the_line() {
    let mesh = mesh("cube");
    let mut board = emulator();
    let renderer = renderer(&mut board).with_backend(Backend::Cpu);
    let frame = mesh_frame(&mesh, "3,10,80", Size::W320);
    drawn_alike(
        &mut renderer.with_route(Route::Serial),
        &frame,
        "by the line",
    );
}

/// The pictures of the animation of `glint orbit` on the emulated board equal the model's, with each backend.
#[test]
fn an_orbit_on_a_board_is_the_models() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board-orbit");
    std::fs::create_dir_all(&folder).unwrap();
    let orbit = |subject: &str, board: &str| {
        let options = "--frames 6 --size 320x180 --aa 1 --force --out a.png --json";
        let command = format!("orbit {options} {subject} {board}");
        let output = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(command.split_whitespace())
            .current_dir(&folder)
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{command}: {error}");
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["frames"], 6);
        let counts_cycles = report["cycles"].as_u64().is_some_and(|cycles| cycles > 0);
        assert_eq!(counts_cycles, !board.is_empty(), "{command}: {report}");
        std::fs::read(folder.join("a.png")).unwrap()
    };
    for (subject, more) in [
        ("gear", ""),
        ("gear", "--backend cpu"),
        ("gear", "--transfer serial"),
        ("gear --stereo 0.1,3", ""),
        ("gear --field box:1,1,0.1", ""),
        ("--field menger:2 --fog 0.1", ""),
        ("--scene mesh-in-field", ""),
        ("--scene objects", ""),
    ] {
        let by_board = orbit(subject, &format!("--board emulated {more}"));
        assert!(by_board == orbit(subject, ""), "{subject} {more}");
    }
}

/// Only the model and the soft core count `pixels_tested`. The gateware tests groups of pixels, and counts them under another
/// name.
#[test]
fn pixels_tested_are_counted_alike_or_have_another_name() {
    let mesh = mesh("icosphere:4");
    let frame = mesh_frame(&mesh, "2,30,60", Size::W320);
    let expected = render::on_model(&frame).unwrap().stats;
    assert!(expected.triangles().pixels_tested > Some(0));
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    for (backend, has_pixels) in [(Backend::Cpu, true), (Backend::Gateware, false)] {
        renderer.set_backend(backend);
        let stats = renderer.show(&frame).unwrap();
        assert_eq!(stats.backend.as_deref(), Some(backend.name()));
        let tested = stats.triangles().pixels_tested;
        let of_model = expected.triangles().pixels_tested;
        assert_eq!(tested, of_model.filter(|_| has_pixels));
        let groups = stats.engine.get("cycles_walking");
        assert_eq!(groups.is_ok(), !has_pixels);
    }
}
