//! The console: a line editor and the grammar of commands.
//!
//! [`LineEditor`] converts the bytes of a terminal to lines, [`Command::parse`] parses a line to a command, and
//! [`Command::execute`] calls the machine's method for this command. One table defines the commands; the parser, the help, the
//! completion and the traits that the machine implements are generated from this table. For each setting of a scene, the table also states
//! its key in scene files and its option on the command line of `glint`.

mod animate;
mod argument;
mod command;
mod completion;
mod editor;
mod effect;
mod error;
mod forms;
mod object;
mod program;
mod projection;
mod syntax;
mod table;
mod values;

pub use argument::OWN;
pub use command::{
    Command, DemoCommands, Executor, FORMS, FrameCommands, GestureCommands, ImuCommands,
    MachineCommands, OptionName, OrbitCommands, SceneCommands, Setting, accepted_words, write_help,
};
pub use completion::complete;
pub use editor::{Event, HISTORY, LINE_MAX, LineEditor, PROMPT};
pub use effect::Effect;
pub use error::ParseError;
pub use forms::{FIELD, Forms, HostOption, MESHES, Order, Row};
pub use object::ObjectAction;
pub use program::ProgramAction;
pub use syntax::{NameList, Names, NoNames};
pub use values::{DemoAction, GestureAction, ImuAction};
