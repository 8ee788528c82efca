//! Tests with random frames, polarities, settings and faults, and tests at the frame rates that the
//! engine must support.

use glint_core::gesture::Region;
use glint_model::gesture::{Channel, Polarity, Settings};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_pcg::Pcg64Mcg;

use crate::bench::{Bench, Clocks, HASTY, settings, window};
use crate::camera::{End, Picture};

fn polarity(random: &mut Pcg64Mcg) -> Polarity {
    Polarity {
        vsync_low: random.random(),
        href_low: random.random(),
        swap: random.random(),
    }
}

fn random_settings(random: &mut Pcg64Mcg, size: [u16; 2]) -> Settings {
    let any = |random: &mut Pcg64Mcg| {
        let [a, b] = [random.random_range(0..=255), random.random_range(0..=255)];
        let window = window(u8::min(a, b), u8::max(a, b));
        (*Channel::ALL.choose(random).unwrap(), window)
    };
    let windows = [any(random), any(random)];
    let mut region = settings(size).region;
    if random.random() {
        for axis in [0, 1] {
            let [a, b] = [(); 2].map(|()| random.random_range(0..size[axis]));
            // Some regions are empty.
            [region.first[axis], region.last[axis]] = if random.random_range(0..8) == 0 {
                [a, b]
            } else {
                [a.min(b), a.max(b)]
            };
        }
    }
    let least_run = if random.random() {
        random.random_range(0..16)
    } else {
        1
    };
    Settings {
        size,
        windows,
        region,
        least_run,
    }
}

/// A picture of noisy patches in random colours.
fn picture(random: &mut Pcg64Mcg, size: [u16; 2]) -> Picture {
    let (patch, colours) = (
        random.random_range(1..24),
        [(); 8].map(|()| random.random::<u16>()),
    );
    let noise = random.random_range(0..20);
    Picture::new(size, |x, y| {
        if random.random_range(0..100) < noise {
            return random.random();
        }
        colours
            [usize::from((x / patch).wrapping_mul(5) ^ (y / patch).wrapping_mul(3)) % colours.len()]
    })
}

/// Adds a fault to a picture; returns how the frame ends.
fn spoil(random: &mut Pcg64Mcg, picture: &mut Picture) -> End {
    let count = picture.lines.len();
    let at = random.random_range(0..count);
    let line = &mut picture.lines[at];
    let place = random.random_range(0..line.len());
    match random.random_range(0..9) {
        0 => line.truncate(place & !1),
        1 => line.extend([1, 2, 3, 4]),
        2 => drop(line.remove(place)),
        3 => line.insert(place, 0x5A),
        4 => drop(picture.lines.remove(at)),
        5 => picture.lines.insert(at, picture.lines[at].clone()),
        6 => return End::Lost,
        7 => {
            picture.lines[count - 1].truncate(place.max(1));
            return End::Cut;
        }
        _ => {
            line.truncate(place & !1);
            line.push(7);
        }
    }
    // An empty line has no pin states.
    picture.lines.retain(|line| !line.is_empty());
    End::Vsync
}

