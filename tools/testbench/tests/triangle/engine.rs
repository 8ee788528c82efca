//! Compares the triangle engine's frames from a mesh in memory with glint-model's: pixels and depths are equal. The model clips
//! triangles for the engine, like the firmware on the board.

mod bench;
mod expected;
mod fields;
mod fog;
mod gathered;
mod light;
mod lines;
mod objects;
mod package;
mod rectangles;
mod samples;
mod textured;

use bench::Bench;
use expected::{CLEAR, SIZES, expected, expected_on, expected_smooth};
use glint_core::camera::{Projection, View};
use glint_core::colour::Rounding;
use glint_core::fixed::{Q32_32, Turns};
use glint_mesh::{convert, generate};
use glint_vectors::meshes::{self, ahead, at};
use glint_vectors::scenes::{inside, scenes};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Returns the mesh of the generated model `name`, as bytes.
fn generated(name: &str) -> Vec<u8> {
    converted(name, convert::Options::default())
}

/// Returns the mesh of the generated model `name`, converted with options, as bytes.
fn converted(name: &str, options: convert::Options) -> Vec<u8> {
    let model = generate::named(name).expect("a model");
    let converted = convert::convert(&model, options);
    converted.expect("a mesh").0
}

/// Draws every scene at one size, in a random frame buffer. At the smallest size, each scene is
/// drawn with depths and without. Larger sizes draw alternate scenes with and without depths,
/// because writing depths triples the time, and skip large meshes, because the geometry pass does
/// not depend on the size.
fn all_scenes(size: (u32, u32)) {
    let mut bench = Bench::new(size.0, 0.0);
    let mut random = Pcg64Mcg::new(size.0.into());
    for (number, (name, mesh, view, cull)) in scenes(generated).into_iter().enumerate() {
        if size != SIZES[0] && mesh.len() > 1 << 20 {
            continue;
        }
        let expected = expected(&mesh, &view, size, cull);
        for with_depth in [true, false] {
            if size != SIZES[0] && with_depth == (number % 2 == 0) {
                continue;
            }
            bench.slot = random.random_range(0..2);
            bench.with_depth = with_depth;
            let clocks = bench.draw(name, &mesh, &expected);
            println!(
                "{name}: {} clocks for the geometry, {} for the raster, {} clipped, {} pixels",
                clocks.geometry,
                clocks.raster,
                expected.stats.clipped,
                expected.stats.pixels_covered
            );
        }
    }
}

#[test]
fn scenes_at_320x180() {
    all_scenes(SIZES[0]);
}

#[test]
fn scenes_at_640x360() {
    all_scenes(SIZES[1]);
}

#[test]
fn scenes_at_1280x720() {
    all_scenes(SIZES[2]);
}

/// Draws frames alternately in orthographic and perspective projection, with memory stalls.
#[test]
fn scenes_in_orthographic_projection() {
    let (mut pixels, mut clipped) = (0, 0);
    let mut bench = Bench::new(30, 0.4);
    for (name, mesh, view, cull) in scenes(generated) {
        // Skips large meshes, which take long and add no coverage.
        if mesh.len() > 1 << 20 {
            continue;
        }
        for projection in Projection::ALL {
            let view = view.with_projection(projection);
            let frame = expected(&mesh, &view, SIZES[0], cull);
            bench.with_depth = projection == Projection::Orthographic;
            bench.slot ^= 1;
            bench.draw(&format!("{name}, {projection}"), &mesh, &frame);
            if bench.with_depth {
                pixels += frame.stats.pixels_covered;
                clipped += frame.stats.clipped;
            }
        }
    }
    println!("{clipped} clipped, {pixels} pixels in orthographic projection");
    assert!(clipped > 20 && pixels > 100_000);
}

/// Draws random lists of triangles with random memory stalls, which must not change a frame. The
/// environment variable `GLINT_RTL_LISTS` sets the number of frames, 25 by default.
#[test]
fn random_lists_with_random_stalls() {
    let lists = std::env::var("GLINT_RTL_LISTS").map_or(25, |text| text.parse().unwrap());
    for seed in 0..lists {
        let mut random = Pcg64Mcg::new(u128::from(seed) * 2 + 1);
        let stalls = [0.0, 0.2, 0.5, 0.7][seed as usize % 4];
        let smooth = seed % 3 == 0;
        let mut bench = if smooth {
            Bench::of("smooth", seed, stalls)
        } else {
            Bench::new(seed, stalls)
        };
        // Only some frames write depths, which triples the time.
        bench.with_depth = seed % 5 == 0;
        let count = random.random_range(1..200);
        let size = [0.01, 0.1, 0.5, 2.0][random.random_range(0..4)];
        let mesh = meshes::mesh(&meshes::random(&mut random, count, size), 65_535);
        let r = Q32_32::from_bits(random.random_range(2_i64 << 32..=5 << 32));
        let (theta, phi) = (
            Turns(random.random()),
            Turns(random.random_range(0..=1 << 31)),
        );
        let view = if random.random_bool(0.3) {
            inside()
        } else {
            View::spherical(r, theta, phi).unwrap()
        };
        let (cull, rounding) = (random.random(), Rounding::new(seed % 3 != 0));
        let expected = if smooth {
            expected_smooth(rounding, &mesh, &view, SIZES[0], cull)
        } else {
            expected(&mesh, &view, SIZES[0], cull)
        };
        bench.draw(&format!("list {seed}"), &mesh, &expected);
    }
}

