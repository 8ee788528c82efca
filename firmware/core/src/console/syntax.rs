//! The syntax of commands as data, for help, error messages and completion.

use core::fmt::{self, Display, Write as _};

/// A command's name, help line and parameters.
#[derive(Debug)]
pub struct Syntax {
    /// The first word of the line.
    pub name: &'static str,
    /// Help line: imperative, without a full stop.
    pub summary: &'static str,
    /// Parameters in their order. Only the last one may be optional.
    pub parameters: &'static [Parameter],
}

/// A parameter of a command.
#[derive(Debug)]
pub struct Parameter {
    /// Name in lower case, as in the command's enumeration.
    pub name: &'static str,
    /// Whether the line may end before this parameter.
    pub optional: bool,
    /// Words of the parameter.
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

/// The words of a parameter.
#[derive(Debug)]
pub enum Shape {
    /// One word.
    Word(&'static Kind),
    /// A keyword: the parameter's own name.
    Flag,
    /// Parameters of a value that takes several words.
    Group(&'static [Parameter]),
}

/// The accepted texts of a word.
pub enum Kind {
    /// One of a list of words.
    Words(&'static [&'static str]),
    /// A text with this description.
    Text(&'static (dyn Display + Sync)),
    /// A keyword, or a word of the other kind.
    Either(&'static str, &'static Kind),
    /// The name of a command.
    Command,
}

/// Longest list of words in a usage line; a longer list is replaced by the parameter's name.
const USAGE_WORDS: usize = 3;

/// The usage line: name and parameters.
impl Display for Syntax {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)?;
        write_usage(f, self.parameters, " ")
    }
}

/// Writes parameters with blanks between them, after `lead`.
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
    /// A command. Only the last parameter may be optional, which is checked at compile time.
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
        }
    }

    /// Calls `visit` with each parameter of one word, in the order of the line.
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
    /// A value of several words. Only the last parameter may be optional.
    pub const fn group(parameters: &'static [Parameter]) -> Self {
        assert_optional_last(parameters);
        Self::Group(parameters)
    }
}

impl Parameter {
    /// The parameter in usage lines and messages, such as `RADIUS`, `on|off` or `off|FIELD`.
    pub const fn form(&self) -> Form<'_> {
        Form(self)
    }
}

/// A parameter of one word in usage lines and messages.
pub struct Form<'a>(&'a Parameter);

impl Display for Form<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Parameter { name, shape, .. } = self.0;
        match shape {
            Shape::Flag => return f.write_str(name),
            Shape::Word(Kind::Words(words)) if words.len() <= USAGE_WORDS => {
                return write_list(f, words, "|");
            }
            Shape::Word(Kind::Either(keyword, _)) => write!(f, "{keyword}|")?,
            Shape::Word(_) | Shape::Group(_) => {}
        }
        name.chars()
            .try_for_each(|c| f.write_char(c.to_ascii_uppercase()))
    }
}

/// The accepted texts of a parameter of one word.
impl Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.shape {
            Shape::Word(kind) => kind.fmt(f),
            Shape::Flag | Shape::Group(_) => f.write_str(self.name),
        }
    }
}

impl Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Words(words) => write_list(f, words, " or "),
            Self::Text(text) => text.fmt(f),
            Self::Either(keyword, kind) => write!(f, "{keyword} or {kind}"),
            Self::Command => f.write_str("a command, `help` lists them"),
        }
    }
}

impl fmt::Debug for Kind {
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
