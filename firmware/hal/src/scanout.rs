//! Two frames in memory and the scan-out that shows one of them while the other is drawn.
//!
//! [`Display`] owns the memory of both frames. [`Display::back`] lends the frame that is not on the screen, and
//! [`Display::show`] flips: scan-out shows this frame from the next vertical blanking on. Until then no frame is free, and
//! `back` returns `None`. Therefore no incomplete picture is shown, and no call waits: the interrupt of the vertical blanking
//! ([`acknowledge_vblank`]) reports when a frame may be free again.
//!
//! The CPU's data cache writes through, so a drawn frame is in memory; scan-out only reads.
//!
//! # Limits
//! A SoC may lack the scan-out block. On such a SoC a frame is always free, and no picture is shown.

use core::sync::atomic::{Ordering, compiler_fence};

pub use litex_pac::scanout::Counters;
use litex_pac::scanout::{self, Control, EvEnable, EvPending};

use crate::Absent;

/// Enlargement on the screen: one pixel of a frame covers this number of screen pixels horizontally and vertically.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Scale {
    /// The frame is as wide as the screen.
    One = 1,
    /// The frame has half the width of the screen.
    Two = 2,
    /// The frame has a quarter of the width of the screen.
    Four = 4,
}

impl Scale {
    /// The scale at which lines of `frame` pixels fill screen lines of `screen` pixels; `None` if no scale does.
    fn new(frame: u32, screen: u32) -> Option<Self> {
        [Self::One, Self::Two, Self::Four]
            .into_iter()
            .find(|&scale| scale as u32 * frame == screen)
    }
}

/// The registers of the scan-out block, whose presence in this SoC has been checked.
pub struct Scanout {
    registers: scanout::Scanout,
    /// Number of pixels in a line of the screen.
    width: u32,
}

impl Scanout {
    /// Takes the registers if the SoC has scan-out. The screen is black until a [`Display`] shows a frame.
    ///
    /// # Errors
    /// The block is absent.
    pub fn probe(registers: scanout::Scanout) -> Result<Self, Absent> {
        Absent::check(registers.ident().read(), scanout::Scanout::IDENT)?;
        registers
            .ev_enable()
            .write(EvEnable::default().with_vblank(true));
        let width = registers.caps().read().width().into();
        Ok(Self { registers, width })
    }

    /// Keeps the frame at the address `shown` on the screen if its successor at the address `next` is not shown yet. Returns
    /// whether the frame at `shown` was kept. If the two frames have different scales, nothing changes, because a frame would be
    /// shown with the wrong scale.
    fn withdraw(&self, next: u32, shown: u32) -> bool {
        let registers = &self.registers;
        if registers.fb_next().read() != next
            || registers.fb_current().read() != shown
            || registers.scale().read() != registers.status().read().scale()
        {
            return false;
        }
        registers.fb_next().write(shown);
        // If a vertical blanking came before the write, `next` is already shown.
        let withdrawn = registers.fb_current().read() == shown;
        if !withdrawn {
            registers.fb_next().write(next);
        }
        withdrawn
    }

    /// Whether the frame at `address` is shown or waits to be shown, and must not be drawn on.
    fn holds(&self, address: u32) -> bool {
        // `next` is read first: a frame that becomes current between the two reads is then found as the next frame.
        self.registers.fb_next().read() == address || self.registers.fb_current().read() == address
    }

    /// Shows the frame at `address` from the next vertical blanking on.
    fn show(&self, address: u32, scale: Scale) {
        let disabled = Control::default().with_enable(false);
        if self.registers.scale().read() != scale as u8
            || self.registers.control().read() == disabled
        {
            // A vertical blanking may begin between any two of these writes. Scan-out is disabled during these writes, so that it never
            // shows a frame with the scale of another frame.
            self.registers.control().write(disabled);
            self.registers.scale().write(scale as u8);
            self.registers.fb_next().write(address);
            self.registers
                .control()
                .write(Control::default().with_enable(true));
        } else {
            self.registers.fb_next().write(address);
        }
    }
}

/// Clears the interrupt of the vertical blanking, for the interrupt handler.
pub fn acknowledge_vblank() {
    // SAFETY: only this function writes the pending register, and clears its only event.
    let registers = unsafe { scanout::Scanout::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_vblank(true));
}

/// A double-buffered picture.
pub struct Display {
    scanout: Option<Scanout>,
    front: &'static mut [u16],
    back: &'static mut [u16],
}

