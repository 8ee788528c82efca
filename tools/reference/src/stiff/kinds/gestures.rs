//! Statistics of the gesture engine, and the arithmetic of the control by a hand.

use anyhow::Result;
use glint_core::fixed::{Q4_28, U16_16};
use glint_core::gesture::{
    Backlash, Control, OneEuro, Region, Statistics, TimeStep, Tuning, calibrate, low_pass_gain,
    quotient, target, towards,
};
use glint_core::root::root;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("hand", |counts: Counted| {
            Ok(Outcome::of(counts.statistics().blob(), |blob| {
                let [x, y] = blob.centre;
                format!("centre ({x}, {y}), width {}", blob.width)
            }))
        }),
        Kind::new("hand-quotient", |[number, divisor]: [u32; 2]| {
            Ok(Outcome::exact(format!(
                "{}/2^12",
                quotient(number, divisor)
            )))
        }),
        Kind::new("hand-root", |square| {
            Ok(Outcome::exact(root(square).to_string()))
        }),
        Kind::new("hand-gain", |Filtered { cutoff, step }| {
            let gain = low_pass_gain(U16_16::from_bits(cutoff), TimeStep::new(step));
            Ok(Outcome::exact(format!("{gain}/2^16")))
        }),
        Kind::new("hand-step", |Way { from, to, gain }| {
            Ok(Outcome::exact(towards(from, to, gain).to_string()))
        }),
        Kind::new("hand-target", |counts: Counted| {
            Ok(Outcome::of(counts.statistics().blob(), |blob| {
                let [theta, phi, r] = target(&blob, counts.size);
                format!("azimuth {theta} turns, polar angle {phi} turns, distance {r}")
            }))
        }),
        Kind::new("hand-confidence", |counts: Counted| {
            Ok(Outcome::of(counts.statistics().blob(), |blob| {
                format!("{}/256", blob.confidence(counts.size))
            }))
        }),
        Kind::new(
            "hand-region",
            |Grown {
                 first,
                 last,
                 margin,
             }| {
                let region = Region { first, last }.grown(margin);
                let (Region { first, last }, area) = (region, region.area());
                Ok(Outcome::exact(format!(
                    "{first:?} to {last:?}, {area} pixels"
                )))
            },
        ),
        Kind::new("hand-filter", filter),
        Kind::new(
            "hand-zone",
            |Zone {
                 start,
                 zone,
                 inputs,
             }| {
                let mut output = Backlash::new(Q4_28::from_bits(start));
                let next = |input| {
                    output
                        .next(Q4_28::from_bits(input), Q4_28::from_bits(zone))
                        .to_bits()
                };
                let outputs: Vec<_> = inputs.into_iter().map(next).collect();
                Ok(Outcome::exact(format!("{outputs:?}")))
            },
        ),
        Kind::new("hand-calibration", calibration),
        Kind::new("hand-pauses", pauses),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Counted {
    size: [u16; 2],
    count: u32,
    sums: [u32; 2],
    /// The first and the last column and row with a pixel.
    bounds: [[u16; 2]; 2],
}

impl Counted {
    fn statistics(&self) -> Statistics {
        let [first, last] = self.bounds;
        Statistics {
            size: self.size,
            count: self.count,
            sums: self.sums,
            bounds: Region { first, last },
            is_whole: true,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Filtered {
    /// Corner frequency in 2^-16 Hz.
    cutoff: u32,
    /// Step in µs.
    step: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Way {
    from: i32,
    to: i32,
    /// Fraction of the distance, in 2^-16.
    gain: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Grown {
    first: [u16; 2],
    last: [u16; 2],
    margin: [u16; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OneEuroRun {
    /// First input and further inputs, with 28 fraction bits.
    start: i32,
    inputs: Vec<i32>,
    /// Number of repetitions of the last input.
    #[serde(default)]
    repeats: usize,
    /// Time between two inputs in µs.
    step: u32,
    /// Corner frequency at rest, slope, and corner frequency of the speed, with 16 fraction bits.
    tuning: [u32; 3],
}

/// The last output of a 1€ filter.
fn filter(run: OneEuroRun) -> Result<Outcome> {
    let mut filter = OneEuro::new(Q4_28::from_bits(run.start));
    let [cutoff, slope, speed_cutoff] = run.tuning.map(U16_16::from_bits);
    let tuning = Tuning {
        cutoff,
        slope,
        speed_cutoff,
    };
    let mut output = Q4_28::from_bits(run.start);
    let last = run.inputs.last().copied().unwrap_or(run.start);
    let repeats = std::iter::repeat_n(last, run.repeats);
    for input in run.inputs.into_iter().chain(repeats) {
        output = filter.next(Q4_28::from_bits(input), &tuning, TimeStep::new(run.step));
    }
    Ok(Outcome::exact(output.to_bits().to_string()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Zone {
    start: i32,
    zone: i32,
    inputs: Vec<i32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SmallPicture {
    columns: u16,
    rows: u16,
    /// Cr and Cb of the samples in the middle, as a cyclic sequence; `rest` contains Cr and Cb of all other samples.
    middle: Vec<[u8; 2]>,
    rest: [u8; 2],
    /// Number of samples; by default the whole picture.
    samples: Option<usize>,
}

/// Calibrates the windows of the hand's colour from a small picture.
fn calibration(shown: SmallPicture) -> Result<Outcome> {
    let (columns, rows) = (usize::from(shown.columns), usize::from(shown.rows));
    let within = |number: usize, length: usize| (length * 3 / 8..length * 5 / 8).contains(&number);
    let sample = |place: usize| {
        let (x, y) = (place % columns, place / columns);
        match within(x, columns) && within(y, rows) {
            true => shown.middle[(x + y * columns) % shown.middle.len()],
            false => shown.rest,
        }
    };
    let samples = (0..shown.samples.unwrap_or(columns * rows)).map(sample);
    Ok(Outcome::of(
        calibrate(shown.columns, shown.rows, samples),
        |found| {
            let [cr, cb] = found.windows.map(|window| [window.lower, window.upper]);
            let (inside, outside) = (found.inside, found.outside);
            format!("Cr {cr:?}, Cb {cb:?}, {inside} % inside, {outside} % outside")
        },
    ))
}

/// States the presence of a hand at rest after each frame, for these times between frames in µs.
fn pauses(gaps: Vec<u64>) -> Result<Outcome> {
    let hand = Statistics {
        size: [320, 240],
        count: 1_681,
        sums: [160 * 1_681, 120 * 1_681],
        bounds: Region {
            first: [140, 100],
            last: [180, 140],
        },
        is_whole: true,
    };
    let mut control = Control::default();
    let mut time = 0;
    let presences = gaps.into_iter().map(|gap| {
        time += gap;
        let _ = control.on_frame(time, &hand);
        control.presence().to_string()
    });
    Ok(Outcome::exact(presences.collect::<Vec<_>>().join(", ")))
}
