//! The shared library of the verilated SoC: a safe interface to the functions of `tools/virtual-board/soc/soc.h`.

use std::ffi::{c_int, c_void};
use std::path::Path;
use std::slice;

use glint_testbench::{Instance, LoadError};
use virtual_image_sensor::Levels;

use crate::Error;

type Handle = *mut c_void;

/// Declares the struct `Functions`, a table of the library's functions, and a function that loads it.
macro_rules! functions {
    ($($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        struct Functions {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            /// Looks up every function in the library of `instance`.
            ///
            /// # Safety
            /// The instance implements `soc.h` and outlives the table.
            unsafe fn load(instance: &Instance) -> Result<Self, LoadError> {
                Ok(Self {
                    // SAFETY: guaranteed by the caller; the types match soc.h.
                    $($name: unsafe { instance.symbol(concat!("soc_", stringify!($name)))? },)*
                })
            }
        }
    };
}

functions! {
    build_id: fn() -> u32;
    clock_hz: fn() -> u32;
    run: fn(Handle, u64);
    run_bare: fn(Handle, u64);
    cycles: fn(Handle) -> u64;
    uart_write: fn(Handle, *const u8, usize);
    uart_queued: fn(Handle) -> usize;
    uart_read: fn(Handle, *mut u8, usize) -> usize;
    i2c_drive: fn(Handle, u8);
    i2c_wires: fn(Handle) -> u8;
    outputs: fn(Handle) -> u8;
    run_to_edge: fn(Handle, u64) -> u64;
    camera_drive: fn(Handle, u8);
    camera_send: fn(Handle, u32, *const u16, usize);
    camera_queued: fn(Handle) -> usize;
    camera_clear: fn(Handle);
    camera_clocks: fn(Handle) -> u64;
    flash_drive: fn(Handle, u8);
    flash_lines: fn(Handle) -> u8;
    video_record: fn(Handle, c_int);
    video_samples: fn(Handle, *mut usize) -> *const u32;
    video_clear: fn(Handle);
    instructions_record: fn(Handle, c_int);
    instructions: fn(Handle, *mut usize) -> *const Instruction;
    instructions_clear: fn(Handle);
    filling: fn(Handle) -> c_int;
    ddr_read: fn(Handle, u32, *mut u8, usize);
    ddr_write: fn(Handle, u32, *const u8, usize);
    rom_write: fn(Handle, *const u8, usize);
}

/// An instruction that the CPU has executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Instruction {
    /// Cycle of the system clock in which the instruction ended.
    pub cycle: u64,
    /// Its address.
    pub pc: u32,
    /// Number of the written register, 0 for none.
    pub register: u32,
    /// The written value.
    pub value: u32,
}

/// Outputs of the SoC to devices that react to each edge. SCL and SDA are released when `true`, and pulled low when `false`.
#[derive(Clone, Copy)]
pub(crate) struct Outputs {
    /// SCL and SDA of the I2C bus.
    pub i2c: [bool; 2],
    /// SCL and SDA of the image sensor's SCCB bus.
    pub camera: [bool; 2],
    /// Level of the image sensor's RESET_N.
    pub camera_reset_n: bool,
    /// Level of the image sensor's PWDN.
    pub camera_power_down: bool,
    /// Level of the flash's CS#.
    pub flash_cs_n: bool,
    /// Level of the flash's clock.
    pub flash_clk: bool,
}

/// One verilated SoC.
pub(crate) struct Soc {
    functions: Functions,
    buttons: usize,
    switches: usize,
    leds: usize,
    /// The pins of the left and of the right display: the pins that select digits, and the segment pins.
    digits: [[usize; 2]; 2],
    // The last field, so that the library is unloaded after its function table is dropped.
    instance: Instance,
}

