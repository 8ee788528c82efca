//! Tests of refused requests and damaged memory: the errors must equal the gateware's, and nothing
//! may panic.

use emulated_board::Device;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_model::triangle::PreparedMesh;
use glint_vectors::Model;
use glint_vectors::scenes::inside;
use litex_pac::memories::MAIN_RAM;
use litex_pac::register::Value;
use litex_pac::triangle::{Caps, Error, Geometry, Raster, Triangle, offset};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::bench::{
    Bench, DESCRIPTOR_BYTES, DESCRIPTORS, FRAMES, Kind, LIMIT, LISTS, MESH, UNTOUCHED, alone,
};

fn sphere() -> Vec<u8> {
    Model::sphere(0.5, 10).encoded()
}

fn part(mesh: &[u8]) -> PreparedMesh<'_> {
    alone(mesh, &inside(), Size::W320, false)
}

/// A bench with a prepared geometry pass, and the start flags.
fn prepared(mesh: &[u8]) -> (Bench, Geometry) {
    let mut bench = Bench::new();
    let flags = bench.prepare(&part(mesh));
    (bench, flags)
}

#[test]
fn the_engine_has_an_identity() {
    let mut bench = Bench::new();
    assert_eq!(bench.read(offset::IDENT), Triangle::IDENT);
    let caps = Caps::from_bits(bench.read(offset::CAPS));
    assert_eq!((caps.sizes(), caps.count_bits()), (0b111, 20));
    assert!(caps.triangles() && caps.lines() && caps.gouraud());
    bench.set(offset::MESH, 7);
    assert_eq!(bench.read(offset::MESH), 0);
}

#[test]
fn a_geometry_pass_with_a_wrong_region_is_refused() {
    let mesh = sphere();
    let (mut bench, flags) = prepared(&mesh);
    let end = MAIN_RAM.base + MAIN_RAM.size;
    for (register, value) in [
        (offset::MESH, MESH + 8),
        (offset::MESH, 0),
        (offset::MESH_BYTES, u32::MAX),
        (offset::GEOMETRY_DESCRIPTORS, end - DESCRIPTOR_BYTES as u32),
        (offset::GEOMETRY_LISTS, end - 16),
        (offset::GEOMETRY_LISTS, 4),
        (offset::LIST_SHIFT, 18),
        (offset::LIST_SHIFT, 31),
        (offset::EXCEPTIONS, end),
    ] {
        bench.prepare(&part(&mesh));
        bench.set(register, value);
        let error = bench.pass(Kind::Geometry, flags.bits());
        assert_eq!(error, Error::Address, "{register:#x} {value:#x}");
        assert_eq!(bench.words(LISTS[0], 64), [0; 64], "memory is unchanged");
    }
    let wrong_size = Geometry::from_bits(flags.bits() | 3 << 2);
    assert_eq!(wrong_size.size(), None);
    assert_eq!(bench.pass(Kind::Geometry, wrong_size.bits()), Error::Size);
}

#[test]
fn a_raster_pass_with_a_wrong_region_is_refused() {
    let mut bench = Bench::new();
    let end = MAIN_RAM.base + MAIN_RAM.size;
    for (register, value) in [
        (offset::FRAME, FRAMES[0] + 2),
        (offset::FRAME, end - 320 * 180 * 2 + 16),
        (offset::DEPTH, end - 320 * 180 * 4 + 16),
        (offset::LISTS_0, end - 16),
        (offset::DESCRIPTORS_0, MAIN_RAM.base - 16),
        (offset::LISTS_1, 0),
        (offset::DESCRIPTORS_1, 1),
        (offset::LIST_SHIFT, 20),
    ] {
        let flags = bench.prepare_raster(Size::W320, false, &[]);
        bench.set(register, value);
        let flags = flags.with_second(true);
        let error = bench.pass(Kind::Raster, flags.bits());
        assert_eq!(error, Error::Address, "{register:#x} {value:#x}");
        // An unused region may have any address.
        if matches!(register, offset::LISTS_1 | offset::DESCRIPTORS_1) {
            let flags = flags.with_second(false);
            assert_eq!(bench.pass(Kind::Raster, flags.bits()), Error::None);
        }
    }
    let wrong_size = Raster::from_bits(Raster::default().with_start(true).bits() | 3 << 1);
    assert_eq!(wrong_size.size(), None);
    assert_eq!(bench.pass(Kind::Raster, wrong_size.bits()), Error::Size);
}

