//! Errors and cycles of sine and cosine kernels over all inputs.

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::report::cycles::{Cycles, Figures};
use crate::report::progress;
use crate::report::provenance::Provenance;
use crate::sine::kernels::{self, Kernel};
use crate::sine::statistics::Statistics;
use crate::sine::sweep::sweep;
use crate::sine::truth::reference_error;

/// Steps of a sample of the inputs. Strides are odd, so they reach every value of the low bits.
const SAMPLE: u64 = 1 << 15;

/// A kernel in one configuration: a line of `sine.csv`. Errors are absolute.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the kernel in `bench sine`.
    pub kernel: String,
    /// Line of the diagram.
    pub family: String,
    /// Variant of the kernel.
    pub config: String,
    /// Number format of the outputs.
    pub word_length: String,
    /// Whether Glint uses the kernel.
    pub shipped: bool,
    /// Measured inputs.
    pub inputs: String,
    /// Number of measured inputs.
    pub samples: u64,
    /// Largest error.
    pub max_err: f64,
    /// Largest error in units of the last place of the outputs.
    pub max_ulp: f64,
    /// Root mean square of the errors.
    pub rms: f64,
    /// 99th percentile of the errors.
    pub p99: f64,
    /// Mean error of the magnitude.
    pub bias: f64,
    /// Function and input of the largest error.
    pub argmax: String,
    /// Largest |sin² + cos² − 1|.
    pub max_norm: f64,
    /// Phases at which a symmetry of the circle does not hold bit for bit; none for other inputs.
    pub asymmetric: Option<u64>,
    /// Fastest call, in cycles of the soft core.
    pub cycles_min: Option<u64>,
    /// Median call.
    pub cycles_median: Option<u64>,
    /// Slowest call.
    pub cycles_max: Option<u64>,
    /// Commit of the measurement.
    pub commit: String,
    /// Tools of the measurement.
    pub tools: String,
}

impl Row {
    fn new(
        kernel: &Kernel,
        stride: u64,
        statistics: &Statistics,
        cycles: Option<Figures>,
        provenance: &Provenance,
    ) -> Self {
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
                kernel.show_input(statistics.worst_input)
            ),
            max_norm: statistics.max_norm,
            asymmetric: kernel.by_phase.then_some(statistics.asymmetric),
            cycles_min: cycles.map(|cycles| cycles.min),
            cycles_median: cycles.map(|cycles| cycles.median),
            cycles_max: cycles.map(|cycles| cycles.max),
            commit: provenance.commit.clone(),
            tools: provenance.tools.clone(),
        }
    }

    /// Accurate fraction bits: −log2 of the largest error.
    pub fn bits(&self) -> f64 {
        -self.max_err.log2()
    }
}

/// The error of the f64 reference: the line of `sine-reference.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// Largest absolute error against a Taylor series in 62-bit integers.
    pub max_err: f64,
}

/// Measures all kernels; `quick` takes a sample of the inputs.
///
/// # Errors
/// When the terminal refuses a progress bar.
pub fn measure(quick: bool, cycles: &Cycles) -> Result<(Vec<Row>, Reference)> {
    let provenance = Provenance::find();
    let kernels = kernels::kernels();
    let stride = |kernel: &Kernel| match quick {
        true => (kernel.steps() / SAMPLE) | 1,
        false => 1,
    };
    let steps = kernels
        .iter()
        .map(|kernel| kernel.steps().div_ceil(stride(kernel)))
        .sum();
    let bar = progress::bar(steps)?;
    let rows = kernels
        .iter()
        .map(|kernel| {
            bar.set_message(format!("{} {}", kernel.name, kernel.config));
            let stride = stride(kernel);
            let statistics = sweep(kernel, stride, &|steps| bar.inc(steps));
            let figures = cycles.get(kernel.name).copied();
            Row::new(kernel, stride, &statistics, figures, &provenance)
        })
        .collect();
    bar.set_message("the reference itself");
    let max_err = reference_error(if quick { (1 << 14) + 1 } else { 15 });
    bar.finish_and_clear();
    Ok((rows, Reference { max_err }))
}
