//! Experiment: the control of the camera by a hand. Measures errors of the hand's centre; noise, lag, tracking errors and cycles of
//! filters; and stiff cases.

use anyhow::{Context, Result};
use glint_core::gesture::{EngineSetting, RUN_MOVING, RUN_RESTING, RUN_SEARCHING, Region};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

use crate::errors::Errors;
use crate::gesture::cases::{Fault, outcome};
use crate::gesture::filters::{Filter, Recordings, motion, quality};
use crate::gesture::frame::{Noise, SIZE, Shape, centre_errors};
use crate::gesture::path::{Path, record};
use crate::report::cycles::Cycles;

/// Frame rate of the comparison of filters, in frames per second.
pub const RATE: f64 = 60.0;

/// Errors of the hand's centre: a line of `gesture-centre.csv`. Errors are in pixels, per coordinate.
#[derive(Serialize, Deserialize)]
pub struct Centre {
    /// Shape and area of the hand.
    pub hand: String,
    /// The pixels that the engine counts: the region, and the minimum length of runs.
    pub counted: String,
    /// Whether the firmware uses this setting.
    pub shipped: bool,
    /// Root mean square of the errors.
    pub rms: f64,
    /// 99th percentile of the errors' magnitudes.
    pub p99: f64,
    /// The largest magnitude of an error.
    pub max: f64,
}

/// Errors and cycles of a filter: a line of `gesture-filters.csv`.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Family of filters.
    pub filter: String,
    /// Parameters of the filter.
    pub parameters: String,
    /// Whether the firmware uses the filter.
    pub shipped: bool,
    /// RMS of the camera's motion while the hand rests, in degrees.
    pub rest: f64,
    /// Lag behind a steady motion of 112° per second, in ms.
    pub lag: f64,
    /// RMS of the tracking error during reaches, in degrees.
    pub tracking: f64,
    /// Largest tracking error during reaches, in degrees.
    pub largest: f64,
    /// Median of the soft core's cycles for one channel of a frame; `None` if not measured.
    pub cycles: Option<u64>,
}

/// A stiff case: a line of `gesture-stiff.csv`.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Stiff {
    /// Content of the frames during the case, which lasts one second.
    pub case: String,
    /// Presence of the hand half a second after the start of the case.
    pub presence: String,
    /// Reason for not using the frames; empty if the frames are used.
    pub reason: String,
    /// Largest angle between a direction of the camera during the case and its direction before the case, in degrees.
    pub moved: f64,
    /// Time in ms from the end of the case until the hand steers the camera again.
    pub back: f64,
    /// Largest rotation of the camera between two successive frames, in degrees.
    pub step: f64,
    /// Angle between the directions of the camera and of the hand two seconds after the case, in degrees.
    pub end: f64,
}

/// A requirement: a line of `gesture.csv`.
#[derive(Serialize, Deserialize)]
pub struct Target {
    /// Description of the measured figure.
    pub what: String,
    /// Unit of the figure.
    pub unit: String,
    /// Required upper bound.
    pub at_least: f64,
    /// Measured value; `None` if not measured.
    pub measured: Option<f64>,
}

/// A setting of the engine for the comparison.
struct Compared {
    /// Description of the setting.
    counted: &'static str,
    /// Returns the region for a hand with the given bounds.
    region: fn(&Region) -> Region,
    /// Minimum length of a counted run, in pixels.
    least_run: u8,
    /// Whether this is the firmware's setting for a hand at rest.
    shipped: bool,
}

impl Compared {
    const fn new(counted: &'static str, region: fn(&Region) -> Region, least_run: u8) -> Self {
        Self {
            counted,
            region,
            least_run,
            shipped: false,
        }
    }
}

fn whole(_: &Region) -> Region {
    Region::WHOLE
}

fn small(bounds: &Region) -> Region {
    EngineSetting::resting(bounds, SIZE).region
}

fn large(bounds: &Region) -> Region {
    EngineSetting::moving(bounds, SIZE).region
}

/// The compared settings of the engine.
const SETTINGS: [Compared; 8] = [
    Compared::new("all pixels", whole, 1),
    Compared::new("runs of 6", whole, RUN_SEARCHING),
    Compared::new("the large region, runs of 3", large, 3),
    Compared::new("the large region, runs of 4", large, RUN_MOVING),
    Compared::new("the small region", small, 1),
    Compared::new("the small region, runs of 2", small, 2),
    Compared {
        shipped: true,
        ..Compared::new("the small region, runs of 3", small, RUN_RESTING)
    },
    Compared::new("the small region, runs of 4", small, 4),
];

