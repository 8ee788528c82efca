//! Compares the positions in a texture, and the mip levels, with the model.

use std::collections::VecDeque;

use glint_core::texture::{Sampler, Source, Texture, Wrap, encode};
use glint_model::triangle::setup::{Bounds, Oriented, Plane, Setup};
use glint_model::triangle::textured::Textured;
use glint_testbench::{Bits, Module};
use glint_vectors::Random;
use glint_vectors::triangles::{SIZE, random_triangle};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Number of fraction bits of a `position_t`.
const FRACTION_BITS: u32 = 15;

fn texture(size_log2: [u8; 2], wrap: Wrap, is_one_level: bool) -> Vec<u8> {
    let [width, height] = size_log2;
    let last = if is_one_level { 0 } else { width.max(height) };
    let level = |level: u8| {
        let texels = [width, height].map(|side| 1_usize << side.saturating_sub(level));
        vec![0; texels[0] * texels[1]]
    };
    encode(&Source {
        size_log2,
        sampler: Sampler {
            wrap: [wrap; 2],
            ..Sampler::default()
        },
        levels: (0..=last).map(level).collect(),
        ..Source::default()
    })
    .unwrap()
}

/// Makes a triangle with a texture. Its planes are computed as for a frame, or random if `is_wild`.
fn triangle<'a>(
    texture: Texture<'a>,
    vectors: &mut Random,
    random: &mut Pcg64Mcg,
    is_wild: bool,
) -> (Textured<'a>, Setup) {
    loop {
        let mut vertices = random_triangle(vectors);
        let least = 64 << random.random_range(0..17);
        for vertex in &mut vertices {
            vertex.w = random.random_range(least..(least * 16).min((1 << 24) - 1));
        }
        let Some(oriented) = Oriented::new(vertices) else {
            continue;
        };
        let Some(bounds) = Bounds::new(&oriented.vertices, SIZE.0, SIZE.1) else {
            continue;
        };
        let bits = random.random_range(1..32);
        let place = random.random::<i32>() >> random.random_range(0..32);
        let coordinates = [(); 3].map(|()| {
            [(); 2].map(|()| place.saturating_add(random.random::<i32>() >> (32 - bits)))
        });
        let mut setup = Setup::new(&oriented, bounds);
        let is_linear = random.random_bool(0.2);
        let mut textured =
            Textured::new(texture, &oriented, &setup, &coordinates, [0; 3], is_linear);
        if is_wild {
            let mut plane = || {
                let shift = random.random_range(0..32);
                let mut value = || (random.random::<i32>() >> shift) as u32;
                Plane {
                    start: value(),
                    step_x: value(),
                    step_y: value(),
                }
            };
            setup.depth = plane();
            for axis in &mut textured.axes {
                axis.plane = plane();
            }
        }
        return (textured, setup);
    }
}

/// An expected quad at the output: its covered lanes and its place in the group, its level, and the
/// position of each lane.
#[derive(Debug)]
struct Expected {
    mask: u64,
    half: bool,
    last: bool,
    level: u64,
    places: [[i64; 2]; 4],
    what: String,
}

fn check(module: &Module, expected: &Expected, texture: &Texture) {
    let what = &expected.what;
    assert_eq!(module.read("out_mask"), expected.mask, "{what}");
    assert_eq!(module.read("out_half"), u64::from(expected.half), "{what}");
    assert_eq!(module.read("out_last"), u64::from(expected.last), "{what}");
    assert_eq!(module.read("out_level"), expected.level, "level of {what}");
    let positions = module.get(module.port("out_positions"));
    for lane in (0..4).filter(|lane| expected.mask >> lane & 1 != 0) {
        for axis in 0..2 {
            let position = positions.element(18, 4 * axis + lane);
            let side = texture.size_log2()[axis];
            let place = expected.places[lane][axis];
            let fraction = position & ((1 << FRACTION_BITS) - 1);
            let repeat = place >> (side + 8);
            let what =
                || format!("axis {axis} of lane {lane}: {position:#x}, {place:#x} in {what}");
            let bits = side + 8;
            // The position of a large texture has fewer bits.
            let cut = bits.saturating_sub(FRACTION_BITS);
            assert_eq!(
                (fraction >> (FRACTION_BITS + cut - bits)) as i64,
                (place - (repeat << bits)) >> cut,
                "fraction, {}",
                what()
            );
            let is_odd = position >> FRACTION_BITS & 1 != 0;
            assert_eq!(is_odd, repeat & 1 != 0, "odd, {}", what());
            if texture.sampler().wrap[axis] == Wrap::Clamp {
                let is_past = position >> (FRACTION_BITS + 1) & 1 != 0;
                let is_below = position >> (FRACTION_BITS + 2) & 1 != 0;
                assert_eq!(is_past, repeat > 0, "past, {}", what());
                assert_eq!(is_below, repeat < 0, "below, {}", what());
            }
        }
    }
}

