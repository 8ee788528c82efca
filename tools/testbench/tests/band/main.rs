//! Tests of the band buffer: the pixels must equal the pixels of a software depth test, and each flush must write the band's changed words
//! in order.

mod bench;
mod pixels;
mod sky;

use glint_core::colour::Rounding;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::bench::Bench;
use crate::pixels::{Band, Group, Kind, LANES, PICTURE_LINES};

/// Makes a random group in one of `rows` rows, mostly with one of a few depth codes, for frequent overlaps and ties.
fn random_group(random: &mut Pcg64Mcg, rows: usize) -> Group {
    Group {
        kind: Kind::Plain,
        row: random.random_range(0..rows),
        mask: if random.random_ratio(1, 10) {
            0
        } else {
            random.random()
        },
        halves: 3,
        codes: std::array::from_fn(|_| match random.random_range(0..4) {
            0 => 1,
            1 => (1 << 18) - 1,
            2 => random.random_range(1..=3),
            _ => random.random_range(1..1 << 18),
        }),
        colours: random.random(),
    }
}

/// Makes a random band at one of three positions of the picture: most bands repeat a position.
fn random_band(random: &mut Pcg64Mcg, [lines, stride]: [usize; 2]) -> Band {
    Band {
        base: random.random_range(0..1 << 22),
        depth_base: random.random_range(0..1 << 22),
        lines,
        stride,
        first_line: [0, 2, PICTURE_LINES - lines][random.random_range(0..3)],
        slot: random.random_range(0..2),
        whole: random.random_ratio(1, 8),
        with_depth: random.random_ratio(1, 4),
        clear: random.random(),
        sky: false,
        rounding: Rounding::new(random.random()),
        compose: 0,
    }
}

/// Makes a group with all eight pixels drawn.
fn full_group(row: usize, code: u32) -> Group {
    Group {
        kind: Kind::Plain,
        row,
        mask: 0xff,
        halves: 3,
        codes: [code; LANES],
        colours: std::array::from_fn(|lane| (row * LANES + lane) as u16),
    }
}

/// Makes a band whose flush writes all of its words.
fn plain_band([lines, stride]: [usize; 2]) -> Band {
    Band {
        base: 0x12_3456,
        depth_base: 0x65_4321,
        lines,
        stride,
        first_line: 0,
        slot: 0,
        whole: true,
        with_depth: false,
        clear: 0xa55a,
        sky: false,
        rounding: Rounding::Dithered,
        compose: 0,
    }
}

#[test]
fn random_groups_in_many_bands_with_stalls() {
    let shares = [(0.0, 0.0), (0.3, 0.3), (0.0, 0.9), (0.8, 0.1)];
    for (seed, (group_stalls, memory_stalls)) in (1..).zip(shares) {
        println!("seed {seed}, stalls {group_stalls} and {memory_stalls}");
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::ready(seed, group_stalls, memory_stalls);
        // All groups are for both eyes (`halves` is 3), so groups of the next band may immediately follow the end of a band. A
        // group taken just before the end of a band belongs to this band.
        let shape @ [lines, stride] = [random.random_range(1..20), random.random_range(1..6)];
        bench.stride = stride;
        for _ in 0..60 {
            // Few groups in most bands: some lines are empty, and the drawn columns differ from line to line.
            let most = [4, 20, 200][random.random_range(0..3)];
            let groups: Vec<_> = (0..random.random_range(0..most))
                .map(|_| random_group(&mut random, lines * stride))
                .collect();
            let band = random_band(&mut random, shape);
            bench.draw(groups, band);
        }
        bench.finish();
    }
}

/// A band with a sky takes a colour for each of its words; other bands, before and after it, have the clear colour.
#[test]
fn random_bands_with_a_sky_and_stalls() {
    for (seed, [group_stalls, memory_stalls]) in (51..).zip([[0.0, 0.0], [0.4, 0.2], [0.1, 0.8]]) {
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::of("band_buffer_sky", seed, group_stalls, memory_stalls);
        let shape @ [lines, stride] = [random.random_range(1..20), random.random_range(2..6)];
        bench.stride = stride;
        for number in 0..60 {
            let groups: Vec<_> = (0..random.random_range(0..40))
                .map(|_| random_group(&mut random, lines * stride))
                .collect();
            let sky = random.random();
            let band = random_band(&mut random, shape);
            bench.draw(groups, Band { sky, ..band });
            if number == 30 {
                bench.restart_with_dead_memory();
            }
        }
        bench.finish();
    }
}

