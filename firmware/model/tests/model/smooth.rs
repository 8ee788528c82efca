//! Tests of exact properties of smooth shading. `tools/reference` measures the errors of smooth shading.

use glint_core::colour::{Rgb565, Rounding};
use glint_model::triangle::quotient::{INVERSE, colour};
use glint_model::triangle::raster::draw;
use glint_model::triangle::setup::{Facing, Setup};
use glint_model::triangle::shade::{Light, Lit, intensity, lit};
use glint_model::triangle::vertex::CameraVertex;
use glint_vectors::triangles::{SIZE, random_triangle, set_up};
use glint_vectors::{Picture, Random};

use crate::{any_vector, clipped, random_frame, random_vertex};

fn any_colour(random: &mut Random) -> Rgb565 {
    Rgb565(random.bits() as u16)
}

/// A colour of 8 bits per channel, with fraction bits.
fn any_channels(random: &mut Random) -> [u8; 3] {
    Rgb565::with_fractions([0; 3].map(|_| random.bits() as u8))
}

/// With equal light at all vertices, all pixels have exactly the colour of the light, at all depths and for triangles of any shape.
#[test]
fn equal_light_is_a_flat_colour() {
    let mut random = Random(1);
    let mut covered = 0;
    for _ in 0..2000 {
        let mut vertices = random_triangle(&mut random);
        for vertex in &mut vertices {
            vertex.w = match random.integer(0, 3) {
                0 => 228 * 64,
                1 => ((1 << 18) - 4) * 64,
                _ => random.integer(228 * 64, ((1 << 18) - 4) * 64) as u32,
            };
        }
        let Some((triangle, Setup { bounds, .. })) = set_up(vertices, SIZE) else {
            continue;
        };
        let colour = any_colour(&mut random);
        let setup = Setup::smooth(
            &triangle,
            bounds,
            &[Lit::new(colour.fractions(), [256; 3]); 3],
        );
        let mut picture = Picture::blank(SIZE);
        covered += draw(&setup, Rgb565(0), &mut picture.target()).covered;
        for (found, code) in picture.colour.iter().zip(&picture.depth) {
            assert!(
                *code == 0 || *found == colour.0,
                "{found:04x} for {colour:04x?}, {vertices:?}"
            );
        }
    }
    assert!(covered > 100_000, "{covered}");
}

/// Random accumulators of light and depth give a colour without a panic. The table `INVERSE` is monotonic and fits 17 bits.
#[test]
fn quotients_of_anything() {
    assert!(INVERSE.is_sorted_by(|a, b| a > b));
    assert!(INVERSE[0] < 1 << 17 && INVERSE[1023] >= 1 << 16);
    let mut random = Random(2);
    for shift in 0..=32 {
        for _ in 0..2000 {
            let light = [0; 3].map(|_| (random.bits() >> random.integer(32, 63)) as u32);
            let depth = ((random.bits() & 0xFFFF_FFFF) >> shift) as u32;
            colour(light, depth, Rounding::Dithered);
        }
    }
    // The largest light, and a light slightly below 0, at the smallest and the largest depth.
    for codes in [228u32, (1 << 18) - 4] {
        let depth = (codes << 14) + (1 << 13);
        let most = (u64::from(depth) * 63 / 64) as u32;
        let found = colour(
            [(u64::from(depth) * 31 / 32) as u32, most, 0],
            depth,
            Rounding::Dithered,
        );
        assert_eq!(found, Rgb565(0xFFE0).fractions());
        let found = colour([u32::MAX - (1 << 13); 3], depth, Rounding::Dithered);
        assert_eq!(found, [0; 3]);
    }
}

/// A channel of 8 bits at full light is the channel of the pixel, at all depths, if the planes are exact.
#[test]
fn channels_keep_their_eight_bits() {
    let mut random = Random(5);
    for value in 0..=u8::MAX {
        let channels = Rgb565::with_fractions([value; 3]);
        for _ in 0..400 {
            let depth = random.integer(228 << 14, ((1 << 18) - 4) << 14) as u32;
            let Lit(light) = Lit::new(channels, [256; 3]);
            let light = light.map(|light| ((u64::from(light) * u64::from(depth)) >> 16) as u32);
            assert_eq!(colour(light, depth, Rounding::Dithered), channels);
        }
    }
}

/// The light of a vertex equals flat shading with the normal of the vertex, for each side of the triangle. The light of one side is 0.
#[test]
fn light_is_that_of_flat_shading() {
    let mut random = Random(3);
    let frame = random_frame(&mut random);
    let (mut front, mut back) = (0, 0);
    for _ in 0..10_000 {
        let normal = any_vector(&mut random);
        let colour = any_colour(&mut random);
        let light = Light::new(colour.fractions(), normal, &frame.n, |i| [i; 3]);
        for facing in [Facing::Front, Facing::Back] {
            let Lit(found) = light.to(facing);
            let [r, g, b] = lit(colour, [intensity(normal, &frame.n, facing); 3])
                .channels()
                .map(u32::from);
            let rounded = [(found[0], 11), (found[1], 10), (found[2], 11)]
                .map(|(x, cut)| (u32::from(x) + (1 << (cut - 1))) >> cut);
            assert_eq!(rounded, [r, g, b]);
        }
        let dark = Lit::default();
        assert!(light.front == dark || light.back == dark);
        front += u32::from(light.front != dark);
        back += u32::from(light.back != dark);
    }
    assert!(front > 3000 && back > 3000, "{front}, {back}");
}

/// The light at a vertex that clipping creates is interpolated linearly between the ends of the edge, and rounded. Both triangles at the
/// edge get the same light.
#[test]
fn cut_edges_have_light_in_between() {
    let mut random = Random(4);
    let mut cuts = 0;
    for _ in 0..20_000 {
        let frame = random_frame(&mut random);
        let [a, b, c] = [0; 3].map(|_| {
            let normal = any_vector(&mut random);
            CameraVertex {
                light: Light::new(any_channels(&mut random), normal, &frame.n, |i| [i; 3]),
                ..random_vertex(&mut random, &frame)
            }
        });
        for end in &clipped(&frame, [a, b, b]) {
            assert!(clipped(&frame, [b, a, c]).contains(end));
            if *end == a || *end == b {
                continue;
            }
            cuts += 1;
            // An edge may be cut by a second plane, which rounds a second time.
            let part = (end.z - a.z) as f64 / (b.z - a.z) as f64;
            if (b.z - a.z).abs() < 1 << 30 {
                continue;
            }
            for facing in [Facing::Front, Facing::Back] {
                let [Lit(from), Lit(to), Lit(found)] = [a, b, *end].map(|v| v.light.to(facing));
                for channel in 0..3 {
                    let [from, to, found] = [from, to, found].map(|x| f64::from(x[channel]));
                    let exact = from + (to - from) * part;
                    assert!((found - exact).abs() < 1.6, "{found} for {exact}");
                }
            }
        }
    }
    assert!(cuts > 5000, "{cuts}");
}
