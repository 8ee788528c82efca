//! Experiments with the whole firmware on the emulated board over hours of the board's time. Each experiment is a separate study, because
//! the longest experiment takes more than an hour of the host's time.

pub mod orbit;
pub mod sensor;
pub mod uptime;

/// Names of the studies. The file of a study is `long-NAME.csv`.
pub const STUDIES: [&str; 4] = [
    "orbit",
    "uptime",
    sensor::Path::Rest.name(),
    sensor::Path::Turning.name(),
];
