//! Tests of the module `triangle_control`, by which software starts passes of the triangle engine and reads their results. A
//! simple model replaces the engine.

mod bench;
mod passes;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::control::bench::{Bench, Events};
use crate::control::passes::{
    ADDRESS, BASE, BUSY, CANCELLED, FULL, GEOMETRY, LATENCY, LINES, LIST, Limits, MEMORY, MESH,
    NAMES, NO_GEOMETRY, NONE, Pass, RASTER, SIZE, TRIANGLES,
};

/// Places each memory region of a pass at valid and at invalid addresses, and requests this pass alone and both passes. The pass
/// is refused if the region is not entirely in memory, or its address is not a multiple of 16 bytes.
#[test]
fn regions_are_wholly_in_memory() {
    let mut bench = Bench::new(1);
    let mut cases = 0;
    for which in [GEOMETRY, RASTER] {
        for size in 0..3 {
            bench.passes = Pass::good();
            // These switches make the raster pass use all its regions.
            let flags = &mut bench.passes[which].flags;
            flags.size = size;
            flags.choose(&["cull", "first", "second", "depth", "slot", "whole"]);
            for (port, bytes) in bench.regions(which) {
                let right = bench.passes[which].get(port);
                let last = BASE + MEMORY - bytes.next_multiple_of(16);
                for (address, expected) in [
                    (right, NONE),
                    (BASE, NONE),
                    (last, NONE),
                    (right + 1, ADDRESS),
                    (right + 8, ADDRESS),
                    (last - 8, ADDRESS),
                    (last + 16, ADDRESS),
                    (BASE + MEMORY - 16, if bytes <= 16 { NONE } else { ADDRESS }),
                    (BASE - 16, ADDRESS),
                    (BASE + MEMORY, ADDRESS),
                    (right - BASE, ADDRESS),
                    (right + MEMORY, ADDRESS),
                    (right ^ 0x8000_0000, ADDRESS),
                    (0, ADDRESS),
                    (0xffff_fff0, ADDRESS),
                ] {
                    bench.passes[which].set(port, address);
                    for both in [false, true] {
                        let ask = [which == GEOMETRY || both, which == RASTER || both];
                        let error = bench.ask(ask)[which];
                        assert_eq!(
                            error, expected,
                            "{port} {address:#x}, size {size}, both {both}"
                        );
                        cases += 1;
                    }
                }
                bench.passes[which].set(port, right);
            }
        }
    }
    println!("{cases} cases");
}

/// A build for 32 MB of memory and two picture sizes refuses regions beyond this memory, and other sizes.
#[test]
fn a_build_has_less_memory_and_fewer_sizes() {
    const MEMORY: u64 = 32 << 20;
    let mut bench = Bench::of("triangle_control_32_mb", 48, 3);
    bench.limits = Limits {
        memory: MEMORY,
        sizes: 2,
        triangles: true,
        lines: false,
        geometry: true,
    };
    for which in [GEOMETRY, RASTER] {
        bench.passes = Pass::good();
        let flags = &mut bench.passes[which].flags;
        flags.choose(&["cull", "first", "second", "depth", "slot", "whole"]);
        let ask = [which == GEOMETRY, which == RASTER];
        for size in 0..4 {
            bench.passes[which].flags.size = size;
            let regions = bench.regions(which);
            for &(port, _) in &regions {
                bench.passes[which].set(port, BASE);
            }
            let expected = if size < 2 { NONE } else { SIZE };
            assert_eq!(bench.ask(ask)[which], expected, "size {size}");
            for (port, bytes) in regions {
                let last = BASE + MEMORY - bytes.next_multiple_of(16);
                for (address, outside) in [
                    (last, NONE),
                    (last + 16, ADDRESS),
                    (BASE + MEMORY, ADDRESS),
                    (last + MEMORY, ADDRESS),
                ] {
                    bench.passes[which].set(port, address);
                    let expected = if size < 2 { outside } else { SIZE };
                    assert_eq!(bench.ask(ask)[which], expected, "{port} {address:#x}");
                }
                bench.passes[which].set(port, BASE);
            }
        }
    }
}

