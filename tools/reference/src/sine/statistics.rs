//! Statistics of the errors of sine and cosine over many inputs.

use super::truth::SinCos;

/// Number of buckets of the histogram per octave (factor of two) of the error's size. Percentiles have a relative resolution of 1/64.
const BUCKETS_PER_OCTAVE: u64 = 64;
/// Number of the histogram's octaves below an error of 1. Errors below 2^-64 are in the first bucket, errors of 1 or more in the last.
const OCTAVES: u64 = 64;

/// Statistics of the absolute errors of sine and cosine together.
///
/// The weight of an input is the part of the circle that it represents. Means are therefore uniform over the angle, even where inputs are
/// dense, such as floats near zero.
#[derive(Clone, Debug)]
pub struct Statistics {
    /// Number of inputs. Each input contributes two errors, of the sine and of the cosine.
    pub inputs: u64,
    /// The largest error of an output.
    pub max: f64,
    /// The bits, as an integer, of an input with the largest error.
    pub worst_input: u64,
    /// The output with the largest error: `sin` or `cos`.
    pub worst_function: &'static str,
    /// The largest value of |sin² + cos² − 1|, from the two outputs of an input.
    pub max_norm: f64,
    /// Number of inputs that violate the symmetry: their outputs differ from the first octant's by more than signs and order.
    pub asymmetric: u64,
    weight: f64,
    sum_of_squares: f64,
    sum: f64,
    histogram: Vec<f64>,
}

impl Default for Statistics {
    fn default() -> Self {
        Self {
            inputs: 0,
            max: -1.0,
            worst_input: 0,
            worst_function: "sin",
            max_norm: 0.0,
            asymmetric: 0,
            weight: 0.0,
            sum_of_squares: 0.0,
            sum: 0.0,
            histogram: vec![0.0; (OCTAVES * BUCKETS_PER_OCTAVE) as usize + 1],
        }
    }
}

impl Statistics {
    /// Adds the errors of one input. `got` has the kernel's outputs, `truth` the exact values, and `weight` the represented part
    /// of the circle in any unit.
    pub fn add(&mut self, input: u64, truth: SinCos, got: SinCos, weight: f64) {
        self.inputs += 1;
        self.add_both(input, truth, got, weight);
    }

    /// Adds the errors of `count` images of an input. The images' outputs and exact values equal the input's apart from signs and order.
    pub fn add_images(&mut self, input: u64, truth: SinCos, got: SinCos, count: u64) {
        self.inputs += count;
        self.add_both(input, truth, got, count as f64);
    }

    fn add_both(&mut self, input: u64, truth: SinCos, got: SinCos, weight: f64) {
        self.add_one(input, "sin", truth.sin, got.sin, weight);
        self.add_one(input, "cos", truth.cos, got.cos, weight);
        let norm = (got.sin * got.sin + got.cos * got.cos - 1.0).abs();
        self.max_norm = self.max_norm.max(norm);
    }

    fn add_one(&mut self, input: u64, function: &'static str, truth: f64, got: f64, weight: f64) {
        let error = got - truth;
        let size = error.abs();
        if size > self.max {
            (self.max, self.worst_input, self.worst_function) = (size, input, function);
        }
        self.weight += weight;
        self.sum_of_squares += error * error * weight;
        self.sum += error * truth.signum() * weight;
        if let Some(count) = self.histogram.get_mut(bucket(size)) {
            *count += weight;
        }
    }

    /// Adds `later`, the statistics of other inputs of the same kernel.
    pub fn merge(&mut self, later: &Self) {
        self.inputs += later.inputs;
        // `later` may contain smaller inputs. Of two inputs with the largest error, the smaller is kept.
        if later.max > self.max || (later.max == self.max && later.worst_input < self.worst_input) {
            (self.max, self.worst_input, self.worst_function) =
                (later.max, later.worst_input, later.worst_function);
        }
        self.max_norm = self.max_norm.max(later.max_norm);
        self.asymmetric += later.asymmetric;
        self.weight += later.weight;
        self.sum_of_squares += later.sum_of_squares;
        self.sum += later.sum;
        for (count, more) in self.histogram.iter_mut().zip(&later.histogram) {
            *count += more;
        }
    }

