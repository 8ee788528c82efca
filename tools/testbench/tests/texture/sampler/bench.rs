//! Test bench of the texture sampler: a source of quads, and a memory.

use std::collections::VecDeque;

use glint_core::records::TextureHeader;
use glint_core::texture::{Filter, Texture};
use glint_testbench::{Bits, Module, Port, Stalls};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::expected::{Quad, REPEAT, Texels, check_sample, steps, texels};

/// Number of bytes of a memory word.
const WORD: usize = 16;
/// Words that the port of the memory holds for the sampler.
const PORT_WORDS: usize = 32;

/// A texture in memory. Without bytes, each word of the memory contains its address.
pub struct Memory {
    /// Word address of the texture.
    pub base: u32,
    bytes: Vec<u8>,
}

impl Memory {
    pub fn new(base: u32, bytes: Vec<u8>) -> Self {
        Self { base, bytes }
    }

    pub fn texture(&self) -> Texture<'_> {
        Texture::new_checked(&self.bytes).expect("a checked texture")
    }

    fn word(&self, address: u32) -> Bits {
        if self.bytes.is_empty() {
            return Bits::from(u64::from(address));
        }
        let at = address
            .checked_sub(self.base)
            .expect("an address of the texture") as usize
            * WORD;
        Bits::from_bytes(&self.bytes[at..at + WORD])
    }
}

struct Ports {
    ask: [Port; 3],
    data: [Port; 3],
    valid: Port,
    mask: Port,
    half: Port,
    last: Port,
    bilinear: Port,
    opaque: Port,
    texels: Port,
    neighbours: Port,
    weights: Port,
    idle: Port,
    credit: Port,
    sent: Port,
    room: Port,
    quad: [Port; 6],
}

pub struct Bench {
    module: Module,
    ports: Ports,
    quads: VecDeque<Quad>,
    /// Whether the last clock had the first item of a quad of two items.
    follows: bool,
    stalls: [Stalls; 4],
    latency: u64,
    seed: u32,
    /// Requested words: the earliest clock of delivery, and the address.
    asked: VecDeque<(u64, u32)>,
    /// Whether the first of `asked` is on the port, where it stays until it is taken.
    shown: bool,
    /// Number of words that the sampler took.
    pub words: u64,
}

/// A step of a quad.
struct Step {
    mask: u8,
    half: bool,
    last: bool,
    opaque: u8,
    texels: Bits,
    neighbours: Bits,
    weights: Bits,
}

impl Bench {
    pub fn new(seed: u32, shares: [f64; 3], latency: u64) -> Self {
        let module = Module::new("texture_sampler", seed);
        let stalls = |i: usize| Stalls::new(u64::from(seed) * 4 + i as u64, shares[i % 3]);
        let port = |name: &str| module.port(name);
        Self {
            quads: VecDeque::new(),
            follows: false,
            stalls: [stalls(0), stalls(1), stalls(2), stalls(3)],
            ports: Ports {
                ask: ["ask_valid", "ask_ready", "ask_addr"].map(port),
                data: ["data_valid", "data_ready", "data"].map(port),
                valid: port("out_valid"),
                mask: port("out_mask"),
                half: port("out_half"),
                last: port("out_last"),
                bilinear: port("out_bilinear"),
                opaque: port("out_opaque"),
                texels: port("out_texels"),
                neighbours: port("out_neighbours"),
                weights: port("out_weights"),
                idle: port("idle"),
                credit: port("credit"),
                sent: port("sent"),
                room: port("out_room"),
                quad: ["valid", "mask", "half", "last", "level", "positions"]
                    .map(|name| port(&format!("in_{name}"))),
            },
            module,
            latency,
            seed,
            asked: VecDeque::new(),
            shown: false,
            words: 0,
        }
    }