/// A build without lines refuses every geometry pass of lines; a build with lines starts it like any other pass.
#[test]
fn a_build_without_lines_refuses_them() {
    let mut random = Pcg64Mcg::new(9);
    for (name, lines) in [
        ("triangle_control", false),
        ("triangle_control_lines", true),
    ] {
        let mut bench = Bench::of(name, 48, 5);
        bench.limits.lines = lines;
        let mut errors = [0; 10];
        for _ in 0..1500 {
            bench.passes = [GEOMETRY, RASTER].map(|which| some_pass(&mut random, which));
            let of_lines = random.random();
            bench.passes[GEOMETRY]
                .flags
                .choose(if of_lines { &["lines"] } else { &["cull"] });
            let error = bench.ask([true, false])[GEOMETRY];
            assert_eq!(error == LINES, of_lines && !lines);
            errors[error as usize] += 1;
        }
        println!("{name}: numbers of geometry passes by error: {errors:?}");
        assert!(
            [NONE, SIZE, ADDRESS]
                .map(|error| errors[error as usize])
                .iter()
                .all(|&n| n > 10)
        );
    }
}

/// A build for lines alone refuses geometry passes of meshes, and checks the lists of raster passes; a build without geometry passes
/// refuses them all.
#[test]
fn builds_for_lines_alone_and_without_geometry_refuse_passes() {
    let mut random = Pcg64Mcg::new(10);
    for (name, [triangles, lines, geometry]) in [
        ("triangle_control_lines_alone", [false, true, true]),
        ("triangle_control_no_geometry", [true, false, false]),
    ] {
        let mut bench = Bench::of(name, 48, 6);
        bench.limits = Limits {
            triangles,
            lines,
            geometry,
            ..bench.limits
        };
        let mut errors = [[0; 11]; 2];
        for _ in 0..3000 {
            bench.passes = [GEOMETRY, RASTER].map(|which| some_pass(&mut random, which));
            bench.list_shift = random.random_range(0..20);
            let expected = [GEOMETRY, RASTER].map(|which| bench.refusal(which));
            let found = bench.ask([true, true]);
            assert_eq!(found, expected, "{name}");
            for which in [GEOMETRY, RASTER] {
                errors[which][found[which] as usize] += 1;
            }
        }
        println!("{name}: numbers of passes by error: {errors:?}");
        let refused = if geometry { TRIANGLES } else { NO_GEOMETRY };
        assert!(errors[GEOMETRY][refused as usize] > 10);
        assert_eq!(errors[RASTER][TRIANGLES as usize], 0);
        for error in [NONE, SIZE, ADDRESS] {
            assert!(errors[RASTER][error as usize] > 10, "error {error}");
        }
    }
}

/// A build without triangles refuses every geometry pass and every raster pass with lists. For other raster passes it checks size
/// and regions.
#[test]
fn a_build_without_triangles_refuses_meshes() {
    let mut random = Pcg64Mcg::new(8);
    let mut bench = Bench::of("triangle_control_fields_alone", 48, 4);
    bench.limits.triangles = false;
    let mut errors = [0; 9];
    for _ in 0..3000 {
        bench.passes = [GEOMETRY, RASTER].map(|which| some_pass(&mut random, which));
        bench.list_shift = random.random_range(0..20);
        let starts = bench.counts.map(|counts| counts[1]);
        let [geometry, raster] = bench.ask([true, true]);
        assert_eq!(geometry, TRIANGLES);
        let flags = &bench.passes[RASTER].flags;
        let lists = flags.is_set("first") || flags.is_set("second");
        assert_eq!(raster == TRIANGLES, lists, "{flags:?}");
        let started = u64::from(raster == NONE);
        let expected = [starts[GEOMETRY], starts[RASTER] + started];
        assert_eq!(bench.counts.map(|counts| counts[1]), expected);
        errors[raster as usize] += 1;
    }
    println!("numbers of raster passes by error: {errors:?}");
    for error in [NONE, SIZE, ADDRESS, TRIANGLES] {
        assert!(errors[error as usize] > 10, "error {error}");
    }
}

