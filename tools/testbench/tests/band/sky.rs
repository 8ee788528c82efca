//! Tests of the colours of the sky, which must equal the model's.

use glint_core::light::Background;
use glint_core::picture::Size;
use glint_model::Sky;
use glint_testbench::{Module, Sink, Stalls, drive_sky};
use glint_vectors::{Camera, Random};

/// A colour in the format of the stream: full red and blue are 248, full green is 252.
pub fn scaled([red, green, blue]: [u8; 3]) -> u32 {
    let colour = [
        red - (red >> 5),
        green - (green >> 6),
        blue - (blue >> 5),
        0,
    ];
    u32::from_le_bytes(colour)
}

/// Pictures of random cameras with the smallest, the largest and two typical half widths. Each picture is drawn in part, and then whole.
#[test]
fn colours_of_random_pictures() {
    let mut random = Random(3);
    for (seed, share) in [(1, 0.0), (2, 0.5)] {
        let mut module = Module::new("band_sky", seed);
        let mut colours = Sink::new(
            &module,
            "out",
            &["line", "colour"],
            Stalls::new(seed.into(), share),
        );
        for half_width in [0.0087, 0.6, 1.5, 115.0] {
            let towards = random.direction();
            let camera = Camera::aimed(&mut random, [0.0; 3], towards, [0.0; 2], half_width, 0.1);
            let background = [Background::Sky, Background::Gradient][random.integer(0, 1) as usize];
            let size = [Size::W320, Size::W640, Size::W1280][random.integer(0, 2) as usize];
            let sky = Sky::new(
                &camera.rounded(),
                size.pixels(),
                background.gradient().unwrap(),
            );
            let groups = size.width() / 8;
            drive_sky(&mut module, &sky);
            module.drive("stride", groups);
            for lines in [random.integer(1, 20) as u32, size.height()] {
                module.drive("start", 1);
                module.clock();
                module.drive("start", 0);
                let mut found = Vec::new();
                let start = module.cycles();
                while found.len() < (lines * groups) as usize {
                    colours.drive(&mut module);
                    module.settle();
                    colours.sample(&module);
                    found.extend(
                        colours
                            .take()
                            .iter()
                            .map(|item| [0, 1].map(|i| item[i].words()[0])),
                    );
                    module.clock();
                }
                let clocks = module.cycles() - start;
                for (place, &colour) in (0..).zip(&found) {
                    let (x, y) = (place % groups, place / groups);
                    assert_eq!(
                        colour,
                        [y % 4, scaled(sky.colour(x, y))],
                        "group {x} of line {y}, half width {half_width}, {sky:?}"
                    );
                }
                if share == 0.0 {
                    assert_eq!(clocks, u64::from(lines * groups) + 8, "clocks");
                }
            }
        }
    }
}
