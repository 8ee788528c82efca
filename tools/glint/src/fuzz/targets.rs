//! Fuzz targets.

use super::{firmware, flash, host, transfer};
use crate::convert::{self, Options};
use crate::formats::{glm, gltf, obj, ply, stl};
use crate::imu::{log, replay};
use crate::polygons::Polygons;
use crate::render::{self, Frame, Subject};
use crate::view;
use crate::wireframe::{self, Form};
use clap::ValueEnum;
use glint_core::console::{Command, Event, LineEditor, NoNames, write_help};
use glint_core::mesh;
use glint_core::orientation::Units;
use glint_core::orientation::log as image;
use glint_core::picture::Size;
use glint_core::texture::{self, Format, Texture};
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{GUARD, Instruction, Key, Motion, Projection, WORD_BYTES};
use glint_scene_file::SceneFile;
use glint_texture::convert::again;
use glint_texture::example;
use glint_texture::picture::Picture;
use glint_texture::sheet::sheet;

/// A fuzz target: a parser of external bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// The sender and the receiver of an upload.
    Upload,
    /// The line editor and the parser of commands.
    Console,
    /// OBJ files and their material files.
    Obj,
    /// STL files.
    Stl,
    /// PLY files.
    Ply,
    /// glTF files, JSON and binary, and their buffer files.
    Gltf,
    /// Meshes in a board's memory layout.
    Glm,
    /// Pictures for textures, and textures in a board's memory layout.
    Texture,
    /// Logs of a gyroscope and an accelerometer, as CSV text.
    Imu,
    /// Logs of a gyroscope and an accelerometer, in the binary format that boards replay.
    Replay,
    /// Programs of the wireframe simulator, in the text form.
    WireframeText,
    /// Programs of the wireframe simulator, in the binary form.
    WireframeWords,
    /// Scene files.
    Scene,
    /// The contents of flash images, and a firmware with its header.
    Flash,
    /// The host's protocols: console replies, transfers and the serial boot, with a board that sends arbitrary bytes.
    Host,
    /// The whole firmware on the emulated board: arbitrary bytes on its serial line.
    Firmware,
}

impl Target {
    /// Keywords of the target's format that the mutator inserts.
    pub fn words(self) -> Vec<&'static str> {
        let words = match self {
            Self::Upload | Self::Glm | Self::Replay | Self::WireframeWords | Self::Texture => {
                return Vec::new();
            }
            Self::Flash => "scene field menger:4 torus lamp start \n",
            Self::Console | Self::Firmware => {
                "help view camera field box: spheres: union: stereo load size on off depth json 0x 1e5 \r \x1b["
            }
            Self::Imu => "t_us ax ay az gx gy gz temp , 32767 -32768 32768",
            Self::WireframeText => "eye plane window segment end # \n -16 15.9995 16 0x0800",
            Self::Scene => {
                "= true\n [budget]\n \" [ ] field menger:4 light steer scenes up material object \n"
            }
            Self::Obj => {
                "v vn vt f l curv usemtl mtllib newmtl Kd map_Kd -clamp a.png d Tr Ke # \\\n 1//1 1/1/1 1/2"
            }
            Self::Stl => "solid facet normal outer loop vertex endloop endfacet endsolid COLOR=",
            Self::Gltf => super::gltf::WORDS,
            Self::Host => host::WORDS,
            Self::Ply => {
                "element property list vertex face tristrips -1 uchar int8 ushort int uint float double format ascii \
                 binary_little_endian binary_big_endian end_header vertex_indices red"
            }
        };
        words.split(' ').collect()
    }

    /// Corrects the checksums and lengths in the input. With wrong values the parser would reject nearly every mutation.
    pub fn repair(self, input: &mut Vec<u8>) {
        match self {
            Self::Upload | Self::Host => transfer::repair(input),
            Self::Stl => {
                // The number of triangles must match the file's length.
                let count = (input.len().saturating_sub(84) / 50) as u32;
                if let (Some(field), false) = (input.get_mut(80..84), count == 0) {
                    field.copy_from_slice(&count.to_le_bytes());
                    input.truncate(84 + 50 * count as usize);
                }
            }
            Self::Gltf => super::gltf::repair(input),
            Self::Glm => {
                input.truncate(input.len() / 16 * 16);
                let length = input.len() as u32;
                if let Some(field) = input.get_mut(4..8) {
                    field.copy_from_slice(&length.to_le_bytes());
                }
                mesh::set_checksum(input);
            }
            Self::Replay => {
                // The number of samples must match the log's length.
                let samples = input.len().saturating_sub(image::HEADER_BYTES) / image::RECORD_BYTES;
                if let Some(field) = input.get_mut(4..8) {
                    field.copy_from_slice(&(samples as u32).to_le_bytes());
                }
                input.truncate(image::HEADER_BYTES + image::RECORD_BYTES * samples);
            }
            Self::WireframeWords => {
                // A program consists of whole words, and its last word is the end of the program.
                input.truncate(input.len() / WORD_BYTES * WORD_BYTES);
                if let Some(last) = input.last_chunk_mut() {
                    *last = Instruction::End.encode();
                }
            }
            Self::Flash => flash::repair(input),
            Self::Texture => example::repair_png(input),
            Self::Console
            | Self::Firmware
            | Self::Obj
            | Self::Ply
            | Self::Imu
            | Self::WireframeText
            | Self::Scene => {}
        }
    }

    /// Runs the target, and returns whether it has accepted the input to its end. A panic is a bug.
    pub fn run(self, input: &[u8]) -> bool {
        match self {
            Self::Upload => transfer::run(input),
            Self::Host => host::run(input),
            Self::Console => run_console(input),
            Self::Obj => run_mesh(obj::parse(input, &mut |name| Some(beside(name, input)))),
            Self::Gltf => run_mesh(gltf::parse(input, &mut |name| Some(beside(name, input)))),
            Self::Texture => run_texture(input),
            Self::Stl => run_mesh(stl::parse(input)),
            Self::Ply => run_mesh(ply::parse(input)),
            Self::Glm => glm::parse(input).is_ok_and(|polygons| {
                run_conversion(&polygons);
                run_model(input);
                true
            }),
            Self::Imu => log::parse(input).is_ok_and(|log| {
                run_replay(&log.entries);
                true
            }),
            Self::Replay => run_image(input),
            Self::WireframeText => run_program(Form::Text, input),
            Self::WireframeWords => run_program(Form::Binary, input),
            Self::Scene => run_scene(input),
            Self::Flash => flash::run(input),
            Self::Firmware => firmware::run(input),
        }
    }
}

