//! The hardware after reset: the memory, the drivers of the blocks that this SoC has, and the renderer.

use core::fmt::{self, Write as _};

use glint_core::block::Block;
use glint_core::feature::{FIELD, GESTURE};
use glint_hal::digits::Digits;
use glint_hal::flash;
use glint_hal::frequency::{Frequency, NotAFrequency};
use glint_hal::gesture::GestureEngine;
use glint_hal::gpio::{InputPort, OutputPort};
use glint_hal::i2c::I2c;
use glint_hal::raymarch::Raymarcher;
use glint_hal::scanout::{Display, Scanout};
use glint_hal::timer::{Clock, Deadline, Stopped};
use glint_hal::triangle::TriangleEngine;
use glint_hal::uart::Direct;
use glint_model::edges::EdgeList;
use litex_pac::ctrl::Ctrl;
use litex_pac::{BUILD_ID, Peripherals};

use crate::gateware::{GatewareRenderer, RightEye};
use crate::gesture::Gesture;
use crate::interrupts::{self, Present};
use crate::memory::{self, Memory};
use crate::renderer::Renderer;
use crate::serial::UART;

/// Build id of the gateware that the program was built for. Tools find this value by the name of the symbol.
#[unsafe(no_mangle)]
static GLINT_BUILD_ID: u32 = BUILD_ID;

/// Reason why the hardware cannot start.
pub enum StartError {
    /// The hardware has already been started.
    Started,
    /// The gateware reports a clock frequency that the firmware does not support.
    Frequency(NotAFrequency),
    /// Main memory is smaller than the memory map of the firmware. Both sizes are in bytes.
    MainRam {
        /// Size that the memory map needs.
        needed: u32,
        /// Size that the gateware reports.
        found: u32,
    },
    /// The uptime counter does not advance.
    Clock(Stopped),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Started => f.write_str("the machine has already been started"),
            Self::Frequency(error) => error.fmt(f),
            Self::MainRam { needed, found } => write!(
                f,
                "main memory: this firmware expects at least {} MB, the board has {} MB; \
                 build the firmware of this board with `cargo xtask firmware --board BOARD`, or a program with GLINT_MAIN_RAM_MB=32",
                needed >> 20,
                found >> 20
            ),
            Self::Clock(stopped) => stopped.fmt(f),
        }
    }
}

/// Build ids of firmware and gateware.
#[derive(Clone, Copy)]
pub struct Identity {
    /// Build id of the gateware that the firmware was built for.
    pub firmware: u32,
    /// Build id that the gateware reports.
    pub gateware: u32,
    /// Block enable bits of the gateware: one bit for each optional block.
    pub blocks: u32,
}

impl Identity {
    /// Whether the firmware was built for the registers of this gateware.
    pub const fn matches(&self) -> bool {
        self.firmware == self.gateware
    }

    /// Whether the gateware contains the block.
    pub const fn has(&self, block: Block) -> bool {
        self.blocks & block.bit() != 0
    }
}

/// Devices that are accessed only on gateware with a matching build id.
pub struct Devices {
    /// The board's four buttons.
    pub buttons: InputPort<u8>,
    /// The board's sixteen switches.
    pub switches: InputPort<u16>,
    /// The board's sixteen LEDs.
    pub leds: OutputPort<u16>,
    /// The seven-segment displays.
    pub digits: Digits,
    /// End of the self-test of the digits, during which their contents must not change; `None` without a self-test.
    pub tests_digits: Option<Deadline>,
    /// The I2C bus of the sensor; `None` after the future that reads the sensor has taken the bus.
    pub i2c: Option<I2c>,
}

/// The devices and memory of the SoC after reset.
pub struct Hardware {
    /// Build ids of program and gateware.
    pub identity: Identity,
    /// The time source: clock cycles since reset, and timers.
    pub clock: Clock,
    /// The devices; `None` if the build ids differ.
    pub devices: Option<Devices>,
    /// Gesture control; `None` without the gesture engine.
    pub gesture: Option<Gesture>,
    /// The bytes of the flash; `None` if the gateware cannot read the flash.
    pub flash: Option<&'static [u8]>,
    /// Frame buffers and renderers.
    pub renderer: Renderer,
    /// The windows of memory that the renderer does not need.
    pub spare: Spare,
    /// The registers that reset the SoC.
    pub ctrl: Ctrl,
}

