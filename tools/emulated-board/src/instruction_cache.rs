//! Cache of decoded instructions of the memories that programs run from.

use litex_pac::Memory;
use litex_pac::memories::{FLASH, MAIN_RAM, ROM, SRAM};

use crate::decode::Instruction;

/// Size of a page in bytes.
pub const PAGE: u32 = 4096;

/// Decoded instructions of a page.
pub type Page = [Instruction; PAGE as usize / 4];

/// The pages of decoded instructions. As in the CPU's instruction cache, writes to memory do not change a cached instruction
/// until [`clear`](Self::clear).
pub struct InstructionCache {
    /// Pages of the memories, one memory after another.
    pages: Vec<Option<Box<Page>>>,
    /// Numbers of the pages that are present.
    present: Vec<usize>,
    /// The page for all addresses without memory. This page stays empty, because there are no instructions at these addresses.
    nowhere: Box<Page>,
}

/// The memories that [`Bus::memory_word`](crate::bus::Bus::memory_word) reads, in the order of their pages.
const MEMORIES: [Memory; 4] = [MAIN_RAM, ROM, SRAM, FLASH];

fn pages(memory: Memory) -> usize {
    memory.size.div_ceil(PAGE) as usize
}

/// A page without decoded instructions. A call of its own, so that the callers of [`InstructionCache::page`] need no page on their stack.
#[cold]
#[inline(never)]
fn empty() -> Box<Page> {
    Box::new([Instruction::UNKNOWN; PAGE as usize / 4])
}

impl InstructionCache {
    /// An empty cache of decoded instructions.
    pub fn new() -> Self {
        let count = MEMORIES.into_iter().map(pages).sum();
        Self {
            pages: (0..count).map(|_| None).collect(),
            present: Vec::new(),
            nowhere: empty(),
        }
    }

    /// The page `number`, counted from address 0.
    pub fn page(&mut self, number: u32) -> &mut Page {
        let mut first = 0;
        for memory in MEMORIES {
            let place = number.wrapping_sub(memory.base / PAGE) as usize;
            if place < pages(memory) {
                let page = &mut self.pages[first + place];
                if page.is_none() {
                    self.present.push(first + place);
                }
                return page.get_or_insert_with(empty);
            }
            first += pages(memory);
        }
        &mut self.nowhere
    }

    /// Removes all decoded instructions, as `fence.i` does.
    pub fn clear(&mut self) {
        for number in self.present.drain(..) {
            self.pages[number] = None;
        }
    }
}
