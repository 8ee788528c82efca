//! Scan-out: vertical blanking at the rate of the video mode, and the frame that is shown.

use glint_board_api::Frame;
use litex_pac::constants::CONFIG_CLOCK_FREQUENCY;
use litex_pac::register::Value;
use litex_pac::scanout::{Caps, Control, Error, Scanout as Block, Status, offset};

use crate::{Device, Events, MainMemory};

/// Bit of the event in the event registers.
const VBLANK: u32 = 1;

/// Cycle of the first vertical blanking. The video timing starts at the end of the last visible line.
const FIRST: u64 = 130;

/// Scales that the block supports.
const SCALES: [u32; 3] = [1, 2, 4];
/// Scale after a reset.
const DEFAULT_SCALE: u32 = 4;

/// Size of a memory word in bytes.
const WORD: u32 = 16;

/// Estimated number of cycles of a line fetch, in addition to one cycle for each word.
const FETCH_OVERHEAD: u32 = 30;

/// The scan-out block.
pub struct Scanout {
    control: u32,
    next: u32,
    scale: u32,
    /// Settings that the last vertical blanking latched.
    enabled: bool,
    current: u32,
    scale_current: u32,
    error: Error,
    frames: u32,
    busy: u32,
    items_in: u32,
    items_out: u32,
    /// Number of the next vertical blanking, counted from the start of the board. A reset does not change the video timing.
    blanking: u64,
    events: Events,
}

impl Scanout {
    /// Scan-out at the start of the board.
    pub fn new() -> Self {
        Self {
            control: 0,
            next: 0,
            scale: DEFAULT_SCALE,
            enabled: false,
            current: 0,
            scale_current: DEFAULT_SCALE,
            error: Error::None,
            frames: 0,
            busy: 0,
            items_in: 0,
            items_out: 0,
            blanking: 0,
            events: Events::default(),
        }
    }

    /// Resets the registers.
    pub fn reset(&mut self) {
        *self = Self {
            blanking: self.blanking,
            ..Self::new()
        };
    }

    /// Cycle of the next vertical blanking.
    pub fn next_blanking(&self) -> u64 {
        let ticks = u128::from(self.blanking) * u128::from(Block::FRAME_TICKS);
        let clock = u128::from(CONFIG_CLOCK_FREQUENCY);
        FIRST + (ticks * clock / u128::from(Block::PIXEL_CLOCK)) as u64
    }

    fn blank(&mut self) {
        if self.enabled {
            let lines = Block::SCREEN_HEIGHT / self.scale_current;
            let words = Block::SCREEN_WIDTH / self.scale_current * 2 / WORD * lines;
            self.items_out = self.items_out.wrapping_add(lines);
            self.items_in = self.items_in.wrapping_add(words);
            self.busy = self.busy.wrapping_add(words + lines * FETCH_OVERHEAD);
        }
        self.enabled = Control::from_bits(self.control).enable();
        self.current = self.next & !(WORD - 1);
        self.error = Error::Scale;
        if SCALES.contains(&self.scale) {
            self.scale_current = self.scale;
            self.error = Error::None;
        }
        self.frames = self.frames.wrapping_add(1);
        self.blanking += 1;
        self.events.raise(VBLANK);
    }

    /// Number of vertical blankings since the start of the board.
    pub fn blankings(&self) -> u64 {
        self.blanking
    }

    /// The displayed frame, which is black while scan-out is disabled. Pixels outside main memory are black too.
    pub fn frame(&self, ram: &MainMemory) -> Frame {
        let [width, height] =
            [Block::SCREEN_WIDTH, Block::SCREEN_HEIGHT].map(|length| length / self.scale_current);
        let size = (width * height) as usize;
        let colour = |number: usize| {
            let colour = ram.array(self.current.wrapping_add(2 * number as u32));
            colour.map_or(0, u16::from_le_bytes)
        };
        let pixels = match ram.bytes(self.current, 2 * size) {
            _ if !self.enabled => vec![0; size],
            Some(bytes) => bytes
                .as_chunks()
                .0
                .iter()
                .map(|&colour| u16::from_le_bytes(colour))
                .collect(),
            None => (0..size).map(colour).collect(),
        };
        Frame {
            width: width as usize,
            height: height as usize,
            pixels,
        }
    }
}

impl Device for Scanout {
    fn read(&mut self, offset: u32, _now: u64) -> u32 {
        match offset {
            offset::IDENT => Block::IDENT,
            offset::CAPS => Caps::default()
                .with_width(Block::SCREEN_WIDTH as u16)
                .with_height(Block::SCREEN_HEIGHT as u16)
                .with_scales(0b111)
                .bits(),
            offset::CONTROL => self.control,
            offset::STATUS => Status::default()
                .with_enabled(self.enabled)
                .with_scale(self.scale_current as u8)
                .with_error(self.error)
                .bits(),
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            offset::FB_NEXT => self.next,
            offset::SCALE => self.scale,
            offset::FB_CURRENT => self.current,
            offset::FRAME_COUNT => self.frames,
            offset::CYCLES_BUSY => self.busy,
            offset::ITEMS_IN => self.items_in,
            offset::ITEMS_OUT => self.items_out,
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, _now: u64, _ram: &mut MainMemory) {
        match offset {
            offset::CONTROL => self.control = value & 1,
            offset::FB_NEXT => self.next = value,
            offset::SCALE => self.scale = value & 7,
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & VBLANK),
            _ => {}
        }
    }

    fn advance(&mut self, now: u64, _ram: &mut MainMemory) -> u64 {
        while self.next_blanking() <= now {
            self.blank();
        }
        self.next_blanking()
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blankings_come_sixty_times_a_second_and_latch_the_settings() {
        let (mut scanout, mut ram) = (Scanout::new(), MainMemory::new());
        let address = litex_pac::memories::MAIN_RAM.base + 0x100;
        ram.bytes_mut(address, 4)
            .unwrap()
            .copy_from_slice(&[1, 2, 3, 4]);
        for (offset, value) in [
            (offset::FB_NEXT, address),
            (offset::SCALE, 2),
            (offset::CONTROL, 1),
        ] {
            scanout.write(offset, value, 0, &mut ram);
        }
        assert_eq!(scanout.advance(0, &mut ram), FIRST);
        assert!(scanout.frame(&ram).pixels.iter().all(|&colour| colour == 0));
        scanout.advance(FIRST, &mut ram);
        let frame = scanout.frame(&ram);
        assert_eq!((frame.width, frame.height), (640, 360));
        assert_eq!(frame.pixels[..3], [0x0201, 0x0403, 0]);
        scanout.advance(u64::from(CONFIG_CLOCK_FREQUENCY) + FIRST, &mut ram);
        assert_eq!(scanout.read(offset::FRAME_COUNT, 0), 61);
        assert_eq!(scanout.read(offset::ITEMS_OUT, 0), 60 * 360);
        scanout.write(offset::SCALE, 3, 0, &mut ram);
        scanout.advance(scanout.next_blanking(), &mut ram);
        let status = Status::from_bits(scanout.read(offset::STATUS, 0));
        assert_eq!((status.scale(), status.error()), (2, Some(Error::Scale)));
    }
}
