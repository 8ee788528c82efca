//! Scenes as text: console commands, a line each.

use core::fmt;

use crate::block::Block;
use crate::console::{Command, Effect, ParseError};
use crate::picture::Backend;

/// Reason why a text is not a scene.
#[derive(Clone, Copy, Debug)]
pub struct LineError<'a> {
    /// Number of the line, from 1.
    pub line: usize,
    /// Reason why the line is refused.
    pub reason: Reason<'a>,
}

/// Reason why a line of a scene is refused.
#[derive(Clone, Copy, Debug)]
pub enum Reason<'a> {
    /// It is not a command.
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

/// The commands of a scene with their lines' numbers, from 1. Each sets the picture, or what moves the camera.
pub fn commands(text: &str) -> impl Iterator<Item = Result<(usize, Command<'_>), LineError<'_>>> {
    text.lines().zip(1..).map(|(text, line)| {
        let error = |reason| LineError { line, reason };
        let command = Command::parse(text).map_err(|reason| error(Reason::Parse(reason)))?;
        command
            .filter(|command| command.effect() == Effect::Picture)
            .map(|command| (line, command))
            .ok_or_else(|| error(Reason::Effect))
    })
}

/// The optional blocks of the gateware that these commands need together, a bit for each ([`Block::bit`]). A picture of the soft core
/// needs no engine.
pub fn blocks<'a>(commands: impl Iterator<Item = Command<'a>>) -> u32 {
    const ENGINES: u32 = Block::Triangle.bit() | Block::Line.bit() | Block::Raymarch.bit();
    let (mut blocks, mut unused) = (Block::Scanout.bit(), 0);
    for command in commands {
        if let Command::Backend {
            backend: Some(backend),
        } = command
        {
            unused = match backend {
                Backend::Cpu => ENGINES,
                Backend::Gateware => 0,
            };
        }
        let needed = command.blocks().iter();
        blocks = needed.fold(blocks, |blocks, block| blocks | block.bit());
    }
    blocks & !unused
}

/// The blocks that these bits stand for.
pub fn blocks_of(bits: u32) -> impl Iterator<Item = Block> {
    let all = Block::ALL.into_iter();
    all.filter(move |block| block.bit() & bits != 0)
}
