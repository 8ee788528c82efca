//! Compares the texels of the texture sampler, which reads a memory of any latency, with the
//! model's.

mod bench;
mod expected;

use glint_core::colour::Rgb565;
use glint_core::texture::{Filter, Format, Sampler, Source, Texture, Wrap, encode};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use bench::{Bench, Memory};
use expected::{Quad, REPEAT};

/// Makes a random texture. A quarter of the texels have the key, so that transparent texels are
/// frequent.
fn texture(
    random: &mut Pcg64Mcg,
    format: Format,
    size_log2: [u8; 2],
    sampler: Sampler,
    has_key: bool,
    has_levels: bool,
) -> Vec<u8> {
    let key: u16 = random.random::<u16>() & ((1_u32 << format.bits()) - 1) as u16;
    let count = if has_levels {
        1 + size_log2[0].max(size_log2[1])
    } else {
        1
    };
    let levels = (0..count).map(|level| {
        let texels = size_log2
            .iter()
            .map(|side| usize::from(side.saturating_sub(level)));
        let texels = 1 << texels.sum::<usize>();
        (0..texels)
            .map(|_| {
                if random.random_ratio(1, 4) {
                    key
                } else {
                    random.random()
                }
            })
            .collect()
    });
    let levels = levels.collect();
    let source = Source {
        format,
        size_log2,
        sampler,
        key: has_key.then_some(key),
        palette: (0..format.colours())
            .map(|_| Rgb565(random.random()))
            .collect(),
        levels,
        ..Source::default()
    };
    encode(&source).expect("a texture of a valid size")
}

/// Makes random quads on a texture, in runs of the same kind.
fn quads(random: &mut Pcg64Mcg, texture: &Texture, count: usize) -> Vec<Quad> {
    let mut all: Vec<Quad> = Vec::new();
    while all.len() < count {
        let level = random.random_range(0..texture.levels());
        let kind = random.random_range(0..5);
        let sides = texture.level_log2(level);
        // Position of the first pixel, and step from pixel to pixel, at most one and a half texels.
        let mut at = [0, 1].map(|_| random.random_range(-3 * REPEAT..3 * REPEAT));
        let steps = sides.map(|side| {
            let texel = REPEAT >> side;
            random.random_range(-3 * texel / 2..=3 * texel / 2)
        });
        for _ in 0..random.random_range(1..40) {
            let positions = [0, 1, 2, 3].map(|_| {
                [0, 1].map(|axis: usize| {
                    let texel = REPEAT >> sides[axis];
                    match kind {
                        // Pixels in a row of the screen.
                        0 | 1 => {
                            at[axis] += steps[axis];
                            at[axis]
                        }
                        // Pixels far apart.
                        2 => random.random_range(-2 * REPEAT..3 * REPEAT),
                        // Pixels at the borders of texels and blocks.
                        3 => {
                            texel * random.random_range(-20..20)
                                + random.random_range(-texel / 64 - 2..=texel / 64 + 2)
                        }
                        // Pixels at seams, where the texture repeats.
                        _ => {
                            REPEAT * random.random_range(-2..=3)
                                + random.random_range(-2 * texel..=2 * texel)
                        }
                    }
                })
            });
            all.push(Quad {
                mask: if random.random_bool(0.5) {
                    0xF
                } else {
                    random.random_range(1..16)
                },
                half: random.random(),
                last: random.random(),
                level,
                positions,
            });
        }
    }
    all
}

fn random_sampler(random: &mut Pcg64Mcg) -> Sampler {
    Sampler {
        wrap: [0; 2].map(|_| Wrap::ALL[random.random_range(0..Wrap::ALL.len())]),
        filter: Filter::ALL[random.random_range(0..Filter::ALL.len())],
    }
}

/// Shares of stalls of the quads, of the requests to memory and of its data, and the latency of
/// memory in clocks.
const PACES: [([f64; 3], u64); 6] = [
    ([0.0; 3], 1),
    ([0.0; 3], 20),
    ([0.5; 3], 5),
    ([0.0, 0.9, 0.0], 1),
    ([0.0, 0.0, 0.8], 40),
    ([0.8, 0.1, 0.1], 3),
];

