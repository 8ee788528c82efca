//! Scenes that are given by a distance field instead of a mesh.
//!
//! A field is named as people type it: a kind, a colon and its numbers in world units, such as `menger:4` or
//! `cubes:2,0.5`. A [`Field`] can only be made through checks, so that what follows may rely on its ranges.

use core::fmt;

use crate::fixed::{Q32_32, Turns};

/// The farthest from the origin that anything of a bounded field may be, along an axis.
pub const MAX_EXTENT: Q32_32 = Q32_32::lit("12");
/// The periods of a field that repeats itself.
pub const PERIOD: [Q32_32; 2] = [Q32_32::lit("0.25"), Q32_32::lit("16")];
/// The smallest thing.
const SMALLEST: Q32_32 = Q32_32::lit("0.01");
/// How wide the fillet of a smooth union is.
const BLEND: [Q32_32; 2] = [Q32_32::lit("0.01"), Q32_32::lit("0.5")];
/// The deepest sponge.
pub const MAX_DEPTH: u8 = 6;
/// The most spheres of one field.
pub const MAX_SPHERES: usize = 8;

/// A solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// The Menger sponge that fills [−1, 1]³.
    Menger {
        /// How often it is hollowed out, 1 to 6.
        depth: u8,
    },
    /// A box about the origin.
    Box {
        /// Half of each side.
        half: [Q32_32; 3],
    },
    /// Cubes at all multiples of the period, in all of space.
    Cubes {
        /// From centre to centre.
        period: Q32_32,
        /// Half of a cube's side, below half the period.
        half: Q32_32,
    },
    /// A floor and a ceiling, which recede to the horizon.
    Planes {
        /// The height of the ceiling above the origin, and the depth of the floor below it.
        half: Q32_32,
    },
    /// A sphere about the origin.
    Sphere {
        /// Its radius.
        radius: Q32_32,
    },
    /// Some spheres: [`Field::spheres`].
    Spheres(Spheres),
    /// Spheres at all multiples of the period, in all of space.
    Lattice {
        /// From centre to centre.
        period: Q32_32,
        /// Of each sphere, below half the period.
        radius: Q32_32,
    },
    /// A sphere that circles about the z axis at height 0.
    Moving {
        /// Its radius.
        radius: Q32_32,
        /// From the origin to its centre.
        orbit: Q32_32,
        /// How far it has come from the x axis towards the y axis.
        angle: Turns,
    },
    /// What is in either.
    Union {
        /// What has faces.
        flat: Flat,
        /// What is round.
        round: Round,
        /// The difference of the distances to both up to which a fillet between them reaches; 0: there is none.
        blend: Q32_32,
    },
}

/// A member of a union that has faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flat {
    /// [`Field::Menger`].
    Menger {
        /// How often it is hollowed out, 1 to 6.
        depth: u8,
    },
    /// [`Field::Box`].
    Box {
        /// Half of each side.
        half: [Q32_32; 3],
    },
}

/// A member of a union that is round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is nowhere to box the spheres"
)]
pub enum Round {
    /// [`Field::Sphere`].
    Sphere {
        /// Its radius.
        radius: Q32_32,
    },
    /// [`Field::Spheres`].
    Spheres(Spheres),
    /// [`Field::Moving`].
    Moving {
        /// Its radius.
        radius: Q32_32,
        /// From the origin to its centre.
        orbit: Q32_32,
        /// How far it has come from the x axis towards the y axis.
        angle: Turns,
    },
}

impl From<Flat> for Field {
    fn from(flat: Flat) -> Self {
        match flat {
            Flat::Menger { depth } => Self::Menger { depth },
            Flat::Box { half } => Self::Box { half },
        }
    }
}

impl From<Round> for Field {
    fn from(round: Round) -> Self {
        match round {
            Round::Sphere { radius } => Self::Sphere { radius },
            Round::Spheres(spheres) => Self::Spheres(spheres),
            Round::Moving {
                radius,
                orbit,
                angle,
            } => Self::Moving {
                radius,
                orbit,
                angle,
            },
        }
    }
}

/// A sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sphere {
    /// Its centre.
    pub centre: [Q32_32; 3],
    /// Its radius.
    pub radius: Q32_32,
}

