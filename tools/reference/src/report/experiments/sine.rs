//! Experiment: errors of sine and cosine kernels over all inputs, and their cycles on the soft core.

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::report::cycles::{Cycles, Figures};
use crate::report::progress;
use crate::sine::kernels::{self, Kernel};
use crate::sine::statistics::Statistics;
use crate::sine::sweep::sweep;
use crate::sine::truth::reference_error;

/// Approximate number of steps per kernel in a quick run. A step has one or more inputs, see `Kernel`. A quick run measures every n-th
/// step; n is odd, so that all values of the inputs' low bits occur.
const SAMPLE: u64 = 1 << 15;

/// Errors and cycles of a kernel in one configuration: a line of `sine.csv`. Errors are absolute.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the kernel in the console's `bench sine`.
    pub kernel: String,
    /// Name of the kernel's line in the diagram, shared by its variants.
    pub family: String,
    /// Name of the kernel's variant, for example the order of the series.
    pub config: String,
    /// Number format of the kernel's outputs.
    pub word_length: String,
    /// Whether Glint itself uses the kernel.
    pub shipped: bool,
    /// Description of the measured inputs.
    pub inputs: String,
    /// Number of measured inputs.
    pub samples: u64,
    /// Largest error of the sine and the cosine.
    pub max_err: f64,
    /// Largest error, in units in the last place of the outputs.
    pub max_ulp: f64,
    /// Root mean square of the errors.
    pub rms: f64,
    /// 99th percentile of the errors.
    pub p99: f64,
    /// Mean error of the outputs' magnitudes, which is positive if magnitudes tend to be too large.
    pub bias: f64,
    /// Function (sine or cosine) and input of the largest error, as text.
    pub argmax: String,
    /// Largest value of |sin² + cos² − 1|, computed from the two outputs for an input.
    pub max_norm: f64,
    /// Number of phases (inputs in fractions of a turn) at which the outputs violate a symmetry of the circle in any bit. `None` if the
    /// inputs are not phases.
    pub asymmetric: Option<u64>,
    /// Cycles of the fastest call on the soft core; `None` if not measured.
    pub cycles_min: Option<u64>,
    /// Median of the cycles of the calls on the soft core.
    pub cycles_median: Option<u64>,
    /// Cycles of the slowest call on the soft core.
    pub cycles_max: Option<u64>,
}

impl Row {
    fn new(kernel: &Kernel, stride: u64, statistics: &Statistics, cycles: Option<Figures>) -> Self {
        Self {
            kernel: kernel.name.into(),
            family: kernel.family.into(),
            config: kernel.config.into(),
            word_length: kernel.format.into(),
            shipped: kernel.shipped,
            inputs: match stride {
                1 => kernel.inputs.to_owned(),
                _ => format!("a sample of {}", kernel.inputs),
            },
            samples: statistics.inputs,
            max_err: statistics.max,
            max_ulp: statistics.max / kernel.ulp,
            rms: statistics.rms(),
            p99: statistics.p99(),
            bias: statistics.bias(),
            argmax: format!(
                "{} of {}",
                statistics.worst_function,
                (kernel.show)(statistics.worst_input)
            ),
            max_norm: statistics.max_norm,
            asymmetric: kernel.by_phase.then_some(statistics.asymmetric),
            cycles_min: cycles.map(|cycles| cycles.min),
            cycles_median: cycles.map(|cycles| cycles.median),
            cycles_max: cycles.map(|cycles| cycles.max),
        }
    }
}

/// The error of the f64 functions with which the kernels are compared: the line of `sine-reference.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// Largest absolute difference from a Taylor series in integers with 62 fraction bits.
    pub max_err: f64,
}

/// Measures all kernels, and the error of the f64 reference. `quick` measures only a sample of the inputs. `cycles` is the result of
/// the console command `bench sine`.
///
/// # Errors
/// When the terminal refuses a progress bar.
pub fn measure(quick: bool, cycles: &Cycles) -> Result<(Vec<Row>, Reference)> {
    let kernels = kernels::kernels();
    let stride = |kernel: &Kernel| match quick {
        true => (kernel.steps / SAMPLE) | 1,
        false => 1,
    };
    let steps = kernels
        .iter()
        .map(|kernel| kernel.steps.div_ceil(stride(kernel)))
        .sum();
    let bar = progress::bar(steps)?;
    let rows = kernels
        .iter()
        .map(|kernel| {
            bar.set_message(format!("{} {}", kernel.name, kernel.config));
            let stride = stride(kernel);
            let statistics = sweep(kernel, stride, &|steps| bar.inc(steps));
            let figures = cycles.get(kernel.name).copied();
            Row::new(kernel, stride, &statistics, figures)
        })
        .collect();
    bar.set_message("the reference itself");
    let max_err = reference_error(if quick { (1 << 14) + 1 } else { 15 });
    bar.finish_and_clear();
    Ok((rows, Reference { max_err }))
}
