//! Two eyes that look at one picture, each through glasses of its own colour.
//!
//! They are named as people type them: half the distance between them, the distance at which both see the same, and
//! the glasses, such as `0.05,3,red-cyan`.

use core::fmt;

use crate::choice::{Choice as _, choices};
use crate::fixed::Q32_32;

/// The half separations that are accepted.
pub const HALF_SEPARATION: [Q32_32; 2] = [Q32_32::ZERO, Q32_32::ONE];
/// The smallest distance at which both eyes may see the same; it is not below the half separation either.
const LEAST_PARALLAX: Q32_32 = Q32_32::lit("0.1");

/// How they are typed.
pub const FORM: &str = "E,ZERO[,red-blue|red-cyan]";

/// Which colour an eye sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tint {
    /// The left one red, the right one blue; green is the darker of both.
    #[default]
    RedBlue,
    /// The left one red, the right one green and blue.
    RedCyan,
}

choices!(Tint {
    RedBlue: "red-blue",
    RedCyan: "red-cyan"
});

/// Two eyes, beside each other along u.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stereo {
    /// From the camera's eye to each of the two, in world units: 0 to 1.
    pub half_separation: Q32_32,
    /// The distance along n at which both see the same place of the picture: at least the half separation, and 0.1.
    pub zero_parallax: Q32_32,
    /// Their colours.
    pub tint: Tint,
}

impl Stereo {
    /// Eyes whose numbers are in their ranges.
    ///
    /// # Errors
    /// The first number that is not.
    pub fn checked(self) -> Result<Self, StereoError<'static>> {
        let Self {
            half_separation,
            zero_parallax,
            ..
        } = self;
        if !(HALF_SEPARATION[0]..=HALF_SEPARATION[1]).contains(&half_separation) {
            return Err(StereoError::HalfSeparation(half_separation));
        }
        let least = half_separation.max(LEAST_PARALLAX);
        if zero_parallax < least {
            return Err(StereoError::ZeroParallax {
                zero_parallax,
                least,
            });
        }
        Ok(self)
    }

    /// Reads them as they are typed, such as `0.05,3`; the glasses are red and blue unless told.
    ///
    /// # Errors
    /// The text has not this form, or a number is out of its range.
    pub fn parse(text: &str) -> Result<Self, StereoError<'_>> {
        let mut words = text.split(',');
        let mut number = || Q32_32::from_str(words.next()?).ok();
        let (Some(half_separation), Some(zero_parallax)) = (number(), number()) else {
            return Err(StereoError::Form { text });
        };
        let tint = match words.next() {
            None => Some(Tint::default()),
            Some(word) => Tint::from_word(word),
        };
        match (tint, words.next()) {
            (Some(tint), None) => Self {
                half_separation,
                zero_parallax,
                tint,
            }
            .checked(),
            _ => Err(StereoError::Form { text }),
        }
    }
}

/// As they are typed.
impl fmt::Display for Stereo {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            half_separation,
            zero_parallax,
            tint,
        } = self;
        write!(f, "{half_separation},{zero_parallax},{}", tint.name())
    }
}

/// Why something is no pair of eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StereoError<'a> {
    /// It has another form.
    Form {
        /// What was typed.
        text: &'a str,
    },
    /// The half separation is out of range.
    HalfSeparation(Q32_32),
    /// Both see the same too near.
    ZeroParallax {
        /// The distance.
        zero_parallax: Q32_32,
        /// The smallest with this half separation.
        least: Q32_32,
    },
}

impl fmt::Display for StereoError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Form { text } => write!(f, "{text}: expected {FORM}"),
            Self::HalfSeparation(x) => write!(
                f,
                "E {x}: expected {} to {}",
                HALF_SEPARATION[0], HALF_SEPARATION[1]
            ),
            Self::ZeroParallax {
                zero_parallax,
                least,
            } => write!(f, "ZERO {zero_parallax}: expected at least {least}"),
        }
    }
}

impl core::error::Error for StereoError<'_> {}
