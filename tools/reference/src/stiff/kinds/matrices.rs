//! Model matrices: singular ones, and those out of range.

use anyhow::Result;
use glint_core::matrix::Matrix;
use serde::Deserialize;

use super::frames::number;
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("matrix", matrix)]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Numbers {
    rows: [[f64; 3]; 3],
    #[serde(default)]
    translation: [f64; 3],
}

fn matrix(Numbers { rows, translation }: Numbers) -> Result<Outcome> {
    let matrix = Matrix::new_checked(rows.map(|row| row.map(number)), translation.map(number));
    Ok(Outcome::of(matrix, |matrix| match matrix.mirrors() {
        true => "accepted, mirrors".to_owned(),
        false => "accepted".to_owned(),
    }))
}
