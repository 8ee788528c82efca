//! Kernels of one family: functions that compute the same value, from fast to exact.

/// A kernel: a function and its names in reports.
pub struct Kernel<I, O> {
    /// Name in the firmware's `bench kernels`.
    pub name: &'static str,
    /// Word length and method.
    pub config: &'static str,
    /// Whether Glint itself uses the kernel.
    pub shipped: bool,
    /// Number format of inputs and outputs.
    pub format: Format,
    /// The function that computes the value.
    pub run: fn(I) -> O,
}

/// Number format of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Fixed point: inputs in the format of the family, outputs with this number of fraction bits.
    Fixed(u32),
    /// The bit patterns of f32 numbers.
    Float,
}

impl Format {
    /// Converts an input with `fraction_bits` fraction bits, below 2^24, to this format. The conversion is exact.
    pub fn number(self, input: u32, fraction_bits: u32) -> u32 {
        match self {
            Self::Fixed(_) => input,
            Self::Float => (input as f32 / (1_u32 << fraction_bits) as f32).to_bits(),
        }
    }

    /// Converts the components of a vector, below 2^24 in magnitude, to this format. The conversion is exact.
    pub fn vector(self, input: [i32; 3]) -> [i32; 3] {
        match self {
            Self::Fixed(_) => input,
            Self::Float => input.map(|x| (x as f32).to_bits().cast_signed()),
        }
    }
}

/// Converts a function on f32 to a function on bit patterns.
macro_rules! float {
    ($run:expr) => {
        |x: u32| {
            let run: fn(f32) -> f32 = $run;
            u64::from(run(f32::from_bits(x)).to_bits())
        }
    };
}
pub(crate) use float;

/// Makes a kernel that Glint does not use.
pub(crate) const fn other<I, O>(
    name: &'static str,
    config: &'static str,
    format: Format,
    run: fn(I) -> O,
) -> Kernel<I, O> {
    Kernel {
        name,
        config,
        shipped: false,
        format,
        run,
    }
}

/// Makes a kernel that Glint uses.
pub(crate) const fn shipped<I, O>(
    name: &'static str,
    config: &'static str,
    format: Format,
    run: fn(I) -> O,
) -> Kernel<I, O> {
    Kernel {
        shipped: true,
        ..other(name, config, format, run)
    }
}
