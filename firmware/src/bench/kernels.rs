//! Benchmark of reciprocals, roots, lengths, quotients and colours, each computed with several methods, from fast to exact.

use glint_variants::{colour, division, inverse_root, length, reciprocal, root, unit};

use super::measure::{Report, measure};

/// Measures the kernels of all families, and reports each under its own name.
pub fn kernels(report: Report) {
    for kernel in reciprocal::KERNELS {
        let input = |phase| kernel.format.number(reciprocal::input(phase), 23);
        measure(report, kernel.name, input, kernel.run);
    }
    for kernel in inverse_root::KERNELS.iter().chain(root::KERNELS) {
        let input = |phase| kernel.format.number(inverse_root::input(phase), 22);
        measure(report, kernel.name, input, kernel.run);
    }
    for kernel in division::KERNELS {
        let input = |phase| division::input(phase).map(|x| kernel.format.number(x, 23));
        measure(report, kernel.name, input, kernel.run);
    }
    for kernel in length::KERNELS {
        let input = |phase| kernel.format.vector(length::input(phase));
        measure(report, kernel.name, input, kernel.run);
    }
    for kernel in unit::KERNELS {
        let input = |phase| kernel.format.vector(length::input(phase));
        measure(report, kernel.name, input, kernel.run);
    }
    for pixel in colour::PIXELS {
        measure(report, pixel.pack.name, colour::input, pixel.pack.run);
    }
}
