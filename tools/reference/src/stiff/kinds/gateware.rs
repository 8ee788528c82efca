//! The console of the virtual board, the simulated gateware. All cases share a board, because its start takes a minute.

use glint::board::{Simulation, Uart};
use std::cell::RefCell;

use anyhow::{Context, Result};
use glint::board::{self, SimulatedBoard};
use glint::console::Console;

use super::console::{Session, outcome};
use crate::emulated::firmware;
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("gateware", gateware)]
}

thread_local! {
    static BOARD: RefCell<Option<SimulatedBoard>> = const { RefCell::new(None) };
}

/// Sends commands to the board; states the reply to the last command.
fn gateware(session: Session) -> Result<Outcome> {
    BOARD.with_borrow_mut(|board| {
        let board = match board {
            Some(board) => board,
            None => {
                let mut started = board::verilated(firmware()?)?;
                Console::new(&mut started).greet()?;
                board.insert(started)
            }
        };
        if let Some(sensor) = session.sensor {
            board.inner().plug(sensor.wires());
        }
        let (last, before) = session.commands.split_last().context("commands")?;
        let mut console = Console::new(board);
        for command in before {
            // A refused command may be part of the case.
            let _ = console.command(command);
        }
        let board = console.board().inner();
        board.run(u64::from(board.clock_hz()) / 1000 * session.wait);
        outcome(console.command(last), &session.lines)
    })
}
