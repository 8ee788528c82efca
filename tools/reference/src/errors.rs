//! Root mean square (RMS) and maximum of a set of errors.

/// Accumulator of errors, for their root mean square and maximum.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// Largest magnitude among the errors.
    pub max: f64,
    squares: f64,
    /// Number of errors.
    pub count: u64,
}

impl Errors {
    /// Adds an error of either sign.
    pub fn add(&mut self, error: f64) {
        self.max = self.max.max(error.abs());
        self.squares += error * error;
        self.count += 1;
    }

    /// Returns the root mean square of the errors, or 0 if there are none.
    pub fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }
}