impl Display {
    /// A display of two frames of RGB565 pixels, aligned to 16 bytes. The sizes that fit a frame are available.
    #[must_use]
    pub fn new(scanout: Option<Scanout>, frames: [&'static mut [u16]; 2]) -> Self {
        let [front, back] = frames;
        Self {
            scanout,
            front,
            back,
        }
    }

    /// The frame to draw on; `None` while this frame is still on the screen.
    pub fn back(&mut self) -> Option<&mut [u16]> {
        let address = address(self.back);
        let held = self
            .scanout
            .as_ref()
            .is_some_and(|scanout| scanout.holds(address));
        (!held).then_some(&mut *self.back)
    }

    /// Withdraws the frame of the last [`show`](Self::show) if it is not on the screen yet, to replace an outdated picture.
    pub fn withdraw(&mut self) {
        let withdrawn = self
            .scanout
            .as_ref()
            .is_some_and(|scanout| scanout.withdraw(address(self.front), address(self.back)));
        if withdrawn {
            core::mem::swap(&mut self.front, &mut self.back);
        }
    }

    /// The frame of the last [`show`](Self::show), on the screen or waiting for the vertical blanking.
    #[must_use]
    pub fn front(&self) -> &[u16] {
        self.front
    }

    /// Whether frames of this width and height fit the memory and the screen.
    #[must_use]
    pub fn has_size(&self, [width, height]: [u32; 2]) -> bool {
        let fits_screen = match &self.scanout {
            Some(scanout) => Scale::new(width, scanout.width).is_some(),
            None => true,
        };
        fits_screen && (width * height) as usize <= self.front.len().min(self.back.len())
    }

    /// Shows the frame that [`back`](Self::back) lent, with the width of one of the [available sizes](Self::has_size), from the next
    /// vertical blanking on.
    pub fn show(&mut self, width: u32) {
        core::mem::swap(&mut self.front, &mut self.back);
        // The writes of the frame's pixels must precede the write of its address to scan-out.
        compiler_fence(Ordering::SeqCst);
        if let Some(scanout) = &self.scanout
            && let Some(scale) = Scale::new(width, scanout.width)
        {
            scanout.show(address(self.front), scale);
        }
    }

    /// Whether the SoC has a scan-out block.
    #[must_use]
    pub const fn is_visible(&self) -> bool {
        self.scanout.is_some()
    }

    /// Counters of scan-out; all 0 if the block is absent.
    #[must_use]
    pub fn counters(&self) -> Counters {
        let scanout = self.scanout.as_ref();
        scanout.map_or(Counters::default(), |scanout| {
            Counters::read(&scanout.registers)
        })
    }
}

/// Address of a frame for scan-out, which uses the same 32-bit addresses as the CPU.
fn address(frame: &[u16]) -> u32 {
    frame.as_ptr().addr() as u32
}

#[cfg(test)]
mod tests {
    use std::boxed::Box;
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::vec;

    use litex_pac::Peripherals;
    use litex_pac::bus::{self, Bus};

    use super::*;

    const IDENT: u32 = scanout::Scanout::IDENT;

    /// Model of the registers of scan-out. `blank_before` is the number of register writes until the next vertical
    /// blanking; `None` for no blanking.
    #[derive(Default)]
    struct Video {
        ident: u32,
        width: u32,
        control: u32,
        next: u32,
        scale: u32,
        /// Control, frame and scale that were latched at the last vertical blanking.
        current: [u32; 3],
        blank_before: Option<u32>,
    }

    impl Video {
        fn blank(&mut self) {
            self.current = [self.control, self.next, self.scale];
        }
    }

    struct Registers(Rc<RefCell<Video>>);

    impl Bus for Registers {
        fn read(&mut self, address: usize) -> u32 {
            let video = self.0.borrow();
            match address - scanout::Scanout::BASE {
                0x00 => video.ident,
                0x04 => video.width,
                0x08 => video.control,
                // Register `status`: the scale of the shown frame is in the bits from 4 on.
                0x0c => video.current[2] << 4,
                0x1c => video.next,
                0x20 => video.scale,
                0x24 => video.current[1],
                offset => panic!("read of scanout + {offset:#x}"),
            }
        }

        fn write(&mut self, address: usize, value: u32) {
            let mut video = self.0.borrow_mut();
            if video.blank_before == Some(0) {
                video.blank();
            }
            video.blank_before = video.blank_before.and_then(|count| count.checked_sub(1));
            match address - scanout::Scanout::BASE {
                0x08 => video.control = value,
                0x18 => {}
                0x1c => video.next = value,
                0x20 => video.scale = value,
                offset => panic!("write of scanout + {offset:#x}"),
            }
        }
    }

    fn probe(ident: u32) -> (Result<Scanout, Absent>, Rc<RefCell<Video>>) {
        probe_with_width(ident, 1280)
    }

