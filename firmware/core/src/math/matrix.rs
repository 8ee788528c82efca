//! Model matrices: the position, rotation and scale of an object in the world.
//!
//! A [`Matrix`] maps a point P of a mesh to the point A·P + t of the world, with the 3×3 matrix A and the translation t in
//! Q8.24. Every matrix is in range and not singular: an operation with an out-of-range or singular result fails with an error
//! that names the row. No operation saturates.

use core::fmt;

use crate::choice::choices;
use crate::fixed::{Decimal, Q2_30, Q8_24, Turns, wide};
use crate::trig::sin_cos_q30;
use crate::vector::{cross, dot, unit};

/// Largest magnitude of an entry of the 3×3 matrix.
pub const MAX_ENTRY: Q8_24 = Q8_24::lit("16");
/// Largest magnitude of a component of the translation, in world units.
pub const MAX_TRANSLATION: Q8_24 = Q8_24::lit("32");
/// Smallest length of a row of the 3×3 matrix.
pub const MIN_ROW: Q8_24 = Q8_24::lit("0.001");
/// Smallest sine of the angle between a row and the rows before it, 2^−10 in units of 2^−30.
const MIN_SINE: i64 = 1 << 20;

/// An axis of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first horizontal axis.
    X,
    /// The second horizontal axis.
    Y,
    /// The axis z, which points up.
    Z,
}

choices!(Axis {
    X: "x",
    Y: "y",
    Z: "z"
});

/// A checked model matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Matrix {
    linear: [[Q8_24; 3]; 3],
    translation: [Q8_24; 3],
    mirrors: bool,
}

impl Matrix {
    /// The identity matrix.
    pub const IDENTITY: Self = {
        let [zero, one] = [Q8_24::ZERO, Q8_24::ONE];
        Self {
            linear: [[one, zero, zero], [zero, one, zero], [zero, zero, one]],
            translation: [zero; 3],
            mirrors: false,
        }
    };

    /// Makes a matrix from its rows and its translation, after checking them.
    ///
    /// Entries are within ±[`MAX_ENTRY`], the translation is within ±[`MAX_TRANSLATION`], every row is at least [`MIN_ROW`] long, and
    /// the sine of the angle between a row and the plane or line through the rows before it is at least 2^−10.
    ///
    /// # Errors
    /// The first row that violates a condition.
    // Not inlined, so that the firmware contains one copy.
    #[inline(never)]
    pub fn new_checked(
        linear: [[Q8_24; 3]; 3],
        translation: [Q8_24; 3],
    ) -> Result<Self, MatrixError> {
        let mut directions = [[0; 3]; 3];
        for (row, entries) in linear.into_iter().enumerate() {
            if entries
                .iter()
                .any(|x| x.unsigned_abs() > MAX_ENTRY.unsigned_abs())
            {
                return Err(MatrixError::Entry { row, entries });
            }
            let distance = translation[row];
            if distance.unsigned_abs() > MAX_TRANSLATION.unsigned_abs() {
                return Err(MatrixError::Translation { row, distance });
            }
            let bits = entries.map(Q8_24::to_bits);
            directions[row] = match unit::<30>(bits.map(i64::from)) {
                Some(direction) if is_long(bits) => direction,
                _ => return Err(MatrixError::Short { row, entries }),
            };
        }
        let [first, second, third] = directions;
        let normal = cross(first, second).map(|x| (x >> 30) as i32);
        if dot(normal, normal) < MIN_SINE * MIN_SINE {
            return Err(MatrixError::Singular { row: 1 });
        }
        let volume = dot(normal, third) >> 30;
        if volume.abs() < MIN_SINE {
            return Err(MatrixError::Singular { row: 2 });
        }
        Ok(Self {
            linear,
            translation,
            mirrors: volume < 0,
        })
    }

    /// The rotation about `axis` by `angle`: x turns to y about the z axis, y to z about the x axis, and z to x about the y axis.
    ///
    /// Quarter turns are exact; the error of other entries is at most 0.51 units (2^−24).
    #[inline(never)]
    pub fn rotation(axis: Axis, angle: Turns) -> Self {
        let narrow = |x: Q2_30| Q8_24::from_bits((x.to_bits() + (1 << 5)) >> 6);
        let (sin, cos) = sin_cos_q30(angle);
        // The sine is rounded as a magnitude and then negated, so that the matrix of −angle is exactly the transpose.
        let sin = if sin < 0 { -narrow(-sin) } else { narrow(sin) };
        let cos = if cos < 0 { -narrow(-cos) } else { narrow(cos) };
        let (i, j) = match axis {
            Axis::X => (1, 2),
            Axis::Y => (2, 0),
            Axis::Z => (0, 1),
        };
        let mut rotation = Self::IDENTITY;
        rotation.linear[i][i] = cos;
        rotation.linear[j][j] = cos;
        rotation.linear[i][j] = -sin;
        rotation.linear[j][i] = sin;
        rotation
    }