#[test]
fn random_textures() {
    for seed in 0..60 {
        let mut random = Pcg64Mcg::new(seed.into());
        let (shares, latency) = PACES[seed as usize % PACES.len()];
        let mut bench = Bench::new(seed, shares, latency);
        for run in 0..6 {
            let format = Format::ALL[random.random_range(0..3)];
            let largest = if run == 0 { 10 } else { 7 };
            let size_log2 = [0; 2].map(|_| random.random_range(3..=largest));
            let sampler = random_sampler(&mut random);
            let (has_key, has_levels) = (random.random(), random.random_ratio(3, 4));
            let bytes = texture(&mut random, format, size_log2, sampler, has_key, has_levels);
            let memory = Memory::new(random.random_range(0..1 << 22), bytes);
            bench.load(&memory, run as u8);
            let quads = quads(&mut random, &memory.texture(), 400);
            bench.check(&memory, &quads);
        }
    }
}

/// Draws every level with every wrap and filter, at the positions where the wraps and filters
/// differ.
#[test]
fn seams() {
    let mut random = Pcg64Mcg::new(100);
    let mut bench = Bench::new(100, [0.0; 3], 10);
    let mut number = 0;
    for format in Format::ALL {
        for size_log2 in [[3, 3], [5, 3], [3, 10], [7, 4]] {
            for (wrap, filter) in Wrap::ALL
                .into_iter()
                .flat_map(|wrap| Filter::ALL.map(|filter| (wrap, filter)))
            {
                let sampler = Sampler {
                    wrap: [wrap; 2],
                    filter,
                };
                let bytes = texture(&mut random, format, size_log2, sampler, true, true);
                let memory = Memory::new(2 * u32::from(number), bytes);
                let texture = memory.texture();
                bench.load(&memory, number);
                number = number.wrapping_add(1);
                let mut all = Vec::new();
                for level in 0..texture.levels() {
                    let edges = texture.level_log2(level).map(|side| {
                        let texel = REPEAT >> side;
                        let mut edges = Vec::new();
                        for repeat in [-2, -1, 0, 1, 2, 3] {
                            for offset in [
                                0,
                                -1,
                                1,
                                texel - 1,
                                -texel,
                                texel / 2,
                                -texel / 2,
                                texel * 119 / 256,
                                texel * 120 / 256,
                                texel * 121 / 256,
                            ] {
                                edges.push(REPEAT * repeat + offset);
                            }
                        }
                        edges
                    });
                    for i in 0..edges[0].len() {
                        let positions = [0, 1, 2, 3].map(|lane| {
                            [
                                edges[0][i],
                                edges[1][(i + 7 * lane * lane + lane) % edges[1].len()],
                            ]
                        });
                        all.push(Quad {
                            mask: 0xF,
                            half: i % 2 == 1,
                            last: i % 3 == 0,
                            level,
                            positions,
                        });
                    }
                }
                bench.check(&memory, &all);
            }
        }
    }
}

/// Textures that are used in turn do not get each other's cached blocks. A texture that replaces
/// another texture of the same number does not get the old blocks either.
#[test]
fn changes_of_texture() {
    for seed in 200..206 {
        let mut random = Pcg64Mcg::new(seed.into());
        let mut bench = Bench::new(seed, [0.0; 3], 15);
        let memories: Vec<_> = (0..4)
            .map(|i| {
                let format = Format::ALL[i % 3];
                let sampler = random_sampler(&mut random);
                let bytes = texture(&mut random, format, [5, 5], sampler, false, true);
                Memory::new(1000 * i as u32, bytes)
            })
            .collect();
        for round in 0..12 {
            let memory = &memories[random.random_range(0..memories.len())];
            // Each texture has its own number; later, all textures have the same number, and the
            // cache is invalidated before each of them.
            let is_own = round < 8;
            let number = if is_own { memory.base / 1000 } else { 77 };
            if !is_own {
                bench.forget();
            }
            bench.load(memory, number as u8);
            let quads = quads(&mut random, &memory.texture(), 200);
            bench.check(memory, &quads);
        }
    }
}