    fn probe_with_width(ident: u32, width: u32) -> (Result<Scanout, Absent>, Rc<RefCell<Video>>) {
        let video = Rc::new(RefCell::new(Video {
            ident,
            width,
            scale: 4,
            ..Video::default()
        }));
        bus::connect(Registers(video.clone()));
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        (
            Scanout::probe(unsafe { Peripherals::steal() }.scanout),
            video,
        )
    }

    fn frames() -> [&'static mut [u16]; 2] {
        [(); 2].map(|()| Box::leak(Box::new([0; 8])).as_mut_slice())
    }

    #[test]
    fn a_frame_is_free_when_it_has_left_the_screen() {
        let (scanout, video) = probe(IDENT);
        let mut display = Display::new(Some(scanout.unwrap()), frames());
        display.back().unwrap()[0] = 1;
        display.show(320);
        display.back().unwrap()[0] = 2;
        video.borrow_mut().blank();
        assert_eq!(display.front()[0], 1);
        display.show(320);
        // The second frame waits for the vertical blanking, and the first frame is still on the screen.
        assert!(display.back().is_none());
        video.borrow_mut().blank();
        assert_eq!(display.back().unwrap()[0], 1);
        assert_eq!(display.front()[0], 2);
    }

    #[test]
    fn a_frame_is_withdrawn_before_it_is_seen() {
        // Tests with a vertical blanking during the withdrawal, and without one.
        for blanking in [Some(0), None] {
            let (scanout, video) = probe(IDENT);
            let mut display = Display::new(Some(scanout.unwrap()), frames());
            for mark in [1, 2] {
                display.back().unwrap()[0] = mark;
                display.show(320);
                if mark == 1 {
                    video.borrow_mut().blank();
                }
            }
            assert!(display.back().is_none());
            video.borrow_mut().blank_before = blanking;
            display.withdraw();
            let seen_first = blanking.is_none();
            assert_eq!(
                display.back().map(|frame| frame[0]),
                Some(if seen_first { 2 } else { 1 })
            );
            video.borrow_mut().blank();
            assert_eq!(display.front()[0], if seen_first { 1 } else { 2 });
            assert_eq!(video.borrow().current[1], address(display.front()));
        }
        // A waiting frame is not withdrawn if its scale differs from the shown frame's scale.
        let (scanout, video) = probe(IDENT);
        let mut display = Display::new(Some(scanout.unwrap()), frames());
        display.show(320);
        video.borrow_mut().blank();
        display.show(640);
        display.withdraw();
        assert!(display.back().is_none());
    }

    #[test]
    fn no_blanking_finds_a_frame_with_another_scale() {
        for moment in 0..6 {
            let (scanout, video) = probe(IDENT);
            let mut display = Display::new(Some(scanout.unwrap()), frames());
            display.show(320);
            let small = [1, video.borrow().next, 4];
            video.borrow_mut().blank();
            assert_eq!(video.borrow().current, small);
            video.borrow_mut().blank_before = Some(moment);
            display.show(640);
            let large = [1, video.borrow().next, 2];
            let seen = video.borrow().current;
            assert!(seen[0] == 0 || seen == small || seen == large, "{seen:?}");
            video.borrow_mut().blank();
            assert_eq!(video.borrow().current, large);
        }
    }

    #[test]
    fn without_scanout_a_frame_is_always_free() {
        let (scanout, _) = probe(0);
        assert_eq!(scanout.map(|_| ()).map_err(|absent| absent.found), Err(0));
        let mut display = Display::new(None, frames());
        display.back().unwrap()[0] = 1;
        display.show(1280);
        assert!(display.back().is_some() && !display.is_visible());
        assert_eq!(display.front()[0], 1);
    }

    #[test]
    fn a_size_must_fit_screen_and_memory() {
        const SIZES: [[u32; 2]; 3] = [[320, 180], [640, 360], [1280, 720]];
        let scales = |screen| SIZES.map(|[width, _]| Scale::new(width, screen));
        let [one, two, four] = [Scale::One, Scale::Two, Scale::Four].map(Some);
        assert_eq!(scales(1280), [four, two, one]);
        assert_eq!(scales(640), [two, one, None]);

        let all = 1280 * 720;
        for (width, pixels, expected) in [
            (None, all, [true; 3]),
            (None, all - 1, [true, true, false]),
            (Some(1280), all, [true; 3]),
            (Some(1280), all - 1, [true, true, false]),
            (Some(640), all, [true, true, false]),
        ] {
            let scanout = width.and_then(|width| {
                let (scanout, _) = probe_with_width(IDENT, width);
                scanout.ok()
            });
            let frames = [(); 2].map(|()| vec![0; pixels].leak());
            let display = Display::new(scanout, frames);
            let sizes = SIZES.map(|size| display.has_size(size));
            assert_eq!(sizes, expected, "width {width:?}, {pixels} pixels");
        }
    }
}