/// Measures the errors of the centres of discs and hands, each at `places` positions, in frames with 5 % salt noise. `only_shipped`
/// restricts the measurement to the firmware's setting for a hand at rest.
pub fn centres(places: u32, only_shipped: bool) -> Vec<Centre> {
    let noise = Noise {
        salt: 0.05,
        ..Noise::NONE
    };
    let mut rows = Vec::new();
    for (name, shape, area) in [
        ("disc, 500 pixels", Shape::Disc, 500.0),
        ("hand, 500 pixels", Shape::Hand, 500.0),
        ("hand, 2000 pixels", Shape::Hand, 2_000.0),
    ] {
        for compared in SETTINGS {
            if only_shipped && !compared.shipped {
                continue;
            }
            let mut random = Pcg64Mcg::seed_from_u64(1);
            let setting = |bounds: &Region| EngineSetting {
                region: (compared.region)(bounds),
                least_run: compared.least_run,
            };
            let mut sizes = centre_errors(shape, area, &noise, places, &mut random, setting);
            let mut errors = Errors::default();
            for size in &mut sizes {
                errors.add(*size);
                *size = size.abs();
            }
            sizes.sort_by(f64::total_cmp);
            rows.push(Centre {
                hand: name.to_owned(),
                counted: compared.counted.to_owned(),
                shipped: compared.shipped,
                rms: errors.rms(),
                p99: sizes[sizes.len() * 99 / 100],
                max: errors.max,
            });
        }
    }
    rows
}

/// The compared filters.
fn compared() -> Vec<Filter> {
    let mut filters = vec![Filter::None];
    filters.extend([2, 4, 8, 16].map(Filter::Average));
    filters.extend([2.0, 4.0, 8.0, 16.0].map(Filter::LowPass));
    filters.extend([0.01, 0.03, 0.1, 0.3, 1.0].map(Filter::AlphaBeta));
    filters.extend([30.0, 60.0, 120.0, 240.0].map(|slope| Filter::OneEuro([1.0, 4.0, slope])));
    filters.push(Filter::Shipped);
    filters
}

/// Records the frames for the comparison of filters, with sensor noise.
pub fn recordings() -> Recordings {
    let record = |path, seconds| record(path, &Noise::SENSOR, RATE, seconds);
    Recordings {
        rate: RATE,
        rest: record(Path::Rest, 10.0),
        sweep: record(Path::Sweep(100.0), 1.9),
        reaches: record(Path::Reaches, 12.0),
    }
}

/// Measures all filters. `cycles` is the result of the console command `bench gesture`.
pub fn filters(recordings: &Recordings, cycles: &Cycles) -> Vec<Row> {
    let rows = compared().into_iter().map(|filter| {
        let quality = quality(filter, recordings);
        Row {
            filter: filter.family().to_owned(),
            parameters: filter.parameters(),
            shipped: filter == Filter::Shipped,
            rest: quality.rest,
            lag: quality.lag,
            tracking: quality.tracking,
            largest: quality.largest,
            cycles: cycles.get(filter.kernel()).map(|figures| figures.median),
        }
    });
    rows.collect()
}

/// Runs the stiff cases.
pub fn stiff() -> Vec<Stiff> {
    let rows = Fault::ALL.into_iter().map(|fault| {
        let outcome = outcome(fault);
        Stiff {
            case: fault.name().to_owned(),
            presence: outcome.presence.to_string(),
            reason: outcome
                .doubt
                .map_or_else(String::new, |doubt| doubt.to_string()),
            moved: outcome.moved,
            back: outcome.back,
            step: outcome.step,
            end: outcome.end,
        }
    });
    rows.collect()
}

/// Collects the figures that have a requirement. `centres` and `recordings` are results of the functions above, `cycles` is the result
/// of the console command `bench gesture`.
///
/// # Errors
/// When the shipped setting is missing in `centres`.
pub fn targets(
    centres: &[Centre],
    recordings: &Recordings,
    cycles: &Cycles,
) -> Result<Vec<Target>> {
    let target = |what: &str, unit: &str, at_least: f64, measured: Option<f64>| Target {
        what: what.to_owned(),
        unit: unit.to_owned(),
        at_least,
        measured,
    };
    let centre = |hand: &str| {
        centres
            .iter()
            .find(|row| row.shipped && row.hand == hand)
            .with_context(|| format!("expected a row of {hand} as shipped"))
    };
    let poses: Vec<[f64; 2]> = recordings.rest.iter().map(|sample| sample.camera).collect();
    let control = |figure: fn(&crate::report::cycles::Figures) -> u64| {
        cycles.get("control").map(|figures| figure(figures) as f64)
    };
    Ok(vec![
        target(
            "centre of a disc of 500 pixels with 5 % of salt noise, RMS",
            " px",
            0.1,
            Some(centre("disc, 500 pixels")?.rms),
        ),
        target(
            "centre of a hand of 500 pixels with 5 % of salt noise, RMS",
            " px",
            0.1,
            Some(centre("hand, 500 pixels")?.rms),
        ),
        target(
            "still hand with the sensor's noise: motion of the camera, RMS",
            "°",
            0.1,
            Some(motion(&poses)),
        ),
        target(
            "cycles of a camera frame, code in the cache, median",
            "",
            4_000.0,
            control(|figures| figures.median),
        ),
        target(
            "cycles of a camera frame, code in the cache, largest",
            "",
            4_000.0,
            control(|figures| figures.max),
        ),
    ])
}
