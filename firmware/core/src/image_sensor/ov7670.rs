//! Registers of the OV7670. A frame takes 510 lines of 784 pixels, 33 ms with XCLK = 24 MHz.

use super::step::SetupStep::{self, Check, Wait, Write};

/// COM7: resets all registers.
pub const RESET: &[SetupStep] = &[Write(0x12, 0x80), Wait(2)];

/// Settings for all sizes: format, clock and automatic control.
pub const COMMON: &[SetupStep] = &[
    // CLKRC and DBLV: the PLL multiplies XCLK by 4, the prescaler divides by 4. PCLK is XCLK.
    Check(0x11, 0x01),
    Check(0x6b, 0x4a),
    // COM7, RGB444, COM15: RGB565 with levels from 0 to 255.
    Check(0x12, 0x04),
    Check(0x8c, 0x00),
    Check(0x40, 0xd0),
    // COM10: HREF is enabled, PCLK also runs between lines, VSYNC is high between frames, data are valid at the rising edge of
    // PCLK.
    Check(0x15, 0x00),
    // MVFP: mirrored. The lower three bits are reserved.
    Write(0x1e, 0x27),
    // COM9: gain up to 16. COM8: fast automatic exposure, gain and white balance, with the filter of 50 and 60 Hz.
    Write(0x14, 0x38),
    Write(0x13, 0xe7),
    // COM13: gamma and automatic saturation. COM16: gain of the white balance.
    Write(0x3d, 0xc0),
    Write(0x41, 0x38),
    // MTX1 to MTX6 and MTXS: the colour matrix for RGB.
    Write(0x4f, 0xb3),
    Write(0x50, 0xb3),
    Write(0x51, 0x00),
    Write(0x52, 0x3d),
    Write(0x53, 0xa7),
    Write(0x54, 0xe4),
    Write(0x58, 0x9e),
    // A reserved register. With its value after a reset, the colours are wrong.
    Write(0xb0, 0x84),
    // VSTART, VSTOP and VREF: 480 lines from line 10 on.
    Write(0x19, 0x02),
    Write(0x1a, 0x7a),
    Write(0x03, 0x0a),
];

/// 640×480: all columns of the pixel array, without scaling.
pub const VGA: &[SetupStep] = &[
    // COM3 and COM14: no scaling. SCALING_DCWCTR and SCALING_PCLK_DIV: no division.
    Check(0x0c, 0x00),
    Check(0x3e, 0x00),
    Write(0x72, 0x11),
    Write(0x73, 0xf0),
    // HSTART, HSTOP and HREF: start and end of the columns.
    Write(0x17, 0x13),
    Write(0x18, 0x01),
    Write(0x32, 0xb6),
];

/// 320×240: half the columns and lines of the pixel array; PCLK is XCLK/2.
pub const QVGA: &[SetupStep] = &[
    // COM3 and COM14: scaling, PCLK divided by 2. SCALING_DCWCTR and SCALING_PCLK_DIV: both directions divided by 2.
    Check(0x0c, 0x04),
    Check(0x3e, 0x19),
    Write(0x72, 0x11),
    Write(0x73, 0xf1),
    // HSTART, HSTOP and HREF: start and end of the columns.
    Write(0x17, 0x16),
    Write(0x18, 0x04),
    Write(0x32, 0x24),
];
