//! Statistics of errors.

/// RMS and maximum of errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// Largest magnitude.
    pub max: f64,
    squares: f64,
    count: u64,
}

impl Errors {
    /// Adds an error.
    pub fn add(&mut self, error: f64) {
        self.max = self.max.max(error.abs());
        self.squares += error * error;
        self.count += 1;
    }

    /// Root of the mean square; 0 without errors.
    pub fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }
}
