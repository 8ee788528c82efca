//! Filters for gesture control, in the formats of the filter in use, [`glint_core::gesture::OneEuro`].

use glint_core::fixed::{Q4_28, U16_16};
use glint_core::gesture::{TimeStep, low_pass_gain, towards};

/// The mean of the last `N` inputs; `N` is a power of two.
#[derive(Clone, Copy, Debug)]
pub struct Average<const N: usize> {
    inputs: [i32; N],
    sum: i64,
    place: usize,
}

impl<const N: usize> Average<N> {
    /// Makes a filter at rest at `input`.
    pub const fn new(input: Q4_28) -> Self {
        Self {
            inputs: [input.to_bits(); N],
            sum: input.to_bits() as i64 * N as i64,
            place: 0,
        }
    }

    /// Processes the next input, and returns the output, rounded down.
    pub fn next(&mut self, input: Q4_28) -> Q4_28 {
        self.place = (self.place + 1) % N;
        let oldest = &mut self.inputs[self.place];
        self.sum += i64::from(input.to_bits()) - i64::from(*oldest);
        *oldest = input.to_bits();
        Q4_28::from_bits((self.sum >> N.ilog2()) as i32)
    }
}

/// A first-order low-pass filter: exponential smoothing.
#[derive(Clone, Copy, Debug)]
pub struct LowPass {
    cutoff: U16_16,
    output: i32,
}

impl LowPass {
    /// Makes a filter with a corner frequency in Hz, at rest at `input`.
    pub const fn new(cutoff: U16_16, input: Q4_28) -> Self {
        Self {
            cutoff,
            output: input.to_bits(),
        }
    }

    /// Takes the next input, and returns the output.
    pub fn next(&mut self, input: Q4_28, step: TimeStep) -> Q4_28 {
        let gain = low_pass_gain(self.cutoff, step);
        self.output = towards(self.output, input.to_bits(), gain);
        Q4_28::from_bits(self.output)
    }
}

/// The α-β filter: the Kalman filter of a position with constant velocity, in its steady state. It assumes equal time steps.
#[derive(Clone, Copy, Debug)]
pub struct AlphaBeta {
    /// Gains with 16 fraction bits.
    gains: [u32; 2],
    place: i32,
    /// Velocity: change of the position per step.
    speed: i32,
}

impl AlphaBeta {
    /// Makes a filter with the gains α and β with 16 fraction bits, at rest at `input`.
    pub const fn new(gains: [u32; 2], input: Q4_28) -> Self {
        Self {
            gains,
            place: input.to_bits(),
            speed: 0,
        }
    }

    /// Processes the next input, and returns the output.
    pub fn next(&mut self, input: Q4_28) -> Q4_28 {
        let predicted = self.place.saturating_add(self.speed);
        let [alpha, beta] = self.gains;
        let off = input.to_bits().saturating_sub(predicted);
        self.place = towards(predicted, input.to_bits(), alpha);
        self.speed = self.speed.saturating_add(towards(0, off, beta));
        Q4_28::from_bits(self.place)
    }
}
