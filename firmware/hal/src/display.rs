//! Two frames in memory and the scan-out that shows one of them while the other is drawn.
//!
//! [`Display`] owns the memory of both. [`Display::back`] lends the frame that is not on the screen, and
//! [`Display::show`] has scan-out take it over at the next vertical blanking; until then no frame is free and `back`
//! returns `None`. So a picture is never seen half drawn, and nobody waits: the vertical blanking's interrupt
//! ([`acknowledge_vblank`]) tells when it is worth asking again.
//!
//! The CPU's data cache writes through, so what was drawn is in memory; scan-out only reads.
//!
//! # Limits
//! A SoC may lack the scan-out block. Then nothing is shown, and a frame is always free.

use core::sync::atomic::{Ordering, compiler_fence};

use glint_core::picture::Size;
use litex_pac::scanout::{self, Control, EvEnable, EvPending};

use crate::Absent;

/// The video picture, in pixels.
pub const SCREEN: [u32; 2] = [1280, 720];

/// What `ident` reads where the block is present: `SCAN` in ASCII.
const IDENT: u32 = u32::from_be_bytes(*b"SCAN");

/// How many pixels of the screen, in each direction, show one pixel of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Scale {
    /// 1280×720.
    One = 1,
    /// 640×360.
    Two = 2,
    /// 320×180.
    Four = 4,
}

/// The scale that fills the screen.
impl From<Size> for Scale {
    fn from(size: Size) -> Self {
        match size {
            Size::W320 => Self::Four,
            Size::W640 => Self::Two,
            Size::W1280 => Self::One,
        }
    }
}

/// The scan-out block, known to be there.
pub struct Scanout {
    registers: scanout::Scanout,
}

impl Scanout {
    /// Takes the block if it is there. It shows black until a [`Display`] shows a frame.
    ///
    /// # Errors
    /// When something else answers, or nothing.
    pub fn probe(registers: scanout::Scanout) -> Result<Self, Absent> {
        match registers.ident().read() {
            IDENT => {
                registers
                    .ev_enable()
                    .write(EvEnable::default().with_vblank(true));
                Ok(Self { registers })
            }
            found => Err(Absent {
                expected: IDENT,
                found,
            }),
        }
    }

    /// Has `shown` stay on the screen instead of `next`, if that is not on it yet; returns whether that is so. Not if the two
    /// have different scales: one of them would be seen with the other's.
    fn withdraw(&self, next: u32, shown: u32) -> bool {
        let registers = &self.registers;
        if registers.fb_next().read() != next
            || registers.fb_current().read() != shown
            || registers.scale().read() != registers.status().read().scale()
        {
            return false;
        }
        registers.fb_next().write(shown);
        // A vertical blanking may have come before the write.
        let withdrawn = registers.fb_current().read() == shown;
        if !withdrawn {
            registers.fb_next().write(next);
        }
        withdrawn
    }

    /// Whether the frame at `address` is shown or will be: then it may not be drawn on.
    fn holds(&self, address: u32) -> bool {
        // In this order: what becomes current between the two readings is still found as the next one was.
        self.registers.fb_next().read() == address || self.registers.fb_current().read() == address
    }