/// After a frame, the frame buffer holds exactly this frame, although the engine writes only words that can differ from the
/// previous content.
#[test]
fn frames_after_each_other() {
    for seed in 0..4_u32 {
        let mut random = Pcg64Mcg::new(u128::from(seed) + 77);
        let stalls = [0.0, 0.4][seed as usize % 2];
        let mut bench = Bench::new(seed, stalls);
        let (mut size, mut clear) = (SIZES[0], CLEAR);
        for frame in 0..30 {
            let name = format!("seed {seed}, frame {frame}");
            bench.slot = random.random_range(0..2);
            bench.with_depth = random.random_ratio(1, 10);
            match random.random_range(0..20) {
                // Large frames are rare, because they take most of the time.
                0..4 => size = SIZES[[0, 0, 0, 0, 0, 1, 1, 2][random.random_range(0..8)]],
                4 => clear = random.random(),
                5 => bench.scribble(),
                _ => {}
            }
            // Few triangles: most lines are empty, and the other lines change from frame to frame.
            let count = random.random_range(0..8);
            let extent = [0.02, 0.3, 1.0][random.random_range(0..3)];
            let mesh = meshes::mesh(&meshes::random(&mut random, count, extent), 65_535);
            let expected = expected_on(clear, &mesh, &ahead(1.0, 0.1), size, false);
            if random.random_ratio(1, 8) {
                bench.configure(&mesh, &expected);
                bench.run_geometry();
                bench.cancel_after("raster_start", random.random_range(0..3000));
            }
            bench.draw(&name, &mesh, &expected);
        }
    }
}

#[test]
fn nothing_new_is_not_written() {
    let mut bench = Bench::new(11, 0.0);
    bench.with_depth = false;
    let nothing = meshes::mesh(&[], 100);
    // At 1280x720, a `square` covers 160 pixels (20 or 21 words) of each of about 90 lines.
    let square = |x: f64| {
        let [left, right, top, bottom] = [x, x + 0.5, -0.14, 0.14];
        let corner = |x, z| at(x, 0.0, z);
        meshes::mesh(
            &[
                (
                    [corner(left, top), corner(right, top), corner(right, bottom)],
                    0xf800,
                ),
                (
                    [
                        corner(left, top),
                        corner(right, bottom),
                        corner(left, bottom),
                    ],
                    0x001f,
                ),
            ],
            100,
        )
    };
    for (name, mesh, slot, words) in [
        ("fresh", &nothing, 0, 115_200..=115_200),
        ("nothing again", &nothing, 0, 0..=0),
        ("a square", &square(0.0), 0, 1600..=1932),
        ("the other slot", &square(0.0), 1, 115_200..=115_200),
        ("the same square", &square(0.0), 0, 1600..=1932),
        ("the next square", &square(0.5), 0, 3200..=3864),
        ("the other slot again", &square(0.0), 1, 1600..=1932),
        ("nothing left", &nothing, 0, 1600..=1932),
        ("and nothing new", &nothing, 0, 0..=0),
    ] {
        bench.slot = slot;
        let expected = expected(mesh, &ahead(1.0, 0.1), SIZES[2], false);
        let written = bench.draw(name, mesh, &expected).written;
        assert!(words.contains(&written), "{name}: {written} words");
    }
}

/// At the end of a pass, all words of the pass are in memory, even the last lengths of lists. The engine writes nothing after the end, so
/// its clock may stop.
#[test]
fn all_is_in_memory_when_a_pass_has_ended() {
    for (stalls, mesh) in [0.0, 0.3, 0.6, 0.9].into_iter().flat_map(|stalls| {
        let meshes = [meshes::mesh(&[], 100), generated("icosphere:4")];
        meshes.map(|mesh| (stalls, mesh))
    }) {
        for seed in 0..3 {
            let expected = expected(&mesh, &inside(), SIZES[0], false);
            let mut bench = Bench::new(seed, stalls);
            bench.configure(&mesh, &expected);
            bench.wait_for("status.ready");
            for (start, done) in [
                ("geometry_start", "status.geometry_done"),
                ("raster_start", "status.raster_done"),
            ] {
                bench.pulse(start);
                bench.wait_for(done);
                let written = bench.written();
                for _ in 0..300 {
                    bench.clock();
                }
                assert_eq!(
                    bench.written(),
                    written,
                    "words after {done}, stalls {stalls}"
                );
            }
        }
    }
}

