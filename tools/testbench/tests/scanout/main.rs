//! Tests of scan-out with two clocks, memories of various timings and a monitor; the test bench checks every cycle and every pixel.
//!
//! The module `scanout` has the video timing of the SoC, CEA-861 1280×720. The module `scanout_small` has frames of a few thousand clocks,
//! for thousands of frames in a test; in the active part of a line, a memory word lasts as many pixel clocks as in `scanout`.

mod bench;
mod memory;
mod monitor;
mod raster;
mod settings;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use bench::Bench;
use memory::Timing;
use raster::{Clocks, Raster};
use settings::{Settings, error};

const SMALL: Raster = Raster::SMALL;

/// Changes the settings at random times, several times per frame, as software may do.
fn restless(random: &mut Pcg64Mcg, asked: &mut Settings) {
    if random.random_range(0..1500) == 0 {
        *asked = Settings::random(random);
    }
}

fn all_scales_are_pixel_exact(clocks: Clocks) {
    let mut bench = Bench::new("scanout", Raster::CEA, clocks, 1);
    bench.memory.timing = Timing::BUSY;
    for scale in [4, 2, 1] {
        bench.asked = Settings::shown(scale, 0x12_3456 * scale);
        // The module latches the settings at the vertical blanking.
        bench.run_to_vblank();
    }
    bench.run_to_vblank();
    assert_eq!((bench.monitor.late, bench.monitor.frames), (0, 3));
    // The source lines and the memory words of three frames, each read once.
    assert_eq!(bench.lines, 180 + 360 + 720);
    assert_eq!(bench.words, 180 * 40 + 360 * 80 + 720 * 160);
}

#[test]
fn all_scales_are_pixel_exact_at_81_25_mhz() {
    all_scales_are_pixel_exact(Clocks::SLOW);
}

#[test]
fn all_scales_are_pixel_exact_at_100_mhz() {
    all_scales_are_pixel_exact(Clocks::FAST);
}

#[test]
fn flips_and_switches_at_any_time_with_seven_clock_ratios() {
    let ratios = [
        (7425, 7425),
        (7426, 7425),
        (20_000, 7425),
        (7425, 11_000),
        (15_000, 7425),
    ];
    let ratios = ratios.into_iter().map(|(sys, pix)| Clocks { sys, pix });
    let ratios = [Clocks::SLOW, Clocks::FAST].into_iter().chain(ratios);
    for (seed, clocks) in (100..).zip(ratios) {
        let mut bench = Bench::small(clocks, seed);
        bench.memory.timing = Timing::SHARED;
        bench.software = Some(restless);
        bench.run_frames(60);
        assert_eq!(bench.monitor.late, 0, "{clocks:?}");
    }
}

#[test]
fn lines_above_and_below_the_picture_are_black() {
    let mut bench = Bench::new("scanout_border", Raster::BORDER, Clocks::SLOW, 150);
    bench.memory.timing = Timing::SHARED;
    bench.software = Some(restless);
    bench.run_frames(60);
    assert_eq!(bench.monitor.late, 0);
}

#[test]
fn a_late_line_is_replaced_by_the_one_before() {
    for scale in [1, 2, 4] {
        let mut bench = Bench::small(Clocks::SLOW, 200 + scale);
        bench.asked = Settings::shown(scale, 0x100);
        bench.run_frames(2);
        bench.monitor.may_be_late = true;
        // Pauses memory in the middle of the picture, for twice the time of a source line.
        bench.run_lines(SMALL.lines_to_picture());
        bench.memory.stopped = true;
        bench.run_lines(2 * scale);
        bench.memory.stopped = false;
        bench.run_to_vblank();
        let late = bench.monitor.late;
        assert!((1..=3).contains(&late), "scale {scale}: {late} late lines");
        // At scale 4, a source line has four output lines; a late source line still appears in the last of them.
        assert!(scale < 4 || bench.monitor.late_again >= 1);
        assert_eq!(bench.module.read("error"), error::UNDERFLOW);
        bench.monitor.may_be_late = false;
        bench.run_frames(2);
        assert_eq!(bench.module.read("error"), error::NONE);
    }
}

