//! Model matrices: singular and out-of-range matrices, products, points and normals.

use anyhow::{Context, Result};
use glint_core::choice::Choice;
use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix, MatrixError};
use serde::Deserialize;

use super::frames::number;
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("matrix", |numbers: Numbers| {
            Ok(Outcome::of(numbers.matrix(), |matrix| {
                match matrix.mirrors() {
                    true => "accepted, mirrors".to_owned(),
                    false => "accepted".to_owned(),
                }
            }))
        }),
        Kind::new("matrix-product", |[first, second]: [Numbers; 2]| {
            let product = first.matrix()?.then(&second.matrix()?);
            Ok(Outcome::of(product, |product| {
                let [a, b, c] = product.linear().map(vector);
                format!(
                    "rows {a}, {b}, {c}, translation {}",
                    vector(product.place())
                )
            }))
        }),
        Kind::new("matrix-rotation", |Rotation { axis, angle }| {
            let axis = Axis::from_word(&axis).with_context(|| format!("no axis {axis:?}"))?;
            let [a, b, c] = Matrix::rotation(axis, Turns(angle)).linear().map(vector);
            Ok(Outcome::exact(format!("rows {a}, {b}, {c}")))
        }),
        Kind::new("matrix-point", |Mapped { matrix, vector }| {
            let point = matrix.matrix()?.apply(vector);
            Ok(Outcome::exact(format!("{point:?} of 2^-38")))
        }),
        Kind::new("matrix-normal", |Mapped { matrix, vector }| {
            let normal = matrix.matrix()?.normals().apply(vector);
            Ok(Outcome::exact(format!("{normal:?} of 2^-14")))
        }),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Numbers {
    rows: [[f64; 3]; 3],
    #[serde(default)]
    translation: [f64; 3],
}

impl Numbers {
    fn matrix(&self) -> Result<Matrix, MatrixError> {
        Matrix::new_checked(
            self.rows.map(|row| row.map(number)),
            self.translation.map(number),
        )
    }
}

fn vector([x, y, z]: [Q8_24; 3]) -> String {
    format!("({x}, {y}, {z})")
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rotation {
    axis: String,
    /// Angle in 2^-32 turns.
    angle: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mapped {
    matrix: Numbers,
    /// A point or a normal, in 2^-14.
    vector: [i16; 3],
}