impl Sphere {
    /// A sphere within [`MAX_EXTENT`].
    fn checked(self) -> Result<Self, FieldError<'static>> {
        check("radius", self.radius, [SMALLEST, MAX_EXTENT])?;
        let room = MAX_EXTENT - self.radius;
        for coordinate in self.centre {
            check("centre", coordinate, [-room, room])?;
        }
        Ok(self)
    }
}

/// One sphere to [`MAX_SPHERES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spheres {
    list: [Sphere; MAX_SPHERES],
    count: usize,
}

impl Spheres {
    /// Each of them.
    pub fn iter(&self) -> impl Iterator<Item = &Sphere> {
        self.list.iter().take(self.count)
    }
}

impl Field {
    /// Some spheres, [`MAX_SPHERES`] at most.
    ///
    /// # Errors
    /// There is none or one too many, or the first number that is not in its range.
    pub fn spheres(spheres: &[Sphere]) -> Result<Self, FieldError<'static>> {
        let mut list = [Sphere::default(); MAX_SPHERES];
        let count = spheres.len();
        if count == 0 || count > MAX_SPHERES {
            return Err(FieldError::Spheres);
        }
        for (place, sphere) in list.iter_mut().zip(spheres) {
            *place = sphere.checked()?;
        }
        Ok(Self::Spheres(Spheres { list, count }))
    }

    /// A field whose numbers are in their ranges.
    ///
    /// # Errors
    /// The first number that is not.
    pub fn checked(self) -> Result<Self, FieldError<'static>> {
        match self {
            Self::Menger { depth } => {
                let depth = Q32_32::from_num(depth);
                check("depth", depth, [Q32_32::ONE, Q32_32::from_num(MAX_DEPTH)])?;
            }
            Self::Box { half } => {
                for side in half {
                    check("half", side, [SMALLEST, MAX_EXTENT])?;
                }
            }
            Self::Cubes { period, half } => {
                check("period", period, PERIOD)?;
                check("half", half, [SMALLEST, period / 2 - Q32_32::DELTA])?;
            }
            Self::Planes { half } => check("half", half, [SMALLEST, MAX_EXTENT])?,
            Self::Sphere { radius } => check("radius", radius, [SMALLEST, MAX_EXTENT])?,
            // Made by its own check.
            Self::Spheres(_) => {}
            Self::Lattice { period, radius } => {
                check("period", period, PERIOD)?;
                check("radius", radius, [SMALLEST, period / 2 - Q32_32::DELTA])?;
            }
            Self::Moving { radius, orbit, .. } => {
                check("radius", radius, [SMALLEST, MAX_EXTENT])?;
                check("orbit", orbit, [Q32_32::ZERO, MAX_EXTENT - radius])?;
            }
            Self::Union { flat, round, blend } => {
                if blend != Q32_32::ZERO {
                    check("k", blend, BLEND)?;
                }
                Self::from(flat).checked()?;
                Self::from(round).checked()?;
            }
        }
        Ok(self)
    }

    /// Whether any of it is round, and not a face across an axis.
    pub const fn is_round(&self) -> bool {
        match self {
            Self::Menger { .. } | Self::Box { .. } | Self::Cubes { .. } | Self::Planes { .. } => {
                false
            }
            Self::Sphere { .. }
            | Self::Spheres(_)
            | Self::Lattice { .. }
            | Self::Moving { .. }
            | Self::Union { .. } => true,
        }
    }

    /// Reads a field as it is typed, such as `menger:4`.
    ///
    /// # Errors
    /// The kind is unknown, a number is missing or is none, or one is out of its range.
    pub fn parse(text: &str) -> Result<Self, FieldError<'_>> {
        let (kind, numbers) = text.split_once(':').unwrap_or((text, ""));
        match kind {
            "spheres" => return parse_spheres(kind, numbers),
            "union" => return parse_union(numbers, Q32_32::ZERO),
            "smooth" => {
                let (blend, members) = numbers.split_once(',').ok_or(FieldError::Union)?;
                let blend = Words::new(kind, blend).next("k")?;
                check("k", blend, BLEND)?;
                return parse_union(members, blend);
            }
            _ => {}
        }
        let mut words = Words::new(kind, numbers);
        let field = match kind {
            "menger" => {
                let depth = words.next("depth")?;
                // What is no such number is beyond the range.
                let whole = depth.checked_to_num().filter(|&whole: &u8| depth == whole);
                Self::Menger {
                    depth: whole.unwrap_or(0),
                }
            }
            "box" => Self::Box {
                half: [words.next("x")?, words.next("y")?, words.next("z")?],
            },
            "cubes" => Self::Cubes {
                period: words.next("period")?,
                half: words.next("half")?,
            },
            "planes" => Self::Planes {
                half: words.next("half")?,
            },
            "sphere" => Self::Sphere {
                radius: words.next("radius")?,
            },
            "lattice" => Self::Lattice {
                period: words.next("period")?,
                radius: words.next("radius")?,
            },
            "moving" => Self::Moving {
                radius: words.next("radius")?,
                orbit: words.next("orbit")?,
                angle: match words.next_if_any("angle")? {
                    Some(degrees) => Turns::from_degrees(degrees),
                    None => Turns::default(),
                },
            },
            _ => return Err(FieldError::Kind { kind }),
        };
        words.end()?;
        field.checked()
    }
}

