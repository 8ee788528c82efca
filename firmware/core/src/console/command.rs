//! The grammar of commands.

use core::fmt;

use crate::camera::View;
use crate::fixed::{Q32_32, Turns};

/// A command, parsed and checked as far as it can be without the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command<'a> {
    /// Nothing was typed.
    Empty,
    /// `help [CMD]`: write [`write_help`].
    Help(Option<&'a str>),
    /// `info`
    Info,
    /// `scene [NAME]`
    Scene(Option<&'a str>),
    /// `camera R THETA PHI`
    Camera {
        /// The distance from the origin.
        r: Q32_32,
        /// The azimuth.
        theta: Turns,
        /// The angle from the z axis.
        phi: Turns,
    },
    /// `view [EYE U V N HALF_WIDTH NEAR]`; without numbers it prints the view.
    View(Option<View>),
    /// `look YAW PITCH ROLL`
    Look {
        /// To the right.
        yaw: Turns,
        /// Downwards.
        pitch: Turns,
        /// About the direction of view.
        roll: Turns,
    },
    /// `orbit [FRAMES]`
    Orbit {
        /// How many frames a turn has.
        frames: Option<u32>,
    },
    /// `size W H`
    Size(Size),
    /// `frame [depth]`
    Frame {
        /// Depth instead of colour.
        depth: bool,
    },
    /// `load BYTES CRC32`
    Load {
        /// Length of the upload.
        bytes: u32,
        /// Its CRC-32.
        crc32: u32,
    },
    /// `render`
    Render,
    /// `cull on|off`
    Cull(bool),
    /// `stats [json]`
    Stats {
        /// As JSON.
        json: bool,
    },
    /// `backend [cpu|gateware]`
    Backend(Option<Backend>),
    /// `bench [KERNEL]`
    Bench(Option<&'a str>),
    /// `selftest`
    SelfTest,
    /// `leds VALUE`
    Leds(u16),
    /// `buttons`
    Buttons,
    /// `reboot`
    Reboot,
}

/// Who renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// The soft core.
    Cpu,
    /// The engines.
    Gateware,
}

/// The size of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// 320×180.
    W320,
    /// 640×360.
    W640,
    /// 1280×720.
    W1280,
}

impl<'a> Command<'a> {
    /// Parses a line.
    ///
    /// # Errors
    /// What is wrong, where, and what was expected.
    pub fn parse(_line: &'a str) -> Result<Self, ParseError<'a>> {
        Ok(Self::Empty)
    }
}

/// Writes the help of one command or the list of all.
///
/// # Errors
/// Those of the writer.
pub fn write_help(_out: &mut dyn fmt::Write, _command: Option<&str>) -> fmt::Result {
    Ok(())
}

/// Why a line is not a command; its `Display` is what follows `error: `.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParseError<'a> {
    /// The word that is wrong.
    pub word: &'a str,
}

impl fmt::Display for ParseError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.word)
    }
}
