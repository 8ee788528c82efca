//! Fuzz targets.

use super::{firmware, flash, host, transfer};
use crate::convert::{self, Options};
use crate::formats::{glm, gltf, obj, ply, stl};
use crate::imu::{log, replay};
use crate::polygons::Polygons;
use crate::wireframe::{self, Form};
use clap::ValueEnum;
use glint_core::calibration::Units;
use glint_core::console::{Command, Event, LineEditor, write_help};
use glint_core::mesh;
use glint_core::orientation::log as image;
use glint_core::picture::Size;
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{GUARD, Instruction, Key, Motion, Projection, WORD_BYTES};
use glint_scene_file::SceneFile;

/// A parser of external bytes.
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

/// Result of a target on an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The target accepted the complete input.
    Accepted,
    /// The target rejected the input.
    Rejected,
}

impl Target {
    /// Every target.
    pub const ALL: [Self; 15] = [
        Self::Upload,
        Self::Console,
        Self::Obj,
        Self::Stl,
        Self::Ply,
        Self::Gltf,
        Self::Glm,
        Self::Imu,
        Self::Replay,
        Self::WireframeText,
        Self::WireframeWords,
        Self::Scene,
        Self::Flash,
        Self::Host,
        Self::Firmware,
    ];

    /// Keywords of the target's format that the mutator inserts.
    pub fn words(self) -> &'static [&'static str] {
        match self {
            Self::Upload | Self::Glm | Self::Replay | Self::WireframeWords => &[],
            Self::Flash => &["scene", "field", "menger:4", "torus", "lamp", "start", "\n"],
            Self::Console | Self::Firmware => &[
                "help", "view", "camera", "field", "box:", "spheres:", "union:", "stereo", "load",
                "size", "on", "off", "depth", "json", "0x", "1e5", "\r", "\x1b[",
            ],
            Self::Imu => &[
                "t_us", "ax", "ay", "az", "gx", "gy", "gz", "temp", ",", "32767", "-32768", "32768",
            ],
            Self::WireframeText => &[
                "eye", "plane", "window", "segment", "end", "#", "\n", "-16", "15.9995", "16",
                "0x0800",
            ],
            Self::Scene => &[
                "= ",
                "= true\n",
                "[budget]\n",
                "\"",
                "[",
                "]",
                "field",
                "menger:4",
                "light",
                "steer",
                "scenes",
                "\n",
            ],
            Self::Obj => &[
                "v", "vn", "vt", "f", "usemtl", "mtllib", "newmtl", "Kd", "#", "\\\n", "1//1",
                "1/1/1",
            ],
            Self::Stl => &[
                "solid", "facet", "normal", "outer", "loop", "vertex", "endloop", "endfacet",
                "endsolid", "COLOR=",
            ],
            Self::Gltf => super::gltf::WORDS,
            Self::Host => host::WORDS,
            Self::Ply => &[
                "element",
                "property",
                "list",
                "vertex",
                "face",
                "uchar",
                "int8",
                "ushort",
                "int",
                "uint",
                "float",
                "double",
                "format",
                "ascii",
                "binary_little_endian",
                "binary_big_endian",
                "end_header",
                "vertex_indices",
                "red",
            ],
        }
    }

    /// Corrects the checksums and lengths in the input. With wrong values the parser would reject nearly every mutation.
    pub fn repair(self, input: &mut Vec<u8>) {
        match self {
            Self::Upload | Self::Host => transfer::repair(input),
            Self::Stl => {
                // Sets the number of triangles to match the file's length.
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
                // Sets the number of samples to match the log's length.
                let samples = input.len().saturating_sub(image::HEADER_BYTES) / image::RECORD_BYTES;
                if let Some(field) = input.get_mut(4..8) {
                    field.copy_from_slice(&(samples as u32).to_le_bytes());
                }
                input.truncate(image::HEADER_BYTES + image::RECORD_BYTES * samples);
            }
            Self::WireframeWords => {
                // Cuts the input at a word, and appends the end of a program.
                input.truncate(input.len() / WORD_BYTES * WORD_BYTES);
                if let Some(last) = input.last_chunk_mut() {
                    *last = Instruction::End.encode();
                }
            }
            Self::Flash => flash::repair(input),
            Self::Console
            | Self::Firmware
            | Self::Obj
            | Self::Ply
            | Self::Imu
            | Self::WireframeText
            | Self::Scene => {}
        }
    }

    /// Runs the target. A panic is a bug.
    pub fn run(self, input: &[u8]) -> Verdict {
        match self {
            Self::Upload => verdict(transfer::run(input)),
            Self::Host => verdict(host::run(input)),
            Self::Console => run_console(input),
            // An OBJ or glTF file also serves as each additional file that it names.
            Self::Obj => run_mesh(obj::parse(input, &mut |_| Some(input.to_vec()))),
            Self::Gltf => run_mesh(gltf::parse(input, &mut |_| Some(input.to_vec()))),
            Self::Stl => run_mesh(stl::parse(input)),
            Self::Ply => run_mesh(ply::parse(input)),
            Self::Glm => glm::parse(input).map_or(Verdict::Rejected, |polygons| {
                run_conversion(&polygons);
                run_model(input);
                Verdict::Accepted
            }),
            Self::Imu => log::parse(input).map_or(Verdict::Rejected, |log| {
                run_replay(&log.entries);
                Verdict::Accepted
            }),
            Self::Replay => run_image(input),
            Self::WireframeText => run_program(Form::Text, input),
            Self::WireframeWords => run_program(Form::Binary, input),
            Self::Scene => run_scene(input),
            Self::Flash => verdict(flash::run(input)),
            Self::Firmware => verdict(firmware::run(input)),
        }
    }
}

