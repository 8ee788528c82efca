//! Why a line is not a command.

use core::fmt;

use super::grammar::{Argument, Syntax, Word};
use crate::camera::ViewError;
use crate::field::FieldError;
use crate::fixed::Q32_32;
use crate::follow::SENSITIVITY;
use crate::light::LightError;
use crate::stereo::StereoError;

/// Why a line is not a command; its `Display` says what is wrong, where, and what was expected.
#[derive(Clone, Copy, Debug)]
pub struct ParseError<'a>(pub(super) Fault<'a>);

#[derive(Clone, Copy, Debug)]
pub(super) enum Fault<'a> {
    /// There is no such command.
    Unknown { word: Word<'a> },
    /// The line ends before this argument.
    Missing {
        syntax: &'static Syntax,
        argument: &'static Argument,
    },
    /// This argument is something else.
    Wrong {
        syntax: &'static Syntax,
        argument: &'static Argument,
        word: Word<'a>,
    },
    /// This word and what follows are too much.
    Surplus {
        syntax: &'static Syntax,
        word: Word<'a>,
    },
    /// The picture cannot have this size.
    Size { width: u32, height: u32 },
    /// A number of samples follows what takes none.
    Samples { count: u32 },
    /// Both directions of the sensor lie on one axis.
    Mounting,
    /// A sensitivity beyond [`SENSITIVITY`].
    Sensitivity,
    /// The numbers are not a camera.
    View(ViewError),
    /// The word is no field.
    Field(FieldError<'a>),
    /// The word is no pair of eyes.
    Stereo(StereoError<'a>),
    /// The word is no light.
    Light(LightError<'a>),
}

impl fmt::Display for ParseError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            Fault::Unknown { word } => write!(f, "{word}: expected a command, `help` lists them"),
            Fault::Missing {
                syntax,
                argument: (name, kind),
            } => {
                write!(
                    f,
                    "{}: {name} is missing: expected {kind}, as in `{syntax}`",
                    syntax.name
                )
            }
            Fault::Wrong {
                syntax,
                argument: (name, kind),
                word,
            } => {
                write!(f, "{}: {name} is {word}: expected {kind}", syntax.name)
            }
            Fault::Surplus { syntax, word } => {
                write!(
                    f,
                    "{}: {word}: expected the end of the line, as in `{syntax}`",
                    syntax.name
                )
            }
            Fault::Size { width, height } => {
                write!(
                    f,
                    "size: {width} x {height}: expected 320 180, 640 360 or 1280 720"
                )
            }
            Fault::Samples { count } => write!(
                f,
                "imu: SAMPLES is {count}: expected it after calibrate or stream"
            ),
            Fault::Mounting => f.write_str(
                "mounting: FORWARD and UP are on the same axis: expected two that are perpendicular",
            ),
            Fault::Sensitivity => {
                let [least, most] = SENSITIVITY.map(|part| Q32_32::from_num(part) / 256);
                write!(f, "sensitivity: expected a number from {least} to {most}")
            }
            Fault::View(error) => write!(f, "view: {error}"),
            Fault::Field(error) => write!(f, "field: {error}"),
            Fault::Stereo(error) => write!(f, "stereo: {error}"),
            Fault::Light(error) => write!(f, "light: {error}"),
        }
    }
}

impl core::error::Error for ParseError<'_> {}

/// The word, shortened and without control characters, and its place.
impl fmt::Display for Word<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        const LONGEST: usize = 24;
        let mut rest = self.text.chars();
        f.write_str("\"")?;
        for c in rest.by_ref().take(LONGEST) {
            write!(f, "{}", c.escape_debug())?;
        }
        f.write_str(if rest.next().is_some() { "...\"" } else { "\"" })?;
        write!(f, " (column {})", self.column)
    }
}
