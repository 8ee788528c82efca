//! Errors of reciprocals, roots, quotients, lengths and unit vectors. The inputs have the same form as the inputs of `bench kernels`, but
//! are more numerous.

use glint_variants::kernel::{Format, Kernel};
use glint_variants::{division, inverse_root, length, reciprocal, root, unit};

use super::trial::{Errors, Trial};

/// Number of mantissas of 24 bits: the numbers in [1, 2) with 23 fraction bits.
const MANTISSAS: u32 = 1 << 23;
/// Number of inputs of a kernel whose input is more than one number.
const SEVERAL: u32 = 1 << 20;

/// Returns phases that are evenly distributed on the circle: multiples of the golden ratio, as in the firmware.
fn spread(count: u32, thinning: u32) -> impl Iterator<Item = u32> {
    (0..count / thinning).map(|i| i.wrapping_mul(0x9e37_79b9))
}

/// Returns the phases of all inputs of a kernel whose input is a number of `bits` bits.
fn all(bits: u32, thinning: u32) -> impl Iterator<Item = u32> {
    // An odd step covers all values of the low bits.
    (0..1 << bits)
        .step_by(thinning as usize | 1)
        .map(move |x| x << (32 - bits))
}

/// The value of an output.
fn value(format: Format, output: u64) -> f64 {
    match format {
        Format::Fixed(bits) => output as f64 * (-f64::from(bits)).exp2(),
        Format::Float => f32::from_bits(output as u32).into(),
    }
}

/// Measures kernels by their relative errors. `number` converts an input to a kernel's format, and `exact` to the exact result.
fn relative<I: Copy>(
    kernels: &[Kernel<I, u64>],
    phases: impl Fn() -> Box<dyn Iterator<Item = u32>>,
    input: impl Fn(u32) -> I,
    number: impl Fn(Format, I) -> I,
    exact: impl Fn(I) -> f64,
    describe: impl Fn(I) -> String,
) -> Vec<Trial> {
    let trial = |kernel: &Kernel<I, u64>| {
        let mut errors = Errors::default();
        for phase in phases() {
            let input = input(phase);
            let found = value(kernel.format, (kernel.run)(number(kernel.format, input)));
            errors.add(&[found / exact(input) - 1.0], || describe(input));
        }
        Trial::of(kernel, errors)
    };
    kernels.iter().map(trial).collect()
}

pub fn reciprocals(thinning: u32) -> Vec<Trial> {
    let mantissa = |m: u32| f64::from(m) / f64::from(MANTISSAS);
    relative(
        reciprocal::KERNELS,
        || Box::new(all(23, thinning)),
        reciprocal::input,
        |format, m| format.number(m, 23),
        |m| mantissa(m).recip(),
        |m| format!("{:.7}", mantissa(m)),
    )
}

/// Converts a number with 22 fraction bits.
fn quarter(x: u32) -> f64 {
    f64::from(x) / f64::from(1 << 22)
}

fn of_quarters(kernels: &[Kernel<u32, u64>], thinning: u32, exact: fn(f64) -> f64) -> Vec<Trial> {
    relative(
        kernels,
        || Box::new(all(24, thinning)),
        inverse_root::input,
        |format, x| format.number(x, 22),
        |x| exact(quarter(x)),
        |x| format!("{:.7}", quarter(x)),
    )
}

pub fn inverse_roots(thinning: u32) -> Vec<Trial> {
    of_quarters(inverse_root::KERNELS, thinning, |x| x.sqrt().recip())
}

pub fn roots(thinning: u32) -> Vec<Trial> {
    of_quarters(root::KERNELS, thinning, f64::sqrt)
}

pub fn divisions(thinning: u32) -> Vec<Trial> {
    relative(
        division::KERNELS,
        || Box::new(spread(SEVERAL, thinning)),
        division::input,
        |format, q| q.map(|x| format.number(x, 23)),
        |[a, b]| f64::from(a) / f64::from(b),
        |[a, b]| format!("{a}/{b}"),
    )
}

/// Returns phases, numbers from which `length::input` computes a vector. The phases of the zero vector are left out, because its
/// relative error is not defined.
fn vectors(thinning: u32) -> Box<dyn Iterator<Item = u32>> {
    Box::new(spread(SEVERAL, thinning).filter(|&phase| length::input(phase) != [0; 3]))
}

fn exact_length(q: [i32; 3]) -> f64 {
    // The sum is exact: it is below 2^46.
    q.iter()
        .map(|&x| f64::from(x) * f64::from(x))
        .sum::<f64>()
        .sqrt()
}

pub fn lengths(thinning: u32) -> Vec<Trial> {
    relative(
        length::KERNELS,
        || vectors(thinning),
        length::input,
        Format::vector,
        exact_length,
        |q| format!("{q:?}"),
    )
}

pub fn units(thinning: u32) -> Vec<Trial> {
    let trial = |kernel: &Kernel<[i32; 3], [i32; 3]>| {
        let mut errors = Errors::default();
        for phase in vectors(thinning) {
            let input = length::input(phase);
            let found = (kernel.run)(kernel.format.vector(input)).map(|x| match kernel.format {
                Format::Fixed(bits) => f64::from(x) * (-f64::from(bits)).exp2(),
                Format::Float => f32::from_bits(x.cast_unsigned()).into(),
            });
            let length = exact_length(input);
            let off = [0, 1, 2].map(|i| found[i] - f64::from(input[i]) / length);
            errors.add(&off, || format!("{input:?}"));
        }
        Trial::of(kernel, errors)
    };
    unit::KERNELS.iter().map(trial).collect()
}