fn verdict(accepted: bool) -> Verdict {
    match accepted {
        true => Verdict::Accepted,
        false => Verdict::Rejected,
    }
}

fn run_mesh<E>(parsed: Result<Polygons, E>) -> Verdict {
    parsed.map_or(Verdict::Rejected, |polygons| run_conversion(&polygons))
}

/// Converts parsed polygons to a mesh, and checks that the mesh is valid.
fn run_conversion(polygons: &Polygons) -> Verdict {
    // A conversion without scaling may fail because of coordinates out of range, but must not panic.
    let keep_scale = Options {
        keep_scale: true,
        fix_winding: true,
        ..Options::default()
    };
    let _ = convert::convert(polygons, keep_scale);
    match convert::convert(polygons, Options::default()) {
        Ok((mesh, report)) => {
            assert!(
                report.error_max_lsb <= 0.87,
                "the rounding is to nearest: {}",
                report.error_max_lsb
            );
            assert!(
                glm::check_file(&mesh).is_ok(),
                "a conversion gives a valid mesh"
            );
            Verdict::Accepted
        }
        Err(_) => Verdict::Rejected,
    }
}

/// Replays a parsed log with every option enabled: by its time stamps, and with two fixed sample periods.
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
        assert!(
            replayed.is_ok_and(|replayed| replayed.attitudes.len() == entries.len()),
            "without a calibration every log is replayed"
        );
        // A calibration fails for a log that is not at rest, so the result may be an error.
        let _ = replay(&replay::Options {
            still: Some(u64::MAX),
            ..options
        });
    }
}

/// Parses a scene file. Every line of an accepted file must be a command.
fn run_scene(input: &[u8]) -> Verdict {
    let scene = std::str::from_utf8(input).ok();
    match scene.and_then(|text| SceneFile::parse("scene", "scene.toml", text).ok()) {
        Some(scene) => {
            let is_command = |line: &str| matches!(Command::parse(line), Ok(Some(_)));
            assert!(scene.lines().all(is_command), "every line is a command");
            assert!(!scene.needs().options().is_empty());
            Verdict::Accepted
        }
        None => Verdict::Rejected,
    }
}

