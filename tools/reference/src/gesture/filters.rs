//! Filters of the camera's control, and their errors along paths of a hand.

use glint_core::fixed::{Q4_28, U16_16};
use glint_core::gesture::{ANGLE, Backlash, CHANNELS, OneEuro, TimeStep, Tuning};
use glint_variants::filter::{AlphaBeta, Average, LowPass};

use super::path::{Sample, between};
use crate::errors::Errors;

/// A filter with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// No filter.
    None,
    /// Mean of the last 2, 4, 8 or 16 frames.
    Average(usize),
    /// Low pass of first order with a corner frequency in Hz.
    LowPass(f64),
    /// α-β filter with tracking index λ (Kalata, 1984).
    AlphaBeta(f64),
    /// 1€ filter: corner frequency at rest in Hz, corner frequency of the speed's low pass in Hz, and slope in Hz per (turn per second).
    OneEuro([f64; 3]),
    /// The firmware's filter: 1€ filter and dead zone with the firmware's constants.
    Shipped,
}

/// The filter of one channel with its state: returns the output for an input and the time since the previous input.
type Channel = Box<dyn FnMut(Q4_28, TimeStep) -> Q4_28>;

/// A moving average of the last `FRAMES` inputs, in its steady state for the input `input`.
fn average<const FRAMES: usize>(input: Q4_28) -> Channel {
    let mut filter = Average::<FRAMES>::new(input);
    Box::new(move |input, _| filter.next(input))
}

/// Returns the gains α and β for the tracking index λ, which is the ratio of the path's accelerations to the noise (Kalata, 1984).
pub fn kalata(index: f64) -> [f64; 2] {
    let r = (4.0 + index - (8.0 * index + index * index).sqrt()) / 4.0;
    let alpha = 1.0 - r * r;
    [alpha, 2.0 * (2.0 - alpha) - 4.0 * (1.0 - alpha).sqrt()]
}

impl Filter {
    /// Name of the filter family: the kernel's name in the console's `bench gesture`.
    pub const fn kernel(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Average(_) => "average",
            Self::LowPass(_) => "low_pass",
            Self::AlphaBeta(_) => "alpha_beta",
            Self::OneEuro(_) => "one_euro",
            Self::Shipped => "one_euro_zone",
        }
    }

    /// Readable name of the filter family.
    pub const fn family(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Average(_) => "moving average",
            Self::LowPass(_) => "low pass",
            Self::AlphaBeta(_) => "α-β",
            Self::OneEuro(_) => "1€",
            Self::Shipped => "1€ and dead zone",
        }
    }

    /// The filter's parameters as text.
    pub fn parameters(self) -> String {
        match self {
            Self::None => String::new(),
            Self::Average(frames) => format!("{frames} frames"),
            Self::LowPass(cutoff) => format!("{cutoff} Hz"),
            Self::AlphaBeta(index) => format!("λ = {index}"),
            Self::OneEuro([cutoff, speed, slope]) => {
                format!("{cutoff} Hz, speed {speed} Hz, slope {slope}")
            }
            Self::Shipped => format!(
                "{} Hz, speed {} Hz, slope {}, 0.06°",
                ANGLE.cutoff, ANGLE.speed_cutoff, ANGLE.slope
            ),
        }
    }

    /// Creates the filter of one channel, in its steady state for the input `input`.
    fn at(self, input: Q4_28) -> Channel {
        match self {
            Self::None => Box::new(|input, _| input),
            Self::Average(2) => average::<2>(input),
            Self::Average(4) => average::<4>(input),
            Self::Average(8) => average::<8>(input),
            Self::Average(_) => average::<16>(input),
            Self::LowPass(cutoff) => {
                let mut filter = LowPass::new(U16_16::from_num(cutoff), input);
                Box::new(move |input, step| filter.next(input, step))
            }
            Self::AlphaBeta(index) => {
                let gains = kalata(index).map(|gain| (gain * 65_536.0).round() as u32);
                let mut filter = AlphaBeta::new(gains, input);
                Box::new(move |input, _| filter.next(input))
            }
            Self::OneEuro(parameters) => {
                let [cutoff, speed_cutoff, slope] = parameters.map(U16_16::from_num);
                let tuning = Tuning {
                    cutoff,
                    slope,
                    speed_cutoff,
                };
                let mut filter = OneEuro::new(input);
                Box::new(move |input, step| filter.next(input, &tuning, step))
            }
            Self::Shipped => {
                let [(tuning, zone), ..] = CHANNELS;
                let (mut filter, mut backlash) = (OneEuro::new(input), Backlash::new(input));
                Box::new(move |input, step| backlash.next(filter.next(input, &tuning, step), zone))
            }
        }
    }

    /// Filters the targets of samples, which have the rate `rate` in frames per second. Returns azimuth and polar angle in turns.
    pub fn run(self, samples: &[Sample], rate: f64) -> Vec<[f64; 2]> {
        let step = TimeStep::new((1e6 / rate).round() as u32);
        let Some(first) = samples.first() else {
            return vec![];
        };
        let mut channels = first.target.map(|input| self.at(input));
        let outputs = samples.iter().map(|sample| {
            let mut filtered = [0.0; 2];
            for ((channel, target), output) in
                channels.iter_mut().zip(sample.target).zip(&mut filtered)
            {
                *output = channel(target, step).to_num();
            }
            filtered
        });
        outputs.collect()
    }
}

