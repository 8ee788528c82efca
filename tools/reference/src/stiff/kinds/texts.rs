//! Texts of the console and of scene files: typed lines, commands, fields, lights and stereo parameters.

use glint_core::console::{Command, Event, LineEditor, NoNames};
use glint_core::field::Field;
use glint_core::light::Light;
use glint_core::stereo::Stereo;
use serde::Deserialize;

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
        Kind::new("light", |text: String| {
            Ok(Outcome::of(Light::parse(&text), |light| {
                format!("{light}, direction {:?} of 2^-14", light.direction())
            }))
        }),
        Kind::new("typed", |typed: Typed| Ok(typed.events())),
        Kind::new("stereo", |text: String| {
            Ok(Outcome::of(Stereo::parse(&text), |eyes| eyes.to_string()))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Typed {
    /// Start of the typed text. Then `repeated` follows `times` times, then `end`.
    #[serde(default)]
    text: String,
    #[serde(default)]
    repeated: String,
    #[serde(default)]
    times: usize,
    end: String,
}

impl Typed {
    /// The events of the line editor.
    fn events(&self) -> Outcome {
        let mut editor = LineEditor::new();
        let mut echo = String::new();
        let bytes = [&self.text, &self.repeated.repeat(self.times), &self.end];
        let mut events = Vec::new();
        for byte in bytes.into_iter().flat_map(|text| text.bytes()) {
            match editor.on_byte(byte, &NoNames, &mut echo) {
                Event::None => {}
                Event::Line(line) if line.len() > 40 => {
                    events.push(format!("a line of {} characters", line.len()));
                }
                Event::Line(line) => events.push(format!("line {line:?}")),
                Event::Overlong => events.push("a line that is too long".to_owned()),
                Event::Interrupt => events.push("an interrupt".to_owned()),
            }
        }
        Outcome::exact(events.join(", "))
    }
}
