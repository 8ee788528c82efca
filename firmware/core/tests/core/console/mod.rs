//! Tests of the console: line editor, completion, grammar and help.

mod commands;
mod editor;
mod effects;
mod errors;
mod help;