/// A cancelled frame does not change the next frame.
#[test]
fn a_cancelled_frame_leaves_a_working_engine() {
    let mesh = generated("icosphere:4");
    let expected = expected(&mesh, &inside(), SIZES[0], false);
    for stalls in [0.0, 0.6] {
        let mut bench = Bench::new(7, stalls);
        for (port, clocks) in [
            ("geometry_start", 700),
            ("geometry_start", 90),
            ("raster_start", 3000),
            ("raster_start", 40),
        ] {
            bench.draw(
                &format!("before {port} {clocks} {stalls}"),
                &mesh,
                &expected,
            );
            bench.cancel_after(port, clocks);
            let busy = ["status.geometry_busy", "status.raster_busy"].map(|path| bench.read(path));
            assert_eq!(busy, [0, 0], "{port}: still busy after it was cancelled");
            bench.draw(
                &format!("{port} cancelled after {clocks} clocks with stalls {stalls}"),
                &mesh,
                &expected,
            );
        }
    }
}

#[test]
fn bad_meshes_and_full_lists_are_reported() {
    let mesh = generated("icosphere:4");
    let expected = expected(&mesh, &inside(), SIZES[0], false);
    let mut bench = Bench::new(8, 0.3);
    // The mesh header of 32 bytes is followed by the chunk header, the vertices and the triangles.
    let damaged = |at: usize, value: u32| {
        let mut mesh = mesh.clone();
        mesh[at..at + 4].copy_from_slice(&value.to_le_bytes());
        mesh
    };
    for (name, bad) in [
        ("no vertices", damaged(32, 0)),
        ("very many vertices", damaged(32, u32::MAX)),
        ("very many triangles", damaged(36, u32::MAX)),
        ("one triangle too many", damaged(36, 321)),
        ("cut short", mesh[..mesh.len() - 16].to_vec()),
    ] {
        bench.configure(&bad, &expected);
        bench.run_geometry();
        assert_eq!(bench.read("status.mesh_error"), 1, "{name}");
        bench.draw("a good mesh", &mesh, &expected);
    }
    for (port, limit) in [
        ("geometry.descriptor_limit", 10),
        ("geometry.exception_limit", 3),
        ("geometry.list_shift", 0),
    ] {
        bench.configure(&mesh, &expected);
        bench.wait_for("status.ready");
        bench.set(port, limit);
        bench.run_geometry();
        assert_eq!(bench.read("status.full"), 1, "{port} {limit}");
        bench.draw("with room", &mesh, &expected);
    }
}

/// Draws frames from random descriptors and lists. Such a frame ends (with an error if a descriptor or a list is invalid) and
/// writes only its own memory, and the next frame is correct.
#[test]
fn frames_end_with_random_memory() {
    let mesh = generated("icosphere:4");
    let mut bench = Bench::new(13, 0.1);
    bench.with_depth = false;
    for seed in 0..12 {
        let mut random = Pcg64Mcg::new(seed);
        let size = SIZES[seed as usize % 3];
        let expected = expected(&mesh, &inside(), size, false);
        let mut descriptors: Vec<u8> = (0..48 * 300).map(|_| random.random()).collect();
        if seed % 4 > 0 {
            // Keeps the group columns, in the bits from 344 up, within the picture; other columns are an error.
            let last = (size.0 / 8 - 1) as u8;
            for descriptor in descriptors.as_chunks_mut::<48>().0 {
                let mut groups: [u8; 3] = std::array::from_fn(|_| random.random_range(0..=last));
                groups.sort_unstable();
                descriptor[43..46].copy_from_slice(&[groups[0], groups[2], groups[1]]);
            }
        }
        let longest = if seed % 4 == 3 { u32::MAX } else { 40 };
        let lengths = std::array::from_fn(|_| random.random_range(0..=longest));
        let list: Vec<_> = (0..40).map(|_| random.random_range(0..300)).collect();
        let name = format!("seed {seed}");
        bench.draw_raw(&name, &expected, &descriptors, lengths, &list);
        let wrong = bench.read("status.list_error");
        assert_eq!(wrong, u64::from(matches!(seed % 4, 0 | 3)), "{name}");
        bench.draw(&format!("after {name}"), &mesh, &expected);
    }
}