/// For counts and lengths from minimum to maximum: a region may end at the end of memory, but not one word beyond.
#[test]
fn lengths_are_counted_to_the_last_word() {
    let mut bench = Bench::new(2);
    for (which, count, region, item) in [
        (
            GEOMETRY,
            "geometry.exception_limit",
            "geometry.exceptions",
            4,
        ),
        (GEOMETRY, "geometry.mesh_bytes", "geometry.mesh", 1),
    ] {
        bench.lengths(which, count, region, item);
    }
    for mut bench in [Bench::new(2), Bench::smooth(2)] {
        for (which, count, region) in [
            (
                GEOMETRY,
                "geometry.descriptor_limit",
                "geometry.descriptors",
            ),
            (RASTER, "raster.count[0]", "raster.descriptors[0]"),
            (RASTER, "raster.count[1]", "raster.descriptors[1]"),
        ] {
            bench.lengths(which, count, region, bench.descriptor);
        }
    }

    // Regions that are longer than memory are invalid.
    bench.passes = Pass::good();
    bench.passes[GEOMETRY].set("geometry.mesh", BASE);
    for bytes in [MEMORY + 16, 1 << 28, 1 << 29, 1 << 30, 1 << 31, 0xffff_fff0] {
        bench.passes[GEOMETRY].set("geometry.mesh_bytes", bytes);
        assert_eq!(
            bench.ask([true, false])[GEOMETRY],
            ADDRESS,
            "a mesh of {bytes:#x}"
        );
    }
    // Tests every value of `list_shift`, which sets the length of the lists, with every picture size.
    for size in 0..4 {
        for shift in 0..32 {
            bench.passes = Pass::good();
            bench.list_shift = shift;
            for which in [GEOMETRY, RASTER] {
                bench.passes[which].flags.size = size;
                bench.passes[which].flags.choose(&["first", "second"]);
            }
            for port in ["raster.lists[0]", "raster.lists[1]"] {
                bench.passes[RASTER].set(port, BASE);
            }
            bench.passes[GEOMETRY].set("geometry.lists", BASE);
            let expected = [GEOMETRY, RASTER].map(|which| bench.refusal(which));
            assert_eq!(expected[GEOMETRY], expected[RASTER]);
            assert_eq!(
                bench.ask([true, true]),
                expected,
                "size {size}, shift {shift}"
            );
        }
    }
}

/// The address of a region unused by a pass may have any value.
#[test]
fn unused_regions_are_not_checked() {
    let mut bench = Bench::new(3);
    for used in 0..8 {
        let used: Vec<_> = (0..3)
            .filter(|bit| used >> bit & 1 == 1)
            .map(|bit| ["first", "second", "depth"][bit])
            .collect();
        for (wrong, flag) in [
            ("raster.depth", "depth"),
            ("raster.lists[0]", "first"),
            ("raster.lists[1]", "second"),
            ("raster.descriptors[0]", "first"),
            ("raster.descriptors[1]", "second"),
        ] {
            bench.passes = Pass::good();
            bench.passes[RASTER].flags.choose(&used);
            bench.passes[RASTER].set(wrong, 4);
            let expected = if used.contains(&flag) { ADDRESS } else { NONE };
            assert_eq!(
                bench.ask([false, true])[RASTER],
                expected,
                "{wrong}, flags {used:?}"
            );
        }
    }
}

/// A single pass starts at most `LATENCY` clocks after its request, and ends with the engine's result.
#[test]
fn passes_end_as_the_engine_says() {
    let mut bench = Bench::new(4);
    for [geometry, raster] in [
        [NONE, NONE],
        [MESH, LIST],
        [FULL, LIST],
        [NONE, LIST],
        [FULL, NONE],
    ] {
        bench.ends = [geometry, raster];
        for ask in [[true, false], [false, true], [true, true]] {
            let starts = bench.counts.map(|counts| counts[1]);
            let errors = bench.ask(ask);
            for which in [GEOMETRY, RASTER] {
                assert_eq!(
                    bench.counts[which][1] - starts[which],
                    u64::from(ask[which])
                );
                assert!(!ask[which] || errors[which] == bench.ends[which]);
            }
        }
    }
    for which in [GEOMETRY, RASTER] {
        bench.clock(Events::ask([which == GEOMETRY, which == RASTER]));
        let start = bench.clocks;
        while bench.value(which, "start") == 0 {
            bench.clock(Events::default());
        }
        println!("{}: {} clocks", NAMES[which], bench.clocks - start);
        assert!(bench.clocks - start <= LATENCY);
        bench.finish();
    }
}

/// A pass waits until its parameters are loaded, and ends immediately if it is cancelled while waiting.
#[test]
fn passes_wait_for_their_parameters() {
    let mut bench = Bench::new(9);
    for loads in [[1, 0], [0, 1], [2, 40], [40, 2], [40, 40]] {
        bench.loads = loads;
        for ask in [[true, false], [false, true], [true, true]] {
            assert_eq!(bench.ask(ask), [NONE; 2], "{loads:?}");
            for after in 0..60 {
                bench.configure();
                bench.clock(Events::ask(ask));
                bench.wait(after);
                bench.clock(Events::cancel(3));
                assert_eq!(bench.ask([true, true]), [NONE; 2], "{loads:?}, {after}");
            }
        }
    }
}

