//! The syntax of commands as data, for help, error messages and completion.

use core::fmt::{self, Display, Write as _};

/// A command's name, help line and parameters.
#[derive(Debug)]
pub struct Syntax {
    /// The first word of the line.
    pub name: &'static str,
    /// Help line: an imperative without a full stop.
    pub summary: &'static str,
    /// Parameters in the order of the line. Only the last parameter may be optional.
    pub parameters: &'static [Parameter],
    /// Whether the line may end before the parameters, which shows the current setting.
    pub is_shown: bool,
}

/// A parameter of a command.
#[derive(Debug)]
pub struct Parameter {
    /// Name in lower case, equal to the name of the parameter's member in the enumeration `Command`.
    pub name: &'static str,
    /// Whether the line may end before this parameter.
    pub optional: bool,
    /// Form of the words that the parameter consists of.
    pub shape: Shape,
}

const fn assert_optional_last(parameters: &[Parameter]) {
    let mut i = 1;
    while i < parameters.len() {
        assert!(
            !parameters[i - 1].optional,
            "only the last parameter may be optional"
        );
        i += 1;
    }
}

/// The words that a parameter consists of.
#[derive(Debug)]
pub enum Shape {
    /// One word.
    Word(&'static WordKind),
    /// A keyword: the parameter's own name.
    Flag,
    /// Several words that form one value; a parameter describes each word.
    Group(&'static [Parameter]),
}

/// The accepted texts of a word.
pub enum WordKind {
    /// One of a list of words.
    Words(&'static [&'static str]),
    /// Any text of a certain form. The value is a description of this form, for help and error messages.
    Text(&'static (dyn Display + Sync)),
    /// Either this keyword, or a word of this kind.
    Either(&'static str, &'static WordKind),
    /// The name of a command.
    Command,
    /// A name, usually one from this list, which the machine has. The second value describes such a name for help and errors.
    Name(NameList, &'static (dyn Display + Sync)),
    /// A name from this table, a colon and numbers. An entry has the form, with names in place of the
    /// numbers, and its description.
    Forms(&'static [(&'static str, &'static str)]),
}

/// Lists of names that the machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameList {
    /// Names of scenes, of lists of scenes, and of meshes.
    Scenes,
    /// Names of meshes.
    Meshes,
    /// Names of uploaded textures.
    Textures,
    /// Names of wireframe programs.
    Programs,
    /// Names of uploads: meshes, textures and programs.
    Uploads,
}

/// The machine's names, for completion.
pub trait Names {
    /// Calls `visit` with each name of a list.
    fn visit(&self, list: NameList, visit: &mut dyn FnMut(&str));
}

/// A machine without names.
#[derive(Clone, Copy, Debug)]
pub struct NoNames;

impl Names for NoNames {
    fn visit(&self, _: NameList, _: &mut dyn FnMut(&str)) {}
}

/// Largest number of accepted words that a usage line lists for a parameter. A parameter with more accepted words is shown by its
/// name.
const USAGE_WORDS: usize = 3;

/// Writes the usage line: the command's name and its parameters.
impl Display for Syntax {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)?;
        if !self.is_shown {
            return write_usage(f, self.parameters, " ");
        }
        f.write_str(" [")?;
        write_usage(f, self.parameters, "")?;
        f.write_str("]")
    }
}

/// Writes `lead` and then the usage of the parameters, separated by blanks.
fn write_usage(f: &mut fmt::Formatter, parameters: &[Parameter], lead: &str) -> fmt::Result {
    parameters
        .iter()
        .enumerate()
        .try_for_each(|(i, parameter)| {
            f.write_str(if i == 0 { lead } else { " " })?;
            let [open, close] = if parameter.optional {
                ["[", "]"]
            } else {
                [""; 2]
            };
            f.write_str(open)?;
            match parameter.shape {
                Shape::Group(group) => write_usage(f, group, "")?,
                Shape::Word(_) | Shape::Flag => parameter.form().fmt(f)?,
            }
            f.write_str(close)
        })
}

impl Syntax {
    /// Makes the syntax of a command. Only the last parameter may be optional; this is checked at compile time.
    pub const fn new(
        name: &'static str,
        summary: &'static str,
        parameters: &'static [Parameter],
    ) -> Self {
        assert_optional_last(parameters);
        Self {
            name,
            summary,
            parameters,
            is_shown: false,
        }
    }

    /// Sets whether the command without arguments shows the current setting.
    pub const fn or_show(self, is_shown: bool) -> Self {
        Self { is_shown, ..self }
    }

    /// Calls `visit` with each parameter that takes one word, in the order of the line. Groups are visited word by word.
    ///
    /// # Errors
    /// The first error of `visit`, which ends the visits.
    pub fn visit<E>(
        &self,
        visit: &mut dyn FnMut(&'static Parameter) -> Result<(), E>,
    ) -> Result<(), E> {
        visit_all(self.parameters, visit)
    }
}

fn visit_all<E>(
    parameters: &'static [Parameter],
    visit: &mut dyn FnMut(&'static Parameter) -> Result<(), E>,
) -> Result<(), E> {
    parameters
        .iter()
        .try_for_each(|parameter| match parameter.shape {
            Shape::Group(group) => visit_all(group, visit),
            Shape::Word(_) | Shape::Flag => visit(parameter),
        })
}

impl Shape {
    /// Returns the shape of a parameter of several words. Only the last word may be optional; this is checked at compile time.
    pub const fn group(parameters: &'static [Parameter]) -> Self {
        assert_optional_last(parameters);
        Self::Group(parameters)
    }
}

impl Parameter {
    /// Returns the parameter's form in usage lines and error messages, such as `RADIUS`, `on|off` or `off|FIELD`.
    pub const fn form(&self) -> Form<'_> {
        Form(self)
    }
}

/// Displays a parameter of one word as in usage lines and error messages.
pub struct Form<'a>(&'a Parameter);

impl Display for Form<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Parameter { name, shape, .. } = self.0;
        match shape {
            Shape::Flag => return f.write_str(name),
            Shape::Word(WordKind::Words(words)) if words.len() <= USAGE_WORDS => {
                return write_list(f, words, "|");
            }
            Shape::Word(WordKind::Either(keyword, _)) => write!(f, "{keyword}|")?,
            Shape::Word(_) | Shape::Group(_) => {}
        }
        name.chars()
            .try_for_each(|c| f.write_char(c.to_ascii_uppercase()))
    }
}

/// Describes the texts that a parameter of one word accepts.
impl Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.shape {
            Shape::Word(kind) => kind.fmt(f),
            Shape::Flag | Shape::Group(_) => f.write_str(self.name),
        }
    }
}

impl Display for WordKind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Words(words) => write_list(f, words, " or "),
            Self::Text(text) => text.fmt(f),
            Self::Either(keyword, kind) => write!(f, "{keyword} or {kind}"),
            Self::Command => f.write_str("a command, `help` lists them"),
            Self::Name(_, text) => text.fmt(f),
            Self::Forms(forms) => forms.iter().enumerate().try_for_each(|(i, (form, _))| {
                f.write_str(if i == 0 { "" } else { " or " })?;
                f.write_str(form)
            }),
        }
    }
}

impl fmt::Debug for WordKind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{self}")
    }
}

fn write_list(f: &mut fmt::Formatter, words: &[&str], separator: &str) -> fmt::Result {
    words.iter().enumerate().try_for_each(|(i, word)| {
        f.write_str(if i == 0 { "" } else { separator })?;
        f.write_str(word)
    })
}