/// Defines methods of [`Soc`] that pass numbers to the library's functions of the same names.
macro_rules! methods {
    ($(
        $(#[$doc:meta])*
        fn $name:ident($self:ident: $receiver:ty $(, $argument:ident: $type:ty)*) $(-> $result:ty)?;
    )*) => {
        impl Soc {
            $(
                $(#[$doc])*
                pub fn $name($self: $receiver $(, $argument: $type)*) $(-> $result)? {
                    // SAFETY: the handle belongs to a live SoC, which the borrow of `self` protects.
                    unsafe { ($self.functions.$name)($self.raw() $(, $argument)*) }
                }
            )*
        }
    };
}

methods! {
    fn run(self: &mut Self, cycles: u64);
    /// Only advances the clocks; serial output and video are lost.
    fn run_bare(self: &mut Self, cycles: u64);
    fn cycles(self: &Self) -> u64;
    fn uart_queued(self: &Self) -> usize;
    fn i2c_drive(self: &mut Self, released: u8);
    fn i2c_wires(self: &Self) -> u8;
    /// Runs until the SoC changes one of its [`Outputs`], but at most `cycles` cycles. Returns the number of cycles run.
    fn run_to_edge(self: &mut Self, cycles: u64) -> u64;
    fn camera_drive(self: &mut Self, released: u8);
    fn camera_queued(self: &Self) -> usize;
    fn camera_clear(self: &mut Self);
    fn camera_clocks(self: &Self) -> u64;
    /// Levels with which the SoC drives the data lines of the flash; undriven lines are high.
    fn flash_lines(self: &Self) -> u8;
    /// Sets the levels that the SoC reads from the flash's data lines.
    fn flash_drive(self: &mut Self, lines: u8);
    fn video_clear(self: &mut Self);
    fn instructions_clear(self: &mut Self);
}

impl Soc {
    /// Loads the library and creates a SoC before its first clock edge.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let instance = Instance::load(path, 0)?;
        // SAFETY: `cargo xtask gateware` made the library from soc.h, and the instance outlives the table.
        let functions = unsafe { Functions::load(&instance) }?;
        Ok(Self {
            functions,
            buttons: instance.find("buttons"),
            switches: instance.find("switches"),
            leds: instance.find("leds"),
            digits: ["left", "right"].map(|side| {
                ["digits", "segments"].map(|pins| instance.find(&format!("digits_{side}_{pins}_n")))
            }),
            instance,
        })
    }

    fn raw(&self) -> Handle {
        self.instance.handle()
    }

    pub fn build_id(&self) -> u32 {
        // SAFETY: the function may be called at any time.
        unsafe { (self.functions.build_id)() }
    }

    pub fn clock_hz(&self) -> u32 {
        // SAFETY: the function may be called at any time.
        unsafe { (self.functions.clock_hz)() }
    }

    /// Starts writing waveforms to a file. Returns `false` if this fails, for example with a library that was built without waveforms.
    pub fn trace(&mut self, path: &Path) -> Result<bool, Error> {
        Ok(self.instance.write_waveforms(path)?)
    }

    pub fn uart_write(&mut self, bytes: &[u8]) {
        // SAFETY: the handle belongs to a live SoC that nothing else uses; the bytes are copied during the call.
        unsafe { (self.functions.uart_write)(self.raw(), bytes.as_ptr(), bytes.len()) }
    }

    /// Appends the unread serial output of the SoC to `output`.
    pub fn uart_read(&mut self, output: &mut Vec<u8>) {
        let mut buffer = [0; 256];
        loop {
            // SAFETY: the handle belongs to a live SoC that nothing else uses; no more than the buffer's length is written.
            let count = unsafe {
                (self.functions.uart_read)(self.raw(), buffer.as_mut_ptr(), buffer.len())
            };
            output.extend_from_slice(&buffer[..count]);
            if count < buffer.len() {
                return;
            }
        }
    }

    pub fn set_buttons(&mut self, pressed: u8) {
        self.instance
            .set_value(self.buttons, (pressed & 0xf).into());
    }

    pub fn set_switches(&mut self, on: u16) {
        self.instance.set_value(self.switches, on.into());
    }

    /// Sets buttons and switches to the levels of another SoC of this library.
    pub fn take_levels(&mut self, other: &Self) {
        for pins in [self.buttons, self.switches] {
            self.instance.set_value(pins, other.instance.value(pins));
        }
    }

    pub fn leds(&self) -> u16 {
        self.instance.value(self.leds) as u16
    }

    /// The selected digits and the segments of the left and of the right display; 1 is lit.
    pub fn digits(&self) -> [[u8; 2]; 2] {
        // The pins are active low. A display has four digits and eight segments.
        self.digits.map(|[digits, segments]| {
            [
                !self.instance.value(digits) as u8 & 0xf,
                !self.instance.value(segments) as u8,
            ]
        })
    }

    /// Outputs of the SoC to devices that react to each edge, in the order of their bits.
    pub fn outputs(&self) -> Outputs {
        // SAFETY: the handle belongs to a live SoC.
        let bits = unsafe { (self.functions.outputs)(self.raw()) };
        let bit = |number: u32| bits >> number & 1 != 0;
        Outputs {
            i2c: [bit(0), bit(1)],
            camera: [bit(2), bit(3)],
            camera_reset_n: bit(4),
            camera_power_down: bit(5),
            flash_cs_n: bit(6),
            flash_clk: bit(7),
        }
    }

    /// Queues levels of the image sensor's port, one per period of PCLK. The frequency of PCLK in Hz must be a multiple of 250 kHz.
    pub fn camera_send(&mut self, frequency: u32, levels: &[Levels]) {
        let levels: Vec<u16> = levels.iter().map(|levels| levels.0).collect();
        // SAFETY: the handle belongs to a live SoC that nothing else uses; the levels are copied during the call.
        unsafe {
            (self.functions.camera_send)(self.raw(), frequency, levels.as_ptr(), levels.len());
        }
    }

    pub fn video_record(&mut self, on: bool) {
        // SAFETY: the handle belongs to a live SoC that nothing else uses.
        unsafe { (self.functions.video_record)(self.raw(), on.into()) }
    }

    /// Passes the recorded video samples to `consume`, and then discards them.
    pub fn video_take(&mut self, consume: impl FnOnce(&[u32])) {
        let mut count = 0;
        // SAFETY: the handle belongs to a live SoC that nothing else uses, and `count` is valid for writing the result.
        let samples = unsafe { (self.functions.video_samples)(self.raw(), &mut count) };
        if count != 0 {
            // SAFETY: the library keeps `count` samples at this address until the next run or clear, and neither can happen
            // during the borrow of `self`.
            consume(unsafe { slice::from_raw_parts(samples, count) });
        }
        self.video_clear();
    }

    pub fn instructions_record(&mut self, on: bool) {
        // SAFETY: the handle belongs to a live SoC that nothing else uses.
        unsafe { (self.functions.instructions_record)(self.raw(), on.into()) }
    }

    /// Appends the recorded instructions to `list`.
    pub fn instructions_take(&mut self, list: &mut Vec<Instruction>) {
        let mut count = 0;
        // SAFETY: the handle belongs to a live SoC that nothing else uses, and `count` is valid for writing the result.
        let instructions = unsafe { (self.functions.instructions)(self.raw(), &mut count) };
        if count != 0 {
            // SAFETY: the library keeps `count` instructions at this address until the next run or clear.
            list.extend_from_slice(unsafe { slice::from_raw_parts(instructions, count) });
        }
        self.instructions_clear();
    }

    /// Whether the CPU is filling a cache line.
    pub fn filling(&self) -> bool {
        // SAFETY: the handle belongs to a live SoC.
        unsafe { (self.functions.filling)(self.raw()) != 0 }
    }

    pub fn ddr_read(&mut self, offset: u32, bytes: &mut [u8]) {
        // SAFETY: the handle belongs to a live SoC that nothing else uses; the board has checked the range.
        unsafe { (self.functions.ddr_read)(self.raw(), offset, bytes.as_mut_ptr(), bytes.len()) }
    }

    /// Writes main memory. No cache line fill may be in progress.
    pub fn ddr_write(&mut self, offset: u32, bytes: &[u8]) {
        // SAFETY: the handle belongs to a live SoC that nothing else uses; the board has checked the range.
        unsafe { (self.functions.ddr_write)(self.raw(), offset, bytes.as_ptr(), bytes.len()) }
    }

    /// Replaces the contents of the ROM; call it before the first cycle.
    pub fn rom_write(&mut self, bytes: &[u8]) {
        // SAFETY: the handle belongs to a live SoC that nothing else uses; the library copies no more bytes
        // than the ROM holds.
        unsafe { (self.functions.rom_write)(self.raw(), bytes.as_ptr(), bytes.len()) }
    }
}