/// Draws quads whose blocks compete with the blocks of previous quads for the same places in the
/// cache.
#[test]
fn blocks_that_compete_for_places() {
    for (seed, filter) in [(300, Filter::Nearest), (301, Filter::Bilinear)] {
        let mut random = Pcg64Mcg::new(seed.into());
        let mut bench = Bench::new(seed, [0.0, 0.2, 0.2], 25);
        let sampler = Sampler {
            filter,
            ..Sampler::default()
        };
        let bytes = texture(&mut random, Format::Rgb565, [10, 10], sampler, false, false);
        let memory = Memory::new(5, bytes);
        bench.load(&memory, 9);
        let texel = REPEAT >> 10;
        let quads: Vec<_> = (0..1500)
            .map(|_| {
                // The blocks differ in the address bits from which the cache computes their places.
                let column = 128 * random.random_range(0..8) + 32 * random.random_range(0..2);
                let row = 64 * random.random_range(0..16) + 8 * random.random_range(0..2);
                let positions = [0, 1, 2, 3].map(|lane| {
                    [
                        texel * (column + lane) + texel / 3,
                        texel * row + texel / 2 + 8,
                    ]
                });
                Quad {
                    mask: 0xF,
                    half: false,
                    last: true,
                    level: 0,
                    positions,
                }
            })
            .collect();
        bench.check(&memory, &quads);
    }
}

/// No header, palette or position stops the sampler.
#[test]
fn any_values() {
    for seed in 500..520 {
        let mut random = Pcg64Mcg::new(seed.into());
        let mut bench = Bench::new(seed, [0.1, 0.3, 0.3], 9);
        let memory = Memory::new(0, Vec::new());
        for _ in 0..10 {
            bench.load_any(&mut random);
            let quads: Vec<_> = (0..100)
                .map(|_| Quad {
                    mask: random.random_range(1..16),
                    half: random.random(),
                    last: random.random(),
                    level: random.random_range(0..16),
                    positions: [[0; 2]; 4].map(|place| {
                        place.map(|_: i64| random.random_range(-3 * REPEAT..3 * REPEAT))
                    }),
                })
                .collect();
            bench.check_any(&memory, &quads);
        }
    }
}

/// Draws a whole texture row by row, one texel per pixel, `rounds` times. Returns the numbers of
/// clocks and of words read per quad in the last round.
fn walk(filter: Filter, format: Format, side_log2: u8, rounds: usize, latency: u64) -> [f64; 2] {
    let mut random = Pcg64Mcg::new(400);
    let mut bench = Bench::new(400, [0.0; 3], latency);
    let sampler = Sampler {
        filter,
        ..Sampler::default()
    };
    let bytes = texture(&mut random, format, [side_log2; 2], sampler, false, false);
    let memory = Memory::new(3, bytes);
    bench.load(&memory, 1);
    let texel = REPEAT >> side_log2;
    let side = 1 << side_log2;
    let mut row = Vec::new();
    for y in 0..side {
        for x in (0..side).step_by(4) {
            let positions =
                [0, 1, 2, 3].map(|lane| [texel * (x + lane) + texel / 3, texel * y + texel / 3]);
            row.push(Quad {
                mask: 0xF,
                half: x % 8 != 0,
                last: x % 8 != 0,
                level: 0,
                positions,
            });
        }
    }
    for _ in 1..rounds {
        bench.check(&memory, &row);
    }
    let words = bench.words;
    let clocks = bench.check(&memory, &row);
    [clocks as f64, (bench.words - words) as f64].map(|count| count / row.len() as f64)
}

#[test]
fn clocks_of_quads() {
    for filter in Filter::ALL {
        for (format, side_log2, rounds, latency) in [
            (Format::Rgb565, 6, 2, 20),
            (Format::Rgb565, 8, 1, 20),
            (Format::Palette256, 8, 1, 20),
            (Format::Palette16, 8, 1, 20),
            (Format::Rgb565, 8, 1, 40),
        ] {
            let [clocks, words] = walk(filter, format, side_log2, rounds, latency);
            println!(
                "{filter:?}, {format:?}, side {}, round {rounds}, latency {latency}: {clocks:.3} clocks and {words:.3} words per quad",
                1 << side_log2
            );
        }
    }
}