#[test]
fn a_second_request_leaves_the_first_pass() {
    let mesh = sphere();
    let (mut bench, flags) = prepared(&mesh);
    bench.set(offset::GEOMETRY, flags.bits());
    assert!(bench.status().geometry_busy());
    bench.now += 10;
    let error = bench.pass(Kind::Geometry, flags.bits());
    assert_eq!(error, Error::Busy);
    let triangles = Mesh::new_checked(&mesh).unwrap().triangle_count();
    assert_eq!(bench.read(offset::TRIANGLES), triangles);
    assert_eq!(bench.pass(Kind::Geometry, flags.bits()), Error::None);
}

#[test]
fn cancelled_passes_have_nothing_to_continue() {
    let mesh = sphere();
    let (mut bench, flags) = prepared(&mesh);
    assert_eq!(bench.pass(Kind::Geometry, flags.bits()), Error::None);
    let whole = bench.read(offset::DESCRIPTOR_COUNT);
    let again = flags.with_append(true).bits();
    assert_eq!(bench.pass(Kind::Geometry, again), Error::None);
    assert_eq!(bench.read(offset::DESCRIPTOR_COUNT), 2 * whole);
    bench.set(offset::GEOMETRY, again);
    bench.now += 5;
    bench.cancel();
    assert!(!bench.status().geometry_busy());
    assert_eq!(bench.finish(Kind::Geometry), Error::Cancelled);
    assert_eq!(bench.pass(Kind::Geometry, again), Error::None);
    assert_eq!(bench.read(offset::DESCRIPTOR_COUNT), whole);
}

#[test]
fn bad_meshes_and_full_lists_are_reported() {
    let mesh = sphere();
    let length = mesh.len() as u32;
    let triangles = Mesh::new_checked(&mesh).unwrap().triangle_count();
    let (mut bench, flags) = prepared(&mesh);
    // The mesh's header has 32 bytes, and the chunk's header follows it.
    for (name, place, value, bytes) in [
        ("no vertices", 32, 0, length),
        ("very many vertices", 32, u32::MAX, length),
        ("many vertices", 32, 1 << 24, length),
        ("very many triangles", 36, u32::MAX, length),
        ("one triangle too many", 36, triangles + 1, length),
        ("cut short", 36, triangles, length - 16),
        ("nothing", 36, triangles, 32),
    ] {
        bench.prepare(&part(&mesh));
        bench.ram.set_word(MESH + place, value).unwrap();
        bench.set_mesh(bytes);
        assert_eq!(
            bench.pass(Kind::Geometry, flags.bits()),
            Error::Mesh,
            "{name}"
        );
    }
    for (register, value) in [
        (offset::DESCRIPTOR_LIMIT, 10),
        (offset::EXCEPTION_LIMIT, 3),
        (offset::LIST_SHIFT, 0),
    ] {
        bench.prepare(&part(&mesh));
        bench.set(register, value);
        let error = bench.pass(Kind::Geometry, flags.bits());
        assert_eq!(error, Error::Full, "{register:#x}");
        let counts = [offset::DESCRIPTOR_COUNT, offset::EXCEPTION_COUNT].map(|at| bench.read(at));
        assert!(register != offset::DESCRIPTOR_LIMIT || counts[0] == 10);
        assert!(register != offset::EXCEPTION_LIMIT || counts[1] == 3);
        bench.prepare(&part(&mesh));
        assert_eq!(bench.pass(Kind::Geometry, flags.bits()), Error::None);
    }
}

