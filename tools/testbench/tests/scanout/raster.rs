//! Video timings, clocks, and the picture in memory.

/// A video timing: active part, front porch, sync and back porch, of lines in pixels and of frames in lines.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    pub h_active: u64,
    pub h_front: u64,
    pub h_sync: u64,
    pub h_back: u64,
    pub v_active: u64,
    pub v_front: u64,
    pub v_sync: u64,
    pub v_back: u64,
    /// Number of visible black lines above and below the picture, which count as part of the porches.
    pub border: u64,
}

impl Raster {
    /// The timing of the module `scanout`: CEA-861 1280×720 at 60 Hz.
    pub const CEA: Self = Self {
        h_active: 1280,
        h_front: 110,
        h_sync: 40,
        h_back: 220,
        v_active: 720,
        v_front: 5,
        v_sync: 5,
        v_back: 20,
        border: 0,
    };

    /// The timing of the module `scanout_small`: a frame takes 1/200 of the time of a frame of `scanout`, with as many pixel
    /// clocks per memory word in the active part of a line.
    pub const SMALL: Self = Self {
        h_active: 160,
        h_front: 8,
        h_sync: 4,
        h_back: 12,
        v_active: 24,
        v_front: 2,
        v_sync: 2,
        v_back: 4,
        border: 0,
    };

    /// The timing of the module `scanout_border`: as [`SMALL`](Self::SMALL), with black lines above and below the picture.
    pub const BORDER: Self = Self {
        v_front: 5,
        v_back: 7,
        border: 3,
        ..Self::SMALL
    };

    /// Number of pixel clocks of a line.
    pub const fn h_total(&self) -> u64 {
        self.h_active + self.h_front + self.h_sync + self.h_back
    }

    /// Number of lines of a frame.
    pub const fn v_total(&self) -> u64 {
        self.v_active + self.v_front + self.v_sync + self.v_back
    }

    /// Number of pixel clocks of a frame.
    pub const fn frame(&self) -> u64 {
        self.h_total() * self.v_total()
    }

    /// Number of lines from the start of vertical blanking to line 9 of the picture.
    pub const fn lines_to_picture(&self) -> u64 {
        self.v_front + self.v_sync + self.v_back + 9
    }
}

/// Frequencies of `sys_clk` and `pix_clk` in a common unit; only their ratio matters.
#[derive(Clone, Copy, Debug)]
pub struct Clocks {
    pub sys: u64,
    pub pix: u64,
}

impl Clocks {
    /// `sys_clk` of 81.25 MHz and `pix_clk` of 74.25 MHz.
    pub const SLOW: Self = Self {
        sys: 8125,
        pix: 7425,
    };
    /// `sys_clk` of 100 MHz and `pix_clk` of 74.25 MHz.
    pub const FAST: Self = Self {
        sys: 10_000,
        pix: 7425,
    };

    /// Number of `sys_clk` cycles in `pixels` cycles of `pix_clk`.
    pub const fn sys_cycles(&self, pixels: u64) -> u64 {
        pixels * self.sys / self.pix
    }
}

/// The RGB565 pixel at a byte address of memory: a hash of the address, which makes all lines of all frames differ.
pub fn pixel_at(address: u64) -> u16 {
    let z = address
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add(0xD1B5_4A32_D192_ED03);
    let z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ z >> 31) as u16
}

/// Widens an RGB565 pixel to RGB888 by bit replication.
pub fn rgb888(pixel: u16) -> u32 {
    let (r, g, b) = (
        u32::from(pixel >> 11),
        u32::from(pixel >> 5 & 63),
        u32::from(pixel & 31),
    );
    ((r * 33) >> 2) << 16 | ((g * 65) >> 4) << 8 | ((b * 33) >> 2)
}
