//! `cargo xtask walk`: tests builds of the virtual board with only some blocks, each with its own firmware.
//!
//! A build is for a scene, or has a single optional block. Each board must start and answer `info`
//! with its blocks. The build for a scene draws the scene with its own firmware: the picture must equal that of the complete build
//! (all blocks, all parts of the firmware), in no more cycles. The scene's firmware must refuse the commands of all other parts,
//! and depths if the gateware has no depth buffer. Without a host, the BIOS of this build, on the emulated board, must start the
//! firmware with all parts from an image with the scene in the flash.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::slice;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use glint_core::block::Block;
use glint_core::feature::{self, Feature};
use glint_scene_file::SceneFile;
use serde::Deserialize;

use crate::gateware::{self, Board, Library};
use crate::{bootstrap, firmware, paths, run, scenes};

/// Longest time from power-up to the firmware's prompt. The BIOS waits for a host for 20 million cycles.
const POWER_UP: Duration = Duration::from_secs(60);

/// Prompts of the firmware and of the BIOS.
const PROMPT: &str = "glint> ";
const BIOS_PROMPT: &str = "litex";

/// Prefix of the name of a build with a single block.
const ONLY: &str = "only-";

/// The builds of `cargo xtask test`, one of each kind: for a scene, and with a single block.
pub const SAMPLE: [&str; 2] = ["wireframe", "only-gesture"];

/// One command of each part of the firmware that has commands. Without `FIELD`, `field sphere:1` is refused before `SPHERES` is checked, and
/// without `VIEW`, `background sky` before `SKY`.
const COMMANDS: [(Feature, &str); 23] = [
    (feature::VIEW, "camera 3 0 90"),
    (feature::MESH, "cull on"),
    (feature::OBJECT, "object"),
    (feature::TEXTURE, "textures on"),
    (feature::SKY, "background sky"),
    (feature::EDGES, "edges"),
    (feature::WIREFRAME, "program"),
    (feature::FIT, "fit"),
    (feature::FIELD, "field"),
    (feature::SPHERES, "field sphere:1"),
    (feature::STEREO, "stereo"),
    (feature::ANTIALIASING, "aa 4"),
    (feature::FOG, "fog"),
    (feature::MESH_IN_FIELD, "mesh"),
    (feature::LIGHT, "light"),
    (feature::ANIMATE, "animate"),
    (feature::IMU, "imu"),
    (feature::REPLAY, "replay"),
    (feature::GESTURE, "gesture"),
    (feature::UPLOAD, "models"),
    (feature::OVERLAY, "overlay"),
    (feature::DEMO, "demo"),
    (feature::BENCH, "bench"),
];

/// The compared statistics of a frame, from `glint render --stats`.
#[derive(Deserialize)]
struct Stats {
    cycles: u64,
}

/// A build of the virtual board.
struct Build {
    name: String,
    /// Folder of the verilated SoC.
    folder: PathBuf,
    /// The firmware's image.
    firmware: PathBuf,
}

/// A frame drawn by a build.
struct Frame {
    png: Vec<u8>,
    cycles: u64,
}

/// Sets up, and tests the builds `names`, or all builds if `names` is empty: names of scenes, and `only-BLOCK`.
///
/// # Errors
/// Those of [`walk`].
pub fn set_up_and_walk(names: &[String]) -> Result<()> {
    bootstrap::bootstrap()?;
    firmware::build(Board::Virtual, &[])?;
    run::build_program("glint", "glint")?;
    walk(names)
}

