//! Registers of the OV5640. A frame takes 984 lines of 1,896 clocks.

use super::step::SetupStep::{self, Check, Wait, Write};

/// Selects the external clock XCLK, resets all registers, and puts the chip to sleep for the set-up.
pub const RESET: &[SetupStep] = &[
    Write(0x3103, 0x11),
    Write(0x3008, 0x82),
    Wait(5),
    Write(0x3008, 0x42),
];

/// Settings for all sizes: clock, pixel array, format and automatic control.
pub const COMMON: &[SetupStep] = &[
    // From here on the PLL generates the clock: input divided by 3 and by 2, times 70, divided by 2.
    Write(0x3103, 0x03),
    Check(0x3034, 0x1a),
    Check(0x3035, 0x21),
    Check(0x3036, 0x46),
    Check(0x3037, 0x13),
    Write(0x3108, 0x01),
    // Pins of the parallel port are outputs.
    Check(0x3017, 0xff),
    Check(0x3018, 0xff),
    // The pixel array from (0, 4) to (2623, 1947): every second column and line, binned and mirrored.
    Write(0x3800, 0x00),
    Write(0x3801, 0x00),
    Write(0x3802, 0x00),
    Write(0x3803, 0x04),
    Write(0x3804, 0x0a),
    Write(0x3805, 0x3f),
    Write(0x3806, 0x07),
    Write(0x3807, 0x9b),
    Write(0x3814, 0x31),
    Write(0x3815, 0x31),
    Write(0x3820, 0x41),
    Write(0x3821, 0x07),
    // Clocks of a line: 1,896. Lines of a frame: 984.
    Write(0x380c, 0x07),
    Write(0x380d, 0x68),
    Write(0x380e, 0x03),
    Write(0x380f, 0xd8),
    // Offsets of the picture: 16 columns, 6 lines.
    Write(0x3810, 0x00),
    Write(0x3811, 0x10),
    Write(0x3812, 0x00),
    Write(0x3813, 0x06),
    // The manufacturer's analog settings for every second column and line.
    Write(0x3618, 0x00),
    Write(0x3612, 0x29),
    Write(0x3708, 0x64),
    Write(0x3709, 0x52),
    Write(0x370c, 0x03),
    // RGB565 with the byte that contains red first.
    Check(0x4300, 0x61),
    Check(0x501f, 0x01),
    // Polarities of PCLK, HREF and VSYNC as after a reset.
    Check(0x4740, 0x20),
    // Colour correction, gamma, white balance, scaling.
    Write(0x5000, 0xa7),
    Write(0x5001, 0xa3),
    // Exposure and gain are automatic.
    Check(0x3503, 0x00),
];

/// Number of columns and lines of the picture, then the end of the sleep.
pub const VGA: &[SetupStep] = &[
    Check(0x3808, 0x02),
    Check(0x3809, 0x80),
    Check(0x380a, 0x01),
    Check(0x380b, 0xe0),
    Check(0x3008, 0x02),
];

/// Number of columns and lines of the picture, then the end of the sleep.
pub const QVGA: &[SetupStep] = &[
    Check(0x3808, 0x01),
    Check(0x3809, 0x40),
    Check(0x380a, 0x00),
    Check(0x380b, 0xf0),
    Check(0x3008, 0x02),
];
