//! The choices that the page offers as buttons: scenes, meshes and fields. Each choice has the
//! console commands that show it.
//!
//! The names come from the lists of the firmware, the examples of fields from the table of
//! `glint-core`.

use glint_core::console::{NameList, Names};
use glint_core::field::{EXAMPLES, Field, KINDS, MovingSphere, Primitive};
use glint_core::fixed::Turns;
use glint_core::wireframe::CUBE_NAME;
use serde::{Deserialize, Serialize};

/// Number of pictures in a full turn of a moving field.
const STEPS: u32 = 72;

/// The lists of choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum List {
    /// Scenes and lists of scenes.
    Scenes,
    /// Meshes.
    Meshes,
    /// Kinds of fields.
    Fields,
}

/// A choice: a scene, a mesh or a field, with the commands that show it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Name on the page's button.
    pub name: String,
    /// The console commands that show it.
    pub commands: Vec<String>,
    /// For a moving field, the commands that show its successive pictures; empty for all other
    /// choices.
    pub frames: Vec<String>,
}

impl Choice {
    fn new(name: &str, commands: impl IntoIterator<Item = String>) -> Self {
        Self {
            name: name.to_owned(),
            commands: commands.into_iter().collect(),
            frames: Vec::new(),
        }
    }
}

/// All choices that a firmware offers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choices {
    scenes: Vec<Choice>,
    meshes: Vec<Choice>,
    fields: Vec<Choice>,
    /// Names of the textures, uploaded or in the flash, for completion.
    textures: Vec<String>,
    /// Names of the wireframe programs, built-in, uploaded or in the flash, for completion.
    programs: Vec<String>,
    /// Names of the uploads, for completion.
    uploads: Vec<String>,
}

impl Choices {
    /// The choices of a board, from its replies to the commands `scene`, `models` and `help field`.
    /// `fit` returns the command that shows a whole mesh, or `None` if the board does not have this
    /// command.
    pub fn new(
        fit: &dyn Fn(&str) -> Option<String>,
        scenes: &[String],
        models: &[String],
        help: &[String],
    ) -> Self {
        let names = scenes
            .iter()
            .filter_map(|line| line.strip_prefix("scene ")?.split(' ').next());
        let meshes = mesh_names(models);
        let (meshes, scenes): (Vec<_>, Vec<_>) = names.partition(|name| meshes.contains(name));
        let show = |name: &str| format!("scene {name}");
        // The last line of the reply lists the forms of the argument: `FIELD: off or sphere:R or
        // ...`.
        let forms = help.last().and_then(|line| line.split_once(": "));
        let forms: Vec<_> = forms
            .into_iter()
            .flat_map(|(_, forms)| forms.split(" or "))
            .collect();
        let kinds = KINDS.iter().zip(&EXAMPLES);
        let kinds = kinds.filter(|((form, _), example)| {
            forms.contains(form) && is_drawn_by_engine(example.field)
        });
        Self {
            scenes: scenes
                .into_iter()
                .map(|name| Choice::new(name, [show(name)]))
                .collect(),
            // Showing a mesh keeps all other settings, so the default scene comes first.
            meshes: meshes
                .into_iter()
                .map(|name| {
                    let shown = [show("default"), show(name)];
                    Choice::new(name, shown.into_iter().chain(fit(name)))
                })
                .collect(),
            fields: kinds
                .map(|(_, example)| field(example.field, example.look))
                .collect(),
            textures: names_of("texture", models),
            programs: [CUBE_NAME.to_owned()]
                .into_iter()
                .chain(names_of("program", models))
                .collect(),
            uploads: upload_names(models),
        }
    }

    /// The choices of a list.
    pub fn of(&self, list: List) -> &[Choice] {
        match list {
            List::Scenes => &self.scenes,
            List::Meshes => &self.meshes,
            List::Fields => &self.fields,
        }
    }

    /// The choice with this name in a list.
    pub fn find(&self, list: List, name: &str) -> Option<&Choice> {
        self.of(list).iter().find(|choice| choice.name == name)
    }
}

/// Whether the raymarcher draws a field. The soft core draws the other fields, which takes minutes
/// in a browser.
fn is_drawn_by_engine(field: &str) -> bool {
    Field::parse(field).is_ok_and(|field| !field.is_left_to_soft_core())
}

/// Provides the names for completion on the console.
impl Names for Choices {
    fn visit(&self, list: NameList, visit: &mut dyn FnMut(&str)) {
        let (lists, names) = match list {
            NameList::Scenes => (&[List::Meshes, List::Scenes][..], &[][..]),
            NameList::Meshes => (&[List::Meshes][..], &[][..]),
            NameList::Textures => (&[][..], &self.textures[..]),
            NameList::Programs => (&[][..], &self.programs[..]),
            NameList::Uploads => (&[][..], &self.uploads[..]),
        };
        let choices = lists.iter().flat_map(|list| self.of(*list));
        choices.for_each(|choice| visit(&choice.name));
        names.iter().for_each(|name| visit(name));
    }
}