/// Errors of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// RMS deviation of the camera's direction from its mean while the hand rests, in degrees.
    pub rest: f64,
    /// Lag in ms behind a steady motion.
    pub lag: f64,
    /// RMS deviation from the true position during reaches, in degrees.
    pub tracking: f64,
    /// Largest deviation from the true position during reaches, in degrees.
    pub largest: f64,
}

/// The samples for the comparison of filters.
pub struct Recordings {
    /// Number of frames per second.
    pub rate: f64,
    /// A hand at rest.
    pub rest: Vec<Sample>,
    /// A steady motion, without the frames in which the hand jumps back to its start.
    pub sweep: Vec<Sample>,
    /// Fast motions of the hand between positions.
    pub reaches: Vec<Sample>,
}

/// Measures the errors of a filter. The lag is measured in the second half of the sweep.
pub fn quality(filter: Filter, recordings: &Recordings) -> Quality {
    let rate = recordings.rate;
    let rest = motion(&filter.run(&recordings.rest, rate));
    let sweep = filter.run(&recordings.sweep, rate);
    let half = sweep.len() / 2;
    let behind: f64 = core::iter::zip(&recordings.sweep, &sweep)
        .skip(half)
        .map(|(sample, output)| sample.truth[0] - output[0])
        .sum();
    let truth = |place: usize| recordings.sweep[place].truth[0];
    let speed = (truth(sweep.len() - 1) - truth(half)) * rate / (sweep.len() - 1 - half) as f64;
    let mut tracking = Errors::default();
    for (sample, output) in
        core::iter::zip(&recordings.reaches, filter.run(&recordings.reaches, rate))
    {
        tracking.add(between(sample.truth, output));
    }
    Quality {
        rest,
        lag: 1e3 * behind / (sweep.len() - half) as f64 / speed,
        tracking: tracking.rms(),
        largest: tracking.max,
    }
}

/// Returns the RMS deviation, in degrees, of azimuths and polar angles (in turns) from their mean.
pub fn motion(angles: &[[f64; 2]]) -> f64 {
    let mean = [0, 1]
        .map(|axis| angles.iter().map(|angle| angle[axis]).sum::<f64>() / angles.len() as f64);
    let mut errors = Errors::default();
    angles
        .iter()
        .for_each(|&angle| errors.add(between(angle, mean)));
    errors.rms()
}
