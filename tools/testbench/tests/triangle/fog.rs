//! Tests of the fog on groups of pixels, which must equal the model's.

use glint_core::colour::{Rgb565, Rounding};
use glint_model::Fog;
use glint_testbench::{Bits, Pipe, drive_fog};
use glint_vectors::Random;

/// The input of the module for a group. `beside` passes through unchanged; `is_added` is set if the colours are added to the picture.
struct Group {
    beside: u64,
    line: u64,
    mask: u64,
    codes: [u32; 8],
    /// RGB565 channels with fraction bits, 8 bits each.
    colours: [[u8; 3]; 8],
    is_added: bool,
}

impl Group {
    fn random(random: &mut Random, codes: [u32; 8]) -> Self {
        Self {
            beside: random.integer(0, 255) as u64,
            line: random.integer(0, 3) as u64,
            mask: match random.integer(0, 3) {
                0 => 1 << random.integer(0, 7),
                1 => 0xFF,
                _ => random.integer(1, 255) as u64,
            },
            codes,
            colours: [(); 8].map(|()| [248, 252, 248].map(|full| random.integer(0, full) as u8)),
            is_added: random.integer(0, 7) == 0,
        }
    }

    fn sent(&self) -> Vec<Bits> {
        vec![
            self.beside.into(),
            self.line.into(),
            self.mask.into(),
            Bits::pack(18, self.codes),
            Bits::pack(8, self.colours.as_flattened().iter().copied()),
            u64::from(self.is_added).into(),
        ]
    }
}

struct Bench {
    pipe: Pipe,
    random: Random,
}

impl Bench {
    fn new(seed: u32, shares: [f64; 2]) -> Self {
        let sent = ["beside", "line", "mask", "codes", "colours", "added"];
        let received = ["beside", "mask", "codes", "colours"];
        Self {
            pipe: Pipe::new("group_fog", seed, ("in", &sent), ("out", &received), shares),
            random: Random(seed.into()),
        }
    }

    /// Sends groups in `fog`, or without fog if it is `None`, and checks the outputs. Returns the number of clocks.
    fn check(&mut self, fog: Option<&Fog>, groups: &[Group]) -> u64 {
        let first_line = self.random.integer(0, 3) as u32;
        let module = &mut self.pipe.module;
        module.drive("enable", u64::from(fog.is_some()));
        module.drive("first_line", first_line);
        let rounding = Rounding::new(self.random.coin());
        module.drive("dither", rounding == Rounding::Dithered);
        if let Some(fog) = fog {
            drive_fog(module, fog);
        }
        for group in groups {
            self.pipe.source.push(group.sent());
        }
        let idle = self.pipe.module.port("idle");
        let limit = 16 * groups.len() as u64 + 100;
        let clocks = self.pipe.drain(limit, idle, |_| {});
        let found = self.pipe.sink.take();
        assert_eq!(found.len(), groups.len());
        for (group, found) in groups.iter().zip(found) {
            let [beside, mask, codes, colours] = &found[..] else {
                panic!("{found:?}");
            };
            assert_eq!(beside.number(), group.beside);
            assert_eq!(mask.number(), group.mask);
            assert_eq!(*codes, Bits::pack(18, group.codes));
            for lane in (0..8).filter(|lane| group.mask >> lane & 1 == 1) {
                let (code, colour) = (group.codes[lane], group.colours[lane]);
                let place = [lane as u32, group.line as u32 + first_line];
                let expected = fog.map_or(colour, |fog| {
                    let target = if group.is_added { [0; 3] } else { fog.colour };
                    fog.over(target, colour, code)
                });
                let expected = Rgb565::rounded(expected, rounding, place);
                assert_eq!(
                    colours.element(16, lane),
                    u64::from(expected.0),
                    "code {code:#x}, colour {colour:?}, lane {lane}, line {} + {first_line}, {fog:?}",
                    group.line
                );
            }
        }
        clocks
    }

    fn fog(&mut self) -> Fog {
        let colour = [(); 3].map(|()| self.random.integer(0, 255) as u8);
        Fog::in_perspective(self.random.integer(-4096, 4095) as i32, colour)
    }
}

/// Every depth code, with offsets that place the table at the far, the middle and the near codes.
#[test]
fn every_code() {
    let mut bench = Bench::new(1, [0.0; 2]);
    for offset in [0, 700, 1500] {
        let fog = Fog::in_perspective(offset, [200, 180, 248]);
        let groups: Vec<Group> = (0..1 << 15)
            .map(|number| {
                let codes = [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| (8 * number + lane).max(1));
                Group {
                    mask: 0xFF,
                    ..Group::random(&mut bench.random, codes)
                }
            })
            .collect();
        let clocks = bench.check(Some(&fog), &groups);
        println!("{} groups: {clocks} clocks", groups.len());
        // Two quads in each group.
        assert!(clocks <= 2 * groups.len() as u64 + 20, "{clocks} clocks");
    }
}

/// Random groups under stalls: in fog of any offset and colour, and without fog.
#[test]
fn random_groups() {
    for (seed, shares) in [
        (2, [0.0; 2]),
        (3, [0.5, 0.0]),
        (4, [0.0, 0.5]),
        (5, [0.3; 2]),
    ] {
        let mut bench = Bench::new(seed, shares);
        for frame in 0..40 {
            let fog = (frame % 5 != 4).then(|| bench.fog());
            let groups: Vec<Group> = (0..100)
                .map(|_| {
                    let bits = bench.random.integer(1, 18);
                    let codes = [(); 8].map(|()| bench.random.integer(1, (1 << bits) - 1) as u32);
                    Group::random(&mut bench.random, codes)
                })
                .collect();
            bench.check(fog.as_ref(), &groups);
        }
    }
}
