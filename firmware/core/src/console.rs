//! The console: a line editor and the grammar of commands.

mod command;
mod editor;

pub use command::{Backend, Command, ParseError, Size, write_help};
pub use editor::{Event, LINE_MAX, LineEditor};

/// What the console writes before it reads a line.
pub const PROMPT: &str = "glint> ";