/// A file that an OBJ or glTF file names: a picture if the name has the extension of a
/// picture, otherwise the input.
fn beside(name: &str, input: &[u8]) -> Vec<u8> {
    if name.ends_with(".png") {
        example::small_png()
    } else {
        input.to_vec()
    }
}

/// Converts a picture or a texture with options that depend on the input, and checks that the texture is valid.
fn run_texture(input: &[u8]) -> bool {
    let format = Format::ALL[input.len() % Format::ALL.len()];
    let converted = if input.starts_with(&texture::MAGIC) {
        let Ok(texture) = Texture::new_checked(input) else {
            return false;
        };
        again(&texture, Some(format), 16, texture.sampler(), None)
    } else {
        let options = glint_texture::options::Options {
            format,
            largest_side: 16,
            cutoff: input.len().is_multiple_of(2).then_some(0.5),
            ..glint_texture::options::Options::default()
        };
        Picture::decode(input)
            .and_then(|picture| glint_texture::convert::convert(&picture, &options))
    };
    match converted {
        Ok((bytes, report)) => {
            let texture = Texture::new_checked(&bytes);
            let is_valid = texture.is_ok_and(|texture| !sheet(&texture).texels.is_empty());
            assert!(is_valid, "a conversion gives a valid texture");
            assert!(report.error_rms <= report.error_max && report.error_max <= 255.0);
            true
        }
        Err(error) => {
            assert!(!error.to_string().contains('\n'));
            false
        }
    }
}

fn run_mesh<E>(parsed: Result<Polygons, E>) -> bool {
    parsed.is_ok_and(|polygons| run_conversion(&polygons))
}

/// Converts parsed polygons to a mesh, and checks that the mesh is valid.
fn run_conversion(polygons: &Polygons) -> bool {
    // A conversion without scaling may fail because of coordinates out of range, but must not panic.
    let keep_scale = Options {
        keep_scale: true,
        fix_winding: true,
        ..Options::default()
    };
    let _ = convert::convert(polygons, keep_scale);
    match convert::convert(polygons, Options::default()) {
        Ok((mesh, report)) => {
            let error = report.error_max_lsb;
            assert!(error <= 0.87, "the rounding is to nearest: {error}");
            let is_valid = glm::check_file(&mesh).is_ok();
            assert!(is_valid, "a conversion gives a valid mesh");
            true
        }
        Err(_) => false,
    }
}