    /// The scaling by a factor for each axis, exactly. A negative factor causes a reflection.
    ///
    /// # Errors
    /// A factor is not between 0.001 and 16 in magnitude.
    pub fn scale([x, y, z]: [Q8_24; 3]) -> Result<Self, MatrixError> {
        let zero = Q8_24::ZERO;
        Self::new_checked(
            [[x, zero, zero], [zero, y, zero], [zero, zero, z]],
            [zero; 3],
        )
    }

    /// The translation by a vector, in world units, exactly.
    ///
    /// # Errors
    /// A component exceeds 32 in magnitude.
    pub fn translation(by: [Q8_24; 3]) -> Result<Self, MatrixError> {
        Self::new_checked(Self::IDENTITY.linear, by)
    }

    /// Returns the matrix that applies this matrix first and `next` second. The error of each number is at most half a unit
    /// (2^−25), because each number is rounded once, to nearest.
    ///
    /// # Errors
    /// The result is out of range or singular.
    #[inline(never)]
    pub fn then(&self, next: &Self) -> Result<Self, MatrixError> {
        // An entry is at most 2^28 and a component of the translation at most 2^29, so the sums are below 2^59. The result is at most
        // 3·16·32 + 32, which exceeds the range of Q8.24; a saturated result is far outside the range of a matrix.
        let product = |row: [Q8_24; 3], column: [Q8_24; 3], addend: Q8_24| {
            let sum: i64 = core::iter::zip(row, column)
                .map(|(a, b)| i64::from(a.to_bits()) * i64::from(b.to_bits()))
                .sum();
            let sum = sum + (i64::from(addend.to_bits()) << 24);
            let rounded = (sum + (1 << 23)) >> 24;
            Q8_24::from_bits(rounded.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
        };
        let [a, b, c] = self.linear;
        let columns = [0, 1, 2].map(|j| [a[j], b[j], c[j]]);
        Self::new_checked(
            next.linear
                .map(|row| columns.map(|column| product(row, column, Q8_24::ZERO))),
            [0, 1, 2].map(|i| product(next.linear[i], self.translation, next.translation[i])),
        )
    }

    /// Returns this matrix turned by `angle` about an axis through the mesh's origin that is parallel to a
    /// world axis. The origin keeps its position. The error of each entry is that of [`then`](Self::then) and [`rotation`](Self::rotation).
    ///
    /// # Errors
    /// The result is out of range or singular.
    pub fn turned(&self, axis: Axis, angle: Turns) -> Result<Self, MatrixError> {
        let at_origin = Self {
            translation: [Q8_24::ZERO; 3],
            ..*self
        };
        let turned = at_origin.then(&Self::rotation(axis, angle))?;
        Ok(Self {
            translation: self.translation,
            ..turned
        })
    }

    /// Whether the 3×3 matrix is a rotation, apart from the rounding of its entries.
    pub fn is_rotation(&self) -> bool {
        let [a, b, c] = self.linear.map(|row| row.map(Q8_24::to_bits));
        let lengths = [a, b, c].map(|row| dot(row, row) - (1 << 48));
        let products = [dot(a, b), dot(b, c), dot(c, a)];
        let mut errors = lengths.into_iter().chain(products);
        !self.mirrors && errors.all(|x| x.abs() < ROTATION_SLACK)
    }

    /// Removes rounding errors from this matrix, which is a product of rotations and `shape`. If they have
    /// changed the lengths or angles of the columns by more than a few units, the result has the lengths
    /// and angles of `shape`. Without this correction, many small rotations would deform an object.
    ///
    /// By Gram–Schmidt, a matrix is the product of a rotation and a triangular matrix; a rotation from the
    /// left does not change the triangular matrix. The result has this matrix's rotation and the
    /// triangular matrix of `shape`.
    #[must_use]
    pub fn with_shape_of(&self, shape: &Self) -> Self {
        let (axes, found) = triangular(&self.linear);
        let (_, wanted) = triangular(&shape.linear);
        let is_kept = core::iter::zip(found, wanted).all(|(found, wanted)| {
            let largest = wanted.iter().fold(0, |largest, x| largest.max(x.abs()));
            let slack = SHAPE_SLACK * (1 + (largest >> 24));
            core::iter::zip(found, wanted).all(|(found, wanted)| (found - wanted).abs() <= slack)
        });
        if is_kept {
            return *self;
        }
        let linear = [0, 1, 2].map(|row| {
            wanted.map(|column| {
                // The axes have length 1 and the column is below 2^29, so the sum is below 2^60.
                let sum: i64 = core::iter::zip(axes, column)
                    .map(|(axis, x)| i64::from(axis[row]) * x)
                    .sum();
                Q8_24::from_bits(((sum + (1 << 29)) >> 30) as i32)
            })
        });
        // Rounding can only cause an error at an end of the range.
        Self::new_checked(linear, self.translation).unwrap_or(*self)
    }

    /// The point of the world to which the matrix maps a position (s2.14), exact, in units of 2^−38.
    pub fn apply(&self, position: [i16; 3]) -> [i64; 3] {
        // An entry is at most 2^28 and a coordinate at most 2^15, so the sums are below 2^46.
        [0, 1, 2].map(|i| {
            let sum: i64 = core::iter::zip(self.linear[i], position)
                .map(|(a, b)| wide(a.to_bits(), b.into()))
                .sum();
            sum + (i64::from(self.translation[i].to_bits()) << 14)
        })
    }

    /// The rows of the 3×3 matrix A.
    pub const fn linear(&self) -> [[Q8_24; 3]; 3] {
        self.linear
    }

    /// The translation t in world units: the position of the mesh's origin.
    pub const fn place(&self) -> [Q8_24; 3] {
        self.translation
    }

    /// Whether the determinant is negative, so that the mesh is mirrored and its front faces are clockwise.
    pub const fn mirrors(&self) -> bool {
        self.mirrors
    }

    /// The matrix for the normals of the mesh.
    #[inline(never)]
    pub fn normals(&self) -> Normals {
        let rows = self.linear.map(|row| row.map(Q8_24::to_bits));
        let [a, b, c] = rows;
        // Entries are at most 2^28, so the sum of two products is at most 2^57.
        let mut cofactors = [cross(b, c), cross(c, a), cross(a, b)];
        let largest = cofactors
            .as_flattened()
            .iter()
            .fold(1, |largest, x| largest | x.unsigned_abs());
        let cut = largest.ilog2().saturating_sub(LEAD);
        let raise = LEAD.saturating_sub(largest.ilog2());
        for x in cofactors.as_flattened_mut() {
            *x = (*x >> cut) << raise;
            if self.mirrors {
                *x = -*x;
            }
        }
        Normals {
            cofactors,
            rotation: rotation_of(rows),
        }
    }
}

/// Number of the highest bit of the largest cofactor after scaling. Normals have components below 2^15, so products stay below
/// 2^62.
const LEAD: u32 = 44;

/// Largest accepted error of a squared length and of a scalar product of rows of a rotation, in units of
/// 2^−48. This limit allows errors of 4 units in the entries.
const ROTATION_SLACK: i64 = 1 << 27;
/// Largest accepted change of a shape by rounding errors, in units of 2^−24, for a column of a length below 1.
const SHAPE_SLACK: i64 = 4;

/// Decomposes a matrix, given by its rows, into a rotation and a triangular matrix. Returns the columns
/// of the rotation, in units of 2^−30, and those of the triangular matrix, in units of 2^−24: a column
/// has the components of the matrix's column along the axes of the rotation.
fn triangular(rows: &[[Q8_24; 3]; 3]) -> ([[i32; 3]; 3], [[i64; 3]; 3]) {
    let columns = [0, 1, 2].map(|j| rows.map(|row| row[j].to_bits()));
    let [a, b, _] = columns;
    // A component is at most √3·2^28, and a term of `across` at most 2^59.
    let along = |axis, column| (dot(axis, column) + (1 << 29)) >> 30;
    let first = unit::<30>(a.map(i64::from)).unwrap_or_default();
    let shadow = along(first, b);
    let across = [0, 1, 2].map(|i| (i64::from(b[i]) << 30) - i64::from(first[i]) * shadow);
    let second = unit::<30>(across).unwrap_or_default();
    let third = cross(first, second).map(|x| ((x + (1 << 29)) >> 30) as i32);
    let axes = [first, second, third];
    (
        axes,
        columns.map(|column| axes.map(|axis| along(axis, column))),
    )
}

/// Whether a row is at least [`MIN_ROW`] long.
fn is_long(row: [i32; 3]) -> bool {
    dot(row, row) >= i64::from(MIN_ROW.to_bits()).pow(2)
}

/// Returns A/s, in units of 2^−30, for a matrix A that is a rotation or reflection times a uniform scale s; `None` for any other
/// matrix.
///
/// The tolerance is 2^−13 of the first row's squared length, both for the squared lengths of the other rows and for the scalar
/// products of rows. A row of length s has s·2^24 units, so the rounding of its entries alone may exceed the tolerance for s
/// below 1/128.
fn rotation_of(rows: [[i32; 3]; 3]) -> Option<[[i32; 3]; 3]> {
    let [a, b, c] = rows;
    let square = dot(a, a);
    let is_small = |x: i64| x.abs() <= square >> 13;
    let is_even = is_small(dot(b, b) - square) && is_small(dot(c, c) - square);
    let is_square = [dot(a, b), dot(b, c), dot(c, a)].into_iter().all(is_small);
    if !(is_even && is_square) {
        return None;
    }
    let direction = |row: [i32; 3]| unit::<30>(row.map(i64::from));
    Some([direction(a)?, direction(b)?, direction(c)?])
}

/// The matrix for the normals of a mesh: the inverse transpose of A, up to a positive factor.
///
/// The computation needs no division: it is the matrix of the cofactors of A, with the sign of the determinant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Normals {
    /// Cofactors of A, scaled so that the highest bit of the largest one is bit `LEAD`.
    cofactors: [[i64; 3]; 3],
    /// A divided by its scale, Q2.30, if A is a rotation or reflection times a uniform scale.
    rotation: Option<[[i32; 3]; 3]>,
}

