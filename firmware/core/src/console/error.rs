//! Reasons why a line is not a command.

use core::fmt::{self, Display};

use super::syntax::{Parameter, Syntax};
use crate::camera::ViewError;
use crate::feature::Feature;
use crate::field::FieldError;
use crate::fixed::Q32_32;
use crate::light::LightError;
use crate::object::PlaceError;
use crate::steering::SENSITIVITY;
use crate::stereo::StereoError;
use crate::words::Word;

/// Reason why a line is not a command. `Display` states the error, its position in the line, and the expected input.
#[derive(Clone, Copy, Debug)]
pub struct ParseError<'a>(pub(super) ParseErrorKind<'a>);

#[derive(Clone, Copy, Debug)]
pub(super) enum ParseErrorKind<'a> {
    /// The first word is not the name of a command.
    Unknown { word: Word<'a> },
    /// This build lacks the feature that contains the command.
    LeftOut { word: Word<'a>, feature: Feature },
    /// The line ends before this parameter.
    Missing {
        syntax: &'static Syntax,
        parameter: &'static Parameter,
    },
    /// The word is not accepted for this parameter.
    Word {
        syntax: &'static Syntax,
        parameter: &'static Parameter,
        word: Word<'a>,
    },
    /// A word follows the last parameter.
    Surplus {
        syntax: &'static Syntax,
        word: Word<'a>,
    },
    /// Each word is valid, but the combination is not.
    Value {
        syntax: &'static Syntax,
        error: ValueError<'a>,
    },
}

/// Reason why the words of an argument are rejected.
#[derive(Clone, Copy, Debug)]
pub enum ValueError<'a> {
    /// The width and height are not a picture size.
    Size([u32; 2]),
    /// A number of samples follows an action of the sensor that does not take this argument.
    Samples {
        /// The action that was given.
        action: &'static str,
        /// The number of samples that was given.
        samples: u32,
    },
    /// The two directions of a mounting, forward and up, lie on the same axis of the sensor.
    Mounting,
    /// The sensitivity of the steered camera is outside [`SENSITIVITY`].
    Sensitivity,
    /// The numbers do not describe a camera.
    View(ViewError),
    /// The word is not the text form of a distance field.
    Field(FieldError<'a>),
    /// The word does not describe the two eyes of a stereo picture.
    Stereo(StereoError<'a>),
    /// The word is not the text form of a light.
    Light(LightError<'a>),
    /// The words do not describe the placement of an object.
    Place(PlaceError<'a>),
}

impl<'a> ParseError<'a> {
    /// The error in the command's value; `None` for an error in the form of the line.
    pub fn value(&self) -> Option<impl Display + 'a> {
        match self.0 {
            ParseErrorKind::Value { error, .. } => Some(error),
            ParseErrorKind::Unknown { .. }
            | ParseErrorKind::LeftOut { .. }
            | ParseErrorKind::Missing { .. }
            | ParseErrorKind::Word { .. }
            | ParseErrorKind::Surplus { .. } => None,
        }
    }
}

impl Display for ParseError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            ParseErrorKind::Unknown { word } => {
                write!(f, "{word}: expected a command, `help` lists them")
            }
            ParseErrorKind::LeftOut { word, feature } => write!(f, "{word}: {feature}"),
            ParseErrorKind::Missing { syntax, parameter } => write!(
                f,
                "{}: {} is missing: expected {parameter}, usage: {syntax}",
                syntax.name,
                parameter.form()
            ),
            ParseErrorKind::Word {
                syntax,
                parameter,
                word,
            } => write!(
                f,
                "{}: {} is {word}: expected {parameter}",
                syntax.name,
                parameter.form()
            ),
            ParseErrorKind::Surplus { syntax, word } => write!(
                f,
                "{}: {word}: expected the end of the line, usage: {syntax}",
                syntax.name
            ),
            ParseErrorKind::Value { syntax, error } => write!(f, "{}: {error}", syntax.name),
        }
    }
}

impl core::error::Error for ParseError<'_> {}

impl Display for ValueError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Size([width, height]) => write!(
                f,
                "{width} x {height}: expected 320 180, 640 360 or 1280 720"
            ),
            Self::Samples { action, samples } => write!(
                f,
                "SAMPLES is {samples} after {action}: expected only after calibrate or stream"
            ),
            Self::Mounting => f.write_str(
                "FORWARD and UP are on the same axis: expected perpendicular directions",
            ),
            Self::Sensitivity => {
                let [least, most] = SENSITIVITY.map(|part| Q32_32::from_num(part) / 256);
                write!(f, "expected a number from {least} to {most}")
            }
            Self::View(error) => error.fmt(f),
            Self::Field(error) => error.fmt(f),
            Self::Stereo(error) => error.fmt(f),
            Self::Light(error) => error.fmt(f),
            Self::Place(error) => error.fmt(f),
        }
    }
}
