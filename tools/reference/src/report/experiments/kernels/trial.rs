//! Results of an experiment.

use glint_variants::kernel::Kernel;

use crate::errors;

/// Result for a configuration: names, cost in bits, and errors.
pub struct Trial {
    /// Name of the kernel.
    pub kernel: &'static str,
    /// Word length and method.
    pub config: String,
    /// Whether Glint uses the configuration.
    pub shipped: bool,
    /// Number of bits of a stored number, for kernels with bits as cost.
    pub bits: Option<u32>,
    /// Errors at all inputs.
    pub errors: Errors,
}

impl Trial {
    /// Makes the trial of a kernel with cycles as cost.
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

/// Statistics of errors, with the input of the largest error.
#[derive(Default)]
pub struct Errors {
    /// The errors, of all inputs together.
    pub all: errors::Errors,
    /// Number of inputs, each with at least one error.
    pub inputs: u64,
    /// Input of the largest error.
    pub worst: String,
}

impl Errors {
    /// Adds the errors of one input; `describe` returns the input's name.
    pub fn add(&mut self, errors: &[f64], describe: impl Fn() -> String) {
        self.inputs += 1;
        for &error in errors {
            if error.abs() > self.all.max {
                self.worst = describe();
            }
            self.all.add(error);
        }
    }
}