/// Requests a pass again while its parameters are checked, or while it starts, runs or ends: the second request is refused, and
/// the pass continues and ends once.
#[test]
fn asks_in_between_are_refused() {
    let mut bench = Bench::new(5);
    bench.runs = [12, 14];
    for which in [GEOMETRY, RASTER] {
        let mine = [which == GEOMETRY, which == RASTER];
        for end in [NONE, [MESH, LIST][which]] {
            for wrong in [false, true] {
                for after in 0..40 {
                    bench.passes = Pass::good();
                    bench.ends = [end; 2];
                    if wrong {
                        bench.passes[which].set(["geometry.mesh", "raster.frame"][which], 0);
                    }
                    bench.configure();
                    let ask = Events::ask(mine);
                    bench.clock(ask);
                    bench.wait(after);
                    let was_active = bench.is_active(which);
                    // The flags of a refused request are ignored.
                    let flags = bench.passes[which].flags.clone();
                    let mut others = flags.clone();
                    others.invert();
                    bench.set_flags(which, if was_active { &others } else { &flags });
                    bench.clock(ask);
                    bench.set_flags(which, &flags);
                    bench.finish();
                    let own = if wrong { ADDRESS } else { end };
                    let expected = if was_active && own == NONE { BUSY } else { own };
                    assert_eq!(
                        bench.errors[which], expected,
                        "{} after {after}",
                        NAMES[which]
                    );
                }
            }
        }
    }
}

/// Cancels one or both passes at any time, and requests both again, before and after the engine is ready again.
#[test]
fn asks_after_a_cancel_wait_for_the_engine() {
    let mut bench = Bench::new(6);
    bench.runs = [12, 14];
    bench.configure();
    for asks in [[true, false], [false, true], [true, true]] {
        for after in 0..45 {
            for recovers in [0, 1, 2, 40] {
                for again in [0, 1, 20, 60] {
                    bench.clock(Events::ask(asks));
                    bench.wait(after);
                    let active = [GEOMETRY, RASTER].map(|which| bench.is_active(which));
                    bench.clock(Events::cancel(recovers));
                    for which in [GEOMETRY, RASTER] {
                        assert!(!active[which] || bench.errors[which] == CANCELLED);
                    }
                    bench.wait(again);
                    let starts = bench.counts.map(|counts| counts[1]);
                    assert_eq!(bench.ask([true, true]), [NONE; 2]);
                    assert_eq!(
                        bench.counts.map(|counts| counts[1]),
                        starts.map(|count| count + 1)
                    );
                }
            }
        }
    }
}

/// Requests and cancels passes at random in every clock.
#[test]
fn random_sequences() {
    let mut random = Pcg64Mcg::new(7);
    for seed in 0..10 {
        let mut bench = Bench::new(seed);
        bench.configure();
        for _ in 0..20_000 {
            let mut events = Events::default();
            let rate = [0.01, 0.05, 0.3][seed as usize % 3];
            for which in [GEOMETRY, RASTER] {
                events.ask[which] = random.random_bool(rate);
                if events.ask[which] && !bench.is_active(which) {
                    bench.passes[which] = some_pass(&mut random, which);
                    bench.runs[which] = random.random_range(1..40);
                    bench.ends[which] = if random.random() {
                        NONE
                    } else {
                        [[MESH, FULL], [LIST, LIST]][which][random.random_range(0..2)]
                    };
                }
            }
            if !bench.is_active(GEOMETRY) && !bench.is_active(RASTER) {
                bench.list_shift = random.random_range(0..20);
            }
            bench.configure();
            events.cancel = random.random_bool(rate / 4.0);
            events.recovers = random.random_range(0..60);
            bench.clock(events);
        }
        bench.finish();
        println!("requests, starts and ends: {:?}", bench.counts);
        assert!(bench.counts.iter().flatten().all(|&count| count > 20));
    }
}

/// Makes random parameters of a pass, valid or with an error.
fn some_pass(random: &mut Pcg64Mcg, which: usize) -> Pass {
    let mut pass = Pass::good()[which].clone();
    pass.flags.size = random.random_range(0..4);
    for (name, set) in &mut pass.flags.others {
        *set = random.random_bool(if *name == "lines" { 0.1 } else { 0.5 });
    }
    if pass.flags.size == 3 && random.random_bool(0.9) {
        pass.flags.size = 2;
    }
    if random.random_bool(0.5) {
        let (name, value) = pass.ports[random.random_range(0..pass.ports.len())];
        let value = match random.random_range(0..4) {
            0 => value ^ 8,
            1 => value ^ (1 << random.random_range(4..20)),
            2 => value & 0xf_fff0,
            _ => value,
        };
        let small = name.contains("count") || name.ends_with("limit");
        pass.set(name, if small { value & 0xf_ffff } else { value });
    }
    pass
}
