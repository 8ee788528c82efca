//! The measured kernels of sine and cosine, each with its inputs.

use std::f64::consts::PI;
use std::ops::Range;

use cordic::CordicNumber;
use fixed::traits::Fixed;
use fixed::types::{I4F28, I8F24, I16F16};
use glint_core::fixed::Turns;
use glint_core::trig;
use micromath::F32Ext;

use super::statistics::Statistics;
use super::truth::{Image, OCTANT, SinCos, TURN};

/// A kernel and its inputs. The measurement runs in steps, numbered from 0, and a step may cover several inputs.
pub struct Kernel {
    /// Name of the kernel, as in the firmware's `bench sine`.
    pub name: &'static str,
    /// Name of the kernel's line in the work-precision diagram, shared by its variants.
    pub family: &'static str,
    /// Name of the kernel's variant, for example the order of the series.
    pub config: &'static str,
    /// Number format of the outputs.
    pub format: &'static str,
    /// Unit in the last place of the outputs' format. For floats, the unit in the last place of numbers just below 1.
    pub ulp: f64,
    /// Description of the measured inputs.
    pub inputs: &'static str,
    /// Whether the inputs are phases (fractions of a turn), for which the symmetries of the circle are checked bit for bit.
    pub by_phase: bool,
    /// Whether Glint itself uses the kernel.
    pub shipped: bool,
    /// Number of steps that cover all inputs. A step covers one or several inputs.
    pub steps: u64,
    /// Measures the kernel.
    pub run: Box<Run>,
    /// Describes an input as text. The argument has the input's bits as an integer.
    pub show: Box<dyn Fn(u64) -> String + Sync>,
}

/// Measures a kernel at the steps `stride·i` for all i in a range, and adds the errors to statistics. The arguments are the
/// range, the stride and the statistics.
pub type Run = dyn Fn(Range<u64>, u64, &mut Statistics) + Sync;

