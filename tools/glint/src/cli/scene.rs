//! `glint scene`.

use super::messages::{note, print_json, say, warn};
use anyhow::Context;
use clap::{Args, Subcommand};
use glint::scene::{self, Changes};
use glint::wireframe::{self, Source};
use glint_scene_file::{NAMES, SceneError, SceneFile, Steer, built_in};
use serde::Serialize;

/// Check, list or show scenes: their contents, and the gateware and firmware that they require (docs/scenes.md).
#[derive(Subcommand)]
pub enum SceneCommand {
    /// Check scene files with their meshes, fields and cameras.
    Check(CheckArguments),
    /// List the built-in scenes.
    List(ListArguments),
    /// Show the console commands of a scene, and the gateware and firmware that it requires.
    Show(ShowArguments),
}

#[derive(Args)]
pub struct CheckArguments {
    /// Scene files, names of built-in scenes, or `-` for standard input.
    #[arg(required = true, value_name = "NAME|FILE.toml")]
    scenes: Vec<String>,
    /// Print the names of the valid scenes as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
pub struct ListArguments {
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
pub struct ShowArguments {
    /// A scene file, the name of a built-in scene, or `-` for standard input.
    #[arg(value_name = "NAME|FILE.toml")]
    scene: String,
    /// Print the scene as JSON.
    #[arg(long)]
    json: bool,
}

/// A built-in scene.
#[derive(Serialize)]
struct Listed<'a> {
    name: &'a str,
    title: &'a str,
}

/// Contents and requirements of a scene.
#[derive(Serialize)]
struct Shown<'a> {
    name: &'a str,
    title: &'a str,
    /// Names of the scenes of a list.
    scenes: Vec<&'a str>,
    /// Console commands.
    settings: &'a [String],
    /// The command or input that moves the camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    steer: Option<&'a str>,
    /// Options of `cargo xtask gateware`.
    gateware: Vec<String>,
    /// Parts of the firmware.
    firmware: Vec<&'static str>,
    budget: Vec<Limit>,
}

/// A limit of a scene's budget.
#[derive(Serialize)]
struct Limit {
    name: &'static str,
    limit: f64,
}

impl SceneCommand {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Check(arguments) => arguments.run(),
            Self::List(arguments) => arguments.run(),
            Self::Show(arguments) => {
                let scene = read(&arguments.scene)?;
                let shown = Shown::of(&scene);
                if arguments.json {
                    return print_json(&shown);
                }
                shown.say()
            }
        }
    }
}

impl CheckArguments {
    fn run(&self) -> anyhow::Result<()> {
        for name in &self.scenes {
            check(name)?;
            if !self.json {
                say(format_args!("{name}: valid"))?;
            }
        }
        if self.json {
            return print_json(&self.scenes);
        }
        Ok(())
    }
}

impl ListArguments {
    fn run(&self) -> anyhow::Result<()> {
        let scenes: Vec<SceneFile> = NAMES.into_iter().filter_map(built_in).collect();
        let listed = scenes.iter().map(|scene| Listed {
            name: scene.name(),
            title: scene.title(),
        });
        if self.json {
            return print_json(&listed.collect::<Vec<_>>());
        }
        for Listed { name, title } in listed {
            say(format_args!("{name:14} {title}"))?;
        }
        Ok(())
    }
}

/// Reads a scene by its name or path, prints its notes, and warns of data after the end of its wireframe program.
///
/// # Errors
/// As for [`glint_scene_file::read`].
pub fn read(name: &str) -> Result<SceneFile, SceneError> {
    let scene = glint_scene_file::read(name)?;
    for text in scene.notes() {
        note(format_args!("{}: {text}", name.escape_debug()));
    }
    if let Some(program) = scene.program() {
        let path = scene.folder().join(program);
        // Errors are reported when the scene is used.
        if let Ok(Source {
            ignored: Some(ignored),
            ..
        }) = wireframe::read(&path)
        {
            warn(format_args!("{}: {ignored}", path.display()));
        }
    }
    Ok(scene)
}

/// Checks that a board can draw a scene.
fn check(name: &str) -> anyhow::Result<()> {
    let drawable = scene::draw(&read(name)?, &Changes::default(), |frame| {
        frame
            .drawn()?
            .try_for_each(|frame| frame.constants().map(|_| ()))
    })?;
    drawable.with_context(|| name.to_owned())
}

impl<'a> Shown<'a> {
    fn of(scene: &'a SceneFile) -> Self {
        let is_list = !scene.scenes().is_empty();
        let steer = match scene.steer() {
            _ if is_list => None,
            Steer::Fixed => None,
            Steer::Buttons => Some("buttons"),
            Steer::Command(command) => Some(command.as_str()),
        };
        let needs = scene.needs();
        let clock = scene.clock().into_iter();
        let clock = clock.flat_map(|clock| ["--clock".to_owned(), clock.to_string()]);
        let budget = scene.budget().iter();
        Self {
            name: scene.name(),
            title: scene.title(),
            scenes: scene.scenes().iter().map(SceneFile::name).collect(),
            settings: if is_list { &[] } else { scene.settings() },
            steer,
            gateware: needs.options().into_iter().chain(clock).collect(),
            firmware: needs.features.iter().map(|feature| feature.name).collect(),
            budget: budget.map(|&(name, limit)| Limit { name, limit }).collect(),
        }
    }

    fn say(&self) -> anyhow::Result<()> {
        say(self.title)?;
        for name in &self.scenes {
            say(format_args!("scene     {name}"))?;
        }
        for line in self.settings {
            say(format_args!("setting   {line}"))?;
        }
        if let Some(steer) = self.steer {
            say(format_args!("steer     {steer}"))?;
        }
        say(format_args!("gateware  {}", self.gateware.join(" ")))?;
        say(format_args!("firmware  {}", self.firmware.join(",")))?;
        for Limit { name, limit } in &self.budget {
            say(format_args!("budget    {name} {limit}"))?;
        }
        Ok(())
    }
}
