//! Benchmark of gesture control: clock cycles per frame of the image sensor.

use core::cell::RefCell;

use glint_core::fixed::{Q4_28, U16_16};
use glint_core::gesture::{
    ANGLE, Backlash, CHANNELS, Control, OneEuro, Region, Statistics, TimeStep,
};
use glint_variants::filter::{AlphaBeta, Average, LowPass};

use super::measure::{Report, measure};

/// The time between two frames in µs.
const FRAME: u32 = 16_667;

/// Measures the complete control, the hand detection from statistics alone, and filters of one channel. Reports them under the names that
/// `cargo xtask report gesture` uses.
pub fn gesture(report: Report) {
    measure(report, "blob", statistics, |statistics| statistics.blob());
    let control = RefCell::new((Control::default(), 0));
    measure(report, "control", statistics, |statistics| {
        let (control, time) = &mut *control.borrow_mut();
        *time += u64::from(FRAME);
        control.on_frame(*time, &statistics)
    });
    let step = TimeStep::new(FRAME);
    measure(report, "step", |phase| FRAME + (phase >> 28), TimeStep::new);
    let start = Q4_28::ZERO;
    measure(report, "none", input, |input| input);
    let average = RefCell::new(Average::<8>::new(start));
    measure(report, "average", input, |input| {
        average.borrow_mut().next(input)
    });
    let low_pass = RefCell::new(LowPass::new(U16_16::lit("4"), start));
    measure(report, "low_pass", input, |input| {
        low_pass.borrow_mut().next(input, step)
    });
    let alpha_beta = RefCell::new(AlphaBeta::new([20_000, 4_000], start));
    measure(report, "alpha_beta", input, |input| {
        alpha_beta.borrow_mut().next(input)
    });
    let one_euro = RefCell::new(OneEuro::new(start));
    measure(report, "one_euro", input, |input| {
        one_euro.borrow_mut().next(input, &ANGLE, step)
    });
    let [(tuning, zone), ..] = CHANNELS;
    let shipped = RefCell::new((OneEuro::new(start), Backlash::new(start)));
    measure(report, "one_euro_zone", input, |input| {
        let (filter, backlash) = &mut *shipped.borrow_mut();
        backlash.next(filter.next(input, &tuning, step), zone)
    });
}

/// A pseudo-random position of the hand, within 1/16 of the range.
fn input(phase: u32) -> Q4_28 {
    Q4_28::from_bits(phase.cast_signed() >> 8)
}

/// Statistics of a hand of 41×41 pixels, with pseudo-random fractions of a pixel in its centre.
fn statistics(phase: u32) -> Statistics {
    const COUNT: u32 = 41 * 41;
    let off = [phase >> 24, phase >> 16 & 0xff];
    Statistics {
        size: [320, 240],
        count: COUNT + (phase >> 28),
        sums: [160 * COUNT + off[0], 120 * COUNT + off[1]],
        bounds: Region {
            first: [139, 99],
            last: [180, 140],
        },
        is_whole: true,
    }
}