/// Queries and groups of blended pixels, in a random order with plain groups. The counters do not count blended groups.
#[test]
fn random_blended_pixels_with_stalls() {
    for (seed, stalls) in [(31, 0.0), (32, 0.3), (33, 0.8)] {
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::of("band_buffer_blend", seed, stalls, 0.2);
        let shape @ [lines, stride] = [random.random_range(1..8), random.random_range(1..4)];
        bench.stride = stride;
        let mut counted = 0;
        for _ in 0..60 {
            let groups: Vec<_> = (0..random.random_range(0..150))
                .map(|_| Group {
                    kind: [Kind::Plain, Kind::Asks, Kind::Blended][random.random_range(0..3)],
                    ..random_group(&mut random, lines * stride)
                })
                .collect();
            let is_counted = |group: &&Group| group.kind != Kind::Blended;
            counted += groups.iter().filter(is_counted).count() as u64;
            let band = random_band(&mut random, shape);
            bench.draw(groups, band);
        }
        bench.finish();
        assert_eq!(bench.counter("groups"), counted);
        assert_eq!(bench.counter("pixels_drawn"), bench.passed);
        assert!(bench.answered.len() > 500);
    }
}

/// The colour behind a pixel is the stored colour, or the clear colour if the pixel has not been written.
#[test]
fn colours_behind_blended_pixels() {
    let mut random = Pcg64Mcg::new(34);
    let mut bench = Bench::of("band_buffer_blend", 34, 0.0, 0.0);
    bench.stride = 5;
    for _ in 0..3 {
        for _ in 0..40 {
            bench.push_group(random_group(&mut random, 20));
        }
        bench.run_until(1000, |bench| bench.groups.is_empty());
        (0..8).for_each(|_| bench.clock());
        let clear: u16 = random.random();
        for row in 0..20 {
            for lane in 0..LANES {
                let module = &mut bench.module;
                module.drive("band_clear", clear);
                module.drive("group_row", row as u32);
                module.drive("behind_lane", lane as u32);
                (0..6).for_each(|_| module.clock());
                module.settle();
                let expected = bench.drawn.0[row][lane].map_or(clear, |(_, colour)| colour);
                assert_eq!(bench.module.read("behind"), u64::from(expected));
            }
        }
        bench.push_band(plain_band([4, 5]));
        bench.finish();
    }
}

#[test]
fn an_answer_takes_five_clocks() {
    let mut bench = Bench::of("band_buffer_blend", 35, 0.0, 0.0);
    bench.push_group(Group {
        kind: Kind::Asks,
        ..full_group(3, 1)
    });
    bench.run_until(100, |bench| bench.groups.is_empty());
    let clocks = bench.run_until(100, |bench| !bench.answered.is_empty());
    assert_eq!(clocks, 5);
}

/// Draws bands in random sequence. A band that composes two eyes has groups for one eye each, in any order; any other band has groups for
/// both eyes.
#[test]
fn luminances_of_two_eyes_are_composed() {
    for (seed, stalls) in [(1, 0.0), (2, 0.4)] {
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::of("band_buffer_stereo", seed, stalls, stalls);
        let shape @ [lines, stride] = [7, 3];
        bench.stride = stride;
        for _ in 0..40 {
            let mut band = random_band(&mut random, shape);
            band.compose = random.random_range(0..3);
            let mut groups: Vec<_> = (0..random.random_range(0..100))
                .map(|_| random_group(&mut random, lines * stride))
                .collect();
            if band.compose != 0 {
                // Replaces each group by a group for the left eye and a group for the right eye.
                groups = groups
                    .into_iter()
                    .flat_map(|group| {
                        [1, 2].map(|halves| Group {
                            halves,
                            ..group.clone()
                        })
                    })
                    .collect();
                let order = |random: &mut Pcg64Mcg| random.random::<u32>();
                groups.sort_by_cached_key(|_| order(&mut random));
            }
            bench.draw(groups, band);
            // Waits for the end of the band, because groups for one eye and for both eyes must not be in flight together.
            bench.run_until(100_000, |bench| bench.bands.is_empty());
        }
        bench.finish();
    }
}

