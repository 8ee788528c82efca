//! The sky behind meshes, compared with its height in f64.

use glint_core::picture::Size;
use glint_model::Sky;
use glint_vectors::camera::Size as Pixels;
use glint_vectors::{Camera, Random};

/// The height of each group is the component along z of the ray through its middle.
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
                let sky = Sky::new(&view, size.pixels(), [[0; 3]; 3]);
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
        println!("half width {half_width}: height within {worst:.2e}");
        // Each step is off by at most half a unit: 80 groups and 360 lines from the middle, which is within a unit.
        assert!(
            worst < 221.0 / f64::from(1 << 23),
            "half width {half_width}"
        );
    }
}
