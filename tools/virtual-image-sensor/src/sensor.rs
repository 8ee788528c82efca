//! The sensor: its chip, its source of frames, and the levels of its port.

use virtual_i2c_device::Wires;

use crate::chip::{Chip, ChipFault, Format, Model, Polarity};
use crate::frame::Source;

/// Number of periods of PCLK between two checks of a chip that sends nothing.
const STILL: usize = 1_000;

/// Levels of the port in one period of PCLK. The levels change at the beginning of the period; PCLK rises in its middle.
///
/// Bits 7:0 are the data, bit 8 HREF, bit 9 VSYNC. With bit 10, PCLK stops in this period. With bit 11, PCLK is inverted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Levels(pub u16);

impl Levels {
    const HREF: u16 = 1 << 8;
    const VSYNC: u16 = 1 << 9;
    const STILL: u16 = 1 << 10;
    const INVERTED: u16 = 1 << 11;

    /// The data pins.
    #[must_use]
    pub const fn data(self) -> u8 {
        self.0 as u8
    }

    /// Level of HREF.
    #[must_use]
    pub const fn href(self) -> bool {
        self.0 & Self::HREF != 0
    }

    /// Level of VSYNC.
    #[must_use]
    pub const fn vsync(self) -> bool {
        self.0 & Self::VSYNC != 0
    }

    /// Whether PCLK is inverted: it rises at the beginning of the period.
    #[must_use]
    pub const fn is_inverted(self) -> bool {
        self.0 & Self::INVERTED != 0
    }

    /// Whether PCLK has an edge in this period.
    #[must_use]
    pub const fn ticks(self) -> bool {
        self.0 & Self::STILL == 0
    }
}

/// Timing of the port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Frequency of PCLK in Hz, a multiple of 250 kHz.
    pub clock: u32,
    /// Number of periods of PCLK between two lines.
    pub gap: usize,
    /// Numbers of lines between two frames: during VSYNC, after VSYNC, and before the next VSYNC.
    pub blank: [usize; 3],
}

impl Timing {
    /// An OV7670 with a master clock of 24 MHz and frames of 640x480: 30 frames per second.
    pub const OV7670: Self = Self {
        clock: 24_000_000,
        gap: 288,
        blank: [3, 17, 10],
    };
    /// Little blanking, so that simulations are short.
    pub const SHORT: Self = Self {
        clock: 40_000_000,
        gap: 60,
        blank: [1, 1, 1],
    };
}

/// A fault of the frames, for tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The cable is unplugged: the chip has no supply and does not answer, and all wires of its port stay low. After it is plugged in
    /// again, the chip has its reset values.
    Unplugged,
    /// VSYNC does not become active.
    NoSync,
    /// The middle of a line loses or repeats bytes.
    Slip {
        /// Index of the line.
        line: usize,
        /// Number of bytes lost in the middle of a line; if negative, number of repetitions of a byte.
        bytes: isize,
    },
    /// Number of lines that the frame lacks; if negative, number of excess lines.
    Lines(isize),
    /// VSYNC cuts the frame in the middle of this line.
    Cut(usize),
    /// PCLK stops in the middle of this line, for the rest of the frame.
    Stopped(usize),
    /// Levels or edges are inverted.
    Inverted(Polarity),
}

/// A virtual image sensor.
pub struct ImageSensor {
    /// The chip on its SCCB wires.
    pub wires: Wires<Chip>,
    /// The view of the sensor.
    pub source: Box<dyn Source>,
    /// Timing of the port.
    pub timing: Timing,
    /// Fault of the following frames.
    pub fault: Option<Fault>,
    /// Number of frames so far.
    pub frames: u64,
}

impl ImageSensor {
    /// Creates a sensor in the state after power-up.
    #[must_use]
    pub fn new(model: Model, source: impl Source + 'static, timing: Timing) -> Self {
        Self {
            wires: Wires::new(Chip::new(model)),
            source: Box::new(source),
            timing,
            fault: None,
            frames: 0,
        }
    }

    /// Sets the level of RESET_N, which clears the registers when it is low, and whether the sensor has a master clock and is not in
    /// power-down. Returns whether the sensor starts or stops.
    pub fn set_inputs(&mut self, reset_n: bool, is_awake: bool) -> bool {
        let chip = &mut self.wires.chip;
        let runs = reset_n && self.fault != Some(Fault::Unplugged);
        if !runs {
            chip.reset();
        }
        let was_awake = chip.is_awake;
        chip.is_awake = is_awake && runs;
        chip.is_awake != was_awake
    }

