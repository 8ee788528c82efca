//! Experiment: errors of the integration methods against the true attitude, at different sample rates.

use serde::{Deserialize, Serialize};

use super::motions::{CONING, TUMBLE};
use crate::imu::measure::method_error;
use crate::imu::method::Method;
use crate::report::cycles::Cycles;

/// Sample rates of the comparison, in samples per second.
pub const RATES: [f64; 5] = [50.0, 100.0, 200.0, 500.0, 1000.0];

/// Error of a method at one sample rate: a line of `imu-methods.csv`.
#[derive(Serialize, Deserialize)]
pub struct Trial {
    /// Name of the motion, `tumble` or `coning`.
    pub motion: String,
    /// Name of the method.
    pub method: String,
    /// Whether Glint itself uses the method.
    pub shipped: bool,
    /// Samples per second.
    pub rate: f64,
    /// Error of the attitude after 20 s, in degrees.
    pub error: f64,
    /// Observed order p of the method (error proportional to step^p), from this and the next lower sample rate.
    pub order: Option<f64>,
    /// Median of the cycles per sample on the soft core; `None` for methods that the firmware does not have.
    pub cycles: Option<u64>,
}

/// Returns the name of a method in the console command `bench attitude`; `None` for methods that the firmware does not have.
fn kernel(method: Method) -> Option<&'static str> {
    match method {
        Method::Angles => Some("angles"),
        Method::FirstOrder => Some("first_order"),
        Method::Newest => Some("newest"),
        Method::Trapezoid => Some("trapezoid"),
        Method::Parabola => Some("parabola"),
        Method::Cubic => Some("cubic"),
        Method::Coning | Method::PlainCubic => None,
    }
}

/// Measures all methods at all sample rates. `cycles` is the result of the console command `bench attitude`.
pub fn measure(cycles: &Cycles) -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, motion) in [("tumble", TUMBLE), ("coning", CONING)] {
        for method in Method::ALL {
            let mut before: Option<[f64; 2]> = None;
            for rate in RATES {
                let error = method_error(method, motion, 20.0, rate);
                let order = before.map(|[last, at]| (at / error).log2() / (rate / last).log2());
                before = Some([rate, error]);
                trials.push(Trial {
                    motion: name.to_owned(),
                    method: method.name().to_owned(),
                    shipped: method == Method::Cubic,
                    rate,
                    error,
                    order,
                    cycles: kernel(method).and_then(|name| Some(cycles.get(name)?.median)),
                });
            }
        }
    }
    trials
}
