//! Experiment: misses of caches for texels, by size, associativity and mip levels.

use glint_core::texture::Format;
use serde::{Deserialize, Serialize};

use crate::triangle::textured::{Scene, blank, scenes};

/// Misses of a cache in a scene: a line of `textures-cache.csv`.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Description of the scene.
    pub scene: String,
    /// Whether the texture has mip levels.
    pub has_levels: bool,
    /// Name of the texels' format.
    pub format: String,
    /// Bytes of the cache.
    pub bytes: u32,
    /// Number of ways of each set.
    pub ways: u32,
    /// Number of covered pixels.
    pub pixels: u64,
    /// Number of blocks of 32 bytes that are loaded.
    pub misses: u64,
    /// Number of distinct blocks that are read, which are the misses of an unlimited cache.
    pub different: u64,
}

/// Sizes in bytes and numbers of ways.
const CACHES: [(u32, u32); 10] = [
    (2048, 1),
    (2048, 2),
    (4096, 1),
    (4096, 2),
    (8192, 1),
    (8192, 2),
    (16_384, 1),
    (16_384, 2),
    (32_768, 1),
    (32_768, 2),
];

/// A cache of blocks that replaces the least recently used way.
struct Cache {
    bytes: u32,
    ways: u32,
    /// The blocks of each set, most recently used first.
    sets: Vec<Vec<[u32; 3]>>,
    misses: u64,
}

impl Cache {
    fn new((bytes, ways): (u32, u32)) -> Self {
        Self {
            bytes,
            ways,
            sets: vec![Vec::new(); (bytes / 32 / ways) as usize],
            misses: 0,
        }
    }

    /// Reads the block with this column, row and level, and counts a miss if the cache does not have it.
    fn read(&mut self, block: [u32; 3]) {
        let [x, y, level] = block;
        let bits = self.sets.len().ilog2();
        let across = bits.div_ceil(2);
        // The low bits of column and row select the set, so neighbouring blocks are in different sets: the sets form a square. Each level
        // is offset from the previous level by half of the square's side.
        let (x, y) = (x + (level << (across - 1)), y + (level << (across - 1)));
        let set = x & ((1 << across) - 1) | (y & ((1 << (bits - across)) - 1)) << across;
        let set = &mut self.sets[set as usize];
        match set.iter().position(|&other| other == block) {
            Some(place) => set[..=place].rotate_right(1),
            None => {
                self.misses += 1;
                set.insert(0, block);
                set.truncate(self.ways as usize);
            }
        }
    }
}

/// Measures all caches in all scenes.
#[must_use]
pub fn measure() -> Vec<Row> {
    let mut rows = Vec::new();
    for has_levels in [true, false] {
        for scene in scenes(&blank(has_levels)) {
            for (name, format) in [
                ("RGB565", Format::Rgb565),
                ("16 colours", Format::Palette16),
            ] {
                rows.extend(measure_scene(&scene, has_levels, name, format));
            }
        }
    }
    rows
}

/// Measures all caches in a scene with texels of one format.
fn measure_scene(scene: &Scene, has_levels: bool, name: &str, format: Format) -> Vec<Row> {
    let mut caches = CACHES.map(Cache::new);
    let mut different = std::collections::HashSet::new();
    let mut pixels = 0;
    let [width, height] = format.block_log2();
    scene.rows(&mut |drawn, _, row| {
        pixels += row.len() as u64;
        let texture = &drawn.textured.texture;
        let (sides, wrap) = (texture.size_log2(), texture.sampler().wrap);
        let mut last = None;
        for (pixel, level) in row.iter().zip(drawn.levels(row)) {
            let places = drawn.textured.places(pixel.depth, pixel.values);
            let level_sides = texture.level_log2(level);
            let [x, y] = [0, 1].map(|axis: usize| {
                let place = places[axis] >> (8 + sides[axis] - level_sides[axis]);
                wrap[axis].place(place as i32, level_sides[axis])
            });
            let block = [x >> width, y >> height, level];
            if last != Some(block) {
                caches.iter_mut().for_each(|cache| cache.read(block));
                different.insert(block);
                last = Some(block);
            }
        }
    });
    let row = |cache: &Cache| Row {
        scene: scene.name.to_owned(),
        has_levels,
        format: name.to_owned(),
        bytes: cache.bytes,
        ways: cache.ways,
        pixels,
        misses: cache.misses,
        different: different.len() as u64,
    };
    caches.iter().map(row).collect()
}
