//! The keys of scene files. The keys that are console commands come from the console's table.

use glint_core::console::{FORMS, Row};

/// The keys that are console commands, in the order of their execution.
pub fn commands() -> Vec<&'static Row> {
    let mut rows: Vec<_> = FORMS.iter().collect();
    rows.sort_by_key(|row| row.forms.order);
    rows
}

/// The keys that are not console commands.
pub const OTHERS: [&str; 8] = [
    "title", "steer", "scenes", "depth", "geometry", "lanes", "clock", "budget",
];

/// The members of the key `budget`.
pub const BUDGET: [&str; 7] = ["lut", "ff", "dsp", "ramb36", "firmware", "cycles", "fps"];

/// The names of all keys.
pub fn names() -> impl Iterator<Item = &'static str> {
    OTHERS.into_iter().chain(FORMS.iter().map(Row::key))
}
