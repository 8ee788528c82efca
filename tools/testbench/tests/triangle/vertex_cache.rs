//! Tests of the vertex cache between models of the memory and the vertex stage.

use std::collections::VecDeque;

use glint_model::triangle::vertex_cache::VertexCache;
use glint_testbench::{Bits, Module, Port, Sink, Source, Stalls, step};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

type Triangle = [u16; 3];

/// Makes 68 bits of a processed vertex that identify the vertex and its chunk.
fn vertex(chunk: u32, index: u16) -> Bits {
    let mixed = (u64::from(chunk) << 16 | u64::from(index)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    Bits::from_words(&[mixed as u32, (mixed >> 32) as u32, mixed as u32 >> 7 & 15])
}

/// Makes 96 bits of a triangle's data that identify the triangle and its chunk.
fn side(chunk: u32, number: usize) -> Bits {
    Bits::from_words(&[number as u32, chunk, !(number as u32)])
}

/// Returns the indices of the vertices that the cache must fetch for a chunk.
fn fetches(triangles: &[Triangle]) -> Vec<u16> {
    let mut cache = VertexCache::empty();
    let all = triangles.as_flattened().iter().copied();
    all.filter(|&index| cache.misses(index)).collect()
}

struct Bench {
    module: Module,
    triangles: Source,
    fetches: Sink,
    projected: Source,
    out: Sink,
    /// Fetched vertices in flight, each with the clock of its arrival.
    on_the_way: VecDeque<(u64, Bits)>,
    /// Fetches still expected: chunk and index of the vertex.
    expected_fetches: VecDeque<(u32, u16)>,
    latency: u64,
    /// Number of clocks between two vertices output by the vertex stage.
    pace: u64,
    clear: Port,
    idle: Port,
}

impl Bench {
    fn new(seed: u32, shares: [f64; 4], latency: u64, pace: u64) -> Self {
        let module = Module::new("vertex_cache", seed);
        let stalls = |i: usize| Stalls::new(u64::from(seed) * 4 + i as u64, shares[i]);
        Self {
            triangles: Source::new(&module, "in", &["indices", "side"], stalls(0)),
            fetches: Sink::new(&module, "fetch", &["index"], stalls(1)),
            projected: Source::new(&module, "projected", &["vertex"], stalls(2)),
            out: Sink::new(&module, "out", &["vertices", "side"], stalls(3)),
            on_the_way: VecDeque::new(),
            expected_fetches: VecDeque::new(),
            latency,
            pace,
            clear: module.port("clear"),
            idle: module.port("idle"),
            module,
        }
    }

    fn clock(&mut self) {
        let now = self.module.cycles();
        if let Some(&(due, vertex)) = self.on_the_way.front()
            && due <= now
        {
            self.on_the_way.pop_front();
            self.projected.push(vec![vertex]);
        }
        step(
            &mut self.module,
            &mut [&mut self.triangles, &mut self.projected],
            &mut [&mut self.fetches, &mut self.out],
        );
        for item in self.fetches.take() {
            let expected = self.expected_fetches.pop_front();
            let (chunk, index) = expected.expect("an unexpected fetch");
            assert_eq!(item[0], Bits::from(u64::from(index)), "chunk {chunk}");
            let last = self.on_the_way.back().map_or(0, |&(due, _)| due);
            let due = (now + self.latency).max(last + self.pace);
            self.on_the_way.push_back((due, vertex(chunk, index)));
        }
    }

    /// Sends chunks through the cache, and compares the output vertices. The cache is cleared as soon as it has taken the last
    /// triangle of a chunk. Returns the number of clocks.
    fn check(&mut self, first: u32, chunks: &[Vec<Triangle>]) -> u64 {
        let start = self.module.cycles();
        let total: usize = chunks.iter().map(Vec::len).sum();
        let limit = start + 2000 + 40 * (self.pace + self.latency) * (total + chunks.len()) as u64;
        for (chunk, triangles) in (first..).zip(chunks) {
            self.module.set(self.clear, 1);
            self.clock();
            self.module.set(self.clear, 0);
            let misses = fetches(triangles);
            self.expected_fetches
                .extend(misses.into_iter().map(|index| (chunk, index)));
            for (number, triangle) in triangles.iter().enumerate() {
                self.triangles
                    .push(vec![Bits::pack(16, *triangle), side(chunk, number)]);
            }
            while !self.triangles.is_empty() {
                assert!(self.module.cycles() < limit, "the cache stalls");
                self.clock();
            }
        }
        while self.out.items().len() < total {
            assert!(self.module.cycles() < limit, "the cache stalls");
            self.clock();
        }
        let clocks = self.module.cycles() - start;

        assert_eq!(self.expected_fetches, []);
        let mut items = self.out.take().into_iter();
        for (chunk, triangles) in (first..).zip(chunks) {
            for (number, triangle) in triangles.iter().enumerate() {
                let item = items.next().expect("an output for each input");
                let place = format!("triangle {number} of chunk {chunk}: {triangle:?}");
                let mut vertices = self.module.record("out_vertices");
                for (part, &index) in ["[0]", "[1]", "[2]"].into_iter().zip(triangle) {
                    vertices.set_bits(part, vertex(chunk, index));
                }
                assert_eq!(item[0], vertices.bits(), "vertices of {place}");
                assert_eq!(item[1], side(chunk, number), "{place}");
            }
        }
        self.clock();
        assert!(self.module.is_high(self.idle));
        clocks
    }
}

/// Makes triangles of one random kind. Their vertices are from a window of 20 vertices that
/// advances by one vertex every two triangles, from three vertices that share a slot of the cache,
/// from the first six vertices, or from all vertices.
fn triangles(random: &mut Pcg64Mcg, count: usize) -> Vec<Triangle> {
    let kind = random.random_range(0..4);
    let base: u16 = random.random();
    (0..count)
        .map(|number| {
            [0; 3].map(|_| match kind {
                0 => base.wrapping_add(number as u16 / 2 + random.random_range(0..20)),
                1 => (base % 512).wrapping_add(512 * random.random_range(0..3)),
                2 => random.random_range(0..6),
                _ => random.random(),
            })
        })
        .collect()
}

#[test]
fn triangles_come_in_order_with_their_own_vertices() {
    let mut random = Pcg64Mcg::new(1);
    for (seed, (shares, latency, pace)) in (0..).zip([
        ([0.0; 4], 1, 1),
        ([0.0; 4], 60, 6),
        ([0.5; 4], 10, 1),
        ([0.0, 0.0, 0.0, 0.9], 1, 1),
        ([0.0, 0.9, 0.0, 0.0], 30, 6),
        ([0.0, 0.0, 0.9, 0.0], 100, 1),
        ([0.9, 0.0, 0.0, 0.3], 3, 1),
        ([0.1; 4], 300, 6),
    ]) {
        let mut bench = Bench::new(seed, shares, latency, pace);
        let chunks: Vec<_> = (0..40)
            .map(|_| {
                let count = [1, 2, 10, 60, 200][random.random_range(0..5)];
                triangles(&mut random, count)
            })
            .collect();
        bench.check(1, &chunks);
    }
}

/// A chunk hits no vertex of earlier chunks, even when the cache's epoch counter, the tag of a chunk, wraps around.
#[test]
fn every_chunk_begins_empty() {
    let mut bench = Bench::new(20, [0.0; 4], 5, 1);
    // The first chunk fills the cache. Each later chunk has few vertices, and must not hit the first chunk's.
    let mut chunks = vec![(0..512).map(|i| [i, i, i]).collect::<Vec<Triangle>>()];
    chunks.extend((1..400).map(|chunk| vec![[chunk * 37 % 512; 3], [chunk * 41 % 512; 3]]));
    bench.check(1, &chunks);
    // A chunk without triangles also takes an epoch, the time between two clears of the cache.
    for _ in 0..100 {
        bench.check(1000, &[vec![]]);
    }
    bench.check(2000, &chunks[..2]);
}

#[test]
fn a_triangle_in_three_clocks_when_all_is_there() {
    let mut bench = Bench::new(30, [0.0; 4], 50, 6);
    let strip: Vec<Triangle> = (0..100).map(|i| [i, i + 1, i + 2]).collect();
    let once = bench.check(1, std::slice::from_ref(&strip));
    let often: Vec<_> = std::iter::repeat_n(strip, 11).flatten().collect();
    let more = bench.check(2, &[often]) - once;
    assert!(more <= 3 * 1000 + 10, "{more} clocks for 1000 triangles");
}

#[test]
fn the_latency_of_memory_is_hidden() {
    let mut bench = Bench::new(40, [0.0; 4], 150, 6);
    let apart: Vec<Triangle> = (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    // The first chunk is not measured, because the cache first clears all its slots one by one.
    bench.check(1, &[vec![[0; 3]]]);
    let clocks = bench.check(2, &[apart]);
    assert!(clocks <= 18 * 300 + 200, "{clocks} clocks for 900 misses");
}