impl Kernel {
    /// Makes a kernel that Glint does not use, with inputs other than phases. `labels` are name, family, config and format.
    fn new(
        [name, family, config, format]: [&'static str; 4],
        ulp: f64,
        inputs: &'static str,
        steps: u64,
        run: impl Fn(Range<u64>, u64, &mut Statistics) + Sync + 'static,
        show: impl Fn(u64) -> String + Sync + 'static,
    ) -> Self {
        Self {
            name,
            family,
            config,
            format,
            ulp,
            inputs,
            by_phase: false,
            shipped: false,
            steps,
            run: Box::new(run),
            show: Box::new(show),
        }
    }
}

/// Returns all measured kernels, Glint's own first.
pub fn kernels() -> Vec<Kernel> {
    vec![
        Kernel {
            shipped: true,
            ..phases(
                ["sin_cos_q30", GLINT, "order 3", "Q2.30"],
                30,
                SHORT_PHASES,
                q30::<3>,
            )
        },
        Kernel {
            shipped: true,
            ..phases(
                ["sin_cos_q30", GLINT, "order 3", "Q2.30"],
                30,
                ALL_PHASES,
                q30::<3>,
            )
        },
        lower_order::<2>("sin_cos_q30_order2", "order 2"),
        lower_order::<1>("sin_cos_q30_order1", "order 1"),
        lower_order::<0>("sin_cos_q30_order0", "order 0"),
        phases(
            ["idsp", "idsp", "cossin", "Q1.31"],
            31,
            ALL_PHASES,
            |angle| {
                let (cos, sin) = idsp::cossin(angle as i32);
                (sin, cos)
            },
        ),
        radians(
            ["cordic_i16f16", "cordic", "I16F16", "Q16.16"],
            16,
            ALL_RADIANS,
            cordic_sin_cos::<I16F16>,
        ),
        radians(
            ["cordic", "cordic", "I8F24", "Q8.24"],
            24,
            ALL_RADIANS,
            cordic_sin_cos::<I8F24>,
        ),
        radians(
            ["cordic_i4f28", "cordic", "I4F28", "Q4.28"],
            28,
            SOME_RADIANS,
            cordic_sin_cos::<I4F28>,
        ),
        floats(["micromath", "micromath", "F32Ext", "f32"], |angle| {
            (F32Ext::sin(angle), F32Ext::cos(angle))
        }),
        floats(["libm", "libm", "sincosf", "f32"], libm::sincosf),
        degrees(),
    ]
}

const GLINT: &str = "glint: table of 64 and Taylor";

/// The measured inputs: n, for every n-th input of a format, and a description.
type Inputs = (u32, &'static str);

const SHORT_PHASES: Inputs = (1 << 16, "all 2^16 phases of 16 bits");
const ALL_PHASES: Inputs = (1, "all 2^32 phases");
const SOME_PHASES: Inputs = (15, "every 15th phase of an octant, in all octants");
const ALL_RADIANS: Inputs = (1, "all radians in [−π, π]");
/// A part of the inputs, for a slow kernel with a format of more than 10^9 inputs.
const SOME_RADIANS: Inputs = (17, "every 17th of the radians in [−π, π]");

fn q30<const ORDER: u32>(angle: u32) -> (i32, i32) {
    let (sin, cos) = trig::sin_cos_q30_order::<ORDER>(Turns(angle));
    (sin.to_bits(), cos.to_bits())
}

/// Makes Glint's Q2.30 kernel with its Taylor series truncated to the lower order `ORDER`, measured at a part of the phases.
fn lower_order<const ORDER: u32>(name: &'static str, config: &'static str) -> Kernel {
    let labels = [name, GLINT, config, "Q2.30"];
    phases(labels, 30, SOME_PHASES, q30::<ORDER>)
}

fn cordic_sin_cos<T: CordicNumber + Fixed<Bits = i32>>(angle: i32) -> (i32, i32) {
    let (sin, cos) = cordic::sin_cos(T::from_bits(angle));
    (sin.to_bits(), cos.to_bits())
}

/// Returns the unit in the last place of a format with `fraction_bits` fraction bits.
fn last_place(fraction_bits: u32) -> f64 {
    (-f64::from(fraction_bits)).exp2()
}

/// Converts fixed-point outputs, in units of `ulp`, to f64.
fn scaled((sin, cos): (i32, i32), ulp: f64) -> SinCos {
    SinCos {
        sin: f64::from(sin) * ulp,
        cos: f64::from(cos) * ulp,
    }
}

/// Makes a kernel whose inputs are phases. A step takes a phase of the first octant and evaluates the kernel at the images of the
/// phase in all eight octants. Images with bitwise equal outputs, apart from signs and order, have equal errors. Their error is
/// computed once and counted for each image; an image with different bits is measured separately.
fn phases(
    labels: [&'static str; 4],
    fraction_bits: u32,
    (spacing, inputs): Inputs,
    evaluate: impl Fn(u32) -> (i32, i32) + Sync + 'static,
) -> Kernel {
    let ulp = last_place(fraction_bits);
    let real = move |fixed_point| scaled(fixed_point, ulp);
    let spacing = u64::from(spacing);
    let steps = u64::from(OCTANT) / spacing + 1;
    let run = move |range: Range<u64>, stride: u64, statistics: &mut Statistics| {
        for step in range {
            let phase = (step * stride * spacing) as u32;
            let truth = SinCos::of_octant(phase);
            let (first_sin, first_cos) = evaluate(phase);
            let mut equal = 0;
            for image in Image::all(phase) {
                let angle = image.angle(phase);
                let got = evaluate(angle);
                if got == image.carry(first_sin, first_cos) {
                    equal += 1;
                } else {
                    let (sin, cos) = image.carry(truth.sin, truth.cos);
                    statistics.asymmetric += 1;
                    statistics.add(angle.into(), SinCos { sin, cos }, real(got), 1.0);
                }
            }
            statistics.add_images(phase.into(), truth, real((first_sin, first_cos)), equal);
        }
    };
    let show = |angle| format!("0x{angle:08x} ({:.6}°)", angle as f64 / TURN * 360.0);
    Kernel {
        by_phase: true,
        ..Kernel::new(labels, ulp, inputs, steps, run, show)
    }
}

/// Makes a kernel with inputs in fixed-point radians, with as many fraction bits as its outputs. Every `spacing`-th input in [−π,
/// π] is measured.
fn radians(
    labels: [&'static str; 4],
    fraction_bits: u32,
    (spacing, inputs): Inputs,
    evaluate: impl Fn(i32) -> (i32, i32) + Sync + 'static,
) -> Kernel {
    let ulp = last_place(fraction_bits);
    let last = (PI / ulp) as i64;
    let spacing = u64::from(spacing);
    let steps = 2 * last as u64 / spacing + 1;
    let run = move |range: Range<u64>, stride: u64, statistics: &mut Statistics| {
        for step in range {
            let bits = (step * stride * spacing) as i64 - last;
            let got = scaled(evaluate(bits as i32), ulp);
            let truth = SinCos::of_radians(bits as f64 * ulp);
            statistics.add(bits as u64, truth, got, 1.0);
        }
    };
    let show = move |bits| format!("{:.9} rad", bits as i64 as f64 * ulp);
    Kernel::new(labels, ulp, inputs, steps, run, show)
}

/// Makes a kernel with inputs in f32 radians. All floats from 2^-24 to 2π are measured; the sine of smaller angles rounds to the angle.
fn floats(
    labels: [&'static str; 4],
    evaluate: impl Fn(f32) -> (f32, f32) + Sync + 'static,
) -> Kernel {
    let first = u64::from(2f32.powi(-24).to_bits());
    let last = u64::from(std::f32::consts::TAU.to_bits());
    let run = move |range: Range<u64>, stride: u64, statistics: &mut Statistics| {
        for step in range {
            let bits = (first + step * stride) as u32;
            let angle = f32::from_bits(bits);
            let to_next = f64::from(f32::from_bits(bits + 1)) - f64::from(angle);
            let (sin, cos) = evaluate(angle);
            let got = SinCos {
                sin: sin.into(),
                cos: cos.into(),
            };
            statistics.add(bits.into(), SinCos::of_radians(angle.into()), got, to_next);
        }
    };
    let show = |bits| format!("{:?} rad", f32::from_bits(bits as u32));
    let inputs = "all floats in [2^-24, 2π] rad";
    Kernel::new(labels, last_place(24), inputs, last - first + 1, run, show)
}

/// Makes a kernel with a table of sines of one entry per degree, measured at all Q16.16 angles in [0°, 360°).
fn degrees() -> Kernel {
    let table: Vec<f64> = (0..=180)
        .map(|degree| (f64::from(degree).to_radians().sin() * 65536.0).round() / 65536.0)
        .collect();
    let sine = move |degree: u64| match degree % 360 {
        low @ 0..=180 => table[low as usize],
        high => -table[high as usize - 180],
    };
    let run = move |range: Range<u64>, stride: u64, statistics: &mut Statistics| {
        for step in range {
            let angle = step * stride;
            let degree = angle >> 16;
            let got = SinCos {
                sin: sine(degree),
                cos: sine(450 - degree),
            };
            let truth = SinCos::of_radians((angle as f64 / 65536.0).to_radians());
            statistics.add(angle, truth, got, 1.0);
        }
    };
    let labels = ["degree_table", "table of degrees", "181 entries", "Q16.16"];
    let inputs = "all of 16.16 in [0°, 360°)";
    let show = |angle| format!("{:.5}°", angle as f64 / 65536.0);
    Kernel::new(labels, last_place(16), inputs, 360 << 16, run, show)
}

#[cfg(test)]
mod tests {
    use super::super::sweep::sweep;
    use super::*;

    fn named(name: &str) -> Kernel {
        kernels()
            .into_iter()
            .find(|kernel| kernel.name == name)
            .expect("a kernel")
    }

    /// The largest error of each kernel lies in a range known from theory or the library's documentation.
    #[test]
    fn other_libraries_have_their_documented_errors() {
        for (name, at_least, at_most) in [
            ("degree_table", 0.01744, 0.01747),
            ("idsp", 1.8e-5, 1.95e-5),
            ("micromath", 8e-4, 2e-3),
            ("libm", 2.5e-8, 6e-8),
        ] {
            let kernel = named(name);
            let statistics = sweep(&kernel, kernel.steps / 300_000 + 1, &|_| ());
            let max = statistics.max;
            assert!((at_least..=at_most).contains(&max), "{name}: {max:e}");
        }
    }

    #[test]
    fn the_weight_of_a_float_is_its_part_of_the_circle() {
        // About half of all input floats are below 2^-11 rad, where the constant outputs sin 0 and cos 0 are nearly right.
        let careless = floats(["", "", "", ""], |_| (0.0, 1.0));
        let statistics = sweep(&careless, 997, &|_| ());
        // With weights by angle, the mean square of the error over the circle is (sin² + (cos − 1)²)/2 = (1/2 + 3/2)/2 = 1.
        assert!(
            (statistics.rms() - 1.0).abs() < 1e-3,
            "{}",
            statistics.rms()
        );
    }

    #[test]
    fn a_broken_symmetry_is_counted() {
        let crooked = phases(["", "", "", ""], 30, SHORT_PHASES, |angle| {
            if angle == 3 << 16 { (1, 1) } else { (0, 0) }
        });
        let statistics = sweep(&crooked, 1, &|_| ());
        assert_eq!(statistics.inputs, 1 << 16);
        // The output at the phase of the first octant is wrong, so it does not match the outputs at the seven other images.
        assert_eq!(statistics.asymmetric, 7);
    }
}
