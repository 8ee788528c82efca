//! Tests of the sky behind meshes: heights compared with f64.

use glint_core::light::Gradient;
use glint_core::picture::{Quarter, Samples, Size, Window};
use glint_model::Sky;
use glint_vectors::camera::Size as Pixels;
use glint_vectors::{Camera, Random};

/// A gradient whose colours are all black, for tests of heights.
fn gradient(is_fixed: bool) -> Gradient {
    Gradient {
        colours: [[0; 3]; 3],
        is_fixed,
    }
}

/// The height of each group is the z component of the ray through the group's middle.
#[test]
fn heights_of_random_cameras() {
    let mut random = Random(7);
    for half_width in [0.0087, 0.5, 1.0, 8.0, 115.0] {
        let mut worst = 0.0_f64;
        for size in [Size::W320, Size::W640, Size::W1280] {
            let [width, height] = size.pixels();
            for _ in 0..100 {
                let towards = random.direction();
                let camera =
                    Camera::aimed(&mut random, [0.0; 3], towards, [0.0; 2], half_width, 0.1);
                let view = camera.rounded();
                let camera = Camera::of(&view);
                let sky = Sky::new(&view, size.pixels(), gradient(false));
                for _ in 0..200 {
                    let x = random.integer(0, i64::from(width / 8) - 1) as u32;
                    let y = random.integer(0, i64::from(height) - 1) as u32;
                    let middle = [f64::from(8 * x) + 3.5, f64::from(y)];
                    let [_, _, exact] = camera.ray(middle, Pixels { width, height }).direction;
                    let found = f64::from(sky.height(x, y)) / f64::from(1 << 23);
                    worst = worst.max((found - exact).abs());
                }
            }
        }
        println!("half width {half_width}: largest error of the height {worst:.2e}");
        // The height of the middle has an error of at most one unit, and each of up to 80 groups and 360 lines adds at most half a unit.
        assert!(
            worst < 221.0 / f64::from(1 << 23),
            "half width {half_width}"
        );
    }
}

/// A fixed gradient has, in each line, the height of the line's middle, for all cameras, sizes, samples and windows.
#[test]
fn heights_of_fixed_gradients() {
    let mut random = Random(8);
    for size in Size::ALL {
        let towards = random.direction();
        let view = Camera::aimed(&mut random, [0.0; 3], towards, [0.0; 2], 1.0, 0.1).rounded();
        let whole = Sky::new(&view, size.pixels(), gradient(true));
        let mut worst = 0.0_f64;
        for (is_lower, samples) in [
            (false, Samples::One),
            (false, Samples::Four),
            (true, Samples::Four),
        ] {
            let window = Window {
                size,
                quarter: (samples == Samples::Four).then_some(Quarter {
                    is_right: true,
                    is_lower,
                }),
            };
            let sky = whole.in_window(window, samples);
            let [_, first] = window.origin().map(|place| place / samples.across());
            for line in 0..size.height() / samples.across() {
                let place = f64::from(2 * (first + line) + 1) / f64::from(size.height());
                let found = f64::from(sky.height(line % (size.width() / 8), line));
                worst = worst.max((found / f64::from(1 << 23) - (1.0 - place)).abs());
            }
        }
        println!("{size}: largest error of the height {worst:.2e}");
        // Each of up to 360 lines from the middle adds an error of at most half a unit.
        assert!(worst < 181.0 / f64::from(1 << 23), "{size}");
    }
}