/// Checks the pixels drawn per clock on a sphere of 96 % of the picture's height, without memory
/// stalls, after an identical frame. There are two lower bounds: `alone` refers to the clocks of
/// both passes of a frame, `overlapped` to the clocks of the longer pass, as for frames whose
/// passes overlap.
#[test]
fn a_sphere_is_drawn_fast() {
    for (name, size, smooth, alone, overlapped, most_read) in [
        ("icosphere:6", SIZES[0], false, 1.9, 3.0, 1000),
        ("icosphere:12", SIZES[2], false, 3.85, 4.6, 6000),
        ("icosphere:6", SIZES[0], true, 0.59, 0.7, 2000),
        ("icosphere:12", SIZES[2], true, 0.6, 0.7, 10_000),
    ] {
        let mesh = generated(name);
        let view = ahead(0.4781, 0.5);
        let (expected, mut bench) = if smooth {
            let expected = expected_smooth(Rounding::Dithered, &mesh, &view, size, true);
            (expected, Bench::of("smooth", 9, 0.0))
        } else {
            let expected = expected(&mesh, &view, size, true);
            (expected, Bench::new(9, 0.0))
        };
        bench.with_depth = false;
        bench.draw("before it", &mesh, &expected);
        let counts = ["cycles_walking", "cycles_empty"].map(|count| bench.count(count));
        let clocks = bench.draw(name, &mesh, &expected);
        let pixels = expected.stats.pixels_covered as f64;
        let rates = [
            pixels / (clocks.geometry + clocks.raster) as f64,
            pixels / clocks.geometry.max(clocks.raster) as f64,
        ];
        println!(
            "{name} at {size:?}, smooth {smooth}: {pixels} pixels, {} clocks for the geometry, {} for the raster, {} walking, {} of them empty, {} words read, {} written, \
             {:.2} pixels per clock alone, {:.2} overlapped",
            clocks.geometry,
            clocks.raster,
            bench.count("cycles_walking") - counts[0],
            bench.count("cycles_empty") - counts[1],
            clocks.read,
            clocks.written,
            rates[0],
            rates[1]
        );
        assert!(
            rates[0] >= alone && rates[1] >= overlapped,
            "{name}: {rates:?}"
        );
        // Descriptors are cached across bands: without the cache 1,066 and 11,888 words would be read.
        assert!(clocks.read < most_read, "{name}: {} words", clocks.read);
    }
}

/// The engine prefetches: with 64 more clocks of memory latency, a frame takes only a few times 64
/// clocks longer.
#[test]
fn latency_of_memory_is_hidden() {
    for (name, size) in [("icosphere:6", SIZES[0]), ("icosphere:12", SIZES[2])] {
        let mesh = generated(name);
        let expected = expected(&mesh, &ahead(0.4781, 0.5), size, true);
        let raster = [12, 12 + 64].map(|latency| {
            let mut bench = Bench::new(10, 0.0);
            bench.with_depth = false;
            for read in &mut bench.reads {
                read.latency = latency;
            }
            bench.draw("before it", &mesh, &expected);
            bench.draw(name, &mesh, &expected).raster
        });
        println!("{name} at {size:?}: {raster:?} clocks for the raster");
        // Reads of lengths, lists and descriptors depend on each other, so their latency is visible
        // in the first band and a few times later.
        assert!(raster[1] < raster[0] + 8 * 64, "{name}: {raster:?}");
    }
}

/// An empty band takes a few clocks.
#[test]
fn empty_bands_are_passed_fast() {
    let nothing = meshes::mesh(&[], 100);
    let expected = expected(&nothing, &ahead(1.0, 0.1), SIZES[2], false);
    let mut bench = Bench::new(12, 0.0);
    bench.with_depth = false;
    bench.draw("before it", &nothing, &expected);
    let raster = bench.draw("nothing", &nothing, &expected).raster;
    println!("{raster} clocks for 60 empty bands");
    assert!(raster < 60 * 30 + 100, "{raster} clocks");
}

/// Checks the clocks of the geometry pass for a mesh of many small triangles, without memory
/// stalls, with the triangles in the order of `glint convert` and in the order of a scanner's file.
#[test]
fn a_scan_is_drawn_fast() {
    for (keep_order, most) in [(false, 5.0), (true, 9.6)] {
        let options = convert::Options {
            keep_order,
            ..convert::Options::default()
        };
        let mesh = converted("scan:59", options);
        let expected = expected(&mesh, &ahead(0.4781, 0.5), SIZES[0], true);
        let mut bench = Bench::new(9, 0.0);
        bench.with_depth = false;
        let name = format!("scan:59, order of the file {keep_order}");
        let clocks = bench.draw(&name, &mesh, &expected);
        let a_triangle = clocks.geometry as f64 / f64::from(expected.stats.triangles_in);
        println!(
            "{name}: {} of {} triangles drawn, {} clocks for the geometry, {a_triangle:.2} per triangle, {} for the raster",
            expected.stats.drawn, expected.stats.triangles_in, clocks.geometry, clocks.raster
        );
        assert!(
            a_triangle <= most,
            "{name}: {a_triangle:.2} clocks per triangle"
        );
    }
}
