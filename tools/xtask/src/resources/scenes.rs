//! `cargo xtask resources --scenes`: the builds for the built-in scenes, gateware and firmware, and their frames.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::slice;

use anyhow::{Context, Result};
use glint_scene_file::{Needs, SceneFile};
use serde_json::{Map, Value, json};

use crate::firmware::Image;
use crate::gateware::{self, Board, Library};
use crate::{firmware, paths, run, scenes};

/// Name of the build for all scenes.
const ALL: &str = "all";

/// Makes a build for each scene and one for all scenes, and draws the frames on the virtual board. Returns the path of a file for
/// `gateware/resources/scenes.py`, which describes builds and frames.
///
/// # Errors
/// A build fails.
pub fn build() -> Result<PathBuf> {
    let scenes: Vec<SceneFile> = scenes::all().collect();
    let mut builds = vec![(ALL, None, Needs::of(&scenes).options())];
    builds.extend(
        scenes
            .iter()
            .map(|scene| (scene.name(), Some(scene), scene.needs().options())),
    );
    for (name, _, options) in &builds {
        gateware::generate_beside(Board::Urbana, name, &words(options))?;
    }
    let ulx3s = gateware::ulx3s_cells(ALL, &words(&Board::Ulx3s.needs(&scenes).options()))?;
    gateware::build(Board::Virtual)?;
    let full = firmware::build(Board::Virtual, &[])?;
    run::build_program("glint", "glint")?;
    let builds = builds.into_iter().map(|(name, scene, options)| {
        let budget = scene.map(SceneFile::budget).unwrap_or_default();
        let budget: Map<String, Value> = budget
            .iter()
            .map(|(limit, value)| ((*limit).to_owned(), json!(value)))
            .collect();
        Ok(json!({
            "name": name,
            "options": options,
            "is_single": scene.is_some_and(|scene| scene.scenes().is_empty()),
            "firmware": firmware(&scenes, scene)?,
            "frame": scene.map(frame).transpose()?,
            "budget": budget,
        }))
    });
    let builds = builds.collect::<Result<Vec<_>>>()?;
    let path = folder()?.join("builds.json");
    let text = json!({"full": full.length, "ulx3s": ulx3s, "builds": builds}).to_string();
    fs::write(&path, text).with_context(|| format!("writing {}", path.display()))?;
    Ok(path)
}

fn words(options: &[String]) -> Vec<&str> {
    options.iter().map(String::as_str).collect()
}

/// The folder of the frames.
fn folder() -> Result<PathBuf> {
    let folder = paths::target().join("scenes");
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    Ok(folder)
}

/// Builds the firmware for a scene, or for all `scenes` without one, and measures the stack on the emulated board.
fn firmware(scenes: &[SceneFile], scene: Option<&SceneFile>) -> Result<Value> {
    let built = scene.map_or(scenes, slice::from_ref);
    let image = firmware::build_for(Board::Urbana, built, &[])?;
    let stack = scene.map(|scene| stack(scene, &image)).transpose()?;
    Ok(json!({
        "length": image.length, "code": image.code, "constants": image.constants, "variables": image.variables, "stack": stack,
    }))
}

/// Measures the stack that the firmware uses for the self-test and the scene's picture.
fn stack(scene: &SceneFile, image: &Image) -> Result<u64> {
    let name = scene.name();
    let binary = paths::target().join(format!("firmware/glint-{name}.bin"));
    let mut last = String::new();
    run::watched_step(
        &format!("stack of {name}"),
        Command::new("cargo")
            .args(["run", "--quiet", "--package", "emulated-board"])
            .args(["--example", "stack", "--"])
            .arg(binary)
            .args([image.stack.start, image.stack.end].map(|address| address.to_string()))
            .args(["selftest", &format!("scene {name}"), "render"])
            .current_dir(paths::root()),
        |line| line.clone_into(&mut last),
    )?;
    let bytes = last.trim().parse();
    bytes.with_context(|| format!("the stack of {name}: expected a number of bytes, got {last:?}"))
}

/// Draws a scene's frame on the virtual board with all blocks. This board has no smooth shading and no textures, so a scene with either is
/// drawn by its own build. Returns the statistics of the frame and its number of pixels.
fn frame(scene: &SceneFile) -> Result<Value> {
    let name = scene.name();
    let needs = scene.needs();
    let board = if needs.smooth || needs.texture {
        gateware::build_beside(name, &words(&needs.options()), Library::Quick)?
    } else {
        Board::Virtual.folder()
    };
    let stats = folder()?.join(name).with_extension("json");
    run::step(
        &format!("frame of {name}"),
        Command::new(paths::target().join("debug/glint"))
            .args(["render", "--force", "--board", "virtual", "--scene", name])
            .arg("--stats")
            .arg(&stats)
            .arg("--out")
            .arg(stats.with_extension("png"))
            .env("GLINT_VIRTUAL_BOARD", board)
            .current_dir(paths::root()),
    )?;
    let text =
        fs::read_to_string(&stats).with_context(|| format!("reading {}", stats.display()))?;
    let mut frame: Value = serde_json::from_str(&text)?;
    frame["pixels"] = scene.size().pixel_count().into();
    Ok(frame)
}
