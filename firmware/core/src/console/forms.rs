//! Keys of scene files and options of the command line that correspond to console commands.

/// A console command, with its key in scene files and its option on the command line of `glint`.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Name of the command.
    pub command: &'static str,
    /// Key and option of the command.
    pub forms: Forms,
}

/// The key of scene files, and the option on the command line of `glint`, for the value of a command.
#[derive(Clone, Copy, Debug)]
pub struct Forms {
    /// Name of the key, if it differs from the command's name.
    pub key: Option<&'static str>,
    /// Word of the console line between the command's name and the key's value, if any.
    pub action: Option<&'static str>,
    /// Position of the command in the order of execution.
    pub order: Order,
    /// An example of the value.
    pub example: &'static str,
    /// Whether the value may be a list, with one command per element.
    pub is_list: bool,
    /// Required keys, of which the file must contain at least one; empty if no other key is required.
    pub with: &'static [&'static str],
    /// Excluded keys, which the file must not contain.
    pub without: &'static [&'static str],
    /// The option of `glint render` and `glint orbit`, if any.
    pub host: Option<HostOption>,
}

/// An option of `glint render` and `glint orbit`. The value of the option is the argument of the command.
#[derive(Clone, Copy, Debug)]
pub struct HostOption {
    /// Name, without the dashes.
    pub name: &'static str,
    /// Name of the value in the help.
    pub value: &'static str,
    /// Value of the setting for an option that takes no value; `None` for an option that takes one.
    pub switch: Option<&'static str>,
    /// Help text of the option.
    pub help: &'static str,
    /// Description of the expected value, for errors.
    pub expected: &'static str,
}

/// The order in which the commands of a scene file are executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Quality, then size, which overrides the size of the quality.
    Size,
    /// The camera, whose command may also set the lens.
    Camera,
    /// Commands that set the lens: projection, field of view, near plane and zoom.
    Lens,
    /// Any other option.
    Option,
    /// Content of the picture.
    Subject,
    /// The camera that shows the whole content.
    Fit,
}

/// Makes a key that has the command's name, from its position in the order of execution and an example of
/// its value.
pub const fn key(order: Order, example: &'static str) -> Forms {
    Forms {
        key: None,
        action: None,
        order,
        example,
        is_list: false,
        with: &[],
        without: &[],
        host: None,
    }
}

/// Makes an option of the command line from its name, the name of its value, and its help line.
pub const fn option(name: &'static str, value: &'static str, help: &'static str) -> HostOption {
    HostOption {
        name,
        value,
        switch: None,
        help,
        expected: "",
    }
}

/// Makes an option that takes no value on the command line; the option sets the setting to `value`.
pub const fn switch(name: &'static str, value: &'static str, help: &'static str) -> HostOption {
    HostOption {
        switch: Some(value),
        ..option(name, "", help)
    }
}

impl HostOption {
    /// Sets the description of the expected value for errors.
    pub const fn expects(self, expected: &'static str) -> Self {
        Self { expected, ..self }
    }
}

impl Forms {
    /// Sets the name of the key.
    pub const fn named(self, key: &'static str) -> Self {
        Self {
            key: Some(key),
            ..self
        }
    }

    /// Sets the word between the command's name and the key's value.
    pub const fn action(self, action: &'static str) -> Self {
        Self {
            action: Some(action),
            ..self
        }
    }

    /// Accepts a list as the key's value.
    pub const fn list(self) -> Self {
        Self {
            is_list: true,
            ..self
        }
    }

    /// Sets the required keys.
    pub const fn with(self, with: &'static [&'static str]) -> Self {
        Self { with, ..self }
    }

    /// Sets the option of the command line.
    pub const fn host(self, option: HostOption) -> Self {
        Self {
            host: Some(option),
            ..self
        }
    }

    /// Sets the excluded keys.
    pub const fn without(self, without: &'static [&'static str]) -> Self {
        Self { without, ..self }
    }
}

/// Keys that show meshes.
pub const MESHES: &[&str] = &["model", "object"];
/// The key that shows a field.
pub const FIELD: &[&str] = &["field"];
/// Keys whose pictures have a camera and lights.
pub const LIT: &[&str] = &["model", "object", "field"];

impl Row {
    /// Name of the key in scene files.
    pub fn key(&self) -> &'static str {
        self.forms.key.unwrap_or(self.command)
    }
}
