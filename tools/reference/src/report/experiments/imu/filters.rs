//! Experiment: errors of the inclination with different filters, which correct the attitude by the accelerometer.

use serde::{Deserialize, Serialize};

use crate::imu::filter::Filter;
use crate::imu::measure::{TAU, filter_inclination};
use crate::imu::motion::Motion;
use crate::imu::sensor::Sensor;

/// Errors of a filter: a line of `imu-filters.csv`. Each figure is the RMS of the errors of the inclination, in degrees.
#[derive(Serialize, Deserialize)]
pub struct FilterErrors {
    /// Name and parameters of the filter.
    pub filter: String,
    /// Whether Glint itself uses the filter.
    pub shipped: bool,
    /// Error for a sensor at rest.
    pub rest: f64,
    /// Error during a mostly sideways hand motion.
    pub hand: f64,
    /// Error during a mostly vertical hand motion.
    pub nod: f64,
    /// Error during the motion of a walking person.
    pub walk: f64,
}

/// Measures all filters. `part` is the fraction of the full duration of the motions; a motion lasts at least 30 s.
pub fn measure(part: f64) -> Vec<FilterErrors> {
    let seconds = (120.0 * part).max(30.0);
    let mahony = Filter::Mahony {
        proportional: 0.74,
        integral: 0.0012,
    };
    let gated = |low, high| Filter::Gated {
        tau: TAU,
        range: [low, high],
    };
    [
        Filter::None,
        Filter::Complementary(TAU),
        mahony,
        Filter::LowPass(TAU),
        Filter::Tilt(1.0),
        Filter::Tilt(TAU),
        Filter::Tilt(10.0),
        gated(0.5, 1.5),
        gated(0.9, 1.1),
    ]
    .map(|filter| {
        let rms = |motion| filter_inclination(filter, Sensor::real(200.0), motion, seconds).rms();
        FilterErrors {
            filter: filter.name(),
            shipped: filter == Filter::Tilt(TAU),
            rest: rms(Motion::Rest),
            hand: rms(Motion::Hand),
            nod: rms(Motion::Nod),
            walk: rms(Motion::Walk),
        }
    })
    .into()
}
