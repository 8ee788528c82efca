//! A scene.

use std::collections::BTreeSet;
use std::ops::Range;

use glint_core::camera::ViewError;
use glint_core::console::{Command, GestureAction, ImuAction, LINE_MAX, Row};
use glint_core::feature::{BASE, Feature};
use glint_core::imu::Follow;
use glint_core::picture::{Backend, Size};
use glint_core::quality::Quality;
use glint_scene::{AnyBoard, Line, Scene};

use crate::built_in::{NAMES, TEXTS};
use crate::error::{SceneError, Source, quote};
use crate::file::File;
use crate::keys::{BUDGET, commands};

/// The control that moves the camera, or the segments of a wireframe program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Steer {
    /// Nothing moves the camera.
    #[default]
    Fixed,
    /// The buttons, which are the keys of a wireframe program.
    Buttons,
    /// The console command that starts the control: `orbit`, `imu look`, `imu orbit`, `gesture on` or `gesture vga`.
    Command(String),
}

/// Limits of the build for this scene alone, and of its frames: names from [`BUDGET`] with numbers.
pub type Budget = Vec<(&'static str, f64)>;

/// A scene as described by its file.
#[derive(Clone, Debug)]
pub struct SceneFile {
    name: String,
    title: String,
    /// Console commands that set the picture.
    settings: Vec<String>,
    /// The state of the scene after the settings.
    scene: Scene,
    /// Names of the meshes, without repetition, in the order of the settings.
    meshes: Vec<String>,
    /// The parts of the firmware that implement the commands.
    features: BTreeSet<Feature>,
    steer: Steer,
    /// The scenes of a list of scenes, which has no settings.
    scenes: Vec<SceneFile>,
    /// Whether depth codes are requested in addition to the colours.
    pub(crate) depth: bool,
    pub(crate) lanes: Option<u8>,
    clock: Option<f64>,
    budget: Budget,
}

impl SceneFile {
    /// Parses the text of a scene file. `name` is the scene's name, and `file` the file's name in messages.
    ///
    /// # Errors
    /// The first violation of the format.
    pub fn parse(name: &str, file: &str, text: &str) -> Result<Self, SceneError> {
        Self::parse_as(name, Source { file, text }, true)
    }

    /// Parses the text of a scene file. A list of scenes is accepted only if `may_be_list`.
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
            scene: Scene::new(Backend::Gateware)
                .map_err(|error: ViewError| file.source.whole(error.to_string()))?,
            meshes: Vec::new(),
            features: BTreeSet::new(),
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
            let line = format!("quality {}", Quality::default());
            scene.add(&file, "quality", "", line, &(0..0))?;
        }
        for row in commands() {
            let key = row.key();
            let Some(value) = file.get(key) else {
                continue;
            };
            check_others(&file, row)?;
            for (words, span) in file.words(key, value, row.forms.is_list)? {
                let line = match row.forms.action {
                    Some(action) => format!("{} {action} {words}", row.command),
                    None if key != "program" => format!("{} {words}", row.command),
                    None if words == "cube" => row.command.to_owned(),
                    None => {
                        return Err(file.refuse(key, value, "`cube`, the built-in program"));
                    }
                };
                if key == "field" && file.has("model") {
                    scene.add(&file, key, &words, "mesh on".to_owned(), &span)?;
                }
                scene.add(&file, key, &words, line, &span)?;
            }
        }
        let lights = scene.scene.appearance.lights.len();
        if let (Some(value), true, false) = (file.get("light"), lights > 1, file.has("field")) {
            return Err(file.refuse("light", value, "one light on meshes"));
        }
        let (steer, feature) = steer(&file)?;
        scene.steer = steer;
        scene.features.insert(feature);
        scene.features.remove(&BASE);
        Ok(scene)
    }

    /// Adds a console command that sets the picture, after the board's checks.
    fn add(
        &mut self,
        file: &File,
        key: &str,
        words: &str,
        line: String,
        span: &Range<usize>,
    ) -> Result<(), SceneError> {
        let refuse = |reason: String| {
            file.source
                .error(span, format!("{key} = {}: {reason}", quote(words)))
        };
        let is_visible = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
        if line.len() > LINE_MAX || !line.bytes().all(is_visible) {
            return Err(refuse(format!(
                "expected at most {LINE_MAX} visible ASCII characters"
            )));
        }
        let parsed = Line::parse(&line).map_err(|reason| refuse(reason.to_string()))?;
        let applied = parsed.apply(&mut self.scene, &mut AnyBoard);
        applied.map_err(|error| refuse(error.to_string()))?;
        self.features.insert(parsed.feature());
        if let Some(mesh) = parsed.mesh()
            && self.meshes.iter().all(|known| known != mesh)
        {
            self.meshes.push(mesh.to_owned());
        }
        self.settings.push(line);
        Ok(())
    }

    /// The name of the scene.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A one-line description of the scene.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The scenes of a list of scenes; empty for a single scene.
    pub fn scenes(&self) -> &[Self] {
        &self.scenes
    }

    /// The console commands that set the picture; for a list of scenes, those of the first scene.
    pub fn settings(&self) -> &[String] {
        self.scenes.first().map_or(&self.settings, Self::settings)
    }

    /// The control of the camera; for a list of scenes, that of the first scene.
    pub fn steer(&self) -> &Steer {
        self.scenes.first().map_or(&self.steer, Self::steer)
    }

    /// All console commands: those that set the picture, and the command that starts the control of the camera.
    pub fn lines(&self) -> impl Iterator<Item = &str> {
        let steer = match self.steer() {
            Steer::Command(command) => Some(command.as_str()),
            Steer::Fixed | Steer::Buttons => None,
        };
        self.settings().iter().map(String::as_str).chain(steer)
    }

    /// The scene after the console commands; for a list of scenes, the first scene.
    pub fn scene(&self) -> &Scene {
        self.scenes.first().map_or(&self.scene, Self::scene)
    }

    /// Names of the meshes, without repetition; for a list of scenes, those of the first scene.
    pub fn meshes(&self) -> &[String] {
        self.scenes.first().map_or(&self.meshes, Self::meshes)
    }

    /// The parts of the firmware that implement the console commands.
    pub(crate) const fn features(&self) -> &BTreeSet<Feature> {
        &self.features
    }

    /// The size of the picture.
    pub fn size(&self) -> Size {
        self.scene().size
    }

    /// Frequency of the system clock in MHz; `None` for the board's default.
    pub const fn clock(&self) -> Option<f64> {
        self.clock
    }

    /// The limits of the build for this scene alone.
    pub fn budget(&self) -> &[(&'static str, f64)] {
        &self.budget
    }
}

