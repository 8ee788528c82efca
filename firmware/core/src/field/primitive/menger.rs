//! `menger:DEPTH`: the Menger sponge.

use core::fmt;

use crate::field::argument::Arguments;
use crate::field::error::FieldError;
use crate::field::folded::{Folded, largest};
use crate::field::shape::{FieldKind, FlatConstants, FlatSolid, Member, Placed};
use crate::field::surface::{FRACTION, FieldSample, magnitude};
use crate::fixed::Q32_32;

/// The largest number of levels of holes.
pub const MAX_DEPTH: u8 = 6;

/// The Menger sponge in [−1, 1]³.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Menger {
    /// Number of levels of holes, 1 to [`MAX_DEPTH`].
    pub depth: u8,
}

impl FieldKind for Menger {
    type Solid = FixedSponge;

    const NAME: &'static str = "menger";
    const FORM: &'static str = "menger:DEPTH";
    const ABOUT: &'static str = "the Menger sponge in [-1, 1]^3, depth 1 to 6";
    const EXAMPLE: &'static str = "menger:4";
    const LOOK: &'static [&'static str] = &["camera 4 30 60"];
    const MEMBER: Option<Member> = Some(Member::First);

    fn read<'a>(numbers: &mut impl Arguments<'a>) -> Result<Self, FieldError<'a>> {
        let depth = numbers.integer("depth", [1, MAX_DEPTH])?;
        Ok(Self { depth })
    }

    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.depth)
    }

    fn placed(&self) -> Placed<FixedSponge> {
        let last = LEVELS[usize::from(self.depth.clamp(1, MAX_DEPTH)) - 1];
        let sponge = FixedSponge {
            levels: LEVELS,
            depth: self.depth,
            half: last / 2,
        };
        Placed::bounded(sponge, [Q32_32::ONE; 3])
    }
}

/// The side S of the cubes of each level: 81/3^i for level i from 1, rounded to an even multiple of 2^−12.
const LEVELS: [i32; MAX_DEPTH as usize] = {
    let one = 1 << FRACTION;
    let third = (one / 2 + 1) / 3 * 2;
    let ninth = (one / 2 + 4) / 9 * 2;
    [27 * one, 9 * one, 3 * one, one, third, ninth]
};

/// The sponge with lengths in field units; half its side is 40.5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedSponge {
    /// The side S of the cubes of each level: 27, 9, 3, 1, 1/3, 1/9, each an even multiple of 2^−12.
    levels: [i32; MAX_DEPTH as usize],
    /// Number of levels that are evaluated: the first `depth` entries of `levels`.
    depth: u8,
    /// Half the side S of the cubes of the last level.
    half: i32,
}

impl FlatSolid for FixedSponge {
    const CODE: u8 = 0;

    /// Evaluates the levels from the largest cubes to the smallest. Each level folds space by mirrors: they map all cubes of the
    /// level's side S onto one cube about the origin, and the level's holes onto the outside of this cube.
    ///
    /// S − |x| replaces every coordinate x; it is above S/2 if x is in the middle third. A point is in a hole if at
    /// least two coordinates are in the middle third. Therefore the largest new coordinate is mirrored at S/2 if it is above S/2: all
    /// points outside the holes are then in the cube |x| ≤ S/2, and points in a hole are not. Mirrors and permutations preserve the
    /// maximum norm.
    #[inline]
    fn sample(&self, point: [i32; 3]) -> FieldSample {
        let mut p = Folded::of(point);
        for &s in self.levels.iter().take(usize::from(self.depth)) {
            p = p.map(|x| x.negated_if(x.value >= 0).plus(s));
            let big = largest(p.map(|x| x.value));
            p.swap(1, big);
            let low = p[1].value < s / 2;
            p[1] = p[1].negated_if(low).plus(if low { 0 } else { -s });
        }
        let p = p.map(|x| x.negated_if(x.value < 0));
        let big = p[largest(p.map(|x| x.value))];
        FieldSample {
            distance: big.value - self.half,
            surface: big.face(),
        }
    }

    /// Folds like `sample`, but without the directions of the coordinates. The order of the coordinates then has no effect, so
    /// each level sorts them.
    #[inline]
    fn distance(&self, point: [i32; 3]) -> i32 {
        let mut p = point;
        for &s in self.levels.iter().take(usize::from(self.depth)) {
            let [x, y, z] = p.map(|x| s + !(magnitude(x) as i32));
            let (low, high) = (x.min(y), x.max(y));
            let big = high.max(z);
            let big = if big < s / 2 { !big } else { big - s };
            p = [low.min(z), low.max(high.min(z)), big];
        }
        let [x, y, z] = p.map(|x| magnitude(x) as i32);
        x.max(y).max(z) - self.half
    }

    fn constants(&self) -> FlatConstants {
        FlatConstants {
            kind: Self::CODE,
            levels: ((1_u32 << self.depth) - 1) as u8,
            half: [self.half as u32; 3],
            ..FlatConstants::default()
        }
    }

    fn of(constants: &FlatConstants) -> Self {
        Self {
            levels: LEVELS,
            depth: (constants.levels.trailing_ones() as u8).min(MAX_DEPTH),
            half: constants.half[0] as i32,
        }
    }
}