#[test]
fn whole_bands_leave_nothing_to_the_next() {
    let mut bench = Bench::ready(5, 0.0, 0.1);
    for shape @ [lines, stride] in [[12, 160], [24, 80], [45, 40], [45, 40]] {
        bench.stride = stride;
        let groups = (0..lines * stride).map(|row| full_group(row, 9));
        bench.draw(groups, plain_band(shape));
    }
    bench.stride = 160;
    // Flushes bands without groups: the written words show whether each bank was cleared after its last band.
    for clear in [1, 2, 3] {
        let band = Band {
            clear,
            with_depth: clear == 2,
            ..plain_band([12, 160])
        };
        bench.draw([], band);
    }
    bench.finish();
}

/// Draws groups at all four corners of the largest bands, at the top and at the bottom of the picture. In each line, a flush must
/// write only the words from the first to the last group drawn for this flush or the line's previous flush.
#[test]
fn only_pixels_drawn_now_or_last_are_flushed() {
    let mut bench = Bench::ready(11, 0.0, 0.1);
    for shape @ [lines, stride] in [[45, 40], [24, 80], [12, 160]] {
        bench.stride = stride;
        let places = [0, PICTURE_LINES - lines];
        let bands = places.map(|first_line| {
            [0, 1].map(|slot| Band {
                first_line,
                slot,
                ..plain_band(shape)
            })
        });
        for band in bands.iter().flatten() {
            bench.draw([], *band);
        }
        let last = lines * stride - 1;
        // For each case, the addresses of two pixel groups in the band buffer, which has `stride` groups per line. Most groups are
        // at the ends of the band's first and last line. Frame buffer 0 gets both groups, frame buffer 1 only the first group.
        for rows in [
            [0, last],
            [stride - 1, last + 1 - stride],
            [1, 1],
            [0, last],
        ] {
            for band in bands.iter().flatten() {
                let groups = rows.map(|row| full_group(row, 9));
                bench.draw(
                    groups.into_iter().take(2 - band.slot),
                    Band {
                        whole: false,
                        ..*band
                    },
                );
            }
        }
        for band in bands.iter().flatten() {
            bench.draw(
                [],
                Band {
                    whole: false,
                    ..*band
                },
            );
        }
        bench.finish();
    }
}

#[test]
fn a_bank_after_reset_is_clear() {
    let mut bench = Bench::new("band_buffer", 6, 0.0, 0.0);
    assert!(bench.is(bench.clearing));
    for _ in 0..2 {
        bench.push_band(plain_band([48, 40]));
    }
    bench.finish();
    assert_eq!(bench.counter("groups"), 0);
}

#[test]
fn one_group_a_clock_where_rows_or_lanes_differ() {
    const COUNT: usize = 1920;
    let mut bench = Bench::ready(7, 0.0, 0.0);
    let rows = (0..COUNT).map(|i| full_group(i, 1));
    // Pairs of groups like those of two adjacent triangles: in the same row, with different lanes
    // (pixels of the row).
    let lanes = (0..COUNT).map(|i| Group {
        mask: 0x0f << (i % 2 * 4),
        ..full_group(i / 2, 2)
    });
    let start = bench.module.cycles();
    bench.draw(rows.chain(lanes), plain_band([COUNT / 40, 40]));
    let clocks = bench.module.cycles() - start;
    assert!(clocks <= 2 * COUNT as u64 + 2, "{clocks} clocks");
    bench.finish();
    assert_eq!(bench.counter("cycles_held"), 0);
    assert_eq!(bench.counter("groups"), 2 * COUNT as u64);
}

#[test]
fn a_group_waits_for_the_lanes_it_shares() {
    // Each case: the number of groups between two groups of the same row, and the number of clocks
    // for which the second group is delayed.
    for (between, held) in [(0, 3), (1, 2), (2, 1), (3, 0)] {
        let mut bench = Bench::ready(8, 0.0, 0.0);
        let others = (0..between).map(|i| full_group(100 + i, 5));
        let groups = [full_group(7, 3)].into_iter().chain(others).chain([Group {
            kind: Kind::Plain,
            halves: 3,
            mask: 0x81,
            codes: [3, 9, 9, 9, 9, 9, 9, 2],
            colours: [0xffff; LANES],
            row: 7,
        }]);
        bench.draw(groups, plain_band([5, 40]));
        bench.finish();
        assert_eq!(bench.counter("cycles_held"), held, "{between} between");
    }
}

