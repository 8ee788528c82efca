//! Tests of the console: line editor, completion, grammar and help.

mod commands;
mod editor;
mod errors;
mod help;
