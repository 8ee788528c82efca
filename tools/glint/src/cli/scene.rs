//! `glint scene`.

use super::messages::say;
use anyhow::Context;
use clap::{Args, Subcommand};
use glint::scene::{self, Changes};
use glint_scene_file::{NAMES, SceneFile, Steer, built_in, read};

/// Check, list or show scenes: their contents, and the gateware and firmware that they require (docs/scenes.md).
#[derive(Subcommand)]
pub enum SceneCommand {
    /// Check scene files with their meshes, fields and cameras.
    Check(CheckArguments),
    /// List the built-in scenes.
    List,
    /// Show the console commands of a scene, and the gateware and firmware that it requires.
    Show(ShowArguments),
}

#[derive(Args)]
pub struct CheckArguments {
    /// Scene files, names of built-in scenes, or `-` for standard input.
    #[arg(required = true, value_name = "NAME|FILE.toml")]
    scenes: Vec<String>,
}

#[derive(Args)]
pub struct ShowArguments {
    /// A scene file, the name of a built-in scene, or `-` for standard input.
    #[arg(value_name = "NAME|FILE.toml")]
    scene: String,
}

impl SceneCommand {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Check(arguments) => arguments.scenes.iter().try_for_each(|name| check(name)),
            Self::List => NAMES
                .into_iter()
                .filter_map(built_in)
                .try_for_each(|scene| say(format_args!("{:14} {}", scene.name(), scene.title()))),
            Self::Show(arguments) => show(&read(&arguments.scene)?),
        }
    }
}

fn check(name: &str) -> anyhow::Result<()> {
    let drawable = scene::draw(&read(name)?, &Changes::default(), |frame| {
        frame
            .drawn()?
            .try_for_each(|frame| frame.constants().map(|_| ()))
    })?;
    drawable.with_context(|| name.to_owned())?;
    say(format_args!("{name}: valid"))
}

fn show(scene: &SceneFile) -> anyhow::Result<()> {
    say(scene.title())?;
    for part in scene.scenes() {
        say(format_args!("scene     {}", part.name()))?;
    }
    if scene.scenes().is_empty() {
        for line in scene.settings() {
            say(format_args!("setting   {line}"))?;
        }
        match scene.steer() {
            Steer::Fixed => {}
            Steer::Buttons => say("steer     buttons")?,
            Steer::Command(command) => say(format_args!("steer     {command}"))?,
        }
    }
    let needs = scene.needs();
    let mut options = needs.options();
    options.extend(
        scene
            .clock()
            .into_iter()
            .flat_map(|clock| ["--clock".to_owned(), clock.to_string()]),
    );
    say(format_args!("gateware  {}", options.join(" ")))?;
    let features: Vec<_> = needs.features.iter().map(|feature| feature.name).collect();
    say(format_args!("firmware  {}", features.join(",")))?;
    for (name, limit) in scene.budget() {
        say(format_args!("budget    {name} {limit}"))?;
    }
    Ok(())
}
