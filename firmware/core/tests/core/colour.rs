//! Conversion of colours to RGB565.

use glint_core::colour::Rgb565;

/// The mean over a pattern is near the given channel, grows with it, and is exact at both ends.
#[test]
fn dithering_keeps_the_mean() {
    let mut worst = 0.0_f64;
    let mut before = [0.0; 3];
    for channel in 0..=255_u8 {
        let places = (0..16).map(|place| (place % 4, place / 4));
        let shown = places.map(|(x, y)| Rgb565::dithered([channel; 3], x, y).to_rgb888());
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
    for (x, y) in (0..16).map(|place| (place % 4, place / 4)) {
        assert_eq!(Rgb565::dithered([255; 3], x, y), Rgb565::WHITE);
        assert_eq!(Rgb565::dithered([0; 3], x, y), Rgb565(0));
    }
}
