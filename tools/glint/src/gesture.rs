//! Access to a board's gesture engine through the board's console, and faults of the virtual image sensor.

use crate::board::Board;
use crate::console::{self, Console};
use crate::transfer::{self, Progress, TransferError};
use std::io::{self, Write};
use virtual_board::virtual_image_sensor::{
    ChipFault, Fault, Hand, ImageSensor, Model, Polarity, Scene, Source, Timing,
};

/// A fault of the virtual image sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorFault {
    /// The sensor does not answer on its bus, and sends nothing.
    Absent,
    /// The sensor has another chip identity.
    Identity,
    /// The cable is unplugged after the set-up.
    Unplugged,
    /// VSYNC does not become active.
    NoSync,
    /// VSYNC is inverted.
    Inverted,
    /// A line has two pixels too few.
    ShortLine,
    /// A line loses a byte.
    LostByte,
    /// The frame has ten lines too few.
    FewLines,
    /// VSYNC ends the frame in the middle of a line.
    Cut,
    /// PCLK stops within the frame.
    Stopped,
}

impl SensorFault {
    /// All faults.
    pub const ALL: [Self; 10] = [
        Self::Absent,
        Self::Identity,
        Self::Unplugged,
        Self::NoSync,
        Self::Inverted,
        Self::ShortLine,
        Self::LostByte,
        Self::FewLines,
        Self::Cut,
        Self::Stopped,
    ];

    /// Name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Absent => "absent",
            Self::Identity => "identity",
            Self::Unplugged => "unplugged",
            Self::NoSync => "no-sync",
            Self::Inverted => "inverted",
            Self::ShortLine => "short-line",
            Self::LostByte => "lost-byte",
            Self::FewLines => "few-lines",
            Self::Cut => "cut",
            Self::Stopped => "stopped",
        }
    }

    /// Applies this fault to a sensor. `line` is the faulty line of its frames.
    pub fn apply(self, sensor: &mut ImageSensor, line: usize) {
        let inverted = Polarity {
            vsync_low: true,
            ..Polarity::default()
        };
        sensor.fault = Some(match self {
            Self::Absent => return sensor.wires.set_fault(Some(ChipFault::Absent)),
            Self::Identity => return sensor.wires.set_fault(Some(ChipFault::Identity(0x2640))),
            Self::Unplugged => Fault::Unplugged,
            Self::NoSync => Fault::NoSync,
            Self::Inverted => Fault::Inverted(inverted),
            Self::ShortLine => Fault::Slip { line, bytes: 4 },
            Self::LostByte => Fault::Slip { line, bytes: 1 },
            Self::FewLines => Fault::Lines(10),
            Self::Cut => Fault::Cut(line),
            Self::Stopped => Fault::Stopped(line),
        });
    }
}

/// Returns a scene with sensor noise and a hand that moves on an ellipse in the middle of frames of
/// `size` pixels, with a period of 4 s.
#[must_use]
pub fn moving_hand(size: [usize; 2]) -> Scene {
    let [width, height] = size.map(|length| length as f64);
    let mut scene = Scene::new(size, move |time| {
        let (sin, cos) = (std::f64::consts::FRAC_PI_2 * time).sin_cos();
        vec![Hand {
            centre: [width * (0.5 + 0.2 * sin), height * (0.5 - 0.2 * cos)],
            area: width * height / 16.0,
        }]
    });
    scene.noise = 2.0;
    scene
}

/// Returns a virtual OV7670 for a simulated board.
#[must_use]
pub fn image_sensor(source: impl Source + 'static) -> ImageSensor {
    ImageSensor::new(Model::Ov7670, source, Timing::SHORT)
}

/// Marks the pixels of a downscaled frame of the image sensor that have the hand's colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Number of pixels of a line, a multiple of 8.
    pub width: u32,
    /// Number of lines.
    pub height: u32,
    /// One bit per pixel, line by line from the top left; the first of eight pixels is the highest
    /// bit of a byte.
    pub bits: Vec<u8>,
}

impl Mask {
    /// Writes the mask as a black and white PNG picture.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width, self.height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::One);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.bits)?;
        writer.finish()?;
        Ok(())
    }
}

/// Maximum width and height of a mask in pixels. A line of an OV5640 has 2592 pixels.
const MAX_SIDE: u32 = 4096;

/// Width and height, parsed from a text that separates them by a space.
struct Dimensions([u32; 2]);

impl std::str::FromStr for Dimensions {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let (width, height) = text.split_once(' ').ok_or(())?;
        let [width, height] = [width, height].map(|number| number.parse().map_err(drop));
        Ok(Self([width?, height?]))
    }
}

/// Turns the image sensor on, and downloads the mask of its next frame.
///
/// # Errors
/// The board refuses the command, for example without an image sensor, or the transfer fails.
pub fn mask<B: Board + ?Sized>(
    console: &mut Console<B>,
    progress: &mut Progress,
) -> Result<Mask, TransferError> {
    const COMMAND: &str = "gesture mask";
    console.command("gesture on")?;
    let mut lines = Vec::new();
    console.command_with_transfer(COMMAND, &mut |line| lines.push(line.to_owned()))?;
    let Dimensions([width, height]) = console::value(COMMAND, &lines, "mask")?;
    if !(width % 8 == 0 && width <= MAX_SIDE && height <= MAX_SIDE) {
        let expected =
            format!("a width and a height of at most {MAX_SIDE} pixels, the width a multiple of 8");
        let found = format!("{width} {height}");
        console.reset_transfer()?;
        return Err(console::unexpected(COMMAND, &expected, &found).into());
    }
    let mut bits = vec![0; (width * height / 8) as usize];
    let (board, pending) = console.line();
    let received = transfer::receive(board, pending, &mut bits, progress);
    let reply = console.reply(COMMAND);
    let received = received?;
    reply?;
    if received != bits.len() {
        let expected = format!("{} bytes", bits.len());
        return Err(console::unexpected(COMMAND, &expected, &received.to_string()).into());
    }
    Ok(Mask {
        width,
        height,
        bits,
    })
}
