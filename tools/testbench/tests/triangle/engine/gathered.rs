//! Frames of several geometry passes, of meshes and of lines.

use glint_core::colour::Rounding;
use glint_model::FrameBuffer;
use glint_model::line::Segment;
use glint_model::triangle::descriptor::list_word;
use glint_testbench::Bits;
use glint_vectors::meshes::ahead;

use super::bench::{Bench, DESCRIPTORS, LIST_SHIFT, LISTS, MESH};
use super::expected::{CLEAR, Expected, picture};

impl Expected {
    /// An empty frame.
    pub fn clear(size: (u32, u32)) -> Self {
        let pixels = (size.0 * size.1) as usize;
        picture(size, &ahead(1.0, 0.1), vec![CLEAR; pixels], vec![0; pixels])
    }

    /// The largest depth code.
    pub fn nearest(&self) -> u32 {
        self.depth.iter().copied().max().unwrap_or(0)
    }

    /// Draws segments over the frame with the depth test.
    pub fn draw_segments(&mut self, segments: &[Segment]) {
        let mut target = FrameBuffer {
            width: self.size.0,
            height: self.size.1,
            colour: &mut self.colour,
            depth: &mut self.depth,
            rounding: Rounding::Dithered,
        };
        for segment in segments {
            segment.draw(&mut target);
        }
    }

    /// Draws another frame's pixels over the frame with the depth test.
    pub fn draw_over(&mut self, other: &Self) {
        for (i, &code) in other.depth.iter().enumerate() {
            if code > 0 && code >= self.depth[i] {
                (self.colour[i], self.depth[i]) = (other.colour[i], code);
            }
        }
    }
}

/// Descriptors, as words, and band lists of several passes.
pub struct Gathered {
    descriptors: Vec<Bits>,
    lists: [Vec<u32>; 64],
}

impl Default for Gathered {
    fn default() -> Self {
        Self {
            descriptors: vec![],
            lists: std::array::from_fn(|_| vec![]),
        }
    }
}

impl Bench {
    /// Configures the engine for a geometry pass of segments.
    pub fn configure_lines(&mut self, segments: &[Segment], expected: &Expected) {
        self.configure(&[], expected);
        let header = Segment::header(segments.len() as u32);
        let words = segments.iter().map(Segment::words);
        let words: Vec<[u32; 8]> = std::iter::once(header).chain(words).collect();
        let words: Vec<[u8; 4]> = words
            .as_flattened()
            .iter()
            .map(|w| w.to_le_bytes())
            .collect();
        self.memory.write(MESH, words.as_flattened());
        self.set("geometry.mesh", u64::from(MESH) * 16);
        self.set("geometry.mesh_bytes", 4 * words.len() as u64);
        self.set("geometry_flags.lines", 1);
    }

    /// Runs the configured geometry pass, whose descriptors must all fit, and returns its clocks. Appends its descriptors and
    /// lists to `gathered`.
    pub fn gather(&mut self, name: &str, gathered: &mut Gathered) -> u64 {
        let clocks = self.run_geometry();
        let errors = ["status.mesh_error", "status.full"].map(|path| self.read(path));
        assert_eq!(errors, [0; 2], "{name}: mesh_error, full");
        self.set("geometry_flags.lines", 0);

        let first = gathered.descriptors.len() as u32 / 3;
        let count = self.read("results.descriptor_count") as u32;
        let words = DESCRIPTORS[0]..DESCRIPTORS[0] + 3 * count;
        gathered
            .descriptors
            .extend(words.map(|word| self.memory.word(word)));
        for (band, list) in (0..).zip(&mut gathered.lists) {
            let length = self.memory.entry(LISTS[0], band);
            let entry = |i| self.memory.entry(LISTS[0] + list_word(band, LIST_SHIFT), i);
            list.extend((0..length).map(|i| first + entry(i)));
        }
        clocks
    }

    /// Draws a frame from the descriptors and lists of several passes, and compares it with the expected frame. Returns the clocks.
    pub fn draw_gathered(&mut self, name: &str, gathered: &Gathered, expected: &Expected) -> u64 {
        self.start_gathered(gathered, expected);
        self.finish(name, expected)
    }

    /// Starts the raster pass of a frame from the descriptors and lists of several passes.
    pub fn start_gathered(&mut self, gathered: &Gathered, expected: &Expected) {
        self.configure(&[], expected);
        for (word, &data) in (DESCRIPTORS[0]..).zip(&gathered.descriptors) {
            self.memory.store(word, data, u16::MAX);
        }
        let bytes =
            |list: &[u32]| -> Vec<u8> { list.iter().flat_map(|n| n.to_le_bytes()).collect() };
        let lengths = gathered.lists.each_ref().map(|list| list.len() as u32);
        self.memory.write(LISTS[0], &bytes(&lengths));
        for (band, list) in (0..).zip(&gathered.lists) {
            let place = LISTS[0] + list_word(band, LIST_SHIFT);
            self.memory.write(place, &bytes(list));
        }
        self.set_sets(Some(gathered.descriptors.len() as u64 / 3), 0);
        self.wait_for("status.ready");
        self.pulse("raster_start");
    }

    /// Overwrites the word count of the segments in memory.
    pub fn overwrite_words(&mut self, words: u32) {
        self.memory
            .store(MESH, Bits::from_words(&[1, words, 0, 0]), u16::MAX);
    }
}
