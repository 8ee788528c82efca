//! Conversion of colours to RGB565.

use glint_core::colour::{Rgb565, Rounding};

fn rounded(rgb: [u8; 3], rounding: Rounding, place: [u32; 2]) -> Rgb565 {
    Rgb565::rounded(Rgb565::with_fractions(rgb), rounding, place)
}

/// The mean over a dither pattern is near the given channel and never decreases as the channel grows; the mean is exact for 0 and 255.
#[test]
fn dithering_keeps_the_mean() {
    let mut worst = 0.0_f64;
    let mut before = [0.0; 3];
    for channel in 0..=255_u8 {
        let places = (0..16).map(|place| [place % 4, place / 4]);
        let shown =
            places.map(|place| rounded([channel; 3], Rounding::Dithered, place).to_rgb888());
        let sums = shown.fold([0; 3], |sums: [u32; 3], pixel| {
            [0, 1, 2].map(|i| sums[i] + u32::from(pixel[i]))
        });
        let means = sums.map(|sum| f64::from(sum) / 16.0);
        for (mean, before) in means.into_iter().zip(before) {
            worst = worst.max((mean - f64::from(channel)).abs());
            assert!(mean >= before, "channel {channel}");
        }
        before = means;
    }
    println!("means within {worst:.2}");
    assert!(worst <= 1.0, "{worst}");
    for place in (0..16).map(|place| [place % 4, place / 4]) {
        for rounding in [Rounding::Dithered, Rounding::Nearest] {
            assert_eq!(rounded([255; 3], rounding, place), Rgb565::WHITE);
            assert_eq!(rounded([0; 3], rounding, place), Rgb565(0));
        }
    }
}

/// Without dithering, a channel becomes the nearest of the values that the monitor shows, or a value that is farther by 1/255.
#[test]
fn without_dithering_a_channel_is_nearest() {
    for channel in 0..=255_u8 {
        let shown = rounded([channel; 3], Rounding::Nearest, [0, 1]).to_rgb888();
        let colours = 0..=u16::MAX;
        let least = colours.fold([u8::MAX; 3], |least, colour| {
            let colour = Rgb565(colour).to_rgb888();
            [0, 1, 2].map(|i| least[i].min(colour[i].abs_diff(channel)))
        });
        for (shown, least) in core::iter::zip(shown, least) {
            assert!(shown.abs_diff(channel) <= least + 1, "{channel}");
        }
    }
}

/// Every colour of RGB565 keeps its value, in every pixel.
#[test]
fn an_exact_colour_is_never_changed() {
    for colour in (0..=u16::MAX).map(Rgb565) {
        for place in (0..16).map(|place| [place % 4, place / 4]) {
            for rounding in [Rounding::Dithered, Rounding::Nearest] {
                assert_eq!(Rgb565::rounded(colour.fractions(), rounding, place), colour);
                assert_eq!(rounded(colour.to_rgb888(), rounding, place), colour);
            }
        }
    }
}