#[test]
fn starved_memory_never_disturbs_the_raster() {
    let (mut late, mut again) = (0, 0);
    for seed in 300..312_u64 {
        let clocks = [Clocks::FAST, Clocks::SLOW][seed as usize & 1];
        let mut bench = Bench::small(clocks, seed);
        bench.monitor.may_be_late = true;
        // Memory pauses at random, for a few lines up to whole frames.
        bench.memory.timing = Timing {
            ready: 0.6,
            deliver: 0.6,
            latency: [2, 150],
            pause: 0.0005,
            pause_cycles: if seed.is_multiple_of(3) { 20_000 } else { 1500 },
        };
        bench.software = Some(restless);
        bench.run_frames(60);
        late += bench.monitor.late;
        again += bench.monitor.late_again;
    }
    assert!(
        late > 500 && again > 20,
        "{late} late lines, {again} of them shown late"
    );
}

#[test]
fn dead_memory_shows_black_and_comes_back() {
    let mut bench = Bench::small(Clocks::SLOW, 400);
    bench.memory.stopped = true;
    bench.asked = Settings::shown(2, 0x4000);
    bench.run_to_vblank();
    bench.monitor.may_be_late = true;
    bench.run_frames(3);
    assert_eq!(bench.monitor.late, 3 * SMALL.v_active / 2);
    // The first delivered words were requested three frames ago, for another base address.
    bench.asked.base = 0x8000;
    bench.run_to_vblank();
    bench.memory.stopped = false;
    bench.monitor.may_be_late = false;
    let late = bench.monitor.late;
    bench.run_frames(2);
    assert_eq!(bench.monitor.late, late, "memory resumed in the blanking");
}

#[test]
fn unknown_scales_are_refused() {
    let mut bench = Bench::small(Clocks::SLOW, 500);
    bench.asked = Settings::shown(2, 0x77);
    bench.run_frames(2);
    for scale in [0, 3, 5, 6, 7] {
        bench.asked.scale = scale;
        bench.run_frames(2);
        let found = ["error", "scale_current"].map(|name| bench.module.read(name));
        assert_eq!(found, [error::SCALE, 2], "scale {scale}");
    }
}

#[test]
fn either_side_may_be_reset_alone() {
    let clocks = Clocks::FAST;
    let mut bench = Bench::small(clocks, 600);
    bench.memory.timing = Timing::SHARED;
    let frame = clocks.sys_cycles(SMALL.frame());
    for round in 0..200 {
        bench.asked = Settings::shown(1 << (round % 3), 0x1000 * round);
        bench.run_frames(2);
        let cycles = bench.random.random_range(0..frame);
        bench.run_cycles(cycles);
        // While only the `sys_clk` domain is reset, the video timing continues and the monitor keeps its position.
        if round % 2 == 0 {
            bench.reset_sys(true);
        }
        if round % 4 != 0 {
            bench.reset_pix(true);
        }
        let cycles = bench.random.random_range(8..3008);
        bench.run_cycles(cycles);
        bench.reset_sys(false);
        bench.reset_pix(false);
        // The reset must reach both clock domains before the first access. 20 cycles suffice; a processor takes longer.
        bench.run_cycles(20);
    }
    bench.asked.enable = true;
    bench.run_frames(3);
    assert_eq!(bench.monitor.late, 0);
}

#[test]
fn a_fetch_may_outlive_its_request() {
    let mut bench = Bench::small(Clocks::SLOW, 700);
    bench.asked = Settings::shown(1, 0x300);
    bench.run_frames(2);
    bench.run_lines(SMALL.lines_to_picture());
    bench.memory.stopped = true;
    while !bench.is_fetching() {
        bench.run_cycles(1);
    }
    bench.reset_pix(true);
    bench.run_cycles(20);
    bench.reset_pix(false);
    bench.run_to_vblank();
    // Line 0 of the next frame is requested during the fetch of a line requested before the reset.
    bench.run_lines(2);
    bench.memory.stopped = false;
    bench.run_frames(2);
    assert_eq!(bench.monitor.late, 0);
}
