//! The console: a line editor and the grammar of commands.
//!
//! [`LineEditor`] turns the bytes of a terminal into lines, [`Command::parse`] turns a line into a command, and
//! [`Command::execute`] calls the command's method of the machine. One table states the commands; parser, help,
//! completion and the traits of the machine follow from it.

mod argument;
mod command;
mod completion;
mod editor;
mod error;
mod syntax;
mod table;
mod values;
mod words;

pub use command::{
    AppearanceCommands, CameraCommands, Command, Executor, FrameCommands, ImuCommands,
    MachineCommands, SceneCommands, write_help,
};
pub use editor::{Event, HISTORY, LINE_MAX, LineEditor, PROMPT};
pub use error::ParseError;
pub use values::ImuAction;
