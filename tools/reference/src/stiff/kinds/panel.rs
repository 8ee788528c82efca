//! Displays of digits, the demo's sequence of scenes, and buttons.

use anyhow::{Result, bail};
use glint_core::demo::{Demo, Move};
use glint_core::digits::Display;
use glint_core::wireframe::Debouncer;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("digits", |shown: DigitsInput| {
            let display = match shown {
                DigitsInput::Number(number) => Display::number(number.parse()?),
                DigitsInput::Error(number) => Display::error(number),
                DigitsInput::Text(text) => Display::of(format_args!("{text}")),
            };
            Ok(Outcome::exact(seen(display.digits())?))
        }),
        Kind::new("demo", demo),
        Kind::new("buttons", buttons),
    ]
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum DigitsInput {
    /// A number as text, because it may have 64 bits.
    Number(String),
    Error(u8),
    Text(String),
}

/// The visible characters of a display.
fn seen(digits: [u8; glint_core::digits::COUNT]) -> Result<String> {
    let known = |lit: u8| {
        let mut known = "0123456789E-".chars();
        known.find(|character| glint_core::digits::segments(*character) == lit)
    };
    let character = |lit: u8| match (lit, known(lit)) {
        (0, _) => Ok('_'),
        (_, Some(character)) => Ok(character),
        _ => bail!("no character has the segments {lit:#x}"),
    };
    digits.into_iter().map(character).collect()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turns {
    scenes: usize,
    steps: Vec<Step>,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Step {
    /// Polls at this time in ms.
    At(u64),
    Next,
    Previous,
    /// Holds the scene from this time on.
    Hold(u64),
    /// Ends the hold at this time.
    GoOn(u64),
    Stop,
}

/// The demo's scene at each poll.
fn demo(Turns { scenes, steps }: Turns) -> Result<Outcome> {
    let mut demo = Demo::default();
    demo.start(scenes);
    let mut shown = Vec::new();
    for step in steps {
        match step {
            Step::At(now) => shown.push(demo.poll(now).map_or("-".to_owned(), |n| n.to_string())),
            Step::Next => demo.go(Move::Next),
            Step::Previous => demo.go(Move::Previous),
            Step::Hold(now) => demo.hold(now, true),
            Step::GoOn(now) => demo.hold(now, false),
            Step::Stop => demo.stop(),
        }
    }
    Ok(Outcome::exact(shown.join(" ")))
}

/// The accepted presses for samples of the buttons' levels, each with a time in ms modulo 2^32.
fn buttons(samples: Vec<(u32, u8)>) -> Result<Outcome> {
    let mut debouncer = Debouncer::default();
    let presses = samples
        .into_iter()
        .map(|(now, levels)| debouncer.sample(now, levels).to_string());
    Ok(Outcome::exact(presses.collect::<Vec<_>>().join(" ")))
}
