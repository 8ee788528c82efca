//! Texts of the console and of scene files: commands, fields and pairs of eyes.

use glint_core::console::Command;
use glint_core::field::Field;
use glint_core::stereo::Stereo;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("command", |line: String| {
            Ok(Outcome::of(Command::parse(&line), |command| {
                command.map_or("no command", |_| "accepted").to_owned()
            }))
        }),
        Kind::new("field", |text: String| {
            Ok(Outcome::of(Field::parse(&text), |field| field.to_string()))
        }),
        Kind::new("stereo", |text: String| {
            Ok(Outcome::of(Stereo::parse(&text), |eyes| eyes.to_string()))
        }),
    ]
}