    /// Drives the settings of a texture as the loader does: its sampler, its palette and the
    /// addresses of its levels.
    pub fn load(&mut self, memory: &Memory, number: u8) {
        assert!(self.module.is_high(self.ports.idle));
        let texture = memory.texture();
        let header = memory.bytes.first_chunk().expect("a header");
        let header = TextureHeader::from_bytes(header);
        let module = &mut self.module;
        module.drive("number", i128::from(number));
        module.drive("sampler.format", i128::from(header.format));
        let sides = [header.width_log2, header.height_log2];
        module.drive_all("sampler.side_log2", sides);
        module.drive_all("sampler.wrap", header.wrap);
        module.drive("sampler.last_level", i128::from(header.levels - 1));
        module.drive("sampler.bilinear", i128::from(header.filter));
        module.drive("sampler.cut_out", i128::from(header.cut_out));
        module.drive("sampler.key", i128::from(header.key));

        let mut at = TextureHeader::BYTES;
        for index in 0..texture.format().colours() {
            let colour = u16::from_le_bytes([memory.bytes[at], memory.bytes[at + 1]]);
            at += 2;
            module.drive("palette_write", 1);
            module.drive("palette_index", index as i128);
            module.drive("palette_colour", i128::from(colour));
            module.clock();
        }
        module.drive("palette_write", 0);
        for level in 0..texture.levels() {
            module.drive("level_write", 1);
            module.drive("level_number", i128::from(level));
            module.drive("level_first", i128::from(memory.base) + (at / WORD) as i128);
            module.clock();
            let (block, sides) = (texture.format().block_log2(), texture.level_log2(level));
            let blocks = [0, 1].map(|axis: usize| sides[axis].saturating_sub(block[axis]));
            at += 32 << (blocks[0] + blocks[1]);
        }
        module.drive("level_write", 0);
        assert_eq!(at, memory.bytes.len());
    }

    /// Drives random settings.
    pub fn load_any(&mut self, random: &mut Pcg64Mcg) {
        assert!(self.module.is_high(self.ports.idle));
        for name in ["number", "sampler", "level_first"] {
            let width = self.module.record(name).layout().width();
            let value: u64 = random.random();
            let value = Bits::from(value & ((1 << width) - 1));
            self.module.drive_bits(name, value);
        }
        self.module.settle();
    }

    /// Sends quads, and checks that their steps serve each covered lane once.
    pub fn check_any(&mut self, memory: &Memory, quads: &[Quad]) {
        self.quads.extend(quads);
        let limit = self.module.cycles() + 1000 + quads.len() as u64 * (200 + 20 * self.latency);
        for quad in quads {
            let mut left = quad.mask;
            while left != 0 {
                assert!(self.module.cycles() < limit, "seed {}: no step", self.seed);
                if let Some(step) = self.clock(memory) {
                    assert_eq!((step.mask & !left, step.half), (0, quad.half));
                    left &= !step.mask;
                    assert_eq!(step.last, quad.last && left == 0);
                }
            }
        }
        self.rest(memory);
    }

    /// Invalidates the cache.
    pub fn forget(&mut self) {
        assert!(self.module.is_high(self.ports.idle));
        self.module.drive("forget", 1);
        self.module.clock();
        self.module.drive("forget", 0);
    }

    /// Drives a quad for this clock, if there is one with a credit. The second item of a quad is sent a clock later.
    fn drive_quad(&mut self) {
        let may = self.module.is_high(self.ports.credit) && !self.stalls[0].next_stalled();
        let quad = (may && !self.follows).then(|| self.quads.pop_front());
        let quad = quad.flatten();
        let sent = self.follows || quad.is_some();
        self.module.set_value(self.ports.sent, sent.into());
        let [valid, mask, half, last, level, positions] = self.ports.quad;
        self.module.set_value(valid, quad.is_some().into());
        self.follows = false;
        if let Some(quad) = quad {
            let is_bilinear = self.module.is_high(self.ports.bilinear);
            self.follows = is_bilinear && quad.mask & 0x3 != 0 && quad.mask & 0xC != 0;
            let placed = [0, 1].into_iter().flat_map(|axis: usize| {
                quad.positions.map(|position| {
                    let position = position[axis];
                    let flags = i64::from(position < 0) << 2
                        | i64::from(position >= REPEAT) << 1
                        | position.div_euclid(REPEAT) & 1;
                    flags << 15 | position.rem_euclid(REPEAT) >> 3
                })
            });
            self.module.set(mask, u64::from(quad.mask));
            self.module.set(half, u64::from(quad.half));
            self.module.set(last, u64::from(quad.last));
            self.module.set(level, u64::from(quad.level));
            self.module.set(positions, Bits::pack(18, placed));
        }
    }

    /// Checks that the sampler is idle and sends no further steps.
    fn rest(&mut self, memory: &Memory) {
        for _ in 0..20 {
            assert!(self.clock(memory).is_none(), "a step after the last quad");
        }
        assert!(self.module.is_high(self.ports.idle));
        assert!(
            self.asked.is_empty(),
            "requested words that the sampler did not take"
        );
    }

