//! Errors and cycles of kernels that have no page of their own: reciprocals, roots, lengths, quotients, depth codes, colours, the
//! number formats of the pipeline's stages, fog, sky, luminance, the ends of lines, and light on fields.

mod appearance;
mod arithmetic;
mod formats;
mod light;
mod pixels;
mod trial;

use anyhow::Result;
use serde::{Deserialize, Serialize};

use self::trial::Trial;
use crate::report::cycles::Cycles;
use crate::report::progress;

/// Error and cost of one configuration of a kernel: a line of `kernels.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Family: the function computed by the kernel.
    pub family: String,
    /// Name of the kernel. A kernel with cycles has this name in the firmware's `bench kernels` too.
    pub kernel: String,
    /// Word length and method.
    pub config: String,
    /// Whether Glint uses the configuration.
    pub shipped: bool,
    /// Largest error, in the unit of the family.
    pub max_err: f64,
    /// Root mean square of the errors.
    pub rms: f64,
    /// Input with the largest error.
    pub argmax: String,
    /// Number of inputs.
    pub samples: u64,
    /// Number of bits of a stored number, for kernels whose cost is the number of bits.
    pub bits: Option<u32>,
    /// Cycles of the fastest call on the soft core; `None` if not measured.
    pub cycles_min: Option<u64>,
    /// Median of the cycles of the calls on the soft core.
    pub cycles_median: Option<u64>,
    /// Cycles of the slowest call on the soft core.
    pub cycles_max: Option<u64>,
}

/// Name of a family, and the function that measures the family's trials with a given thinning of the inputs.
type Family = (&'static str, fn(u32) -> Result<Vec<Trial>>);

/// Measures all configurations. With a `thinning` of n, every n-th input of a kernel is measured. `cycles` is the result of the console
/// command `bench kernels`.
///
/// # Errors
/// When the terminal refuses a progress bar, or a camera is invalid.
pub fn measure(thinning: u32, cycles: &Cycles) -> Result<Vec<Row>> {
    let families: [Family; 16] = [
        ("reciprocal", |thinning| {
            Ok(arithmetic::reciprocals(thinning))
        }),
        ("inverse root", |thinning| {
            Ok(arithmetic::inverse_roots(thinning))
        }),
        ("root", |thinning| Ok(arithmetic::roots(thinning))),
        ("division", |thinning| Ok(arithmetic::divisions(thinning))),
        ("length", |thinning| Ok(arithmetic::lengths(thinning))),
        ("unit", |thinning| Ok(arithmetic::units(thinning))),
        ("depth", pixels::depths),
        ("colour", |thinning| Ok(pixels::colours(thinning))),
        ("format", formats::formats),
        ("fog", appearance::fogs),
        ("sky", appearance::skies),
        ("luminance", |thinning| Ok(appearance::luminances(thinning))),
        ("line", appearance::lines),
        ("round", light::rounds),
        ("highlight", light::highlights),
        ("occlusion", light::occlusions),
    ];
    let bar = progress::bar(families.len() as u64)?;
    let mut rows = Vec::new();
    for (family, trials) in families {
        bar.set_message(family);
        for trial in trials(thinning)? {
            let cycles = cycles.get(trial.kernel);
            let errors = trial.errors;
            rows.push(Row {
                family: family.to_owned(),
                kernel: trial.kernel.to_owned(),
                config: trial.config,
                shipped: trial.shipped,
                max_err: errors.all.max,
                rms: errors.all.rms(),
                argmax: errors.worst,
                samples: errors.inputs,
                bits: trial.bits,
                cycles_min: cycles.map(|cycles| cycles.min),
                cycles_median: cycles.map(|cycles| cycles.median),
                cycles_max: cycles.map(|cycles| cycles.max),
            });
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}