/// Windows of main memory that drawing does not need.
pub struct Spare {
    /// Memory for a copy of a picture.
    pub copy: &'static mut [u8],
    /// Memory for copies of meshes.
    pub turned: &'static mut [u8],
    /// Memory for meshes that the program makes.
    pub shapes: &'static mut [u8],
    /// Memory for uploads.
    pub uploads: &'static mut [u8],
}

impl Hardware {
    /// Takes the peripherals and the memory, and starts the drivers.
    ///
    /// The banner is printed first and needs only the UART, so that later errors are visible. If the build ids of gateware and firmware
    /// differ, only the UART is started, and the clock is assumed to have its default frequency.
    ///
    /// # Errors
    /// The gateware reports an unsupported clock frequency, or less memory than the firmware's memory map needs; or the timer is faulty.
    pub fn start() -> Result<Self, StartError> {
        // SAFETY: the UART has no owner yet.
        let mut banner = unsafe { Direct::seize() };
        // Writing fails only if the serial line accepts no text, so an error is ignored.
        let _ = write!(banner, "\r\nGlint {}\r\n", env!("CARGO_PKG_VERSION"));

        memory::load_fast_code();
        let peripherals = Peripherals::take().ok_or(StartError::Started)?;
        let identity = Identity {
            // SAFETY: the pointer refers to a static. The read is volatile, because tools change the value in the file of the program.
            firmware: unsafe { (&raw const GLINT_BUILD_ID).read_volatile() },
            gateware: peripherals.identity.build_id().read(),
            blocks: peripherals.identity.blocks().read(),
        };
        let frequency = if identity.matches() {
            Frequency::new(peripherals.identity.clock().read()).map_err(StartError::Frequency)?
        } else {
            Frequency::DEFAULT
        };
        let _ = write!(
            banner,
            "gateware {:#010x}, {} kHz\r\n",
            identity.gateware,
            frequency.hertz() / 1000
        );
        if identity.matches() {
            let (needed, found) = (memory::size(), peripherals.identity.main_ram().read());
            if found < needed {
                return Err(StartError::MainRam { needed, found });
            }
        } else {
            let _ = write!(
                banner,
                "MISMATCH: this firmware was built for gateware {:#010x}, whose registers may lie elsewhere.\r\n\
                 Just the console is started. Build both from the same sources.\r\n",
                identity.firmware
            );
        }

        let memory = Memory::take().ok_or(StartError::Started)?;
        let clock = Clock::new(peripherals.timer0, frequency).map_err(StartError::Clock)?;
        UART.start(peripherals.uart);
        let (scanout, engine, raymarcher, gesture, devices) = if identity.matches() {
            let devices = Devices {
                tests_digits: None,
                buttons: InputPort::new(peripherals.buttons.in_()),
                switches: InputPort::new(peripherals.switches.in_()),
                leds: OutputPort::new(peripherals.leds.out()),
                digits: Digits::new(peripherals.digits),
                i2c: Some(I2c::new(peripherals.i2c, clock, identity.has(Block::I2C))),
            };
            (
                Scanout::probe(peripherals.scanout).ok(),
                TriangleEngine::probe(peripherals.triangle).ok(),
                Raymarcher::probe(peripherals.raymarch)
                    .ok()
                    .filter(|_| FIELD.is_built),
                GestureEngine::probe(peripherals.gesture)
                    .ok()
                    .filter(|_| GESTURE.is_built),
                Some(devices),
            )
        } else {
            (None, None, None, None, None)
        };
        let flash = identity
            .matches()
            .then(|| flash::bytes(&peripherals.identity, Block::Flash.bit()))
            .flatten();
        interrupts::start(Present {
            devices: devices.is_some(),
            scanout: scanout.is_some(),
            triangle: engine.is_some(),
            gesture: gesture.is_some(),
        });
        let gateware = engine.and_then(|engine| {
            let first_buffer = memory.frames[0].as_ptr().addr() as u32;
            GatewareRenderer::new(engine, raymarcher, memory.lists, first_buffer, frequency)
        });
        let renderer = Renderer {
            display: Display::new(scanout, memory.frames),
            samples: memory.samples,
            depth: memory.depth,
            right: RightEye::new(memory.eye),
            scratch: memory.scratch,
            edges: EdgeList::new(memory.edges),
            frequency,
            gateware,
        };
        Ok(Self {
            identity,
            clock,
            devices,
            gesture: gesture.map(|engine| Gesture::new(engine, clock)),
            flash,
            renderer,
            spare: Spare {
                copy: memory.copy,
                turned: memory.turned,
                shapes: memory.shapes,
                uploads: memory.uploads,
            },
            ctrl: peripherals.ctrl,
        })
    }
}