/// Tests builds, after `glint` and the firmware with all parts are built.
///
/// # Errors
/// A name is unknown, a build fails, a board does not answer or does not refuse a command of a missing part, its picture differs from the
/// complete build's, or it takes more cycles.
pub fn walk(names: &[String]) -> Result<()> {
    let all: Vec<SceneFile> = scenes::all().collect();
    let everything = || all.iter().map(SceneFile::name).map(str::to_owned);
    let subsets = || Block::ALL.map(|block| format!("{ONLY}{}", block.name()));
    let names = match names {
        [] => everything().chain(subsets()).collect(),
        names => names.to_vec(),
    };
    let complete = Build::complete()?;
    let mut lines = Vec::new();
    for name in &names {
        let line = if let Some(block) = name.strip_prefix(ONLY) {
            subset(block)
        } else if let Some(scene) = all.iter().find(|scene| scene.name() == name) {
            of_scene(scene, &complete)
        } else {
            let known: Vec<_> = everything().chain(subsets()).collect();
            bail!("{name}: expected {}", known.join(", "));
        };
        run::print_progress(&format!("  {}", line.as_ref().map_or("FAIL", |line| line)));
        lines.push(line.with_context(|| format!("the build {name}")));
    }
    let failures: Vec<_> = lines
        .iter()
        .filter_map(|line| line.as_ref().err())
        .collect();
    let failures: Vec<_> = failures.iter().map(|error| format!("{error:#}")).collect();
    ensure!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}

/// Runs the build with a single block, with the complete firmware. Returns the result as one line for the log.
fn subset(name: &str) -> Result<String> {
    let block = Block::ALL.into_iter().find(|block| block.name() == name);
    let Some(block) = block else {
        bail!("no block {name}: expected {}", Block::NAMES.join(", "));
    };
    Build::single(&format!("{ONLY}{name}"), block)?.answers(&[block])?;
    Ok(format!("{ONLY}{name}: answers"))
}

/// Draws a scene's picture on its own build and on the `complete` build. Returns the result as one line for the log.
fn of_scene(scene: &SceneFile, complete: &Build) -> Result<String> {
    let own = Build::of_scene(scene)?;
    let blocks = Board::Virtual.needs(slice::from_ref(scene)).blocks;
    own.answers(&blocks.into_iter().collect::<Vec<_>>())?;
    own.refuses_others(scene)?;
    if scene.needs().features.contains(&feature::WIREFRAME) {
        own.draws_other_programs()?;
    }
    own.runs_alone(scene)?;
    let [own, reference] = [own.draw(scene)?, complete.draw(scene)?];
    ensure!(
        own.png == reference.png,
        "the picture differs from that of the complete build"
    );
    ensure!(
        own.cycles <= reference.cycles,
        "a frame takes {} cycles: expected at most {}, as on the complete build",
        own.cycles,
        reference.cycles
    );
    Ok(format!(
        "{}: same picture, {} cycles; {} on the complete build",
        scene.name(),
        own.cycles,
        reference.cycles
    ))
}

/// A child process, killed on drop.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Reads a board's serial port up to the first prompt, or until the time `end`.
fn said_at_power_up(port: &Path, end: Instant) -> Result<String> {
    let mut line = File::open(port).with_context(|| format!("opening {}", port.display()))?;
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut bytes = [0; 4096];
        while let Ok(length @ 1..) = line.read(&mut bytes) {
            if sender.send(bytes[..length].to_vec()).is_err() {
                return;
            }
        }
    });
    let mut said = Vec::new();
    loop {
        let text = String::from_utf8_lossy(&said);
        if [PROMPT, BIOS_PROMPT]
            .iter()
            .any(|prompt| text.contains(prompt))
        {
            return Ok(text.into_owned());
        }
        let rest = end.saturating_duration_since(Instant::now());
        match receiver.recv_timeout(rest) {
            Ok(bytes) => said.extend(bytes),
            Err(_) => return Ok(text.into_owned()),
        }
    }
}

/// The program `glint` with these arguments.
fn glint(arguments: &[&str]) -> Command {
    let mut command = Command::new(paths::target().join("debug/glint"));
    command.args(arguments).current_dir(paths::root());
    command
}

/// The folder of pictures and images.
fn folder() -> Result<PathBuf> {
    let folder = paths::target().join("walk");
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    Ok(folder)
}

/// Path of a firmware's image in `target`.
fn firmware_image(name: &str) -> PathBuf {
    paths::target()
        .join("firmware")
        .join(name)
        .with_extension("bin")
}

