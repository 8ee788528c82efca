//! A scene.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glint_core::animation::Animation;
use glint_core::camera::{Projection, ViewError};
use glint_core::choice::Choice;
use glint_core::console::{
    Command, GestureAction, ImuAction, LINE_MAX, MESHES, ObjectAction, Order, Row, Setting,
};
use glint_core::feature::{BASE, Feature};
use glint_core::field::Field;
use glint_core::fixed::Turns;
use glint_core::framing;
use glint_core::imu::Follow;
use glint_core::light::{Background, Material};
use glint_core::matrix::Axis;
use glint_core::picture::{Samples, Size};
use glint_core::quality::Quality;
use glint_core::wireframe::{CUBE_NAME, is_program_file};
use glint_scene::{AnyBoard, Board, Defaults, Line, Scene};

use crate::built_in::{NAMES, TEXTS};
use crate::error::{SceneError, Source, quote, unknown};
use crate::file::{File, Value, such_as};
use crate::keys::{BUDGET, commands};

/// Camera of a scene that shows a field and does not state a camera.
const CAMERA: &str = "4 30 60";

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

/// Limits for a build with this scene alone and for the frames of the scene: names from [`BUDGET`],
/// and numbers.
pub type Budget = Vec<(&'static str, f64)>;

/// A scene that a scene file describes.
#[derive(Clone, Debug)]
pub struct SceneFile {
    name: String,
    title: String,
    /// The folder of the file, which contains its meshes, its texture and its wireframe program.
    folder: PathBuf,
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
    /// Whether gateware for the scene includes the geometry pass of the triangle engine, if the scene needs this pass.
    pub(crate) geometry: bool,
    pub(crate) lanes: Option<u8>,
    clock: Option<f64>,
    budget: Budget,
}

impl SceneFile {
    /// Parses the text of a scene file. `name` is the scene's name, and `file` the file's name in messages; the file's folder
    /// contains its meshes.
    ///
    /// # Errors
    /// All violations of the format.
    pub fn parse(name: &str, file: &str, text: &str) -> Result<Self, SceneError> {
        Self::parse_as(name, Source { file, text }, true)
    }

    /// Parses the text of a scene file. A list of scenes is accepted only if `may_be_list`.
    fn parse_as(name: &str, source: Source, may_be_list: bool) -> Result<Self, SceneError> {
        let start = Scene::new(Defaults::GATEWARE);
        let start = start.map_err(|error: ViewError| source.whole(error.to_string()))?;
        let file = File::read(source);
        let scene = Self::of(name, &file, start, may_be_list);
        file.check()?;
        Ok(scene)
    }

    /// Builds the scene of a file. The result is valid only if the file has no violations.
    fn of(name: &str, file: &File, start: Scene, may_be_list: bool) -> Self {
        if let (Some(value), false) = (file.get("scenes"), may_be_list) {
            file.refuse("scenes", value, "a picture");
        }
        if !file.has("title") {
            file.add_missing("no title: expected the key title, one line about the scene");
        }
        let title = file.text("title").unwrap_or_default();
        let scenes = if may_be_list {
            file.texts("scenes")
        } else {
            Vec::new()
        };
        let scenes = scenes.into_iter();
        let folder = Path::new(file.source.file)
            .parent()
            .unwrap_or(Path::new(""));
        let mut scene = Self {
            name: name.to_owned(),
            title: title.split_whitespace().collect::<Vec<_>>().join(" "),
            folder: folder.to_owned(),
            settings: Vec::new(),
            scene: start,
            meshes: Vec::new(),
            features: BTreeSet::new(),
            steer: Steer::default(),
            scenes: scenes
                .filter_map(|(name, span)| member(file, name, &span))
                .collect(),
            depth: file.switch("depth").unwrap_or(false),
            geometry: geometry(file),
            lanes: lanes(file),
            clock: file.number("clock"),
            budget: file.numbers("budget", &BUDGET),
        };
        if file.has("scenes") {
            check_list(file);
        } else {
            scene.set_picture(file);
        }
        scene
    }

    /// Adds the console commands of a single scene.
    fn set_picture(&mut self, file: &File) {
        const SUBJECTS: [&str; 4] = ["model", "object", "field", "program"];
        if !file.has_any(&SUBJECTS) {
            file.add_missing(
                "nothing to show: expected one of the keys model, object, field, program, scenes",
            );
        }
        if !file.has("quality") && !file.has("size") {
            self.add_default(file, "quality", &Quality::default().to_string());
        }
        if self.depth && !file.has("aa") {
            self.add_default(file, "aa", Samples::One.name());
        }
        let has_camera = file.has_any(&["camera", "lookat", "view"]);
        if !has_camera && file.has("field") {
            self.add_default(file, "camera", CAMERA);
        }
        let fits = !has_camera && !file.has("field") && file.has_any(MESHES);
        let mut rows = commands();
        // A camera that shows whole meshes replaces the lens.
        rows.sort_by_key(|row| fits && row.forms.order == Order::Lens);
        let colour = mesh_colour(file);
        for row in rows {
            let key = row.key();
            if key == "up" && fits {
                self.add_fit(file, row);
            } else if file.get(key).is_some() && has_right_others(file, row) {
                for (words, span) in file.words(row) {
                    self.set(file, row, &words, &span, colour.as_deref());
                }
            }
        }
        if file.has_any(MESHES) && !file.has_any(&["field", "background"]) {
            // Boards whose gateware cannot draw gradients have another default.
            self.add_default(file, "background", Background::GRADIENT);
        }
        let lights = self.scene.appearance.lights.len();
        if let (Some(value), true, false) = (file.get("light"), lights > 1, file.has("field")) {
            file.refuse("light", value, "one light on meshes");
        }
        if let (Some(value), true, false) = (file.get("aa"), self.depth, self.scene.has_depths()) {
            file.refuse("aa", value, "1 beside the key depth");
        }
        if let Some(value) = file.get("projection")
            && self.scene.view.projection() == Projection::Orthographic
            && file.has_any(&["field", "stereo"])
        {
            file.refuse("projection", value, "perspective beside field or stereo");
        }
        if let Some(value) = file.get("animate") {
            check_animation(file, value, &self.scene);
        }
        let (steer, feature) = steer(file);
        self.steer = steer;
        self.features.insert(feature);
        self.features.remove(&BASE);
    }

    /// Adds the console command of a key with this value. `colour` replaces the colours of meshes.
    fn set(
        &mut self,
        file: &File,
        row: &Row,
        words: &str,
        span: &Range<usize>,
        colour: Option<&str>,
    ) {
        let key = row.key();
        let line = match (key, colour) {
            ("program", _) if words == CUBE_NAME => row.command.to_owned(),
            ("program", _) if !is_program_file(words) || words.contains(' ') => {
                let expected = "expected `cube`, the built-in program, or a file .wft (text) or .wfb (binary) without blanks in its name";
                return file.add(span, format!("program: {}: {expected}", quote(words)));
            }
            // The material of a mesh is the colour of an object.
            ("material", Some(_)) => return,
            ("model", Some(colour)) => format!("object add {words} colour {colour}"),
            ("object", Some(colour)) => {
                let line = format!("object add {words}");
                match has_colour(&line) {
                    true => line,
                    false => format!("{line} colour {colour}"),
                }
            }
            _ => match row.forms.action {
                Some(action) => format!("{} {action} {words}", row.command),
                None => format!("{} {words}", row.command),
            },
        };
        if key == "field" && file.has("model") {
            self.add(file, row, words, "mesh on".to_owned(), span);
        }
        self.add(file, row, words, line, span);
    }

    /// Adds the console command of a key that the file does not contain.
    fn add_default(&mut self, file: &File, key: &str, words: &str) {
        if let Some(row) = commands().into_iter().find(|row| row.key() == key) {
            self.set(file, row, words, &(0..0), None);
        }
    }

    /// Adds the camera that shows all meshes. The axis that points up on the screen comes from the
    /// key `up` or from the format of the model, and the distance from the key `fov`.
    fn add_fit(&mut self, file: &File, row: &Row) {
        let stated = file.words(row).pop();
        let model = file.get("model").and_then(|model| model.get_ref().as_str());
        let usual = model.and_then(upright).map_or(Axis::Z, |(axis, _)| axis);
        let (up, span) = stated.unwrap_or((usual.name().to_owned(), 0..0));
        let mut line = format!("{} {up}", row.command);
        let angle = commands().into_iter().find(|row| row.key() == "fov");
        // The horizontal angle, without a vertical one.
        let angle = angle.and_then(|row| {
            let angles = file.peek(row)?;
            Some(format!("{line} {}", angles.split(' ').next()?))
        });
        // A wrong angle is reported with the key `fov`.
        if let Some(with_angle) = angle.filter(|line| Line::parse(line).is_ok()) {
            line = with_angle;
        }
        self.add(file, row, &up, line, &span);
    }

    /// Adds a console command that sets the picture, after the board's checks.
    fn add(&mut self, file: &File, row: &Row, words: &str, line: String, span: &Range<usize>) {
        let refuse = |reason: String| {
            file.add(span, format!("{} = {}: {reason}", row.key(), quote(words)));
        };
        let is_visible = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
        if line.len() > LINE_MAX || !line.bytes().all(is_visible) {
            return refuse(format!(
                "expected at most {LINE_MAX} visible ASCII characters"
            ));
        }
        let parsed = match Line::parse(&line) {
            Ok(parsed) => parsed,
            Err(reason) => return refuse(format!("{reason}{}", such_as(row))),
        };
        // The command `fit` needs the meshes, so the host or the board executes it later.
        if !matches!(parsed, Line::Option(Setting::Fit { .. }))
            && let Err(error) = parsed.apply(&mut self.scene, &mut AnyBoard)
        {
            return refuse(error.to_string());
        }
        self.features.insert(parsed.feature());
        if let Some(mesh) = parsed.mesh()
            && self.meshes.iter().all(|known| known != mesh)
        {
            self.meshes.push(mesh.to_owned());
        }
        self.settings.push(line);
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

    /// Notes on settings without effect ([`Setting::note`]), of all scenes of a list.
    pub fn notes(&self) -> Vec<&'static str> {
        let of_scenes = self.scenes.iter().flat_map(Self::notes);
        let of_settings = self.settings.iter();
        let of_settings = of_settings.filter_map(|line| match Line::parse(line) {
            Ok(Line::Option(setting)) => setting.note(),
            _ => None,
        });
        of_scenes.chain(of_settings).collect()
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

    /// The scene after the console commands, except the camera that shows all meshes; for a list of scenes, the first scene.
    pub fn scene(&self) -> &Scene {
        self.scenes.first().map_or(&self.scene, Self::scene)
    }

    /// Names of the meshes, without repetition; for a list of scenes, those of the first scene.
    pub fn meshes(&self) -> &[String] {
        self.scenes.first().map_or(&self.meshes, Self::meshes)
    }

    /// Name of the texture that replaces those of the meshes; for a list of scenes, that of the first scene.
    pub fn texture(&self) -> Option<&str> {
        self.scene().texture.as_deref()
    }

    /// Name of the wireframe program, unless it is the built-in one; for a list of scenes, that of the first scene.
    pub fn program(&self) -> Option<&str> {
        self.scene().program.as_deref()
    }

    /// The folder that contains the meshes, the texture and the wireframe program; for a list of scenes, that of the first scene.
    pub fn folder(&self) -> &Path {
        self.scenes.first().map_or(&self.folder, Self::folder)
    }

    /// Axis and field of view of the camera that shows all meshes; `None` if the scene has a camera of its own.
    pub fn fit(&self) -> Option<(Axis, Option<Turns>)> {
        self.settings()
            .iter()
            .find_map(|line| match Line::parse(line) {
                Ok(Line::Option(Setting::Fit { lens })) => lens,
                _ => None,
            })
    }

    /// The scene after the console commands, with a camera that shows the meshes of `board`.
    ///
    /// # Errors
    /// The board excludes a command, which the message names.
    pub fn scene_on(&self, board: &mut dyn Board) -> Result<Scene, String> {
        let scene = Scene::new(Defaults::GATEWARE);
        let mut scene = scene.map_err(|error| error.to_string())?;
        for line in self.settings() {
            let parsed = Line::parse(line).map_err(|reason| reason.to_string())?;
            let applied = parsed.apply(&mut scene, board);
            applied.map_err(|error| error.to_string())?;
        }
        Ok(scene)
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

/// The axis that points up in models of a file format, and the format's extension, by the name of a
/// file. `None` for a name of another format or of a generator.
pub fn upright(model: &str) -> Option<(Axis, &'static str)> {
    framing::upright(Path::new(model).extension()?.to_str()?)
}

/// A member of a list of scenes, which must be a built-in single scene.
fn member(file: &File, name: &str, span: &Range<usize>) -> Option<SceneFile> {
    let picture = |(name, text): (&str, &str)| {
        let file = &format!("scenes/{name}.toml");
        SceneFile::parse_as(name, Source { file, text }, false).ok()
    };
    let pictures = || NAMES.into_iter().zip(TEXTS);
    let found = pictures().find(|(known, _)| *known == name);
    let found = found.and_then(picture);
    if found.is_none() {
        let pictures: Vec<_> = pictures().filter_map(picture).collect();
        let names = pictures.iter().map(SceneFile::name);
        file.add(
            span,
            format!("scenes: {}", unknown(name, "a built-in scene", names)),
        );
    }
    found
}

/// Checks that a list of scenes contains scenes, and no keys of a single scene.
fn check_list(file: &File) {
    if let Some(value) = file.get("scenes")
        && value
            .get_ref()
            .as_array()
            .is_some_and(|list| list.is_empty())
    {
        file.refuse("scenes", value, "at least one scene");
    }
    for key in commands().into_iter().map(Row::key).chain(["steer"]) {
        if let Some(value) = file.get(key) {
            file.refuse(key, value, "no such key beside scenes");
        }
    }
}

/// Whether the file contains the keys that the row's key requires, and none of the keys that it
/// excludes.
fn has_right_others(file: &File, row: &Row) -> bool {
    let (key, forms) = (row.key(), &row.forms);
    let at = |name| file.get(name).map(|value| value.span()).unwrap_or_default();
    if !forms.with.is_empty() && !file.has_any(forms.with) {
        let message = format!("{key}: expected only beside {}", forms.with.join(" or "));
        file.add(&at(key), message);
        return false;
    }
    if let Some(other) = forms.without.iter().find(|name| file.has(name)) {
        let line = file.source.line(at(other).start);
        let message = format!("{key}: expected only without {other}, found it in line {line}");
        file.add(&at(key), message);
        return false;
    }
    true
}

/// The colour RRGGBB that the key `material` gives to meshes in place of their own colours. In a
/// scene with a field, the material applies to the field instead.
fn mesh_colour(file: &File) -> Option<String> {
    let value = file.get("material").filter(|_| !file.has("field"))?;
    if file.has("edges") {
        file.refuse(
            "material",
            value,
            "a mesh with faces, without the key edges",
        );
    }
    let name = value.get_ref().as_str()?.trim();
    let material = Material::from_word(name)?;
    if material == Material::Normal {
        file.refuse("material", value, "a material of one colour on meshes");
    }
    let [r, g, b] = material.faces()[0];
    Some(format!("{r:02x}{g:02x}{b:02x}"))
}

/// Whether a console command adds an object with a colour.
fn has_colour(line: &str) -> bool {
    let Ok(Line::Option(Setting::Object { action })) = Line::parse(line) else {
        return false;
    };
    matches!(action, ObjectAction::Add { place, .. } if place.colour.is_some())
}

fn geometry(file: &File) -> bool {
    if let Some(value) = file.get("geometry")
        && (!file.has_any(&["model", "object"]) || file.has("edges"))
    {
        file.refuse(
            "geometry",
            value,
            "the key only beside model or object, without edges",
        );
    }
    file.switch("geometry").unwrap_or(true)
}

fn lanes(file: &File) -> Option<u8> {
    let value = file.get("lanes")?;
    let found = file.number("lanes")?;
    let mut known = [1, 2, 4].into_iter();
    let lanes = known.find(|lanes| found == f64::from(*lanes));
    if lanes.is_none() {
        file.refuse("lanes", value, "1, 2 or 4");
    } else if !file.has_any(&["field", "scenes"]) {
        file.refuse("lanes", value, "the key only beside field or scenes");
    }
    lanes
}

/// Checks that the scene shows the objects or the field that its animation moves.
fn check_animation(file: &File, value: &Value, scene: &Scene) {
    let Animation {
        azimuth,
        orbit,
        turn,
    } = scene.animation;
    let refuse = |expected| file.refuse("animate", value, expected);
    if !azimuth.is_zero() && !file.has("camera") {
        refuse("the key camera, because azimuth keeps the distance of the camera");
    }
    let mut field = scene.field;
    if !orbit.is_zero() && field.as_mut().and_then(Field::moving).is_none() {
        refuse("a field moving:R,ORBIT,ANGLE beside orbit");
    }
    let least = turn.map_or(0, |turn| turn.object.unwrap_or(1));
    if (scene.objects.len() as u32) < least {
        refuse("as many objects as the number after turn, and at least one");
    }
}

/// The control of the camera, and the part of the firmware that implements its command.
fn steer(file: &File) -> (Steer, Feature) {
    const FIXED: (Steer, Feature) = (Steer::Fixed, BASE);
    let (Some(value), Some(text)) = (file.get("steer"), file.text("steer")) else {
        return FIXED;
    };
    let refuse = |expected| {
        file.refuse("steer", value, expected);
        FIXED
    };
    let is_program = file.has("program");
    match text {
        "fixed" => return FIXED,
        "buttons" if is_program => return (Steer::Buttons, BASE),
        "buttons" => return refuse("buttons only beside program"),
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
            return refuse(
                "fixed, buttons, orbit FRAMES, imu look, imu orbit, gesture on or gesture vga",
            );
        }
    };
    if is_program {
        return refuse("fixed or buttons beside program");
    }
    if around && !file.has("camera") {
        return refuse("the key camera, because this control keeps the distance of the camera");
    }
    let command = text.split_ascii_whitespace().collect::<Vec<_>>().join(" ");
    (Steer::Command(command), feature)
}
