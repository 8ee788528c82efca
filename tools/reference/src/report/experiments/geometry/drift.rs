//! Drift of the wireframe simulator's rotations.

use serde::{Deserialize, Serialize};

use crate::wireframe::{Drift, Form, Session, drift};

/// Numbers of steps at which the errors are measured.
const STEPS: [u32; 5] = [1, 10, 100, 1_000, 10_000];

/// Errors of the corners of a cube of side 4 after some rotations: a line of `geometry-drift.csv`.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Sequence of rotations.
    pub session: String,
    /// Implementation of the motion.
    pub form: String,
    /// Number of rotations.
    pub steps: u32,
    /// Largest distance of a corner from its position in f64.
    pub max_err: f64,
    /// Relative growth of the corners' mean distance from the origin.
    pub growth: f64,
}

/// Measures all sessions with all implementations of the motion.
pub fn measure() -> Vec<Row> {
    let mut rows = Vec::new();
    for session in Session::ALL {
        for form in Form::ALL {
            for Drift {
                steps,
                distance,
                growth,
            } in drift(form, session, &STEPS)
            {
                rows.push(Row {
                    session: session.name().to_owned(),
                    form: form.name().to_owned(),
                    steps,
                    max_err: distance,
                    growth,
                });
            }
        }
    }
    rows
}