/// Draws frames from random descriptors and lists. Each frame must end, report an error if a
/// descriptor or a list is invalid, and write only its own memory.
#[test]
fn frames_end_with_random_memory() {
    let mut bench = Bench::new();
    for seed in 0..12 {
        let mut random = Pcg64Mcg::new(seed);
        let size = Size::ALL[seed as usize % 3];
        let mut descriptors: Vec<u8> = (0..DESCRIPTOR_BYTES * 300)
            .map(|_| random.random())
            .collect();
        if seed % 4 > 0 {
            // Columns of groups within the picture; other columns are an error.
            let last = (size.width() / 8 - 1) as u8;
            for descriptor in descriptors.as_chunks_mut::<DESCRIPTOR_BYTES>().0 {
                let mut groups: [u8; 3] = std::array::from_fn(|_| random.random_range(0..=last));
                groups.sort_unstable();
                descriptor[43..46].copy_from_slice(&[groups[0], groups[2], groups[1]]);
            }
        }
        bench.write(DESCRIPTORS[0], &descriptors);
        let longest = if seed % 4 == 3 { u32::MAX } else { 40 };
        let flags = bench.prepare_raster(size, false, &[]).with_depth(false);
        for band in 0..64 {
            let length = random.random_range(0..=longest);
            bench.ram.set_word(LISTS[0] + 4 * band, length).unwrap();
            let list = glint_model::triangle::descriptor::list_word(band, crate::bench::LIST_SHIFT);
            for place in 0..40 {
                let entry = random.random_range(0..300);
                let address = LISTS[0] + 16 * list + 4 * place;
                bench.ram.set_word(address, entry).unwrap();
            }
        }
        bench.set(offset::COUNT_0, 300);
        let behind = FRAMES[0] + 2 * size.pixel_count() as u32;
        bench.write(behind, &UNTOUCHED.to_le_bytes().repeat(4096));
        let expected = if matches!(seed % 4, 0 | 3) {
            Error::List
        } else {
            Error::None
        };
        let error = bench.pass(Kind::Raster, flags.bits());
        assert_eq!(error, expected, "seed {seed}");
        let words = bench.words(behind, 2048);
        assert!(words.iter().all(|word| *word == 0x7777_7777), "seed {seed}");
        // A list entry beyond the last descriptor.
        bench.set(offset::COUNT_0, 10);
        let error = bench.pass(Kind::Raster, flags.bits());
        assert_eq!(error, Error::List, "seed {seed}");
    }
}

/// Runs passes with random parameters and memory, which must not panic.
#[test]
fn random_parameters_do_no_harm() {
    let mut random = Pcg64Mcg::new(77);
    let mut bench = Bench::new();
    let noise: Vec<u8> = (0..1 << 20).map(|_| random.random()).collect();
    let mut passes = [0; 2];
    for number in 0..300 {
        bench.write(MESH, &noise);
        let place = |random: &mut Pcg64Mcg| MESH + 16 * random.random_range(0..2000);
        for word in 0..128 {
            bench.set(4 * word + offset::MESH, random.random());
        }
        for register in [
            offset::MESH,
            offset::GEOMETRY_DESCRIPTORS,
            offset::GEOMETRY_LISTS,
            offset::EXCEPTIONS,
            offset::FRAME,
            offset::DEPTH,
            offset::LISTS_0,
            offset::LISTS_1,
            offset::DESCRIPTORS_0,
            offset::DESCRIPTORS_1,
        ] {
            let value = place(&mut random);
            bench.set(register, value);
        }
        let limit = random.random_range(0..LIMIT);
        let shift = random.random_range(0..8);
        bench.set_all([
            (offset::MESH_BYTES, 16 * random.random_range(0..2000)),
            (offset::DESCRIPTOR_LIMIT, limit),
            (offset::EXCEPTION_LIMIT, limit),
            (offset::COUNT_0, limit),
            (offset::COUNT_1, limit),
            (offset::LIST_SHIFT, shift),
        ]);
        // Small counts in memory, so that some words are valid headers of chunks.
        for at in (0..2000).step_by(7) {
            bench.ram.set_word(MESH + 16 * at, at % 5).unwrap();
            bench.ram.set_word(MESH + 16 * at + 4, at % 900).unwrap();
        }
        let start = [offset::GEOMETRY, offset::RASTER][number % 2];
        bench.set(start, random.random::<u32>() & 0x3FF | 1);
        while bench.status().geometry_busy() || bench.status().raster_busy() {
            bench.now = bench.engine.advance(bench.now, &mut bench.ram);
        }
        let status = bench.status();
        let error = [status.geometry_error(), status.raster_error()][number % 2].unwrap();
        let is_refused = matches!(error, Error::Size | Error::Address);
        passes[usize::from(is_refused)] += 1;
        if number % 10 == 0 {
            bench.cancel();
            bench.now += 5000;
            bench.engine.advance(bench.now, &mut bench.ram);
        }
    }
    println!("{passes:?} passes done and refused");
    assert!(passes.iter().all(|&count| count > 50), "{passes:?}");
}
