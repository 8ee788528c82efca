//! Distances to solids in field units (12 fraction bits), and which surface is the nearest.

use super::sphere::Balls;

/// Fraction bits of field units.
pub(super) const FRACTION: u32 = 12;

/// What is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A face that is perpendicular to an axis.
    Face {
        /// 0, 1, 2: x, y, z.
        axis: u8,
        /// Whether its normal points along the axis, and not against it.
        positive: bool,
    },
    /// A sphere's.
    Round {
        /// Which one, from 0.
        number: u8,
    },
    /// Of a union with a fillet: a face's, a sphere's, or what is between them.
    Blended {
        /// The face's axis.
        axis: u8,
        /// Whether its normal points along the axis.
        positive: bool,
        /// The sphere.
        number: u8,
        /// The part of the sphere in it, u0.8: 0 is the face.
        share: u8,
    },
}

impl Surface {
    /// The face as the gateware has it: twice its axis, and 1 if it is positive.
    pub const fn face(self) -> Option<u8> {
        match self {
            Self::Face { axis, positive } | Self::Blended { axis, positive, .. } => {
                Some(2 * axis + positive as u8)
            }
            Self::Round { .. } => None,
        }
    }

    /// The sphere's number.
    pub const fn number(self) -> Option<u8> {
        match self {
            Self::Face { .. } => None,
            Self::Round { number } | Self::Blended { number, .. } => Some(number),
        }
    }

    /// The part of the sphere in it, 255 of a sphere alone.
    pub const fn share(self) -> u8 {
        match self {
            Self::Face { .. } => 0,
            Self::Round { .. } => 255,
            Self::Blended { share, .. } => share,
        }
    }
}

/// A distance and what it is to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// In the maximum norm of what has faces: the cube of this half side about the point holds nothing of the solid's surface. In
    /// the Euclidean one of what is round. s10.12.
    pub distance: i32,
    /// What is there.
    pub surface: Surface,
}

/// A solid as the gateware has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// The Menger sponge of half side 40.5.
    Menger {
        /// S of every level that there is: 27, 9, 3, 1, 1/3, 1/9, each an even number of 2^−12.
        levels: [i32; 6],
        /// How many of them count.
        depth: u8,
        /// Half the side of the cubes that are left: half of the last S.
        half: i32,
    },
    /// Boxes, or the room inside one.
    Box {
        /// Half of each side; `None` where the box has no end.
        half: [Option<i32>; 3],
        /// Whether the solid is what is outside.
        room: bool,
        /// Whether it repeats itself every 64 units along each axis.
        repeated: bool,
    },
    /// Spheres.
    Balls(Balls),
}

impl Solid {
    /// The distance of a point, each coordinate s10.12.
    pub fn sample(&self, point: [i32; 3]) -> Sample {
        match self {
            Self::Menger {
                levels,
                depth,
                half,
            } => menger(point, levels.iter().take(usize::from(*depth)), *half),
            Self::Box {
                half,
                room,
                repeated,
            } => cuboid(point, half, *room, *repeated),
            Self::Balls(balls) => balls.sample(point),
        }
    }

    /// The spheres of it.
    pub const fn balls(&self) -> Option<&Balls> {
        match self {
            Self::Balls(balls) => Some(balls),
            _ => None,
        }
    }
}

/// A coordinate on its way through the folds: its value, and the direction in the world in which it grows.
///
/// A coordinate k stands for k + 1/2, the middle of what was cut to k: so −x is exactly `!k`, and a mirror takes no carry.
#[derive(Clone, Copy)]
struct Folded {
    value: i32,
    axis: u8,
    positive: bool,
}

impl Folded {
    /// −x, or x.
    fn negated_if(self, negate: bool) -> Self {
        if negate {
            Self {
                value: !self.value,
                positive: !self.positive,
                ..self
            }
        } else {
            self
        }
    }

    fn plus(self, offset: i32) -> Self {
        Self {
            value: self.value + offset,
            ..self
        }
    }

    /// The face across its axis.
    const fn face(self) -> Surface {
        Surface::Face {
            axis: self.axis,
            positive: self.positive,
        }
    }
}

/// The lowest bits of a number, the highest of them its sign.
pub(super) const fn cropped(x: i32, bits: u32) -> i32 {
    let beyond = 32 - bits;
    x << beyond >> beyond
}

/// The coordinates of a point in the world.
fn unfolded(point: [i32; 3]) -> [Folded; 3] {
    [0, 1, 2].map(|axis: u8| Folded {
        value: point[usize::from(axis)],
        axis,
        positive: true,
    })
}

/// Which of three numbers is the largest; of equals the second, then the first.
fn largest([x, y, z]: [i32; 3]) -> usize {
    if z > x && z > y {
        2
    } else if x > y {
        0
    } else {
        1
    }
}

/// The sponge: each level mirrors space until one of its cubes is left, and the hole through it has become its outside.
///
/// S − |x| is above S/2 where a coordinate lies in the middle third. A point is in a hole where two coordinates do; so the
/// largest is mirrored at S/2, by which the hole falls outside of the cube |x| ≤ S/2 and everything else stays as
/// it was. Mirrors and permutations keep the maximum norm.
fn menger<'a>(point: [i32; 3], levels: impl Iterator<Item = &'a i32>, half: i32) -> Sample {
    let mut p = unfolded(point);
    for &s in levels {
        p = p.map(|x| x.negated_if(x.value >= 0).plus(s));
        let big = largest(p.map(|x| x.value));
        p.swap(1, big);
        let low = p[1].value < s / 2;
        p[1] = p[1].negated_if(low).plus(if low { 0 } else { -s });
    }
    let p = p.map(|x| x.negated_if(x.value < 0));
    let big = p[largest(p.map(|x| x.value))];
    Sample {
        distance: big.value - half,
        surface: big.face(),
    }
}

/// A box: the largest of |x| − half.
fn cuboid(point: [i32; 3], half: &[Option<i32>; 3], room: bool, repeated: bool) -> Sample {
    // 64 units are 2^18: the middle of the cell in which the point lies is where the lowest 18 bits are 0.
    let wrap = |x: i32| {
        if repeated {
            cropped(x, 6 + FRACTION)
        } else {
            x
        }
    };
    let p = unfolded(point.map(wrap)).map(|x| x.negated_if(x.value < 0));
    // Beyond all that there is: below −2^21 and no larger in magnitude than 23 bits hold.
    let nowhere = -1 << (10 + FRACTION);
    let outside = [0, 1, 2].map(|i: usize| half[i].map_or(nowhere, |half| p[i].value - half));
    let big = largest(outside);
    let nearest = Folded {
        value: outside[big],
        ..p[big]
    }
    .negated_if(room);
    Sample {
        distance: nearest.value,
        surface: nearest.face(),
    }
}
