//! Stereo: the pictures for two eyes combined in one picture for coloured glasses (an anaglyph).
//!
//! The text form is half the distance between the eyes, the distance of zero parallax, and the colours
//! of the glasses, such as `0.05,3,red-cyan`.

use core::fmt;

use crate::camera::View;
use crate::choice::{Choice as _, choices};
use crate::fixed::{Q4_28, Q32_32};

/// Smallest and largest accepted half separation of the eyes, in world units.
pub const HALF_SEPARATION: [Q32_32; 2] = [Q32_32::ZERO, Q32_32::ONE];
/// Smallest accepted distance of zero parallax, in world units. The distance must also be at least as large as the half
/// separation.
const LEAST_PARALLAX: Q32_32 = Q32_32::lit("0.1");

/// The text form, for help and error messages.
pub const FORM: &str = "E,ZERO[,red-blue|red-cyan]";

/// Colours of the glasses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tint {
    /// The left eye is red, the right eye blue; the green channel is the smaller of the two eyes' values.
    #[default]
    RedBlue,
    /// The left eye is red, the right eye is green and blue.
    RedCyan,
}

choices!(Tint {
    RedBlue: "red-blue",
    RedCyan: "red-cyan"
});

impl Tint {
    /// The combined pixel in RGB565, from the luminances for the left and the right eye. Channels are truncated instead of
    /// rounded, because the gateware composes all eight pixels of a word at once.
    pub fn compose(self, left: u8, right: u8) -> u16 {
        let [red, green, blue] = match self {
            Self::RedBlue => [left, left.min(right), right],
            Self::RedCyan => [left, right, right],
        }
        .map(u16::from);
        red >> 3 << 11 | green >> 2 << 5 | blue >> 3
    }
}

/// Settings of a stereo picture, whose two eyes are on both sides of the camera along its direction u.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stereo {
    /// Half separation: the distance from the camera to each eye, in world units, 0 to 1.
    pub half_separation: Q32_32,
    /// Distance along the camera's direction n at which a point has the same position in the pictures of both eyes (zero
    /// parallax): at least the half separation, and at least 0.1.
    pub zero_parallax: Q32_32,
    /// Colours of the glasses.
    pub tint: Tint,
}

impl Stereo {
    /// Checks that half separation and distance of zero parallax are in their ranges.
    ///
    /// # Errors
    /// The first number out of range.
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

    /// The cameras of the left and the right eye: displaced from the eye of `view` along its direction u, with shifted pictures,
    /// so that a point at the distance of zero parallax has the same position in both pictures.
    pub fn eyes(&self, view: &View) -> [View; 2] {
        let aside = self.half_separation;
        // The half separation divided by the distance of zero parallax: at most 1, apart from the rounding of the divisor, so it fits.
        let shift = (aside.to_bits() << 24) / (self.zero_parallax.to_bits() >> 4).max(1);
        let shift = Q4_28::from_bits(shift as i32);
        [view.beside(-aside, shift), view.beside(aside, -shift)]
    }

    /// Reads the text form, such as `0.05,3`. The default glasses are red and blue.
    ///
    /// # Errors
    /// The text has another form, or a number is out of range.
    pub fn parse(text: &str) -> Result<Self, StereoError<'_>> {
        let mut words = text.split(',');
        let mut number = || Q32_32::from_str(words.next()?).ok();
        let (Some(half_separation), Some(zero_parallax)) = (number(), number()) else {
            return Err(StereoError::Form(text));
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
            _ => Err(StereoError::Form(text)),
        }
    }
}

/// Writes the text form.
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

/// Reason why a text does not describe stereo settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StereoError<'a> {
    /// This text does not have the form that `FORM` states.
    Form(&'a str),
    /// The half separation is out of range.
    HalfSeparation(Q32_32),
    /// The distance of zero parallax is too small.
    ZeroParallax {
        /// The distance that was given.
        zero_parallax: Q32_32,
        /// The smallest accepted distance at this half separation.
        least: Q32_32,
    },
}

impl fmt::Display for StereoError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Form(text) => write!(f, "{text}: expected {FORM}"),
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