/// The numbers behind a kind, commas between them.
struct Words<'a> {
    kind: &'a str,
    words: core::str::Split<'a, char>,
}

impl<'a> Words<'a> {
    fn new(kind: &'a str, numbers: &'a str) -> Self {
        let words = numbers.split(',');
        Self { kind, words }
    }

    fn word(&mut self) -> Option<&'a str> {
        self.words.find(|word| !word.is_empty())
    }

    fn next(&mut self, name: &'static str) -> Result<Q32_32, FieldError<'a>> {
        let kind = self.kind;
        self.next_if_any(name)?
            .ok_or(FieldError::Missing { kind, name })
    }

    fn next_if_any(&mut self, name: &'static str) -> Result<Option<Q32_32>, FieldError<'a>> {
        let read = |word| Q32_32::from_str(word).map_err(|_| FieldError::Number { name, word });
        self.word().map(read).transpose()
    }

    fn end(&mut self) -> Result<(), FieldError<'a>> {
        let kind = self.kind;
        self.word()
            .map_or(Ok(()), |word| Err(FieldError::Extra { kind, word }))
    }
}

/// Reads what stands behind `spheres:`, each sphere's centre and radius, semicolons between them.
fn parse_spheres<'a>(kind: &'a str, text: &'a str) -> Result<Field, FieldError<'a>> {
    let mut list = [Sphere::default(); MAX_SPHERES];
    let mut count = 0;
    for numbers in text.split(';').filter(|numbers| !numbers.is_empty()) {
        let mut words = Words::new(kind, numbers);
        let sphere = Sphere {
            centre: [words.next("x")?, words.next("y")?, words.next("z")?],
            radius: words.next("radius")?,
        };
        words.end()?;
        *list.get_mut(count).ok_or(FieldError::Spheres)? = sphere;
        count += 1;
    }
    Field::spheres(list.get(..count).unwrap_or_default())
}

/// Reads what stands behind `union:`, a field with faces and a round one, a plus between them.
fn parse_union(text: &str, blend: Q32_32) -> Result<Field, FieldError<'_>> {
    let (flat, round) = text.split_once('+').ok_or(FieldError::Union)?;
    let flat = match Field::parse(flat)? {
        Field::Menger { depth } => Flat::Menger { depth },
        Field::Box { half } => Flat::Box { half },
        _ => return Err(FieldError::Union),
    };
    let round = match Field::parse(round)? {
        Field::Sphere { radius } => Round::Sphere { radius },
        Field::Spheres(spheres) => Round::Spheres(spheres),
        Field::Moving {
            radius,
            orbit,
            angle,
        } => Round::Moving {
            radius,
            orbit,
            angle,
        },
        _ => return Err(FieldError::Union),
    };
    Ok(Field::Union { flat, round, blend })
}

fn check(
    name: &'static str,
    value: Q32_32,
    [least, most]: [Q32_32; 2],
) -> Result<(), FieldError<'static>> {
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(FieldError::Range { name, least, most })
    }
}

