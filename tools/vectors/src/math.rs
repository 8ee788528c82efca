//! Operations on vectors of three `f64`.

/// Inner product of two vectors.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product of two vectors.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The difference a − b.
pub fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The sum a + b·factor.
pub fn add_scaled(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    [
        a[0] + b[0] * factor,
        a[1] + b[1] * factor,
        a[2] + b[2] * factor,
    ]
}

/// Length of a vector.
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Unit vector in the direction of `v`.
pub fn normalised(v: [f64; 3]) -> [f64; 3] {
    let length = length(v);
    v.map(|x| x / length)
}

/// Converts a position of a mesh from Q2.14 to world units.
pub fn world(position: [i16; 3]) -> [f64; 3] {
    position.map(|x| f64::from(x) / 16384.0)
}
