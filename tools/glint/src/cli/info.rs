//! `glint info`.

use super::common::LineArguments;
use super::config::BoardChoice;
use super::messages::{print_json, say};
use clap::Args;
use glint::console::Console;
use serde_json::{Map, Value};

/// Show information about a board: its gateware, firmware, clock, memory and state.
#[derive(Args)]
pub struct InfoArguments {
    #[command(flatten)]
    board: BoardChoice,
    #[command(flatten)]
    line: LineArguments,
    /// Print the entries as JSON: an object whose values are strings.
    #[arg(long)]
    json: bool,
}

impl InfoArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let mut board = self.line.board(&self.board.name()?)?;
        let lines = Console::new(&mut *board).command("info")?;
        if !self.json {
            return lines.iter().try_for_each(say);
        }
        let entries: Map<String, Value> = lines
            .iter()
            .map(|line| line.split_once(' ').unwrap_or((line, "")))
            .map(|(key, value)| (key.to_owned(), value.into()))
            .collect();
        print_json(&entries)
    }
}
