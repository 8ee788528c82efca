//! The constants of cones in words, as the gateware and its registers store them (gateware/rtl/raymarch/sphere_unit.sv).

use super::cones::{Cone, ConeKind, Cones, Linear};
use super::rectangle::Rectangle;

impl Cone {
    /// Number of words of a cone.
    pub const WORDS: usize = 16;

    /// Number of words of a cone in which an eye sees a sphere. Only the cones of solid cones use the last word.
    pub const SPHERE_WORDS: usize = 15;

    /// The words of the cone. Numbers are in two's complement. A number of more than 32 bits takes two words, the low word first.
    pub fn words(&self) -> [u32; Self::WORDS] {
        let [columns, rows] = [self.rectangle.columns, self.rectangle.rows];
        let ([a, b], forward) = (self.sides, self.forward);
        let low = |x: i64| x as u32;
        let high = |x: i64| (x >> 32) as u32;
        let (mantissa, exponent) = self.distance;
        [
            columns[0] >> 3 | columns[1] >> 3 << 8,
            rows[0] | rows[1] << 10,
            low(a.across),
            low(a.down),
            low(b.down),
            low(forward.across),
            low(forward.down),
            low(a.first),
            high(a.first),
            low(b.first),
            high(b.first),
            low(forward.first),
            self.share as u32,
            mantissa as u32 | exponent << 24,
            u32::from(self.number) | self.shift << 2 | (self.kind as u32) << 5,
            low(b.across),
        ]
    }

    /// The cone with these [words](Self::words). Bits that the gateware does not read have no effect.
    pub fn of_words(words: &[u32; Self::WORDS]) -> Self {
        let signed = |x: i64, bits: u32| x << (64 - bits) >> (64 - bits);
        let step = |word: u32| signed(word.into(), 25);
        let first = |low: u32, high: u32| signed(i64::from(high) << 32 | i64::from(low), 46);
        let [columns, rows] = [words[0], words[1]];
        let linear = |first, across, down| Linear {
            first,
            across,
            down,
        };
        Self {
            kind: ConeKind::ALL[(words[14] >> 5 & 7) as usize],
            number: (words[14] & 7) as u8,
            rectangle: Rectangle {
                columns: [(columns & 0xFF) << 3, (columns >> 8 & 0xFF) << 3 | 7],
                rows: [rows & 0x3FF, rows >> 10 & 0x3FF],
            },
            forward: linear(signed(words[11].into(), 32), step(words[5]), step(words[6])),
            sides: [
                linear(first(words[7], words[8]), step(words[2]), step(words[3])),
                linear(first(words[9], words[10]), step(words[15]), step(words[4])),
            ],
            shift: words[14] >> 2 & 6,
            share: (words[12] & 0x1_FFFF).into(),
            distance: ((words[13] & 0xFF_FFFF).into(), words[13] >> 24 & 0xF),
        }
    }

    /// The words of a cone with an empty rectangle, for an eye without cones.
    pub fn unseen() -> [u32; Self::WORDS] {
        let mut words = [0; Self::WORDS];
        // In an empty rectangle, the first column exceeds the last one.
        words[0] = 1;
        words
    }
}

impl Cones {
    /// A list of these cones, in this order; cones that do not fit the list are dropped.
    pub fn of(cones: impl IntoIterator<Item = Cone>) -> Self {
        let mut all = Self::default();
        cones.into_iter().for_each(|cone| all.push(cone));
        all
    }
}
