//! Tests of the colour conversion with all colours.

use glint_core::colour::Rgb565;
use glint_model::gesture::{Channel, channels};
use glint_testbench::Module;

/// Number of clocks from the input of a pixel to the comparison of its channels with the windows.
const LATENCY: u32 = 4;

/// Tests each colour with a window that contains only the model's value, so a marked pixel has this
/// value.
#[test]
fn every_channel_of_every_colour_is_that_of_the_model() {
    let mut module = Module::load("colour_window", 1);
    module.settle();
    let [clk, pixel, marked] = ["clk", "pixel", "marked"].map(|name| module.port(name));
    for (tested, other) in [("window_a", "window_b"), ("window_b", "window_a")] {
        module.drive(&format!("{other}.lower"), 0);
        module.drive(&format!("{other}.upper"), 255);
        let bounds = ["lower", "upper"].map(|bound| module.port(&format!("{tested}.{bound}")));
        for channel in Channel::ALL {
            module.drive(&format!("{tested}.channel"), channel as u8);
            for place in 0..0x1_0000 + LATENCY {
                let colour = Rgb565(place.wrapping_sub(LATENCY) as u16);
                let value = channels(colour)[channel as usize];
                module.set_value(pixel, u64::from(place as u16));
                for bound in bounds {
                    module.set_value(bound, value.into());
                }
                for level in [1, 0] {
                    module.set_value(clk, level);
                    module.settle();
                }
                assert!(
                    place < LATENCY || module.is_high(marked),
                    "{tested}: {channel:?} of {colour:x?} is not {value}"
                );
            }
        }
    }
}

/// The conversion equals ITU-R BT.601 up to rounding and the precision of its factors.
#[test]
fn channels_are_near_their_real_values() {
    let mut greatest = 0.0_f64;
    for colour in (0..=u16::MAX).map(Rgb565) {
        let [r, g, b] = colour.to_rgb888().map(f64::from);
        let luma = 0.299 * r + 0.587 * g + 0.114 * b;
        let real = [luma, 128.0 + (r - luma) / 1.402, 128.0 + (b - luma) / 1.772];
        for (found, real) in channels(colour)[3..].iter().zip(real) {
            greatest = greatest.max((f64::from(*found) - real).abs());
        }
    }
    assert!(greatest <= 0.7, "{greatest}");
}
