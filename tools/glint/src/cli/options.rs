//! The scene options of the command line, generated from the console's table of options.

use super::common::bad_value;
use super::heading;
use super::messages::note;
use clap::builder::{PossibleValuesParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use glint::error::{InputError, quote};
use glint_core::camera::View;
use glint_core::console::{self, FORMS, Forms, HostOption, Order, Row, Setting, accepted_words};
use glint_core::fixed::Turns;
use glint_core::light::MAX_LIGHTS;
use glint_scene::{AnyBoard, Defaults, Scene};

/// The options given on the command line, with their values.
pub struct OptionArguments {
    given: Vec<Given>,
}

/// A given option with its values.
struct Given {
    row: &'static Row,
    option: &'static HostOption,
    values: Vec<String>,
}

/// The rows of the table that are options of the command line.
fn options() -> impl Iterator<Item = (&'static Row, &'static HostOption)> {
    let rows = FORMS.iter();
    rows.filter_map(|row| Some((row, row.forms.host.as_ref()?)))
}

impl Args for OptionArguments {
    fn augment_args(command: Command) -> Command {
        options().fold(command, |command, (row, option)| {
            let argument = argument(&command, row, option);
            command.arg(argument)
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

fn argument(command: &Command, row: &Row, option: &HostOption) -> Arg {
    let Forms {
        order,
        with,
        without,
        is_list,
        ..
    } = row.forms;
    let is_of_subject = order == Order::Option;
    let heading = match order {
        Order::Camera | Order::Lens | Order::Fit => heading::CAMERA,
        Order::Size => heading::PICTURE,
        Order::Subject => heading::SUBJECT,
        Order::Option => heading::APPEARANCE,
    };
    let argument = Arg::new(row.key()).long(option.name).help(option.help);
    let argument = argument.help_heading(heading);
    // Only the camera of a scene can be replaced, so options of the subject conflict with a scene.
    let argument = match is_of_subject {
        true => argument.conflicts_with("scene"),
        false => argument,
    };
    let argument = match option.switch {
        Some(_) => argument.action(ArgAction::SetTrue),
        None => {
            let words = accepted_words(row.command);
            let parser = words.map_or(ValueParser::string(), |words| {
                PossibleValuesParser::new(words).into()
            });
            let action = if is_list {
                ArgAction::Append
            } else {
                ArgAction::Set
            };
            argument
                .value_name(option.value)
                .value_parser(parser)
                .action(action)
                .allow_hyphen_values(true)
        }
    };
    // Such an option applies only to meshes without a field.
    let argument = match is_of_subject && with.contains(&"model") && !with.contains(&"field") {
        true => argument.requires("model"),
        false => argument,
    };
    let is_of_one_mesh = with == ["model"];
    let others = without
        .iter()
        .copied()
        .chain(is_of_one_mesh.then_some("object"));
    let known = |id: &&str| {
        let mut arguments = command.get_arguments().map(|known| known.get_id().as_str());
        arguments.any(|known| known == *id) || options().any(|(row, _)| row.key() == *id)
    };
    argument.conflicts_with_all(others.filter(known))
}

impl FromArgMatches for OptionArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let values = |row: &Row, option: &HostOption| match option.switch {
            Some(value) => matches.get_flag(row.key()).then(|| vec![value.to_owned()]),
            None => Some(matches.get_many::<String>(row.key())?.cloned().collect()),
        };
        let given = options().filter_map(|(row, option)| {
            let values = values(row, option)?;
            Some(Given {
                row,
                option,
                values,
            })
        });
        Ok(Self {
            given: given.collect(),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Given {
    /// The error for a value that is not accepted.
    fn refuse(&self, found: String) -> InputError {
        let name = format!("--{}", self.option.name);
        bad_value(&name, self.option.expected, found)
    }

    /// The console lines that set the values. The numbers of a camera and its lens are separated by commas on the command line, and by
    /// spaces on the console.
    fn lines(&self) -> impl Iterator<Item = String> {
        self.values.iter().map(|value| match self.row.forms.order {
            Order::Camera | Order::Lens => {
                format!("{} {}", self.row.command, value.replace(',', " "))
            }
            Order::Size | Order::Option | Order::Subject | Order::Fit => {
                format!("{} {value}", self.row.command)
            }
        })
    }

    /// The setting of a line; `value` is its value, for errors.
    fn setting<'l>(&self, line: &'l str, value: &str) -> Result<Setting<'l>, InputError> {
        match console::Command::parse(line) {
            Ok(Some(console::Command::Set(setting))) => Ok(setting),
            Ok(_) => Err(self.refuse(quote(value.as_bytes()))),
            Err(error) => {
                let reason = error.value().map(|reason| reason.to_string());
                // The reason may quote the value.
                let reason = reason.map(|reason| reason.escape_debug().to_string());
                Err(self.refuse(reason.unwrap_or_else(|| quote(value.as_bytes()))))
            }
        }
    }

    /// Sets the values in `scene`.
    fn apply(&self, scene: &mut Scene) -> Result<(), InputError> {
        for (line, value) in self.lines().zip(&self.values) {
            let setting = self.setting(&line, value)?;
            let set = scene.apply(&setting, &mut AnyBoard);
            set.map_err(|error| self.refuse(error.to_string()))?;
            if let Some(text) = setting.note() {
                note(text);
            }
        }
        Ok(())
    }

    /// Checks that the option applies to the subject, which has a field if `has_field` is set, and
    /// that it does not have too many values.
    fn check(&self, has_field: bool) -> Result<(), InputError> {
        let Self {
            row,
            option,
            values,
        } = self;
        let name = format!("--{}", option.name);
        if !has_field && row.forms.with == console::FIELD {
            return Err(bad_value(&name, "a --field", "a mesh"));
        }
        let most = if has_field { MAX_LIGHTS } else { 1 };
        if values.len() > most {
            let expected = match has_field {
                true => format!("at most {most} {}s", option.name),
                false => format!("one {} on meshes", option.name),
            };
            return Err(bad_value(&name, &expected, values.len().to_string()));
        }
        Ok(())
    }
}

impl OptionArguments {
    fn get(&self, name: &str) -> Option<&Given> {
        self.given.iter().find(|given| given.option.name == name)
    }

    /// Whether the option `name` is given.
    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Sets the given options in `scene`, except camera and lens. Of a projection, only the far plane is set.
    ///
    /// # Errors
    /// A value is invalid, or the option requires a field.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), InputError> {
        if let Some(projection) = self.get("projection") {
            let view = scene.view;
            projection.apply(scene)?;
            scene.view = view;
        }
        let given = self.given.iter();
        for given in given.filter(|given| given.row.forms.order == Order::Option) {
            given.check(scene.field.is_some())?;
            given.apply(scene)?;
        }
        Ok(())
    }

    /// The camera `view` with the given options for camera and lens.
    ///
    /// # Errors
    /// A value is not accepted.
    pub fn camera(&self, view: View) -> anyhow::Result<View> {
        let mut scene = Scene {
            view,
            ..Scene::new(Defaults::GATEWARE)?
        };
        let given = self.given.iter();
        for given in given.filter(|given| given.row.forms.order != Order::Option) {
            given.apply(&mut scene)?;
        }
        Ok(scene.view)
    }

    /// Whether a given projection has a far plane.
    pub fn has_far_plane(&self) -> bool {
        let projection = self.get("projection");
        projection.is_some_and(|given| {
            let line = given.lines().collect::<String>();
            let setting = given.setting(&line, "");
            matches!(setting, Ok(Setting::Projection { volume }) if volume.far.is_some())
        })
    }

    /// The given field of view.
    ///
    /// # Errors
    /// The value is not accepted.
    pub fn field_of_view(&self) -> Result<Option<Turns>, InputError> {
        let Some(given) = self.get("fov") else {
            return Ok(None);
        };
        let line = given.lines().collect::<String>();
        Ok(match given.setting(&line, &given.values.concat())? {
            Setting::FieldOfView {
                angles: (across, _),
            } => Some(across),
            _ => None,
        })
    }
}