/// The names of meshes in a reply to `models`.
fn mesh_names(models: &[String]) -> Vec<&str> {
    let mut names = Vec::new();
    for line in models {
        let words: Vec<_> = line.split(' ').collect();
        match words[..] {
            ["built-in", ..] => names.extend_from_slice(&words[1..]),
            ["flash", name, "bytes", _] | ["mesh", name, ..] => names.push(name),
            _ => {}
        }
    }
    names
}

/// The names of textures or of programs in a reply to `models`, without duplicates: an upload may be a copy of an item in the flash.
fn names_of(kind: &str, models: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for line in models {
        let words: Vec<_> = line.split(' ').collect();
        if let ["flash", of, name, "bytes", _] | [of, name, ..] = words[..]
            && of == kind
            && names.iter().all(|known| known != name)
        {
            names.push(name.to_owned());
        }
    }
    names
}

/// The names of uploads in a reply to `models`.
fn upload_names(models: &[String]) -> Vec<String> {
    let name = |line: &String| {
        let mut words = line.split(' ');
        matches!(words.next(), Some("mesh" | "texture" | "program")).then_some(())?;
        words.next().map(str::to_owned)
    };
    models.iter().filter_map(name).collect()
}

/// The choice of a field.
fn field(text: &str, look: &[&str]) -> Choice {
    let name = text.split(':').next().unwrap_or_default();
    let command = |field: &str| format!("field {field}");
    let look = look.iter().map(|line| (*line).to_owned());
    let all = ["scene default".to_owned()].into_iter().chain(look);
    let mut choice = Choice::new(name, all.chain([command(text)]));
    if let Ok(Field::Primitive(Primitive::Moving(sphere))) = Field::parse(text) {
        let angle = |step| {
            let turned = u32::MAX / STEPS * step;
            sphere.angle.wrapping_add(Turns(turned))
        };
        let moved = (1..=STEPS).map(|step| MovingSphere {
            angle: angle(step),
            ..sphere
        });
        choice.frames = moved
            .map(|sphere| command(&Field::from(sphere).to_string()))
            .collect();
    }
    choice
}

#[cfg(test)]
mod tests {
    use super::*;
    use glint_core::console::complete;

    fn lines(text: &str) -> Vec<String> {
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn choices_are_those_of_the_firmware() {
        let choices = Choices::new(
            &|name| Some(format!("fit {name}")),
            &lines("scene cube there\nscene hull flash\nscene cubes there\nscene default there"),
            &lines(
                "built-in cube\nflash hull bytes 7\nflash texture wood bytes 9\nflash texture rust bytes 9\n\
                 flash program ball.wfb bytes 96\ntexture wood size 8 8 bytes 9\nprogram net segments 1 bytes 80\n\
                 uploads 2 of 18\nfree 1 bytes",
            ),
            &lines(
                "field\n  show\n  off|FIELD: off or menger:DEPTH or moving:R,ORBIT[,DEGREES] or other:X",
            ),
        );
        let names = |list| -> Vec<_> {
            let names = choices.of(list).iter().map(|choice| choice.name.as_str());
            names.collect()
        };
        assert_eq!(names(List::Scenes), ["cubes", "default"]);
        assert_eq!(names(List::Meshes), ["cube", "hull"]);
        assert_eq!(names(List::Fields), ["menger", "moving"]);
        for (line, expected) in [
            ("texture w", "wood"),
            ("texture r", "rust"),
            ("object add h", "hull"),
            ("load 9 0 w", "wood"),
            ("unload w", "wood"),
            ("program b", "ball.wfb"),
            ("program c", "cube"),
            ("unload n", "net"),
            ("unload r", ""),
            ("unload h", ""),
            ("scene w", ""),
        ] {
            let mut words = String::new();
            complete(line, &choices, &mut |word, _| words += word);
            assert_eq!(words, expected, "{line}");
        }
        let hull = choices.find(List::Meshes, "hull").unwrap();
        assert_eq!(hull.commands, ["scene default", "scene hull", "fit hull"]);
        let menger = choices.find(List::Fields, "menger").unwrap();
        assert_eq!(
            menger.commands,
            ["scene default", "camera 4 30 60", "field menger:4"]
        );
        assert!(menger.frames.is_empty());
    }

    #[test]
    fn a_moving_field_has_frames_all_around() {
        let help = lines("off|FIELD: off or moving:R,ORBIT[,DEGREES]");
        let choices = Choices::new(&|_| None, &[], &[], &help);
        let moving = choices.find(List::Fields, "moving").unwrap();
        assert_eq!(moving.frames.len(), STEPS as usize);
        let mut different = moving.frames.clone();
        different.sort();
        different.dedup();
        assert_eq!(different.len(), STEPS as usize);
        for frame in &moving.frames {
            Field::parse(frame.strip_prefix("field ").unwrap()).unwrap();
        }
    }
}
