//! The windows of main memory that `memory.x` sets aside, as what they hold.

use core::mem::MaybeUninit;
use core::ptr;
use core::slice;
use core::sync::atomic::{AtomicBool, Ordering};

use glint_model::Projected;
use litex_pac::cpu;

use crate::models::Buffer;

/// Every window, each handed out once.
pub struct Memory {
    /// Two frames: RGB565, one number a pixel.
    pub frames: [&'static mut [u16]; 2],
    /// Depth codes, one a pixel.
    pub depth: &'static mut [u32],
    /// Room for projected vertices.
    pub scratch: Scratch,
    /// Room for two meshes.
    pub meshes: [Buffer; 2],
    /// What passes between the passes of the triangle engine.
    pub lists: &'static mut [u32],
}

unsafe extern "C" {
    static mut _frame_a: u8;
    static mut _frame_b: u8;
    static _frame_size: u8;
    static mut _depth: u8;
    static _depth_size: u8;
    static mut _scratch: u8;
    static _scratch_size: u8;
    static mut _mesh_a: u8;
    static mut _mesh_b: u8;
    static _mesh_size: u8;
    static mut _lists: u8;
    static _lists_size: u8;
    static mut _fast: u8;
    static _fast_size: u8;
    static _fast_loaded: u8;
}

/// The windows, from symbol to slice: `window!(first byte, bytes, kind of element)`.
macro_rules! window {
    ($start:ident, $size:ident, $element:ty) => {{
        let bytes = (&raw const $size).addr();
        // SAFETY: memory.x keeps this window for this use alone and asserts that it is aligned and overlaps nothing;
        // every bit pattern is an element; and the caller hands it out once.
        unsafe { slice::from_raw_parts_mut((&raw mut $start).cast::<$element>(), bytes / size_of::<$element>()) }
    }};
}

impl Memory {
    /// The windows, the first time; nothing after that.
    pub fn take() -> Option<Self> {
        static TAKEN: AtomicBool = AtomicBool::new(false);
        // Only the main program calls this, so that nothing comes between the two.
        if TAKEN.load(Ordering::Relaxed) {
            return None;
        }
        TAKEN.store(true, Ordering::Relaxed);
        Some(Self {
            frames: [
                window!(_frame_a, _frame_size, u16),
                window!(_frame_b, _frame_size, u16),
            ],
            depth: window!(_depth, _depth_size, u32),
            scratch: Scratch {
                memory: window!(_scratch, _scratch_size, MaybeUninit<Projected>),
                ready: 0,
            },
            meshes: [
                Buffer::new(window!(_mesh_a, _mesh_size, u8)),
                Buffer::new(window!(_mesh_b, _mesh_size, u8)),
            ],
            lists: window!(_lists, _lists_size, u32),
        })
    }
}

/// Puts the code that memory.x has in the memory beside the processor there. Nothing of it may run before. Every SoC of this kind has that
/// memory, as its BIOS runs on it.
pub fn load_fast_code() {
    let size = (&raw const _fast_size).addr();
    // SAFETY: memory.x keeps this memory for this code alone, and the linker has put the code into the program; both are whole words, and
    // nobody else looks at either.
    unsafe {
        ptr::copy_nonoverlapping(&raw const _fast_loaded, &raw mut _fast, size);
    }
    cpu::flush_instruction_cache();
}

/// Room for projected vertices, of which only the first ones hold any: not every bit pattern is one.
pub struct Scratch {
    memory: &'static mut [MaybeUninit<Projected>],
    ready: usize,
}

impl Scratch {
    /// Room for at least `count` vertices, if there is so much.
    pub fn vertices(&mut self, count: usize) -> &mut [Projected] {
        let count = count.min(self.memory.len());
        if let Some(fresh) = self.memory.get_mut(self.ready..count) {
            fresh.fill(MaybeUninit::new(Projected::Behind));
            self.ready = count;
        }
        let ready = self.memory.get_mut(..self.ready).unwrap_or_default();
        // SAFETY: the first `ready` have been filled, and a `MaybeUninit` lies in memory as what it holds.
        unsafe { &mut *(ptr::from_mut(ready) as *mut [Projected]) }
    }
}