    /// Has the frame at `address` taken over at the next vertical blanking.
    fn show(&self, address: u32, scale: Scale) {
        let disabled = Control::default().with_enable(false);
        if self.registers.scale().read() != scale as u8
            || self.registers.control().read() == disabled
        {
            // A vertical blanking may come between any two of these writes. It then finds the picture switched off, and
            // never a frame with another frame's scale.
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

/// Clears the vertical blanking's interrupt; its handler calls this.
pub fn acknowledge_vblank() {
    // SAFETY: nobody else writes the pending register, and its one event is cleared as a whole.
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

/// What scan-out has counted since reset; each counter wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counters {
    /// Vertical blankings.
    pub frames: u32,
    /// Source lines that memory delivered too late.
    pub underflows: u32,
}

impl Display {
    /// A display of two frames, each large enough for 1280×720 pixels of RGB565 and at a multiple of 16 bytes.
    #[must_use]
    pub fn new(scanout: Option<Scanout>, frames: [&'static mut [u16]; 2]) -> Self {
        let [front, back] = frames;
        Self {
            scanout,
            front,
            back,
        }
    }

    /// The frame to draw on, or nothing while it is still on the screen.
    pub fn back(&mut self) -> Option<&mut [u16]> {
        let address = address(self.back);
        let held = self
            .scanout
            .as_ref()
            .is_some_and(|scanout| scanout.holds(address));
        (!held).then_some(&mut *self.back)
    }

    /// Takes back the frame shown last if it is not on the screen yet, so that there is a frame to draw on: for those who
    /// want another picture rather than to see this one.
    pub fn withdraw(&mut self) {
        let withdrawn = self
            .scanout
            .as_ref()
            .is_some_and(|scanout| scanout.withdraw(address(self.front), address(self.back)));
        if withdrawn {
            core::mem::swap(&mut self.front, &mut self.back);
        }
    }

    /// The frame shown last, or still to be taken over.
    #[must_use]
    pub fn front(&self) -> &[u16] {
        self.front
    }

    /// Shows the frame that [`back`](Self::back) lent, from the next vertical blanking on.
    pub fn show(&mut self, scale: Scale) {
        core::mem::swap(&mut self.front, &mut self.back);
        // What was drawn must be on its way to memory before scan-out is told of it.
        compiler_fence(Ordering::SeqCst);
        if let Some(scanout) = &self.scanout {
            scanout.show(address(self.front), scale);
        }
    }

    /// Whether there is a scan-out to show anything.
    #[must_use]
    pub const fn is_visible(&self) -> bool {
        self.scanout.is_some()
    }

    /// Scan-out's counters, all 0 where there is none.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.scanout.as_ref().map_or(
            Counters {
                frames: 0,
                underflows: 0,
            },
            |scanout| Counters {
                frames: scanout.registers.frame_count().read(),
                underflows: scanout.registers.underflow_count().read(),
            },
        )
    }
}

/// A frame's address as scan-out sees it: the CPU's own, which has 32 bits.
fn address(frame: &[u16]) -> u32 {
    frame.as_ptr().addr() as u32
}

#[cfg(test)]
mod tests {
    use std::boxed::Box;
    use std::cell::RefCell;
    use std::rc::Rc;

    use litex_pac::Peripherals;
    use litex_pac::bus::{self, Bus};

    use super::*;

    /// The registers by offset, with a vertical blanking before the write that `blank_before` counts down to.
    #[derive(Default)]
    struct Video {
        ident: u32,
        control: u32,
        next: u32,
        scale: u32,
        /// Control, frame and scale in force.
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
                0x08 => video.control,
                // The scale in force.
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
        let video = Rc::new(RefCell::new(Video {
            ident,
            scale: 4,
            ..Video::default()
        }));
        bus::connect(Registers(video.clone()));
        // SAFETY: the registers are a model's.
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
        display.show(Scale::Four);
        display.back().unwrap()[0] = 2;
        video.borrow_mut().blank();
        assert_eq!(display.front()[0], 1);
        display.show(Scale::Four);
        // The second is awaited, the first still on the screen.
        assert!(display.back().is_none());
        video.borrow_mut().blank();
        assert_eq!(display.back().unwrap()[0], 1);
        assert_eq!(display.front()[0], 2);
    }

    #[test]
    fn a_frame_is_withdrawn_before_it_is_seen() {
        // A vertical blanking in the last moment, or none.
        for blanking in [Some(0), None] {
            let (scanout, video) = probe(IDENT);
            let mut display = Display::new(Some(scanout.unwrap()), frames());
            for mark in [1, 2] {
                display.back().unwrap()[0] = mark;
                display.show(Scale::Four);
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
        // Another scale is waited for.
        let (scanout, video) = probe(IDENT);
        let mut display = Display::new(Some(scanout.unwrap()), frames());
        display.show(Scale::Four);
        video.borrow_mut().blank();
        display.show(Scale::Two);
        display.withdraw();
        assert!(display.back().is_none());
    }

    #[test]
    fn no_blanking_finds_a_frame_with_another_scale() {
        for moment in 0..6 {
            let (scanout, video) = probe(IDENT);
            let mut display = Display::new(Some(scanout.unwrap()), frames());
            display.show(Scale::Four);
            let small = [1, video.borrow().next, 4];
            video.borrow_mut().blank();
            assert_eq!(video.borrow().current, small);
            video.borrow_mut().blank_before = Some(moment);
            display.show(Scale::Two);
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
        display.show(Scale::One);
        assert!(display.back().is_some() && !display.is_visible());
        assert_eq!(display.front()[0], 1);
    }

    #[test]
    fn every_size_fills_the_screen() {
        for size in Size::ALL {
            let scale = Scale::from(size) as u32;
            assert_eq!(size.pixels().map(|pixels| scale * pixels), SCREEN);
        }
    }
}