/// Replays a parsed log with every option enabled: with its time stamps, and with two fixed sample
/// periods.
fn run_replay(entries: &[log::Entry]) {
    for period in [None, Some(1_000), Some(600_000)] {
        let options = replay::Options {
            units: Units::MPU_6050,
            period,
            still: None,
            tilt: true,
            follow_bias: true,
        };
        let replay = |options| replay::on_model(replay::prepare(entries, options)?);
        let replayed = replay(&options);
        let is_whole = replayed.is_ok_and(|replayed| replayed.attitudes.len() == entries.len());
        assert!(is_whole, "without a calibration every log is replayed");
        // A calibration fails for a log that is not at rest, so the result may be an error.
        let _ = replay(&replay::Options {
            still: Some(u64::MAX),
            ..options
        });
    }
}

/// Parses a scene file. Every line of an accepted file must be a command, and every line of an error must name the file.
fn run_scene(input: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(input) else {
        return false;
    };
    match SceneFile::parse("scene", "scene.toml", text) {
        Ok(scene) => {
            let is_command = |line: &str| matches!(Command::parse(line), Ok(Some(_)));
            assert!(scene.lines().all(is_command), "every line is a command");
            assert!(!scene.needs().options().is_empty());
            true
        }
        Err(error) => {
            let error = error.to_string();
            let mut lines = error.lines();
            let is_located = lines.all(|line| line.starts_with("scene.toml: "));
            assert!(is_located, "{error}");
            false
        }
    }
}

/// Replays a log in a board's format. The attitudes of an accepted log must have length 1.
fn run_image(input: &[u8]) -> bool {
    let mut image = input.to_vec();
    match image::replay(&mut image) {
        Ok(counts) => {
            let mut records = image[image::HEADER_BYTES..].as_chunks().0.iter();
            assert!(counts.steps < records.len() as u64);
            let is_unit = |record| image::attitude(image::from_bytes(record)).is_some();
            assert!(records.all(is_unit), "every attitude has length 1");
            true
        }
        Err(error) => {
            assert!(!error.to_string().contains('\n'));
            assert_eq!(image, input, "a rejected log stays unchanged");
            false
        }
    }
}

/// Parses a program, and transforms and projects its segments.
fn run_program(form: Form, input: &[u8]) -> bool {
    let Ok(wireframe::Source { bytes, .. }) = wireframe::parse(form, input.to_vec()) else {
        return false;
    };
    let program = wireframe::check(&bytes);
    assert!(program.is_ok(), "a parsed program is valid");
    let Ok(program) = program else {
        return false;
    };
    let mut motion = Motion::default();
    for (number, key) in Key::ALL.into_iter().cycle().take(20).enumerate() {
        motion.apply(key.step(number % 3 > 0));
    }
    let lines = wireframe::text(&program);
    assert!(assemble(&lines).is_ok(), "the text form is valid too");
    let pose = motion.pose();
    let projection = Projection::new(program.viewing(), Size::W1280);
    for segment in program.segments() {
        if let Some(line) = projection.line(pose.segment(segment)) {
            let mut ends = line.as_flattened().iter();
            let is_within = ends.all(|x| x.abs() <= GUARD);
            assert!(is_within, "a line is within the guard band");
        }
    }
    true
}

/// Renders a mesh if it is valid.
fn run_model(mesh: &[u8]) {
    if let (Ok(mesh), Ok(view)) = (glm::check(mesh), view::spherical("2,30,60")) {
        let frame = Frame::new(Subject::mesh(mesh), view, Size::W320);
        let rendered = render::on_model(&frame);
        assert!(rendered.is_ok(), "a checked mesh is rendered");
    }
}

fn run_console(input: &[u8]) -> bool {
    let mut editor = LineEditor::new();
    let (mut echo, mut text) = (String::new(), String::new());
    let mut accepted = false;
    for &byte in input {
        if let Event::Line(line) = editor.on_byte(byte, &NoNames, &mut echo) {
            use std::fmt::Write;
            match Command::parse(line) {
                Ok(Some(Command::Help { command })) => {
                    // Writing to a string cannot fail.
                    let _ = write_help(&mut text, command);
                }
                Ok(_) => accepted = true,
                Err(error) => {
                    let _ = write!(text, "{error}");
                    let is_line = !text.contains(['\r', '\n']);
                    assert!(is_line, "an error is one line: {text:?}");
                }
            }
            text.clear();
        }
        let is_short = echo.len() < 4096 && echo.is_ascii();
        assert!(
            is_short,
            "a byte echoes less than a screen of ASCII: {echo:?}"
        );
        echo.clear();
    }
    accepted
}
