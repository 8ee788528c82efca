//! The command `demo`: shows the scenes of a list in turn.

use glint_core::console::{DemoAction, DemoCommands};
use glint_core::demo::Move;

use crate::error::CommandError;
use crate::job::{CommandResult, Reply};
use crate::machine::Machine;

impl<'l> DemoCommands<'l> for Machine {
    fn demo(&mut self, action: Option<DemoAction>) -> CommandResult<'l> {
        let Machine {
            terminal,
            demo,
            library,
            clock,
            ..
        } = self;
        let now = clock.milliseconds();
        match action {
            None => {
                let state = match (demo.is_on(), demo.turns.is_held()) {
                    (false, _) => "off",
                    (true, false) => "on",
                    (true, true) => "held",
                };
                terminal.print_entry("demo", &state);
                if let (Some(number), Some(name)) = (demo.turns.number(), demo.scene()) {
                    let (number, count) = (number + 1, demo.turns.count());
                    terminal.print(format_args!("scene {number} of {count} {name}\n"));
                }
                if let Some(error) = demo.error() {
                    terminal.print_entry("error", &error);
                }
            }
            Some(DemoAction::On) => demo.start(library),
            Some(DemoAction::Off) => demo.stop(),
            Some(_) if !demo.is_on() => return Err(CommandError::DemoOff),
            Some(DemoAction::Next) => demo.turns.go(Move::Next),
            Some(DemoAction::Previous) => demo.turns.go(Move::Previous),
            Some(action @ (DemoAction::Hold | DemoAction::Run)) => {
                demo.turns.hold(now, action == DemoAction::Hold);
            }
        }
        Ok(Reply::Done)
    }
}