/// A scene of a list of scenes: a built-in single scene.
fn member(file: &File, name: &str, span: &Range<usize>) -> Result<SceneFile, SceneError> {
    let picture = |(name, text): (&str, &str)| {
        let file = &format!("scenes/{name}.toml");
        SceneFile::parse_as(name, Source { file, text }, false).ok()
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

/// Checks that a list of scenes contains scenes, and no keys of a single scene.
fn check_list(file: &File, scenes: &[SceneFile]) -> Result<(), SceneError> {
    if let (true, Some(value)) = (scenes.is_empty(), file.get("scenes")) {
        return Err(file.refuse("scenes", value, "at least one scene"));
    }
    let keys = commands().into_iter().map(Row::key);
    match keys
        .chain(["steer"])
        .find_map(|key| file.get(key).map(|value| (key, value)))
    {
        Some((key, value)) => Err(file.refuse(key, value, "no such key beside scenes")),
        None => Ok(()),
    }
}

/// Checks that the file sets the subject of the picture and the camera.
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

/// Checks that the file contains the keys that another key requires, and none that it excludes.
fn check_others(file: &File, row: &Row) -> Result<(), SceneError> {
    let (key, forms) = (row.key(), &row.forms);
    let at = |name| file.get(name).map(|value| value.span()).unwrap_or_default();
    if !forms.with.is_empty() && !forms.with.iter().any(|name| file.has(name)) {
        let message = format!("{key}: expected only beside {}", forms.with.join(" or "));
        return Err(file.source.error(&at(key), message));
    }
    if let Some(other) = forms.without.iter().find(|name| file.has(name)) {
        let line = file.source.line(at(other).start);
        let message = format!("{key}: expected only without {other}, found it in line {line}");
        return Err(file.source.error(&at(key), message));
    }
    Ok(())
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

/// The control of the camera, and the part of the firmware that implements its command.
fn steer(file: &File) -> Result<(Steer, Feature), SceneError> {
    let (Some(value), Some(text)) = (file.get("steer"), file.text("steer")?) else {
        return Ok((Steer::Fixed, BASE));
    };
    let is_program = file.has("program");
    match text {
        "fixed" => return Ok((Steer::Fixed, BASE)),
        "buttons" if is_program => return Ok((Steer::Buttons, BASE)),
        "buttons" => return Err(file.refuse("steer", value, "buttons only beside program")),
        _ => {}
    }
    // Whether the camera moves around the origin.
    let (around, feature) = match Command::parse(text) {
        Ok(Some(command @ Command::Orbit { .. })) => (true, command.feature()),
        Ok(Some(
            command @ Command::Imu {
                action: Some(ImuAction::Follow(Some(follow))),
            },
        )) => (follow == Follow::Orbit, command.feature()),
        Ok(Some(
            command @ Command::Gesture {
                action: Some(GestureAction::On | GestureAction::Vga),
            },
        )) => (true, command.feature()),
        Ok(_) | Err(_) => {
            let expected =
                "fixed, buttons, orbit FRAMES, imu look, imu orbit, gesture on or gesture vga";
            return Err(file.refuse("steer", value, expected));
        }
    };
    if is_program {
        return Err(file.refuse("steer", value, "fixed or buttons beside program"));
    }
    if around && !file.has("camera") {
        let expected = "the key camera beside it, whose distance it keeps";
        return Err(file.refuse("steer", value, expected));
    }
    let command = text.split_ascii_whitespace().collect::<Vec<_>>().join(" ");
    Ok((Steer::Command(command), feature))
}
