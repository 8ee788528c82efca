//! Messages between the page and the program with the board: JSON texts, and binary messages for
//! pictures and uploads.

use crate::choices::List;
use glint_board_api::Frame;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// Size in bytes of the header of a picture message.
pub const PICTURE_HEAD: usize = 8;

/// Maximum size in bytes of a message from the page; an upload consists of several messages.
pub const MAX_MESSAGE: usize = 128 << 10;

/// A message to the page in its transmitted form. Clones share their bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// A JSON text.
    Text(Arc<str>),
    /// A picture.
    Binary(Arc<[u8]>),
}

impl Message {
    /// Length in bytes.
    #[must_use]
    pub fn length(&self) -> usize {
        match self {
            Self::Text(text) => text.len(),
            Self::Binary(bytes) => bytes.len(),
        }
    }
}

/// A console command with its purpose.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// Name of the command.
    pub name: String,
    /// Text that the command `help` prints for the command.
    pub text: String,
}

/// Who has control of the board, from the point of view of the viewer that receives the message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Holder {
    /// The receiving viewer.
    You,
    /// A different viewer.
    Other,
    /// No viewer.
    Nobody,
}

/// A message to the page.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToPage {
    /// Properties of the board.
    Board {
        /// Name: `emulated`, `virtual` or a serial port.
        name: String,
        /// Whether the host can access the monitor and the pins; otherwise there are no pictures.
        has_pins: bool,
        /// Whether other pages may show the board too.
        is_shared: bool,
    },
    /// The firmware's lists of commands and of choices.
    Lists {
        /// Console commands.
        commands: Vec<Entry>,
        /// Names of scenes.
        scenes: Vec<String>,
        /// Names of meshes.
        meshes: Vec<String>,
        /// Names of kinds of fields.
        fields: Vec<String>,
    },
    /// Console output.
    Console {
        /// Text with terminal control sequences.
        text: String,
    },
    /// Levels of the board's pins.
    Pins(Pins),
    /// A change of control.
    Control {
        /// Who has control.
        holder: Holder,
    },
    /// Measurements of the board.
    Sample {
        /// The board's time in ms.
        ms: u64,
        /// Reply to `stats json`; null before the first frame.
        stats: Value,
        /// Attitude of the motion sensor as a quaternion w, x, y, z.
        attitude: Option<[f64; 4]>,
    },
    /// The last attitude of the motion sensor and position of the hand that a page has set.
    Motion {
        /// As in [`FromPage::Turn`].
        attitude: [f64; 4],
        /// As in [`FromPage::Hand`].
        hand: Option<[f64; 2]>,
    },
    /// Reply to `help COMMAND`.
    Help {
        /// Name of the described command.
        command: String,
        /// Lines of the reply.
        lines: Vec<String>,
    },
    /// Words that complete a line.
    Completions {
        /// The line to complete.
        line: String,
        /// The words that can replace its last word.
        words: Vec<String>,
    },
    /// Progress of a transfer in bytes; `done` equals `all` at the end, and both are 0 if the transfer has failed.
    Progress {
        /// Bytes transferred so far.
        done: u64,
        /// Total number of bytes.
        all: u64,
    },
    /// A notice for the user.
    Notice {
        /// Text of the notice, one line.
        text: String,
        /// Whether the notice is an error.
        is_error: bool,
    },
}

/// Levels of the board's pins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Pins {
    /// The 16 LEDs, one bit each.
    pub leds: u16,
    /// Lit segments of the eight digits from left to right: bits 0 to 6 for the segments a to g, bit 7 for the point.
    pub digits: [u8; 8],
    /// Whether each of the buttons 0 to 3 is pressed, one bit each.
    pub buttons: u8,
    /// The 16 switches, one bit each.
    pub switches: u16,
}

impl ToPage {
    /// The message in its transmitted form.
    #[must_use]
    pub fn encoded(&self) -> Message {
        let text = serde_json::to_string(self).expect("the messages have string keys only");
        Message::Text(text.into())
    }
}

/// The binary message of a picture: width and height as 16-bit words, the picture's number as a 32-bit word, and the RGB565
/// colours line by line as 16-bit words; little-endian.
#[must_use]
pub fn picture(frame: &Frame, number: u32) -> Message {
    let mut bytes = Vec::with_capacity(PICTURE_HEAD + 2 * frame.pixels.len());
    for side in [frame.width, frame.height] {
        bytes.extend((side as u16).to_le_bytes());
    }
    bytes.extend(number.to_le_bytes());
    bytes.extend(frame.pixels.iter().flat_map(|pixel| pixel.to_le_bytes()));
    Message::Binary(bytes.into())
}

/// A message from the page. All messages except `take`, `release`, `help` and `complete` require control.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum FromPage {
    /// Requests control, which succeeds if no viewer has it.
    Take,
    /// Releases control.
    Release,
    /// Enters a line on the console.
    Command {
        /// The line.
        line: String,
    },
    /// Shows a scene, a mesh or a field from the lists.
    Choose {
        /// The list that contains the choice.
        list: List,
        /// Name of the choice.
        name: String,
    },
    /// Cancels the running command.
    Interrupt,
    /// Requests the description of a command.
    Help {
        /// The command.
        command: String,
    },
    /// Requests the words that complete a line.
    Complete {
        /// The line.
        line: String,
    },
    /// Moves the camera around the subject.
    Orbit {
        /// As in [`Drag::turn`](crate::orbit::Drag::turn).
        turn: [f64; 2],
        /// As in [`Drag::zoom`](crate::orbit::Drag::zoom).
        zoom: f64,
    },
    /// Sets the buttons.
    Buttons {
        /// Whether each of the buttons 0 to 3 is pressed, one bit each.
        pressed: u8,
    },
    /// Sets the switches.
    Switches {
        /// The 16 switches, one bit each.
        on: u16,
    },
    /// Turns the motion sensor.
    Turn {
        /// Attitude from body to world, a quaternion w, x, y, z.
        attitude: [f64; 4],
    },
    /// Moves the hand in front of the camera.
    Hand {
        /// Centre of the hand as fractions of the frame's width and height; null for no hand.
        place: Option<[f64; 2]>,
    },
    /// Downloads the picture over the console from a board without access to its monitor.
    Picture,
    /// Announces a mesh file and its auxiliary files, which follow in binary messages in this order.
    Upload {
        /// Name of the mesh file, which determines its format.
        name: String,
        /// Size of the mesh file in bytes.
        bytes: usize,
        /// The auxiliary files, such as materials.
        #[serde(default)]
        beside: Vec<FileHead>,
    },
}

/// Name and size of a file.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct FileHead {
    /// Name of the file.
    pub name: String,
    /// Size of the file in bytes.
    pub bytes: usize,
}