    /// Returns the root mean square of the errors of all outputs.
    pub fn rms(&self) -> f64 {
        (self.sum_of_squares / self.weight).sqrt()
    }

    /// Returns the mean error of the outputs' magnitudes: positive if magnitudes tend to be too large.
    pub fn bias(&self) -> f64 {
        self.sum / self.weight
    }

    /// Returns the 99th percentile of the errors' sizes. The result is too large by up to 1/64 of its value.
    pub fn p99(&self) -> f64 {
        let mut below = 0.0;
        for (index, count) in self.histogram.iter().enumerate() {
            below += count;
            if below >= 0.99 * self.weight {
                return bucket_end(index).min(self.max);
            }
        }
        self.max
    }
}

/// Number of low bits of an f64 that do not affect the bucket. The remaining bits are the exponent and the six high bits of the mantissa.
const SHIFT: u32 = 52 - BUCKETS_PER_OCTAVE.ilog2();
const FIRST: u64 = (1023 - OCTAVES) * BUCKETS_PER_OCTAVE;

fn bucket(size: f64) -> usize {
    ((size.to_bits() >> SHIFT).saturating_sub(FIRST)).min(OCTAVES * BUCKETS_PER_OCTAVE) as usize
}

fn bucket_end(index: usize) -> f64 {
    f64::from_bits((index as u64 + 1 + FIRST) << SHIFT)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: SinCos = SinCos {
        sin: 0.6,
        cos: -0.8,
    };

    fn off_by(sin: f64, cos: f64) -> SinCos {
        SinCos {
            sin: RIGHT.sin + sin,
            cos: RIGHT.cos + cos,
        }
    }

    #[test]
    fn known_errors_give_known_figures() {
        let mut statistics = Statistics::default();
        statistics.add(7, RIGHT, off_by(0.0, 0.0), 1.0);
        statistics.add(8, RIGHT, off_by(0.0, -0.25), 1.0);
        assert_eq!(statistics.inputs, 2);
        let worst = (statistics.worst_input, statistics.worst_function);
        assert_eq!(worst, (8, "cos"));
        assert!((statistics.max - 0.25).abs() < 1e-15);
        assert!((statistics.rms() - 0.125).abs() < 1e-15);
        assert!(
            (statistics.bias() - 0.0625).abs() < 1e-15,
            "too far from zero is positive"
        );
        assert!((statistics.max_norm - (1.05f64 * 1.05 + 0.36 - 1.0)).abs() < 1e-15);
    }

    #[test]
    fn merging_parts_is_adding_all() {
        let (mut whole, mut early, mut late) = (
            Statistics::default(),
            Statistics::default(),
            Statistics::default(),
        );
        for i in 0..100u32 {
            let got = off_by(f64::from(i) / 64.0, 0.0);
            whole.add(i.into(), RIGHT, got, 1.0);
            if i < 40 { &mut early } else { &mut late }.add(i.into(), RIGHT, got, 1.0);
        }
        early.merge(&late);
        assert_eq!(early.worst_input, whole.worst_input);
        assert_eq!((early.p99(), early.rms()), (whole.p99(), whole.rms()));
    }

    #[test]
    fn p99_leaves_one_in_a_hundred_above() {
        let mut statistics = Statistics::default();
        for i in 1..=1000u32 {
            let error = f64::from(i) / 1024.0;
            statistics.add(i.into(), RIGHT, off_by(error, error), 1.0);
        }
        let p99 = statistics.p99() * 1024.0;
        assert!((990.0..990.0 * 65.0 / 64.0).contains(&p99), "p99 is {p99}");
    }
}
