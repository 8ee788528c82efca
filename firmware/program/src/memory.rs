//! Windows of main memory: regions reserved by the linker script `memory.x`, as typed slices.

use core::mem::MaybeUninit;
use core::ptr;
use core::slice;
use core::sync::atomic::{AtomicBool, AtomicPtr, Ordering};

use glint_model::Projected;
use litex_pac::cpu;
use litex_pac::memories::MAIN_RAM;

/// All windows of main memory. `take` returns them only once.
pub struct Memory {
    /// Two frame buffers: colours in RGB565, one per pixel.
    pub frames: [&'static mut [u16]; 2],
    /// The picture of the right eye: colours in RGB565, one per pixel.
    pub eye: &'static mut [u16],
    /// Samples of a picture with four samples per pixel that the CPU backend draws: colours in RGB565.
    pub samples: &'static mut [u16],
    /// Depth codes, one per pixel or sample.
    pub depth: &'static mut [u32],
    /// Memory for a copy of a picture during its download.
    pub copy: &'static mut [u8],
    /// Memory for projected vertices, used by the CPU backend.
    pub scratch: Scratch,
    /// Memory for copies of meshes with transformed normals.
    pub turned: &'static mut [u8],
    /// Memory for the edges of the shown mesh.
    pub edges: &'static mut [u32],
    /// Memory for built-in meshes.
    pub shapes: &'static mut [u8],
    /// Memory for uploaded meshes and programs, and the staging memory.
    pub uploads: &'static mut [u8],
    /// Memory for the descriptors and band lists that the triangle engine's geometry pass writes and its raster pass reads.
    pub lists: &'static mut [u32],
}

unsafe extern "C" {
    static mut _frame_a: u8;
    static mut _frame_b: u8;
    static _frame_size: u8;
    static mut _sample_memory: u8;
    static _sample_memory_size: u8;
    static mut _eye: u8;
    static _eye_size: u8;
    static mut _depth: u8;
    static _depth_size: u8;
    static mut _copy: u8;
    static _copy_size: u8;
    static mut _scratch: u8;
    static _scratch_size: u8;
    static mut _turned: u8;
    static _turned_size: u8;
    static mut _edges: u8;
    static _edges_size: u8;
    static mut _shapes: u8;
    static _shapes_size: u8;
    static mut _uploads: u8;
    static _uploads_size: u8;
    static mut _lists: u8;
    static _lists_size: u8;
    static mut _windows_end: u8;
    static mut _fast: u8;
    static _fast_size: u8;
    static _fast_loaded: u8;
}

/// The end of the windows. Tools find this value by the name of the symbol.
#[unsafe(no_mangle)]
static GLINT_WINDOWS_END: AtomicPtr<u8> = AtomicPtr::new(&raw mut _windows_end);

/// Size of main memory in bytes that the windows need.
pub fn size() -> u32 {
    // SAFETY: the pointer refers to a static. The read is volatile, because tools change the value in the program's file.
    let end = unsafe { GLINT_WINDOWS_END.as_ptr().read_volatile() };
    end.addr() as u32 - MAIN_RAM.base
}

/// Expands to a slice of a window of memory. The arguments are the linker symbol of the window's first byte, the linker symbol of the
/// window's size in bytes, and the element type.
macro_rules! window {
    ($start:ident, $size:ident, $element:ty) => {{
        let bytes = (&raw const $size).addr();
        // SAFETY: memory.x reserves this window for this use and asserts alignment and no overlap; every bit pattern is
        // a valid element; the caller makes at most one slice of the window.
        unsafe { slice::from_raw_parts_mut((&raw mut $start).cast::<$element>(), bytes / size_of::<$element>()) }
    }};
}

impl Memory {
    /// Returns the windows on the first call, and `None` on later calls.
    pub fn take() -> Option<Self> {
        static TAKEN: AtomicBool = AtomicBool::new(false);
        // Only the main program calls this function, never an interrupt handler, so load and store need not be atomic.
        if TAKEN.load(Ordering::Relaxed) {
            return None;
        }
        TAKEN.store(true, Ordering::Relaxed);
        Some(Self {
            frames: [
                window!(_frame_a, _frame_size, u16),
                window!(_frame_b, _frame_size, u16),
            ],
            eye: window!(_eye, _eye_size, u16),
            samples: window!(_sample_memory, _sample_memory_size, u16),
            depth: window!(_depth, _depth_size, u32),
            copy: window!(_copy, _copy_size, u8),
            scratch: Scratch {
                memory: window!(_scratch, _scratch_size, MaybeUninit<Projected>),
                ready: 0,
            },
            turned: window!(_turned, _turned_size, u8),
            edges: window!(_edges, _edges_size, u32),
            shapes: window!(_shapes, _shapes_size, u8),
            uploads: window!(_uploads, _uploads_size, u8),
            lists: window!(_lists, _lists_size, u32),
        })
    }
}

/// Copies the fast code, which memory.x selects, to the SRAM. Fast code must not run before this call. Every SoC has this SRAM, because the
/// BIOS needs it.
pub fn load_fast_code() {
    let size = (&raw const _fast_size).addr();
    // SAFETY: memory.x reserves the SRAM at `_fast` for the fast code, and places the code's load image at `_fast_loaded`.
    // Both regions have `_fast_size` bytes, a multiple of a word, and nothing else uses them.
    unsafe {
        ptr::copy_nonoverlapping(&raw const _fast_loaded, &raw mut _fast, size);
    }
    cpu::flush_instruction_cache();
}

/// Memory for projected vertices. The first `ready` vertices are initialised, because not every bit pattern is a vertex.
pub struct Scratch {
    memory: &'static mut [MaybeUninit<Projected>],
    ready: usize,
}

impl Scratch {
    /// Returns memory for at least `count` vertices, or the whole memory if it holds fewer.
    pub fn vertices(&mut self, count: usize) -> &mut [Projected] {
        let count = count.min(self.memory.len());
        if let Some(fresh) = self.memory.get_mut(self.ready..count) {
            fresh.fill(MaybeUninit::new(Projected::Behind));
            self.ready = count;
        }
        let ready = self.memory.get_mut(..self.ready).unwrap_or_default();
        // SAFETY: the first `ready` vertices are initialised, and a `MaybeUninit` has the layout of its content.
        unsafe { &mut *(ptr::from_mut(ready) as *mut [Projected]) }
    }
}
