//! Drift of objects that turn by many small steps.

use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix, MatrixError};
use glint_core::object::Place;
use glint_scene::{Name, PlacedMesh};

/// Method of turning an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The method of scenes: rotations keep the lengths and angles that the object's axes had before the first of the rotations.
    Kept,
    /// Products of matrices alone.
    Products,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 2] = [Self::Kept, Self::Products];

    /// Name of the method in the report.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Kept => "shape kept",
            Self::Products => "products alone",
        }
    }
}

/// Errors of a model matrix after some rotations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned {
    /// Number of rotations.
    pub steps: u32,
    /// Largest error of an entry of the matrix.
    pub error: f64,
    /// Largest relative change, by magnitude, of the length of an axis of the object.
    pub growth: f64,
}

/// Turns an object with this model matrix by `angle` about an axis of the world, and returns the errors after each number of steps
/// in the ascending list `after`.
///
/// # Errors
/// A matrix is out of range.
pub fn turned(
    method: Method,
    shape: Matrix,
    axis: Axis,
    angle: Turns,
    after: &[u32],
) -> Result<Vec<Turned>, MatrixError> {
    let placed = |matrix| Place {
        matrix,
        ..Place::default()
    };
    let step = placed(Matrix::rotation(axis, angle));
    let mut object = PlacedMesh::new(Name::new(), placed(shape));
    let mut done = 0;
    let mut errors = Vec::new();
    for &steps in after {
        for _ in done..steps {
            match method {
                Method::Kept => object.change(&step)?,
                Method::Products => object.place = object.place.then(&step)?,
            }
        }
        done = steps;
        let whole = Matrix::rotation(axis, Turns(angle.0.wrapping_mul(steps)));
        let (found, start) = (linear(&object.place.matrix), linear(&shape));
        let exact = product(linear(&whole), start);
        let entries = found.as_flattened().iter().zip(exact.as_flattened());
        let lengths = [0, 1, 2].map(|i| length(&found, i) / length(&start, i) - 1.0);
        errors.push(Turned {
            steps,
            error: entries.fold(0.0, |most, (a, b)| (a - b).abs().max(most)),
            growth: lengths.into_iter().fold(0.0, |most: f64, growth| {
                if growth.abs() > most.abs() {
                    growth
                } else {
                    most
                }
            }),
        });
    }
    Ok(errors)
}

type Rows = [[f64; 3]; 3];

fn linear(matrix: &Matrix) -> Rows {
    matrix.linear().map(|row| row.map(Q8_24::to_num))
}

fn product(a: Rows, b: Rows) -> Rows {
    a.map(|row| [0, 1, 2].map(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
}

/// Length of a column, which is an axis of the object.
fn length(rows: &Rows, column: usize) -> f64 {
    rows.iter()
        .map(|row| row[column] * row[column])
        .sum::<f64>()
        .sqrt()
}
