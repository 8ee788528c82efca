//! Motion of a picture over time: the rates of camera, objects and a sphere on its orbit.
//!
//! The text form is a list of parts with their rates in degrees a second, such as `azimuth 30 turn z -45`, or `off`.

use core::fmt;

use crate::choice::choices;
use crate::fixed::{Q32_32, Turns, U32_32};
use crate::matrix::Axis;

/// A rate in degrees a second, at most [`Rate::LIMIT`] in magnitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rate(Q32_32);

impl Rate {
    /// Largest magnitude: one turn a second.
    pub const LIMIT: Q32_32 = Q32_32::lit("360");

    /// The rate of this number of degrees a second; `None` beyond the limit.
    pub fn new(degrees: Q32_32) -> Option<Self> {
        (-Self::LIMIT..=Self::LIMIT)
            .contains(&degrees)
            .then_some(Self(degrees))
    }

    /// Whether nothing moves.
    pub const fn is_zero(self) -> bool {
        self.0.to_bits() == 0
    }

    /// The angle after `time` seconds: the product, rounded to nearest, modulo one turn. The angle is computed from the total time, so
    /// errors do not add up: up to a year the angle differs by at most one unit of [`Turns`] from the exact angle.
    pub const fn angle(self, time: U32_32) -> Turns {
        // From degrees a second with 32 fraction bits to turns a second with 62 fraction bits: times
        // 2^30/360 = 2^27/45. The result is at most 2^62 in magnitude.
        let degrees = self.0.to_bits();
        let turns = ((degrees / 45) << 27) + ((degrees % 45) << 27) / 45;
        // A product has 94 fraction bits, an angle 32; the conversion to 32 bits drops the whole turns.
        let product = turns as i128 * time.to_bits() as i128;
        Turns(((product + (1 << 61)) >> 62) as u32)
    }
}

/// Writes the number of degrees a second.
impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A rotation of objects, each about its own origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectTurn {
    /// Number of the rotating object, from 1; `None` for all objects.
    pub object: Option<u32>,
    /// The world axis to which the axis of rotation is parallel.
    pub axis: Axis,
    /// The rate, positive in the direction of [`Matrix::rotation`](crate::matrix::Matrix::rotation).
    pub rate: Rate,
}

/// A moving part of a picture.
#[derive(Clone, Copy)]
pub(crate) enum Part {
    Azimuth,
    Orbit,
    Turn,
}

choices!(Part {
    Azimuth: "azimuth",
    Orbit: "orbit",
    Turn: "turn",
});

/// The rates of all motion over time. By default nothing moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Animation {
    /// Rate of the azimuth of the camera on a sphere.
    pub azimuth: Rate,
    /// Rate of the angle of a sphere on an orbit.
    pub orbit: Rate,
    /// Rotation of one object or of all objects; `None` if no object rotates.
    pub turn: Option<ObjectTurn>,
}

impl Animation {
    /// Whether nothing moves.
    pub const fn is_off(&self) -> bool {
        self.azimuth.is_zero() && self.orbit.is_zero() && self.turn.is_none()
    }
}

/// Writes the text form: the parts that move, or `off`.
impl fmt::Display for Animation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let rates = [(Part::Azimuth, self.azimuth), (Part::Orbit, self.orbit)];
        let mut lead = "";
        for (part, rate) in rates {
            if !rate.is_zero() {
                write!(f, "{lead}{part} {rate}")?;
                lead = " ";
            }
        }
        if let Some(ObjectTurn { object, axis, rate }) = self.turn {
            write!(f, "{lead}{} ", Part::Turn)?;
            if let Some(number) = object {
                write!(f, "{number} ")?;
            }
            return write!(f, "{axis} {rate}");
        }
        f.write_str(if lead.is_empty() { "off" } else { "" })
    }
}