impl Normals {
    /// Transforms a normal (s2.14) and scales it to length 1, s2.14; the zero vector stays unchanged.
    ///
    /// The error of each component is at most 0.51 units (2^−14).
    // Not inlined, because most meshes have no matrix for their normals.
    #[inline(never)]
    pub fn apply(&self, normal: [i16; 3]) -> [i16; 3] {
        let turned = self.cofactors.map(|row| {
            core::iter::zip(row, normal)
                .map(|(a, b)| a * i64::from(b))
                .sum()
        });
        unit::<14>(turned).map_or([0; 3], |x| x.map(|x| x as i16))
    }

    /// A divided by its scale, Q2.30, if A is a rotation or reflection times a uniform scale, within a tolerance; otherwise `None`. Its
    /// transpose transforms the direction of a light to the coordinates of the mesh, so the normals of the mesh need no transformation.
    /// Rounding errors of the entries may also cause `None` for a product of matrices with a uniform scale below 1/128.
    pub const fn rotation(&self) -> Option<&[[i32; 3]; 3]> {
        self.rotation.as_ref()
    }
}

/// Reason why numbers are not a model matrix. Rows count from 0 here, and from 1 in the message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixError {
    /// An entry of the 3×3 matrix is out of range.
    Entry {
        /// Number of the row.
        row: usize,
        /// Entries of the row.
        entries: [Q8_24; 3],
    },
    /// A component of the translation is out of range.
    Translation {
        /// Number of the row.
        row: usize,
        /// Value of the component.
        distance: Q8_24,
    },
    /// A row of the 3×3 matrix is shorter than [`MIN_ROW`].
    Short {
        /// Number of the row.
        row: usize,
        /// Entries of the row.
        entries: [Q8_24; 3],
    },
    /// A row of the 3×3 matrix is nearly a linear combination of the rows before it.
    Singular {
        /// Number of the row.
        row: usize,
    },
}

impl fmt::Display for MatrixError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (Self::Entry { row, .. }
        | Self::Translation { row, .. }
        | Self::Short { row, .. }
        | Self::Singular { row }) = self;
        write!(f, "matrix row {}: ", row + 1)?;
        match self {
            Self::Entry { entries, .. } => {
                let ([x, y, z], most) = (entries.map(Decimal), Decimal(MAX_ENTRY));
                write!(f, "({x}, {y}, {z}): expected entries within ±{most}")
            }
            Self::Translation { distance, .. } => {
                let [distance, most] = [*distance, MAX_TRANSLATION].map(Decimal);
                write!(f, "translation {distance}: expected within ±{most}")
            }
            Self::Short { entries, .. } => {
                let ([x, y, z], least) = (entries.map(Decimal), Decimal(MIN_ROW));
                write!(f, "({x}, {y}, {z}): expected a length of at least {least}")
            }
            Self::Singular { .. } => f.write_str(
                "singular: expected an angle of at least 0.056 degrees to the rows before it",
            ),
        }
    }
}

impl core::error::Error for MatrixError {}
