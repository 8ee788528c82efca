//! Drift of objects that turn by small steps.

use anyhow::Result;
use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix};
use serde::{Deserialize, Serialize};

use crate::object::{Method, Turned, turned};

/// Numbers of rotations at which the errors are measured.
const STEPS: [u32; 6] = [1, 10, 100, 1_000, 10_000, 36_000];

/// Errors of a model matrix after some rotations by 0.1°: a line of `geometry-turns.csv`.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Scale of the object along its axes.
    pub object: String,
    /// Method of turning.
    pub form: String,
    /// Number of rotations.
    pub steps: u32,
    /// Largest error of an entry of the matrix.
    pub max_err: f64,
    /// Largest relative change, by magnitude, of the length of an axis of the object.
    pub growth: f64,
}

/// Measures objects of several scales by all methods.
///
/// # Errors
/// None: all matrices are in range.
pub fn measure() -> Result<Vec<Row>> {
    let step = Turns::from_degrees("0.1".parse()?);
    let mut rows = Vec::new();
    for (object, scale) in [
        ("scale 1", [1.0; 3]),
        ("scale 0.3", [0.3; 3]),
        ("scale 4, 0.05, -1", [4.0, 0.05, -1.0]),
    ] {
        let shape = Matrix::scale(scale.map(Q8_24::from_num))?;
        for method in Method::ALL {
            for Turned {
                steps,
                error,
                growth,
            } in turned(method, shape, Axis::Z, step, &STEPS)?
            {
                rows.push(Row {
                    object: object.to_owned(),
                    form: method.name().to_owned(),
                    steps,
                    max_err: error,
                    growth,
                });
            }
        }
    }
    Ok(rows)
}