impl Build {
    /// The build with all blocks and all parts of the firmware.
    fn complete() -> Result<Self> {
        gateware::build(Board::Virtual)?;
        Ok(Self {
            name: "complete".to_owned(),
            folder: Board::Virtual.folder(),
            firmware: firmware_image("glint"),
        })
    }

    /// Builds the virtual board with this block alone. Its firmware has all parts.
    fn single(name: &str, block: Block) -> Result<Self> {
        let options = ["--blocks", block.name()];
        Ok(Self {
            name: name.to_owned(),
            folder: gateware::build_beside(name, &options, Library::Quick)?,
            firmware: firmware_image("glint"),
        })
    }

    /// Builds the virtual board and the firmware for a scene.
    fn of_scene(scene: &SceneFile) -> Result<Self> {
        let name = scene.name();
        let options = Board::Virtual.needs(slice::from_ref(scene)).options();
        let options: Vec<_> = options.iter().map(String::as_str).collect();
        firmware::build_for(Board::Virtual, slice::from_ref(scene), &[])?;
        Ok(Self {
            name: name.to_owned(),
            folder: gateware::build_beside(name, &options, Library::Quick)?,
            firmware: firmware_image(&format!("glint-{name}")),
        })
    }

    /// Fails unless `info` lists exactly these blocks.
    fn answers(&self, blocks: &[Block]) -> Result<()> {
        let bits: u32 = blocks.iter().map(|block| block.bit()).sum();
        let expected = format!("blocks {bits:#x}");
        let mut reply = Vec::new();
        run::watched_step(
            &format!("info of {}", self.name),
            self.glint(&["console"])
                .args(["virtual", "--send", "info blocks"]),
            |line| reply.push(line.to_owned()),
        )?;
        ensure!(
            reply.iter().any(|line| line.trim() == expected),
            "expected `{expected}` from `info blocks`, got {:?}",
            reply.join("\n")
        );
        Ok(())
    }

    /// Fails unless the firmware, on the emulated board, refuses the commands of each part that the scene does not need, and
    /// depths if the gateware has no depth buffer.
    fn refuses_others(&self, scene: &SceneFile) -> Result<()> {
        let needs = scene.needs().features;
        for (part, command) in COMMANDS {
            let command_part = match part {
                feature::SPHERES => feature::FIELD,
                feature::SKY => feature::VIEW,
                part => part,
            };
            let is_reached = command_part == part || needs.contains(&command_part);
            if needs.contains(&part) || !is_reached {
                continue;
            }
            let expected = format!("lacks the feature {},", part.name);
            self.refuses("emulated", &[command], &expected)?;
        }
        if !scene.needs().depths {
            let show = format!("scene {}", scene.name());
            let commands = [&show, "size 320 180", "aa 1", "render depth"];
            self.refuses("virtual", &commands, "this gateware has no depth buffer")?;
        }
        Ok(())
    }

    /// Fails unless a board refuses the last of these commands with an error that contains `expected`.
    fn refuses(&self, board: &str, commands: &[&str], expected: &str) -> Result<()> {
        let sends = commands.iter().flat_map(|command| ["--send", command]);
        let output = self.glint(&["console", board]).args(sends).output()?;
        let error = String::from_utf8_lossy(&output.stderr);
        ensure!(
            !output.status.success() && error.contains(expected),
            "{}: expected the error `{expected}`, got {error:?}",
            commands.join(", ")
        );
        Ok(())
    }

    /// Fails unless the firmware, on the emulated board, accepts an uploaded wireframe program and draws it.
    fn draws_other_programs(&self) -> Result<()> {
        let folder = folder()?;
        let program = folder.join("ball.wfb");
        run::step(
            "wireframe program",
            glint(&["wireframe", "make", "icosphere:2", "--force", "--out"]).arg(&program),
        )?;
        let [own, expected] = ["board", "model"].map(|by| folder.join(format!("ball-{by}.png")));
        let render = ["wireframe", "render", "--force"];
        run::step(
            "wireframe program by the model",
            glint(&render).arg(&program).arg("--out").arg(&expected),
        )?;
        run::step(
            &format!("wireframe program by the firmware of {}", self.name),
            self.glint(&render)
                .arg(&program)
                .args(["--board", "emulated", "--out"])
                .arg(&own),
        )?;
        ensure!(
            fs::read(&own)? == fs::read(&expected)?,
            "the picture of an uploaded wireframe program differs from the model's"
        );
        Ok(())
    }