/// Replays a log in a board's format. The attitudes of an accepted log must have length 1.
fn run_image(input: &[u8]) -> Verdict {
    let mut image = input.to_vec();
    match image::replay(&mut image) {
        Ok(counts) => {
            let mut records = image[image::HEADER_BYTES..].as_chunks().0.iter();
            assert!(counts.steps < records.len() as u64);
            assert!(
                records.all(|record| image::attitude(image::from_bytes(record)).is_some()),
                "every attitude has length 1"
            );
            Verdict::Accepted
        }
        Err(error) => {
            assert!(!error.to_string().contains('\n'));
            assert_eq!(image, input, "a rejected log stays unchanged");
            Verdict::Rejected
        }
    }
}

/// Parses a program, and transforms and projects its segments.
fn run_program(form: Form, input: &[u8]) -> Verdict {
    let Ok(bytes) = wireframe::parse(form, input.to_vec()) else {
        return Verdict::Rejected;
    };
    let program = wireframe::check(&bytes);
    assert!(program.is_ok(), "a parsed program is valid");
    let Ok(program) = program else {
        return Verdict::Rejected;
    };
    let mut motion = Motion::default();
    for (number, key) in Key::ALL.into_iter().cycle().take(20).enumerate() {
        motion.apply(key.step(number % 3 > 0));
    }
    let lines: String = program
        .instructions()
        .map(|line| format!("{line}\n"))
        .collect();
    assert!(assemble(&lines).is_ok(), "the text form is valid too");
    let (pose, projection) = (
        motion.pose(),
        Projection::new(program.viewing(), Size::W1280),
    );
    for segment in program.segments() {
        if let Some(line) = projection.line(pose.segment(segment)) {
            let ends = line.as_flattened();
            assert!(
                ends.iter().all(|x| x.abs() <= GUARD),
                "a line is within the guard band"
            );
        }
    }
    Verdict::Accepted
}

/// Renders a mesh if it is valid.
fn run_model(mesh: &[u8]) {
    let (Ok(mesh_view), Ok(view)) = (glm::check(mesh), crate::view::spherical("2,30,60")) else {
        return;
    };
    let vertices = mesh_view
        .chunks()
        .map(|chunk| chunk.vertex_count())
        .max()
        .unwrap_or(0);
    let mut scratch = vec![glint_model::Projected::Behind; vertices];
    let (width, height) = glint_model::SIZES[0];
    let pixels = (width * height) as usize;
    let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let mut target = glint_model::FrameBuffer {
        width,
        height,
        colour: &mut colour,
        depth: &mut depth,
    };
    let rendered = glint_model::triangle::render(
        &mesh_view,
        &view,
        &mut target,
        &mut scratch,
        &glint_model::Options::default(),
    );
    assert!(
        rendered.is_ok(),
        "a checked mesh and a checked camera are rendered"
    );
}

fn run_console(input: &[u8]) -> Verdict {
    let mut editor = LineEditor::new();
    let (mut echo, mut text) = (String::new(), String::new());
    let mut verdict = Verdict::Rejected;
    for &byte in input {
        if let Event::Line(line) = editor.on_byte(byte, &mut echo) {
            use std::fmt::Write;
            match Command::parse(line) {
                Ok(Some(Command::Help { command })) => {
                    // Writing to a string cannot fail.
                    let _ = write_help(&mut text, command);
                }
                Ok(_) => verdict = Verdict::Accepted,
                Err(error) => {
                    let _ = write!(text, "{error}");
                    assert!(
                        !text.contains(['\r', '\n']),
                        "an error is one line: {text:?}"
                    );
                }
            }
            text.clear();
        }
        assert!(
            echo.len() < 4096 && echo.is_ascii(),
            "a byte echoes less than a screen of ASCII: {echo:?}"
        );
        echo.clear();
    }
    verdict
}
