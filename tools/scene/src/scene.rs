//! A scene.

use std::ops::Range;

use glint_core::console::{Command, GestureAction, ImuAction, LINE_MAX};
use glint_core::picture::Size;
use glint_core::quality::Quality;

use crate::built_in::{NAMES, TEXTS};
use crate::error::{SceneError, Source, quote};
use crate::file::File;
use crate::keys::{BUDGET, COMMANDS, Key};

/// What moves the camera, or the segments of a wireframe program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Steer {
    /// Nothing moves the camera.
    #[default]
    Fixed,
    /// The buttons, which are the keys of a wireframe program.
    Buttons,
    /// The console command that starts it: `orbit`, `imu look`, `imu orbit`, `gesture on` or `gesture vga`.
    Command(String),
}

/// Limits of a build for the scene alone, and of its frames: names of [`BUDGET`] with their numbers.
pub type Budget = Vec<(&'static str, f64)>;

/// A scene.
#[derive(Clone, Debug)]
pub struct Scene {
    name: String,
    title: String,
    /// Console commands that set the picture.
    settings: Vec<String>,
    steer: Steer,
    /// The scenes of a list of scenes, instead of settings.
    scenes: Vec<Scene>,
    /// Whether depth codes are requested in addition to the colours.
    pub(crate) depth: bool,
    pub(crate) lanes: Option<u8>,
    clock: Option<f64>,
    budget: Budget,
}

impl Scene {
    /// Parses the text of a scene file. `name` is the scene's name, and `file` the file's name in messages.
    ///
    /// # Errors
    /// The first violation of the format.
    pub fn parse(name: &str, file: &str, text: &str) -> Result<Self, SceneError> {
        Self::parse_as(name, Source { file, text }, true)
    }

    /// Parses the text of a scene file, which may be a list of scenes or not.
    fn parse_as(name: &str, source: Source, may_be_list: bool) -> Result<Self, SceneError> {
        let file = File::read(source)?;
        if let (Some(value), false) = (file.get("scenes"), may_be_list) {
            return Err(file.refuse("scenes", value, "a picture"));
        }
        let title = file.text("title")?;
        let title = title.ok_or_else(|| {
            file.source
                .whole("no title: expected the key title, one line about the scene")
        })?;
        let scenes = file.texts("scenes")?;
        let mut scene = Self {
            name: name.to_owned(),
            title: title.split_whitespace().collect::<Vec<_>>().join(" "),
            settings: Vec::new(),
            steer: Steer::default(),
            scenes: scenes
                .into_iter()
                .map(|(name, span)| member(&file, name, &span))
                .collect::<Result<_, _>>()?,
            depth: file.switch("depth")?.unwrap_or(false),
            lanes: lanes(&file)?,
            clock: file.number("clock")?,
            budget: file.numbers("budget", &BUDGET)?,
        };
        if file.has("scenes") {
            check_list(&file, &scene.scenes)?;
            return Ok(scene);
        }
        check_subject(&file)?;
        if !file.has("quality") && !file.has("size") {
            scene
                .settings
                .push(format!("quality {}", Quality::default()));
        }
        for key in &COMMANDS {
            let Some(value) = file.get(key.name) else {
                continue;
            };
            check_others(&file, key)?;
            if key.name == "field" && file.has("model") {
                scene.settings.push("mesh on".to_owned());
            }
            for (words, span) in file.words(key.name, value, key.is_list)? {
                let line = if key.name == "program" {
                    if words != "cube" {
                        return Err(file.refuse(key.name, value, "`cube`, the built-in program"));
                    }
                    key.command.to_owned()
                } else {
                    format!("{} {words}", key.command)
                };
                check_line(&file, key.name, &words, &line, &span)?;
                scene.settings.push(line);
            }
        }
        let lights = scene
            .settings
            .iter()
            .filter(|line| line.starts_with("light "));
        if let (Some(value), true, false) =
            (file.get("light"), lights.count() > 1, file.has("field"))
        {
            return Err(file.refuse("light", value, "one light on meshes"));
        }
        scene.steer = steer(&file)?;
        Ok(scene)
    }

    /// The name of the scene.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One line about the scene.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The scenes of a list of scenes; empty for a scene with a picture of its own.
    pub fn scenes(&self) -> &[Self] {
        &self.scenes
    }

    /// The console commands that set the picture; of a list of scenes, those of the first one.
    pub fn settings(&self) -> &[String] {
        self.scenes.first().map_or(&self.settings, Self::settings)
    }

    /// What moves the camera; of a list of scenes, that of the first one.
    pub fn steer(&self) -> &Steer {
        self.scenes.first().map_or(&self.steer, Self::steer)
    }

    /// All console commands: those of the picture, and the one that starts what moves the camera.
    pub fn lines(&self) -> impl Iterator<Item = &str> {
        let steer = match self.steer() {
            Steer::Command(command) => Some(command.as_str()),
            Steer::Fixed | Steer::Buttons => None,
        };
        self.settings().iter().map(String::as_str).chain(steer)
    }

    /// The console commands that set the picture, parsed.
    pub fn commands(&self) -> impl Iterator<Item = Command<'_>> {
        let lines = self.settings().iter();
        // The lines have been checked.
        lines.filter_map(|line| Command::parse(line).ok().flatten())
    }

    /// The size of the picture; that at start if the scene sets none.
    pub fn size(&self) -> Size {
        let size = |command| match command {
            Command::Quality {
                quality: Some(quality),
            } => Some(quality.size()),
            Command::Size { size } => Some(size),
            _ => None,
        };
        self.commands().filter_map(size).last().unwrap_or_default()
    }

    /// Frequency of the system clock in MHz; `None` for that of the board.
    pub const fn clock(&self) -> Option<f64> {
        self.clock
    }

    /// The limits of the build for this scene alone.
    pub fn budget(&self) -> &[(&'static str, f64)] {
        &self.budget
    }
}

/// A scene of a list of scenes: a built-in one with a picture of its own.
fn member(file: &File, name: &str, span: &Range<usize>) -> Result<Scene, SceneError> {
    let picture = |(name, text): (&str, &str)| {
        let file = &format!("scenes/{name}.toml");
        Scene::parse_as(name, Source { file, text }, false).ok()
    };
    let pictures = || NAMES.into_iter().zip(TEXTS);
    let found = pictures().find(|(known, _)| *known == name);
    found.and_then(picture).ok_or_else(|| {
        let pictures = pictures().filter_map(picture);
        let names: Vec<_> = pictures.map(|scene| scene.name).collect();
        let names = names.join(", ");
        file.source.error(
            span,
            format!("scenes: {}: expected one of {names}", quote(name)),
        )
    })
}

/// Checks that a list of scenes has scenes, and no picture of its own.
fn check_list(file: &File, scenes: &[Scene]) -> Result<(), SceneError> {
    if let (true, Some(value)) = (scenes.is_empty(), file.get("scenes")) {
        return Err(file.refuse("scenes", value, "at least one scene"));
    }
    let commands = COMMANDS.iter().map(|key| key.name);
    match commands
        .chain(["steer"])
        .find_map(|key| file.get(key).map(|value| (key, value)))
    {
        Some((key, value)) => Err(file.refuse(key, value, "no such key beside scenes")),
        None => Ok(()),
    }
}

/// Checks that the file states what the picture shows, and the camera.
fn check_subject(file: &File) -> Result<(), SceneError> {
    if !["model", "object", "field", "program"]
        .iter()
        .any(|key| file.has(key))
    {
        return Err(file.source.whole(
            "nothing to show: expected one of the keys model, object, field, program, scenes",
        ));
    }
    let has_camera = ["camera", "lookat", "view"].iter().any(|key| file.has(key));
    if !has_camera && !file.has("program") {
        return Err(file
            .source
            .whole("no camera: expected one of the keys camera, lookat, view"));
    }
    Ok(())
}

/// Checks that the keys which a key needs are in the file, and those which it excludes are not.
fn check_others(file: &File, key: &Key) -> Result<(), SceneError> {
    let at = |name| file.get(name).map(|value| value.span()).unwrap_or_default();
    if !key.with.is_empty() && !key.with.iter().any(|name| file.has(name)) {
        let message = format!(
            "{}: expected only beside {}",
            key.name,
            key.with.join(" or ")
        );
        return Err(file.source.error(&at(key.name), message));
    }
    if let Some(other) = key.without.iter().find(|name| file.has(name)) {
        let line = file.source.line(at(other).start);
        let message = format!(
            "{}: expected only without {other}, found it in line {line}",
            key.name
        );
        return Err(file.source.error(&at(key.name), message));
    }
    Ok(())
}

/// Checks a line as the board does.
fn check_line(
    file: &File,
    key: &str,
    words: &str,
    line: &str,
    span: &Range<usize>,
) -> Result<(), SceneError> {
    let refuse = |reason: String| {
        Err(file
            .source
            .error(span, format!("{key} = {}: {reason}", quote(words))))
    };
    if line.len() > LINE_MAX
        || !line
            .bytes()
            .all(|byte| byte == b' ' || byte.is_ascii_graphic())
    {
        return refuse(format!(
            "expected at most {LINE_MAX} visible ASCII characters"
        ));
    }
    match Command::parse(line) {
        Ok(_) => Ok(()),
        Err(error) => refuse(error.to_string()),
    }
}

fn lanes(file: &File) -> Result<Option<u8>, SceneError> {
    let Some(value) = file.get("lanes") else {
        return Ok(None);
    };
    let found = file.number("lanes")?;
    let lanes = [1, 2, 4]
        .into_iter()
        .find(|lanes| found == Some(f64::from(*lanes)));
    let lanes = lanes.ok_or_else(|| file.refuse("lanes", value, "1, 2 or 4"))?;
    if !file.has("field") && !file.has("scenes") {
        return Err(file.refuse("lanes", value, "the key only beside field or scenes"));
    }
    Ok(Some(lanes))
}

fn steer(file: &File) -> Result<Steer, SceneError> {
    let (Some(value), Some(text)) = (file.get("steer"), file.text("steer")?) else {
        return Ok(Steer::Fixed);
    };
    let is_program = file.has("program");
    let steer = match text {
        "fixed" => Steer::Fixed,
        "buttons" if is_program => Steer::Buttons,
        "buttons" => return Err(file.refuse("steer", value, "buttons only beside program")),
        text => {
            let around = match Command::parse(text) {
                Ok(Some(Command::Orbit { .. })) => true,
                Ok(Some(Command::Imu {
                    action: Some(ImuAction::Follow(Some(_))),
                })) => text.contains("orbit"),
                Ok(Some(Command::Gesture {
                    action: Some(GestureAction::On | GestureAction::Vga),
                })) => true,
                _ => {
                    let expected = "fixed, buttons, orbit FRAMES, imu look, imu orbit, gesture on or gesture vga";
                    return Err(file.refuse("steer", value, expected));
                }
            };
            if is_program {
                return Err(file.refuse("steer", value, "fixed or buttons beside program"));
            }
            if around && !file.has("camera") {
                return Err(file.refuse(
                    "steer",
                    value,
                    "the key camera beside it, whose distance it keeps",
                ));
            }
            Steer::Command(text.split_ascii_whitespace().collect::<Vec<_>>().join(" "))
        }
    };
    Ok(steer)
}