    /// Fails unless the BIOS of the build, on the emulated board, starts the complete firmware from a flash image with the scene, without an
    /// error.
    fn runs_alone(&self, scene: &SceneFile) -> Result<()> {
        let folder = folder()?;
        let [image, port] =
            ["bin", "port"].map(|kind| folder.join(scene.name()).with_extension(kind));
        run::step(
            &format!("image of {}", scene.name()),
            glint(&["image", "make", "--force", "--scene", scene.name()])
                .arg("--firmware")
                .arg(firmware_image("glint"))
                .arg("--out")
                .arg(&image),
        )?;
        let start = Instant::now();
        let mut board = glint(&["board", "--board", "emulated", "--flash"]);
        board
            .arg(&image)
            .arg("--ready-file")
            .arg(&port)
            .env("GLINT_VIRTUAL_BOARD", &self.folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        let _ = fs::remove_file(&port);
        let _board = Running(board.spawn().context("starting `glint board`")?);
        let port = loop {
            match fs::read_to_string(&port) {
                Ok(path) if path.ends_with('\n') => break path,
                _ => ensure!(start.elapsed() < POWER_UP, "`glint board` is not ready"),
            }
            thread::sleep(Duration::from_millis(20));
        };
        let said = said_at_power_up(Path::new(port.trim_end()), start + POWER_UP)?;
        ensure!(
            said.contains(PROMPT) && !said.contains("error"),
            "expected the firmware from the flash, got {said:?}"
        );
        Ok(())
    }

    /// Draws the scene's picture.
    fn draw(&self, scene: &SceneFile) -> Result<Frame> {
        let picture = folder()?.join(format!("{}-{}.png", scene.name(), self.name));
        let stats = picture.with_extension("json");
        run::step(
            &format!("frame of {} on {}", scene.name(), self.name),
            self.glint(&["render", "--board", "virtual", "--scene", scene.name()])
                .args(["--force", "--stats"])
                .arg(&stats)
                .arg("--out")
                .arg(&picture),
        )?;
        let read =
            |path: &Path| fs::read(path).with_context(|| format!("reading {}", path.display()));
        let found: Stats = serde_json::from_slice(&read(&stats)?)?;
        Ok(Frame {
            png: read(&picture)?,
            cycles: found.cycles,
        })
    }

    /// `glint` with these arguments, on boards of this build with its firmware.
    fn glint(&self, arguments: &[&str]) -> Command {
        let mut command = glint(arguments);
        command
            .arg("--firmware")
            .arg(&self.firmware)
            .env("GLINT_VIRTUAL_BOARD", &self.folder);
        command
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_build_is_an_error_that_names_the_known_ones() {
        let error = subset("lamp").err().map(|error| error.to_string());
        let expected = format!("no block lamp: expected {}", Block::NAMES.join(", "));
        assert_eq!(error, Some(expected));
    }

    #[test]
    fn every_part_but_those_of_the_soft_core_has_a_command() {
        let parts = COMMANDS.map(|(part, _)| part);
        for part in feature::ALL {
            let has_none = [feature::CPU, feature::CLIPPING].contains(&part);
            assert_eq!(parts.contains(&part), !has_none, "{}", part.name);
        }
    }

    #[test]
    fn the_sample_has_builds_of_scenes_and_of_blocks() {
        for name in SAMPLE {
            let is_known = match name.strip_prefix(ONLY) {
                Some(block) => Block::NAMES.contains(&block),
                None => glint_scene_file::NAMES.contains(&name),
            };
            assert!(is_known, "{name}");
        }
    }
}