    fn clock(&mut self, memory: &Memory) -> Option<Step> {
        let now = self.module.cycles();
        self.drive_quad();
        let has_room = self.asked.len() < PORT_WORDS && !self.stalls[1].next_stalled();
        self.module.set_value(self.ports.ask[1], has_room.into());
        let may_leave = !self.stalls[3].next_stalled();
        self.module.set_value(self.ports.room, may_leave.into());
        let stalled = self.stalls[2].next_stalled();
        self.shown |= !stalled && self.asked.front().is_some_and(|&(due, _)| due <= now);
        self.module.set_value(self.ports.data[0], self.shown.into());
        if let Some(&(_, address)) = self.asked.front().filter(|_| self.shown) {
            self.module.set(self.ports.data[2], memory.word(address));
        }
        self.module.settle();
        let module = &self.module;
        if module.is_high(self.ports.ask[0]) && has_room {
            let address = module.value(self.ports.ask[2]) as u32;
            self.asked.push_back((now + self.latency, address));
        }
        if self.shown && module.is_high(self.ports.data[1]) {
            self.asked.pop_front();
            self.shown = false;
            self.words += 1;
        }
        let step = module.is_high(self.ports.valid).then(|| Step {
            mask: module.value(self.ports.mask) as u8,
            half: module.is_high(self.ports.half),
            last: module.is_high(self.ports.last),
            opaque: module.value(self.ports.opaque) as u8,
            texels: module.get(self.ports.texels),
            neighbours: module.get(self.ports.neighbours),
            weights: module.get(self.ports.weights),
        });
        self.module.clock();
        step
    }

    /// Sends quads on a texture, and compares all steps. Returns the number of clocks from the first to the last step.
    pub fn check(&mut self, memory: &Memory, quads: &[Quad]) -> u64 {
        self.quads.extend(quads);
        let texture = memory.texture();
        let limit = self.module.cycles() + 1000 + quads.len() as u64 * (200 + 20 * self.latency);
        let mut first = None;
        for (number, quad) in quads.iter().enumerate() {
            let mut left = quad.mask;
            for mask in steps(&texture, quad) {
                let step = loop {
                    assert!(
                        self.module.cycles() < limit,
                        "seed {}, quad {number}: no step",
                        self.seed
                    );
                    if let Some(step) = self.clock(memory) {
                        break step;
                    }
                };
                first.get_or_insert(self.module.cycles());
                self.compare(&texture, quad, number, mask, &step, &mut left);
            }
            assert_eq!(left, 0, "lanes without a step");
        }
        let end = self.module.cycles();
        self.rest(memory);
        end - first.unwrap_or(end)
    }

    fn compare(
        &self,
        texture: &Texture,
        quad: &Quad,
        number: usize,
        mask: u8,
        step: &Step,
        left: &mut u8,
    ) {
        let is_bilinear = texture.sampler().filter == Filter::Bilinear;
        let context = format!(
            "seed {}, quad {number}: {quad:?} of {:?}, {:?}, {:?}, {is_bilinear}; step {:#06b}",
            self.seed,
            texture.format(),
            texture.size_log2(),
            texture.sampler(),
            step.mask
        );
        assert_eq!(step.mask, mask, "{context}");
        *left &= !step.mask;
        assert_eq!(step.half, quad.half, "{context}");
        assert_eq!(step.last, quad.last && *left == 0, "{context}");
        assert_eq!(self.module.is_high(self.ports.bilinear), is_bilinear);
        for lane in (0..4).filter(|lane| step.mask >> lane & 1 != 0) {
            let context = format!("lane {lane} of {context}");
            let mut expected = texels(texture, quad.level, quad.positions[lane]);
            let is_opaque = step.opaque >> lane & 1 != 0;
            let found = if is_bilinear {
                let pixel = lane % 2;
                Texels {
                    nearest: expected.nearest.filter(|_| is_opaque),
                    neighbours: [0, 1, 2, 3]
                        .map(|i| step.neighbours.element(16, 4 * pixel + i) as u16),
                    weights: [0, 1].map(|axis| step.weights.element(4, 2 * pixel + axis) as u8),
                }
            } else {
                Texels {
                    nearest: is_opaque.then(|| step.texels.element(16, lane) as u16),
                    ..expected
                }
            };
            assert_eq!(is_opaque, expected.nearest.is_some(), "{context}");
            if expected.nearest.is_none() {
                expected.neighbours = found.neighbours;
            }
            assert_eq!(found, expected, "{context}");
            check_sample(texture, quad.level, quad.positions[lane], &found);
        }
    }
}