    /// Returns the levels of the next frame, which begins at `time` in s: VSYNC, the lines, and the
    /// blanking before the next frame. If the sensor sends nothing, returns some periods without
    /// PCLK.
    pub fn frame(&mut self, time: f64) -> Vec<Levels> {
        let chip = &self.wires.chip;
        let absent = chip.fault == Some(ChipFault::Absent) || self.fault == Some(Fault::Unplugged);
        let Some(format) = chip.format().filter(|_| !absent) else {
            return vec![Levels(Levels::STILL); STILL];
        };
        let gates_clock = chip.gates_clock();
        let mut polarity = chip.polarity();
        if let Some(Fault::Inverted(inverted)) = self.fault {
            polarity = polarity ^ inverted;
        }
        let lines = self.lines(time, format, polarity.swap);
        self.frames += 1;

        let line_periods = self.timing.gap + lines.first().map_or(0, Vec::len);
        let [sync, after, before] = self.timing.blank;
        let has_sync = self.fault != Some(Fault::NoSync);
        // Bit 8 is an active HREF, bit 9 an active VSYNC, for either polarity.
        let mut active = Vec::new();
        let blank = |active: &mut Vec<u16>, periods: usize, levels: u16| {
            active.extend(std::iter::repeat_n(levels, periods));
        };
        let vsync = if has_sync { Levels::VSYNC } else { 0 };
        blank(&mut active, sync * line_periods, vsync);
        blank(&mut active, after * line_periods, 0);
        for (number, line) in lines.iter().enumerate() {
            let half = line.len() / 2;
            let levels = line.iter().map(|&byte| Levels::HREF | u16::from(byte));
            match self.fault {
                Some(Fault::Cut(at)) if at == number => {
                    active.extend(levels.take(half));
                    break;
                }
                Some(Fault::Stopped(at)) if at == number => {
                    active.extend(levels.take(half));
                    blank(
                        &mut active,
                        (lines.len() - at) * line_periods,
                        Levels::STILL,
                    );
                    break;
                }
                _ => active.extend(levels),
            }
            blank(&mut active, self.timing.gap, 0);
        }
        // A frame cut by VSYNC has no blanking before VSYNC.
        if !matches!(self.fault, Some(Fault::Cut(_))) {
            blank(&mut active, before * line_periods, 0);
        }

        let mut inverted = 0;
        for (is_low, bit) in [
            (polarity.href_low, Levels::HREF),
            (polarity.vsync_low, Levels::VSYNC),
            (polarity.falling, Levels::INVERTED),
        ] {
            inverted |= if is_low { bit } else { 0 };
        }
        let levels = active.into_iter().map(|active| {
            let gated = gates_clock && active & Levels::HREF == 0;
            Levels((active ^ inverted) | if gated { Levels::STILL } else { 0 })
        });
        levels.collect()
    }

    /// The bytes of each line of the next frame.
    fn lines(&mut self, time: f64, format: Format, swap: bool) -> Vec<Vec<u8>> {
        let frame = self.source.frame(time);
        let mut lines: Vec<Vec<u8>> = frame
            .pixels
            .chunks(frame.width.max(1))
            .map(|pixels| {
                let pairs = pixels.iter().enumerate().map(|(x, &pixel)| {
                    let pair = match format {
                        Format::Rgb565 => pixel.to_be_bytes(),
                        Format::Yuv422 => yuv422(pixel, x % 2 == 0),
                    };
                    if swap { [pair[1], pair[0]] } else { pair }
                });
                pairs.flatten().collect()
            })
            .collect();
        match self.fault {
            Some(Fault::Slip { line, bytes }) => {
                if let Some(line) = lines.get_mut(line) {
                    let middle = line.len() / 2;
                    let lost = bytes.unsigned_abs();
                    if bytes > 0 {
                        line.drain(middle..(middle + lost).min(line.len()));
                    } else {
                        let byte = line.get(middle).copied().unwrap_or_default();
                        line.splice(middle..middle, std::iter::repeat_n(byte, lost));
                    }
                }
            }
            Some(Fault::Lines(less)) => {
                let count = lines.len().saturating_add_signed(-less);
                let last = lines.last().cloned().unwrap_or_default();
                lines.resize(count, last);
            }
            _ => {}
        }
        lines
    }
}

/// Converts a pixel to luma and one chroma sample, Cb or Cr, as in ITU-R BT.601 with the full range.
fn yuv422(pixel: u16, blue: bool) -> [u8; 2] {
    let [r, g, b] = [
        (pixel >> 11) << 3,
        (pixel >> 5 & 0x3f) << 2,
        (pixel & 0x1f) << 3,
    ]
    .map(f64::from);
    let luma = 0.299 * r + 0.587 * g + 0.114 * b;
    let chroma = if blue {
        0.564 * (b - luma)
    } else {
        0.713 * (r - luma)
    };
    [luma as u8, (chroma + 128.0) as u8]
}