/// As it is typed.
impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Menger { depth } => write!(f, "menger:{depth}"),
            Self::Box { half: [x, y, z] } => write!(f, "box:{x},{y},{z}"),
            Self::Cubes { period, half } => write!(f, "cubes:{period},{half}"),
            Self::Planes { half } => write!(f, "planes:{half}"),
            Self::Sphere { radius } => write!(f, "sphere:{radius}"),
            Self::Spheres(spheres) => {
                f.write_str("spheres")?;
                spheres.iter().enumerate().try_for_each(|(i, sphere)| {
                    let [x, y, z] = sphere.centre;
                    let radius = sphere.radius;
                    write!(f, "{}{x},{y},{z},{radius}", if i == 0 { ':' } else { ';' })
                })
            }
            Self::Lattice { period, radius } => write!(f, "lattice:{period},{radius}"),
            Self::Moving {
                radius,
                orbit,
                angle,
            } => {
                write!(f, "moving:{radius},{orbit}")?;
                match *angle {
                    Turns(0) => Ok(()),
                    angle => write!(f, ",{}", angle.to_degrees()),
                }
            }
            Self::Union { flat, round, blend } => {
                if *blend == Q32_32::ZERO {
                    f.write_str("union:")?;
                } else {
                    write!(f, "smooth:{blend},")?;
                }
                write!(f, "{}+{}", Self::from(*flat), Self::from(*round))
            }
        }
    }
}

/// The kinds of fields as they are typed, with what each is.
pub const KINDS: [(&str, &str); 10] = [
    (
        "menger:DEPTH",
        "the Menger sponge in [-1, 1]^3, depth 1 to 6",
    ),
    ("box:X,Y,Z", "a box about the origin, by half its sides"),
    ("cubes:PERIOD,HALF", "cubes everywhere, by half their side"),
    ("planes:HALF", "a floor and a ceiling at +-HALF"),
    ("sphere:R", "a sphere about the origin"),
    ("spheres:X,Y,Z,R;...", "up to 8 spheres"),
    ("lattice:PERIOD,R", "spheres everywhere"),
    (
        "moving:R,ORBIT[,DEGREES]",
        "a sphere that circles about the z axis",
    ),
    (
        "union:A+B",
        "A menger or box, B sphere, spheres or moving, both together",
    ),
    (
        "smooth:K,A+B",
        "the same with a fillet of the width K between them",
    ),
];

/// Why something is no field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldError<'a> {
    /// No kind has this name.
    Kind {
        /// What was typed.
        kind: &'a str,
    },
    /// A number is missing.
    Missing {
        /// The kind.
        kind: &'a str,
        /// What the number means.
        name: &'static str,
    },
    /// There is a number too many.
    Extra {
        /// The kind.
        kind: &'a str,
        /// The number.
        word: &'a str,
    },
    /// Something is no number.
    Number {
        /// What the number means.
        name: &'static str,
        /// What was typed.
        word: &'a str,
    },
    /// The members of a union are others than it may have.
    Union,
    /// There is no sphere, or there are more than [`MAX_SPHERES`].
    Spheres,
    /// A number is out of its range.
    Range {
        /// What the number means.
        name: &'static str,
        /// The smallest that is accepted.
        least: Q32_32,
        /// The largest.
        most: Q32_32,
    },
}

impl fmt::Display for FieldError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Kind { kind } => {
                write!(f, "no field is named {kind}: expected")?;
                KINDS.iter().enumerate().try_for_each(|(i, (form, _))| {
                    write!(f, "{} {form}", if i == 0 { "" } else { "," })
                })
            }
            Self::Missing { kind, name } => write!(f, "{kind} needs one more number: {name}"),
            Self::Extra { kind, word } => {
                write!(f, "{kind} has one number too many: {word}")
            }
            Self::Number { name, word } => write!(f, "{name} {word}: expected a number"),
            Self::Union => {
                f.write_str("union: expected menger or box, +, and sphere, spheres or moving")
            }
            Self::Spheres => write!(f, "spheres: expected 1 to {MAX_SPHERES}"),
            Self::Range { name, least, most } => {
                write!(f, "{name}: expected {least} to {most}")
            }
        }
    }
}

impl core::error::Error for FieldError<'_> {}