#[test]
fn random_frames_polarities_and_faults() {
    // Periods of the image sensor: longer than the engine's period, similar, and half of it, with a
    // pixel in each clock of the engine.
    let clocks = [
        (12_308, 41_600),
        (12_308, 20_400),
        (25_000, 20_400),
        (10_000, 10_000),
        (10_000, 10_002),
        (12_000, 6_000),
    ];
    for (seed, (sys, camera)) in (0..).zip(clocks.into_iter().cycle().take(24)) {
        let mut random = rand::SeedableRng::seed_from_u64(1000 + seed);
        let mut size = [40, 12];
        let first = random_settings(&mut random, size);
        let falling = random.random();
        let mut bench = Bench::new(
            HASTY,
            Clocks { sys, camera },
            polarity(&mut random),
            falling,
            first,
            seed,
        );
        bench.begin();
        for _ in 0..30 {
            let mut sent = picture(&mut random, size);
            let end = if random.random_range(0..3) == 0 {
                spoil(&mut random, &mut sent)
            } else {
                End::Vsync
            };
            if random.random_range(0..4) == 0 {
                bench.request_snapshot(random.random_range(0..4), random.random());
            }
            // Settings requested now are latched at the next frame.
            size = [random.random_range(1..100), random.random_range(1..14)];
            let next = random_settings(&mut random, size);
            let pins = bench.camera.send(&mut random, &sent, end);
            let stop = random.random_range(0..12) == 0;
            let middle = random.random_range(0..pins.len());
            bench.set(next);
            bench.send(&pins[..middle]);
            if stop {
                bench.idle(0);
                bench.stop(150);
            }
            bench.send(&pins[middle..]);
            bench.compare();
            bench.compare_snapshot();
            if end == End::Lost {
                // The settings are not latched yet, so the next frame would count as faulty whatever its size.
                bench.begin();
            }
        }
        assert!(bench.twin.counts.frames > 8, "{:?}", bench.twin.counts);
        assert!(
            bench.twin.counts.frames_dropped > 2,
            "{:?}",
            bench.twin.counts
        );
    }
}

/// Sends two complete frames of `size` at these clocks, and expects both to be counted.
fn takes(clocks: Clocks, size: [u16; 2]) {
    let mut asked = settings(size);
    asked.windows[0] = (Channel::Cr, window(100, 180));
    asked.least_run = 4;
    let mut bench = Bench::usual(clocks, asked, 7);
    let mut random = rand::SeedableRng::seed_from_u64(3);
    for _ in 0..2 {
        bench.frame(&picture(&mut random, size), End::Vsync);
    }
    assert_eq!((bench.twin.counts.frames, bench.twin.fault), (2, None));
}

/// 640x480 pixels at 60 frames per second: 784 x 510 pixel periods of two clocks in 1/60 s. On the
/// ULX3S, the engine runs at 40 MHz.
#[test]
fn vga_at_60_frames_a_second() {
    takes(Clocks::URBANA, [640, 480]);
    let slow = Clocks {
        sys: 25_000,
        ..Clocks::URBANA
    };
    takes(slow, [640, 480]);
}

/// The largest frame with every pixel marked: no sum overflows.
#[test]
fn sums_of_the_largest_frame_fit() {
    let size = Settings::MAX_SIZE;
    let mut bench = Bench::usual(Clocks::TWICE, settings(size), 9);
    bench.frame(&Picture::new(size, |_, _| 0xFFFF), End::Vsync);
    let results = bench.twin.results;
    assert_eq!(results.count, 921_600);
    assert_eq!(results.sums, [589_363_200, 331_315_200]);
    assert_eq!(
        results.bounds,
        Region {
            first: [0; 2],
            last: [1279, 719]
        }
    );
    assert!(
        results.products.iter().all(|&product| product < 1 << 39),
        "{:?}",
        results.products
    );
}

/// The small picture of a 640x480 frame is a mask of 160x120 bits, or 40x30 colours. A larger
/// picture is truncated at the end of its memory.
#[test]
fn small_pictures() {
    let size = [640, 480];
    let mut asked = settings(size);
    asked.windows[1] = (Channel::Luma, window(40, 160));
    let mut bench = Bench::usual(Clocks::TWICE, asked, 11);
    let mut random = rand::SeedableRng::seed_from_u64(5);
    for (step, is_colour, words) in [
        (2, false, 1200),
        (4, true, 1200),
        (0, false, 2048),
        (3, true, 2048),
        (5, true, 300),
    ] {
        bench.request_snapshot(step, is_colour);
        bench.frame(&picture(&mut random, size), End::Vsync);
        bench.compare_snapshot();
        // The small picture shows the frame after the request, not the frame in progress.
        bench.frame(&picture(&mut random, size), End::Vsync);
        bench.compare_snapshot();
        assert_eq!(
            bench.twin.snapshot().map(|snapshot| snapshot.words().len()),
            Some(words)
        );
    }
}
