//! The sender's record of the sent and the arrived blocks of a transfer.

use super::format::WINDOW;
use super::frame::Acknowledge;

/// Maximum number of data frames in flight. This is less than half of the 256 frame numbers, so that older and newer numbers can
/// be distinguished.
const MAX_FRAMES: u8 = 120;

/// The sender's record of sent and acknowledged blocks.
pub struct SendWindow {
    /// Number of the first block that is not acknowledged.
    pub next: u32,
    /// Number of the block after the last block sent so far.
    pub end: u32,
    /// Bit i is set if block `next` + i has arrived.
    arrived: u128,
    /// Bit i is set if block `next` + i was sent and is not known to be lost.
    sent: u128,
    /// For each block, the number of the last data frame that carried the block. The index is the block's number modulo `WINDOW`.
    carriers: [u8; WINDOW as usize],
    /// Number of the last data frame sent.
    number: u8,
    /// Number of the last acknowledged data frame.
    heard: u8,
}

/// Changes since the previous acknowledgement: numbers of arrived blocks, lost blocks and lost frames.
pub struct Fate {
    pub arrived: u32,
    pub lost: u32,
    pub lost_frames: u32,
}

/// The contents of a data frame to send: its number, the number of its first block, and its number of blocks.
pub struct Run {
    pub number: u8,
    pub block: u32,
    pub blocks: u32,
}

impl SendWindow {
    pub const fn new() -> Self {
        Self {
            next: 0,
            end: 0,
            arrived: 0,
            sent: 0,
            carriers: [0; WINDOW as usize],
            number: 0,
            heard: 0,
        }
    }

    /// Applies an acknowledgement, and returns the changes; ignores an impossible acknowledgement and returns `None`.
    pub fn update(&mut self, Acknowledge { number, next, map }: Acknowledge) -> Option<Fate> {
        let past = next.checked_add(u128::BITS - map.leading_zeros())?;
        let unheard = self.number.wrapping_sub(self.heard);
        let far_back = self.next.saturating_sub(next) > WINDOW;
        if past > self.end || far_back || number.wrapping_sub(self.heard) > unheard {
            return None;
        }
        let shift = next.saturating_sub(self.next);
        let moved = |bits: u128| bits.checked_shr(shift).unwrap_or(0);
        let left_behind = shift.min(WINDOW) - (self.arrived & low_bits(shift)).count_ones();
        let arrived = left_behind + (map & !moved(self.arrived)).count_ones();

        // If `next` is smaller than before, the previous acknowledgement was damaged although its CRC-16 was right; the bits are
        // then shifted back.
        let back = self.next.saturating_sub(next);
        self.sent = moved(self.sent).checked_shl(back).unwrap_or(0);
        self.arrived = map;
        self.next = next;
        self.heard = number;

        let mut fate = Fate {
            arrived,
            lost: 0,
            lost_frames: 0,
        };
        let mut last_carrier = None;
        let mut missing = self.sent & !map;
        while missing != 0 {
            let bit = missing.trailing_zeros();
            missing &= missing - 1;
            let carrier = self.carrier(bit);
            if is_before(carrier, number) {
                self.sent &= !(1 << bit);
                fate.lost += 1;
                fate.lost_frames += u32::from(last_carrier != Some(carrier));
                last_carrier = Some(carrier);
            }
        }
        Some(fate)
    }

    /// Whether the maximum number of data frames is in flight.
    pub const fn is_full(&self) -> bool {
        self.number.wrapping_sub(self.heard) >= MAX_FRAMES
    }

    /// Marks the first block in flight as lost, so that it is sent again.
    pub const fn forget_first(&mut self) {
        let on_the_way = self.sent & !self.arrived;
        let first = on_the_way & on_the_way.wrapping_neg();
        self.sent &= !first;
    }

    /// Chooses the next consecutive blocks to send, at most `most`, in a transfer of `total` blocks, and marks these blocks as
    /// sent. Returns `None` if there is no block to send.
    pub fn take(&mut self, most: u32, total: u32) -> Option<Run> {
        let settled = self.sent | self.arrived;
        let first = settled.trailing_ones();
        let block = self.next.saturating_add(first);
        if first >= WINDOW || block >= total {
            return None;
        }
        let blocks = (settled >> first)
            .trailing_zeros()
            .min(most)
            .min(WINDOW - first)
            .min(total - block);
        // If no frame number is free, the new frame gets the number of the last frame. Blocks of the last frame are never marked
        // as lost.
        if !self.is_full() {
            self.number = self.number.wrapping_add(1);
        }
        for bit in first..first + blocks {
            self.sent |= 1 << bit;
            if let Some(carrier) = self.carriers.get_mut(((self.next + bit) % WINDOW) as usize) {
                *carrier = self.number;
            }
        }
        self.end = self.end.max(block + blocks);
        Some(Run {
            number: self.number,
            block,
            blocks,
        })
    }

    fn carrier(&self, bit: u32) -> u8 {
        self.carriers
            .get((self.next.wrapping_add(bit) % WINDOW) as usize)
            .copied()
            .unwrap_or(0)
    }
}

/// Returns a number whose lowest `count` bits are set.
const fn low_bits(count: u32) -> u128 {
    if count >= u128::BITS {
        u128::MAX
    } else {
        (1 << count) - 1
    }
}

/// Returns whether the frame number `number` precedes the frame number `other`, modulo 256.
const fn is_before(number: u8, other: u8) -> bool {
    (number.wrapping_sub(other) as i8) < 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_acknowledgement_is_true_until_the_next_and_never_impossible() {
        let mut window = SendWindow::new();
        for _ in 0..3 {
            window.take(4, 100);
        }
        let says = |number, next, map| Acknowledge { number, next, map };
        // Of the sent frames 1 to 3 with four blocks each, frames 1 and 3 have arrived, and frame 2 is lost.
        let fate = window.update(says(3, 4, 0b1111_0000)).expect("possible");
        assert_eq!((fate.arrived, fate.lost, fate.lost_frames), (8, 4, 1));
        assert_eq!(
            window
                .take(15, 100)
                .map(|run| (run.number, run.block, run.blocks)),
            Some((4, 4, 4))
        );
        // An acknowledgement of an unsent block is impossible.
        assert!(window.update(says(4, 13, 0)).is_none());
        assert!(window.update(says(4, 12, 1)).is_none());
        assert!(window.update(says(5, 12, 0)).is_none());
        // An acknowledgement of all blocks, which is wrong but possible, is accepted. The next acknowledgement corrects the
        // error.
        assert!(window.update(says(4, 12, 0)).is_some());
        assert!(window.update(says(4, 4, 0b1111_0000)).is_some());
        assert_eq!(
            window.take(15, 100).map(|run| (run.block, run.blocks)),
            Some((4, 4))
        );
    }
}
