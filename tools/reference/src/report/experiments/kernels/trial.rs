//! What an experiment finds.

use glint_variants::kernel::Kernel;

/// Names, cost in bits, and errors of a configuration: what an experiment finds.
pub struct Trial {
    /// Name of the kernel.
    pub kernel: &'static str,
    /// Word length and method.
    pub config: String,
    /// Whether Glint uses the configuration.
    pub shipped: bool,
    /// Number of bits of a stored number, where these are the cost.
    pub bits: Option<u32>,
    /// Errors at all inputs.
    pub errors: Errors,
}

impl Trial {
    /// The errors of a kernel, whose cost is its cycles.
    pub fn of<I, O>(kernel: &Kernel<I, O>, errors: Errors) -> Self {
        Self {
            kernel: kernel.name,
            config: kernel.config.to_owned(),
            shipped: kernel.shipped,
            bits: None,
            errors,
        }
    }
}

/// Statistics of errors, with the input of the largest one.
#[derive(Default)]
pub struct Errors {
    /// Largest magnitude.
    pub largest: f64,
    /// Sum of the squares.
    pub squares: f64,
    /// Number of errors.
    pub count: u64,
    /// Number of inputs, each with one error or more.
    pub inputs: u64,
    /// Input of the largest error.
    pub worst: String,
}

impl Errors {
    /// Adds the errors of one input, which `describe` names.
    pub fn add(&mut self, errors: &[f64], describe: impl Fn() -> String) {
        self.inputs += 1;
        for error in errors {
            self.count += 1;
            self.squares += error * error;
            if error.abs() > self.largest {
                self.largest = error.abs();
                self.worst = describe();
            }
        }
    }
}
