//! Text form of scenes: console commands, one per line.

use core::fmt;

use glint_core::console::{Command, Effect, ObjectAction, ParseError, Setting};
use glint_core::feature::{BASE, Feature, WIREFRAME};

use crate::error::SettingError;
use crate::scene::{Board, Scene};

/// Error in the text form of a scene.
#[derive(Clone, Copy, Debug)]
pub struct LineError<'a> {
    /// Number of the line, from 1.
    pub line: usize,
    /// Reason why the line is rejected.
    pub reason: Reason<'a>,
}

/// Reason why a line of a scene is rejected.
#[derive(Clone, Copy, Debug)]
pub enum Reason<'a> {
    /// The line is not a command.
    Parse(ParseError<'a>),
    /// The line is blank, or a command that does not set the picture.
    Effect,
}

impl fmt::Display for LineError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { line, reason } = self;
        write!(f, "line {line}: {reason}")
    }
}

impl fmt::Display for Reason<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Parse(error) => error.fmt(f),
            Self::Effect => f.write_str("expected a command that sets the picture"),
        }
    }
}

/// Effect of a line of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line<'l> {
    /// Sets an option.
    Option(Setting<'l>),
    /// Shows a mesh, even if a scene has the same name.
    Mesh(&'l str),
    /// Shows the wireframe: the program with this name, or for `None` the program of the scene.
    Wireframe(Option<&'l str>),
    /// Sets or starts the motion of the camera or the wireframe.
    Motion(Command<'l>),
}

impl<'l> Line<'l> {
    /// Reads a line.
    ///
    /// # Errors
    /// The line is not a command that sets the picture.
    pub fn parse(text: &'l str) -> Result<Self, Reason<'l>> {
        let command = Command::parse(text).map_err(Reason::Parse)?;
        let command = command.ok_or(Reason::Effect)?;
        match command.effect() {
            Effect::Option(setting) => Ok(Self::Option(*setting)),
            Effect::Subject(mesh) => Ok(Self::Mesh(mesh)),
            Effect::Wireframe(program) => Ok(Self::Wireframe(program)),
            Effect::Motion => Ok(Self::Motion(command)),
            Effect::None | Effect::Uploads => Err(Reason::Effect),
        }
    }

    /// Name of the mesh that the line shows, or adds to the objects.
    pub const fn mesh(&self) -> Option<&'l str> {
        match self {
            Self::Mesh(mesh)
            | Self::Option(Setting::Object {
                action: ObjectAction::Add { mesh, .. },
            }) => Some(mesh),
            Self::Option(_) | Self::Wireframe(_) | Self::Motion(_) => None,
        }
    }

    /// Name of the texture that the line sets.
    pub const fn texture(&self) -> Option<&'l str> {
        match self {
            Self::Option(Setting::Texture { texture }) => *texture,
            Self::Option(_) | Self::Mesh(_) | Self::Wireframe(_) | Self::Motion(_) => None,
        }
    }

    /// Name of the wireframe program that the line shows.
    pub const fn program(&self) -> Option<&'l str> {
        match self {
            Self::Wireframe(program) => *program,
            Self::Option(_) | Self::Mesh(_) | Self::Motion(_) => None,
        }
    }

    /// The feature that contains the line's command.
    pub const fn feature(&self) -> Feature {
        match self {
            Self::Option(setting) => setting.name().feature(),
            Self::Mesh(_) => BASE,
            Self::Wireframe(_) => WIREFRAME,
            Self::Motion(command) => command.feature(),
        }
    }

    /// Applies the line to `scene`, unless it is a motion.
    ///
    /// # Errors
    /// The errors of [`Scene::apply`] and [`Scene::show_program`].
    pub fn apply(&self, scene: &mut Scene, board: &mut dyn Board) -> Result<(), SettingError<'l>> {
        match self {
            Self::Option(setting) => scene.apply(setting, board)?,
            Self::Mesh(mesh) => scene.show_mesh(mesh),
            Self::Wireframe(program) => scene.show_program(*program, board)?,
            Self::Motion(_) => {}
        }
        Ok(())
    }
}

/// The lines of a scene with their numbers, from 1.
pub fn lines(text: &str) -> impl Iterator<Item = Result<(usize, Line<'_>), LineError<'_>>> {
    text.lines().zip(1..).map(|(text, line)| {
        let parsed = Line::parse(text);
        let parsed = parsed.map_err(|reason| LineError { line, reason })?;
        Ok((line, parsed))
    })
}