#[test]
fn the_flush_keeps_up_with_memory_and_overlaps_with_drawing() {
    let mut bench = Bench::ready(9, 0.0, 0.0);
    for (with_depth, words) in [(false, 1920), (true, 3 * 1920)] {
        let band = Band {
            with_depth,
            ..plain_band([48, 40])
        };
        bench.draw([], band);
        let start = bench.module.cycles();
        bench.finish();
        let clocks = bench.module.cycles() - start;
        assert!(clocks <= words + 16, "{clocks} clocks for {words} words");
    }
    // Draws six bands, each with as many groups as words to flush: drawing overlaps with the flush of the previous band.
    let start = bench.module.cycles();
    for _ in 0..6 {
        let band = Band {
            whole: false,
            ..plain_band([48, 40])
        };
        bench.draw((0..1920).map(|row| full_group(row, 1)), band);
    }
    bench.finish();
    let clocks = bench.module.cycles() - start;
    assert!(clocks <= 7 * (1920 + 24), "{clocks} clocks");
    let (memory, flush) = (
        bench.counter("cycles_memory"),
        bench.counter("cycles_flush"),
    );
    assert!(memory == 0 && flush < 6 * 24, "{memory} and {flush} clocks");
}

/// Flushing loses no clock between lines, and an empty line takes one clock.
#[test]
fn a_line_takes_a_clock_for_each_word_and_one_at_least() {
    let mut bench = Bench::ready(12, 0.0, 0.0);
    let band = Band {
        whole: false,
        ..plain_band([45, 40])
    };
    bench.draw([], band);
    bench.finish();
    // Each case: the number of drawn words in every n-th line, n, and the number of clocks of the
    // flush, without its start and end, if the previous frame drew the same words.
    for (words, every, clocks) in [(1, 1, 45), (2, 1, 90), (5, 3, 75), (1, 3, 45), (1, 45, 45)] {
        for same in [false, true] {
            let rows = (0..45)
                .step_by(every)
                .flat_map(|line| 40 * line + 7..40 * line + 7 + words);
            bench.draw(rows.map(|row| full_group(row, 1)), band);
            bench.run_until(100, |bench| bench.bands.is_empty());
            let start = bench.module.cycles();
            bench.finish();
            let found = bench.module.cycles() - start;
            assert!(
                !same || found <= clocks + 14,
                "{found} clocks for {words} words in one of {every} lines"
            );
        }
    }
}

#[test]
fn waits_for_memory_are_counted() {
    let mut bench = Bench::ready(10, 0.0, 0.75);
    for _ in 0..2 {
        bench.draw([], plain_band([25, 40]));
    }
    bench.finish();
    assert!(bench.counter("cycles_memory") > 1000);
    assert!(bench.counter("cycles_flush") > 1000);
}

#[test]
fn a_restart_ends_whatever_goes_on() {
    for seed in 20..60_u64 {
        println!("seed {seed}");
        let mut random = Pcg64Mcg::new(u128::from(seed));
        let mut bench = Bench::ready(seed, 0.2, 0.3);
        // The restart happens while a band is flushed and the next band is drawn. With few rows,
        // the clearing after the restart soon reaches the rows that were drawn last.
        let lines = random.random_range(if seed % 2 == 0 { 1..4 } else { 10..40 });
        let stride = random.random_range(1..10);
        let (shape, rows) = ([lines, stride], lines * stride);
        bench.stride = stride;
        // These lines are outside the interrupted band, so the module still knows their drawn ranges.
        bench.draw(
            (0..rows / 2).map(|row| full_group(row, 9)),
            Band {
                first_line: 300,
                ..plain_band(shape)
            },
        );
        bench.draw(
            (0..rows).map(|row| full_group(row, 9)),
            random_band(&mut random, shape),
        );
        bench.run_until(100_000, |bench| bench.bands.is_empty());
        for _ in 0..500 {
            bench.push_group(random_group(&mut random, rows));
        }
        for _ in 0..random.random_range(0..400) {
            bench.clock();
        }
        // In half of the rounds, the end of a band is pending at the restart.
        if random.random() {
            bench.push_band(random_band(&mut random, shape));
            bench.clock();
        }

        bench.restart_with_dead_memory();

        for _ in 0..4 {
            let groups: Vec<_> = (0..100).map(|_| random_group(&mut random, rows)).collect();
            let band = random_band(&mut random, shape);
            bench.draw(groups, band);
        }
        let elsewhere = Band {
            first_line: 300,
            whole: false,
            ..plain_band(shape)
        };
        bench.draw([full_group(0, 1)], elsewhere);
        bench.finish();
    }
}
