//! Results of an experiment.

use glint_variants::kernel::Kernel;

use crate::errors;

/// Result of a configuration: names, cost in bits, and errors.
pub struct Trial {
    /// Name of the kernel.
    pub kernel: &'static str,
    /// Word length and method of the kernel.
    pub config: String,
    /// Whether Glint uses the configuration.
    pub shipped: bool,
    /// Number of bits of a stored number, for kernels whose cost is the number of bits.
    pub bits: Option<u32>,
    /// Errors at all inputs.
    pub errors: Errors,
}

impl Trial {
    /// Creates the trial of a kernel whose cost is its cycles.
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

/// A trial whose cost is a number of bits.
pub fn trial(
    kernel: &'static str,
    config: String,
    shipped: bool,
    bits: u32,
    errors: Errors,
) -> Trial {
    Trial {
        kernel,
        config,
        shipped,
        bits: Some(bits),
        errors,
    }
}

/// Statistics of errors, and the input with the largest error.
#[derive(Default)]
pub struct Errors {
    /// The errors at all inputs.
    pub all: errors::Errors,
    /// Number of inputs. An input may have more than one error.
    pub inputs: u64,
    /// Input of the largest error.
    pub worst: String,
}

impl Errors {
    /// Adds the errors at one input; `describe` returns the description of the input.
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
