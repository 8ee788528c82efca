//! The scene options of the command line, generated from the console's table of options.

use super::common::bad_value;
use clap::builder::{PossibleValuesParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use glint::error::{InputError, quote};
use glint_core::console::{self, FORMS, Forms, HostOption, Row, accepted_words};
use glint_core::light::MAX_LIGHTS;
use glint_scene::{AnyBoard, Scene};

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
        with,
        without,
        is_list,
        ..
    } = row.forms;
    let argument = Arg::new(option.name)
        .long(option.name)
        .help(option.help)
        .conflicts_with("scene");
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
    // Only meshes without a field have the option.
    let argument = match with.contains(&"model") && !with.contains(&"field") {
        true => argument.requires("model"),
        false => argument,
    };
    let is_of_one_mesh = with == ["model"];
    let others = without
        .iter()
        .copied()
        .chain(is_of_one_mesh.then_some("object"));
    let known = |id: &&str| {
        command
            .get_arguments()
            .any(|argument| argument.get_id() == *id)
    };
    argument.conflicts_with_all(others.filter(known))
}

impl FromArgMatches for OptionArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let values = |option: &HostOption| match option.switch {
            Some(value) => matches
                .get_flag(option.name)
                .then(|| vec![value.to_owned()]),
            None => {
                let values = matches.get_many::<String>(option.name)?;
                Some(values.cloned().collect())
            }
        };
        let given = options().filter_map(|(row, option)| {
            let values = values(option)?;
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

impl OptionArguments {
    /// Whether an option is given.
    pub fn has(&self, name: &str) -> bool {
        self.given.iter().any(|given| given.option.name == name)
    }

    /// Applies the given options to `scene`, with or without a field.
    ///
    /// # Errors
    /// A value is invalid, or the option requires a field.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), InputError> {
        for Given {
            row,
            option,
            values,
        } in &self.given
        {
            let name = format!("--{}", option.name);
            let refuse = |found: String| bad_value(&name, option.expected, found);
            let has_field = scene.field.is_some();
            if !has_field && !option.is_free && row.forms.with == console::FIELD {
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
            for value in values {
                let line = format!("{} {value}", row.command);
                let setting = match console::Command::parse(&line) {
                    Ok(Some(console::Command::Set(setting))) => setting,
                    Ok(_) => return Err(refuse(quote(value.as_bytes()))),
                    Err(error) => {
                        let reason = error.value().map(|reason| reason.to_string());
                        // The reason may contain the value.
                        let reason = reason.map(|reason| reason.escape_debug().to_string());
                        let found = reason.unwrap_or_else(|| quote(value.as_bytes()));
                        return Err(refuse(found));
                    }
                };
                let set = scene.apply(&setting, &mut AnyBoard);
                set.map_err(|error| refuse(error.to_string()))?;
            }
        }
        Ok(())
    }
}
