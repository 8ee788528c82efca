//! Names of boards on the command line.

use std::convert::Infallible;
use std::fmt;
use std::str::FromStr;

/// A board as named on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BoardName {
    /// `emulated`: the instruction set emulator with its devices, in this process.
    Emulated,
    /// `virtual`: the verilated SoC, simulated in this process.
    Virtual,
    /// Any other name: a serial port such as `/dev/ttyUSB1`, or `serial` for the port that is
    /// probably connected to a board.
    Serial(String),
}

impl BoardName {
    /// Whether the board is simulated in this process; such a board has a monitor, pins and memory that the host can access.
    pub const fn is_simulated(&self) -> bool {
        matches!(self, Self::Emulated | Self::Virtual)
    }
}

impl FromStr for BoardName {
    type Err = Infallible;

    fn from_str(name: &str) -> Result<Self, Infallible> {
        Ok(match name {
            "emulated" => Self::Emulated,
            "virtual" => Self::Virtual,
            port => Self::Serial(port.to_owned()),
        })
    }
}

impl fmt::Display for BoardName {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Emulated => "emulated",
            Self::Virtual => "virtual",
            Self::Serial(port) => port,
        })
    }
}

/// What executes a command, as named on the command line: the bit-exact model in this process, or a
/// board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelOrBoard {
    /// `model`: the bit-exact model.
    Model,
    /// Any other name: the name of a board.
    Board(BoardName),
}

impl ModelOrBoard {
    /// Whether this is a board that is simulated in this process.
    pub const fn is_simulated(&self) -> bool {
        matches!(self, Self::Board(name) if name.is_simulated())
    }
}

impl FromStr for ModelOrBoard {
    type Err = Infallible;

    fn from_str(name: &str) -> Result<Self, Infallible> {
        Ok(match name {
            "model" => Self::Model,
            name => Self::Board(name.parse()?),
        })
    }
}

impl fmt::Display for ModelOrBoard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Model => f.write_str("model"),
            Self::Board(name) => name.fmt(f),
        }
    }
}