/// Advances by one clock, and checks the output, if it is valid.
fn clock(module: &mut Module, expected: &mut VecDeque<Expected>, texture: &Texture) {
    module.settle();
    if module.read("out_valid") == 1 {
        check(module, &expected.pop_front().unwrap(), texture);
    }
    module.clock();
}

#[test]
fn positions_and_levels() {
    let mut levels = [0; 11];
    let mut module = Module::new("texture_place", 1);
    for seed in 0..300 {
        let mut random = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        let mut vectors = Random(seed + 1);
        let size_log2 = [(); 2].map(|()| random.random_range(3..=10));
        let wrap = Wrap::ALL[random.random_range(0..3)];
        let bytes = texture(size_log2, wrap, seed % 8 == 0);
        let texture = Texture::new_checked(&bytes).unwrap();

        module.drive_all("sampler.side_log2", size_log2);
        module.drive("sampler.last_level", texture.levels() - 1);
        let mut expected = VecDeque::new();
        for number in 0..60 {
            let is_wild = seed % 3 == 0;
            let (textured, setup) = triangle(texture, &mut vectors, &mut random, is_wild);
            let planes = [setup.depth, textured.axes[0].plane, textured.axes[1].plane];
            let group = random.random_range(setup.bounds.left / 8..=(setup.bounds.right - 1) / 8);
            let row = random.random_range(setup.bounds.top..setup.bounds.bottom);
            let at = |plane: &Plane, column: i32| {
                let across = (column - setup.start_column) as u32;
                let down = (row - setup.bounds.top) as u32;
                let step = plane.step_x.wrapping_mul(across);
                let step = step.wrapping_add(plane.step_y.wrapping_mul(down));
                plane.start.wrapping_add(step)
            };
            let half_code = |depth: u32| depth.wrapping_add(1 << 13);
            let pixel = |lane: i32| {
                let [depth, s, t] = planes.each_ref().map(|plane| at(plane, 8 * group + lane));
                (half_code(depth), [s, t])
            };
            let mask: u64 = random.random_range(1..256);
            let (depth, values) = pixel(mask.trailing_zeros() as i32);
            let level = textured.level(&setup, depth, values);
            levels[level as usize] += 1;
            let mut is_first = true;
            for half in [false, true] {
                let of_half = mask >> (4 * u32::from(half)) & 0xF;
                if of_half == 0 {
                    continue;
                }
                let is_last = half || mask >> 4 == 0;
                let mut words = Vec::new();
                for (i, plane) in planes.iter().enumerate() {
                    let start = at(plane, 8 * group);
                    let start = if i == 0 { half_code(start) } else { start };
                    words.extend([start, plane.step_x, plane.step_y]);
                }
                module.drive("in_valid", 1);
                module.drive("in_mask", of_half);
                module.drive("in_half", half);
                module.drive("in_first", is_first);
                module.drive("in_last", is_last);
                module.drive_bits("in_planes", Bits::from_words(&words));
                module.drive("in_linear", textured.weight.is_some());
                module.drive_all("in_range", textured.axes.map(|axis| axis.range_log2));
                module.drive_all("in_periods", textured.axes.map(|axis| axis.periods & 0xF));
                is_first = false;
                expected.push_back(Expected {
                    mask: of_half,
                    half,
                    last: is_last,
                    level: level.into(),
                    places: [0, 1, 2, 3].map(|lane| {
                        let (depth, values) = pixel(4 * i32::from(half) + lane);
                        textured.places(depth, values)
                    }),
                    what: format!(
                        "seed {seed}, group {number}: {:?}, {setup:?}",
                        textured.axes
                    ),
                });
                clock(&mut module, &mut expected, &texture);
                module.drive("in_valid", 0);
                for _ in 0..random.random_range(0..3) {
                    clock(&mut module, &mut expected, &texture);
                }
            }
        }
        for _ in 0..30 {
            clock(&mut module, &mut expected, &texture);
        }
        assert!(expected.is_empty());
    }
    println!("groups by level: {levels:?}");
    assert!(levels.iter().all(|&groups| groups > 0), "{levels:?}");
}
