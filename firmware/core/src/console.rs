//! The console: a line editor and the grammar of commands.
//!
//! [`LineEditor`] turns the bytes of a terminal into lines, [`Command::parse`] turns a line into a command. Commands
//! are defined by one table, from which the parser and the help follow.

mod command;
mod editor;
mod error;
mod grammar;

pub use command::{Command, ImuAction, write_help};
pub use editor::{Event, HISTORY, LINE_MAX, LineEditor};
pub use error::ParseError;

/// What the console writes before it reads a line.
pub const PROMPT: &str = "glint> ";
