//! Forms of a scene's options outside of the console.

/// A command of the console, and how scene files and the command line of `glint` state what it sets.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Name of the command.
    pub command: &'static str,
    /// Its forms.
    pub forms: Forms,
}

/// How scene files and the command line of `glint` state what a command sets.
#[derive(Clone, Copy, Debug)]
pub struct Forms {
    /// Name of the key, if it is not that of the command.
    pub key: Option<&'static str>,
    /// Word of the command before the value of the key.
    pub action: Option<&'static str>,
    /// When the command is executed.
    pub turn: Turn,
    /// Whether the value may be a list, with a command for each of its members.
    pub is_list: bool,
    /// The file needs one of these keys beside it; empty: no other key.
    pub with: &'static [&'static str],
    /// Keys that exclude it.
    pub without: &'static [&'static str],
    /// The option of `glint render` and `glint orbit`, if there is one.
    pub host: Option<HostOption>,
}

/// An option of `glint render` and `glint orbit`. Its value is the argument of the command.
#[derive(Clone, Copy, Debug)]
pub struct HostOption {
    /// Name, without the dashes.
    pub name: &'static str,
    /// Name of the value in the help.
    pub value: &'static str,
    /// The value of an option that is given without one.
    pub switch: Option<&'static str>,
    /// Help.
    pub help: &'static str,
    /// The expected value, for errors.
    pub expected: &'static str,
    /// Whether the option has a meaning without the keys that the command needs.
    pub is_free: bool,
}

/// The order in which the commands of a scene file are executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Turn {
    /// Quality and size, of which the second one replaces a part of the first.
    Size,
    /// The camera, which also sets the lens.
    Camera,
    /// The lens.
    Lens,
    /// Any other option.
    Option,
    /// What the picture shows.
    Subject,
}

/// The key with the command's name, whose command is executed at this turn.
pub const fn key(turn: Turn) -> Forms {
    Forms {
        key: None,
        action: None,
        turn,
        is_list: false,
        with: &[],
        without: &[],
        host: None,
    }
}

/// An option of the command line with this name, name of its value, and help.
pub const fn option(name: &'static str, value: &'static str, help: &'static str) -> HostOption {
    HostOption {
        name,
        value,
        switch: None,
        help,
        expected: "",
        is_free: false,
    }
}

/// An option of the command line that stands for this value.
pub const fn switch(name: &'static str, value: &'static str, help: &'static str) -> HostOption {
    HostOption {
        switch: Some(value),
        ..option(name, "", help)
    }
}

impl HostOption {
    /// With this description of the value in errors.
    pub const fn expects(self, expected: &'static str) -> Self {
        Self { expected, ..self }
    }

    /// With a meaning without the keys that the command needs.
    pub const fn free(self) -> Self {
        Self {
            is_free: true,
            ..self
        }
    }
}

impl Forms {
    /// With this name of the key.
    pub const fn named(self, key: &'static str) -> Self {
        Self {
            key: Some(key),
            ..self
        }
    }

    /// With this word before the value.
    pub const fn action(self, action: &'static str) -> Self {
        Self {
            action: Some(action),
            ..self
        }
    }

    /// With a value that may be a list.
    pub const fn list(self) -> Self {
        Self {
            is_list: true,
            ..self
        }
    }

    /// Beside one of these keys alone.
    pub const fn with(self, with: &'static [&'static str]) -> Self {
        Self { with, ..self }
    }

    /// With this option of the command line.
    pub const fn host(self, option: HostOption) -> Self {
        Self {
            host: Some(option),
            ..self
        }
    }

    /// Without these keys.
    pub const fn without(self, without: &'static [&'static str]) -> Self {
        Self { without, ..self }
    }
}

/// The keys of meshes.
pub const MESHES: &[&str] = &["model", "object"];
/// The key of a field.
pub const FIELD: &[&str] = &["field"];
/// The keys of what has a camera and lights.
pub const LIT: &[&str] = &["model", "object", "field"];

impl Row {
    /// Name of the key in scene files.
    pub fn key(&self) -> &'static str {
        self.forms.key.unwrap_or(self.command)
    }
}
