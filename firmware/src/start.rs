//! Start of the machine after reset.

use core::fmt::{self, Write as _};

use glint_core::block::Block;
use glint_core::camera::ViewError;
use glint_core::deviation::Deviation;
use glint_core::feature::{FIELD, GESTURE, MESH, WIREFRAME};
use glint_core::flash::CONTENTS;
use glint_core::wireframe::{CUBE, Program, ProgramError};
use glint_hal::digits::Digits;
use glint_hal::flash;
use glint_hal::frequency::{Frequency, NotAFrequency};
use glint_hal::gesture::GestureEngine;
use glint_hal::gpio::{InputPort, OutputPort};
use glint_hal::i2c::I2c;
use glint_hal::raymarch::Raymarcher;
use glint_hal::scanout::{Display, Scanout};
use glint_hal::timer::{Clock, Stopped};
use glint_hal::triangle::TriangleEngine;
use glint_hal::uart::Direct;
use glint_model::edges::EdgeList;
use glint_scene::Scene;
use litex_pac::{BUILD_ID, Peripherals};

use crate::gateware::{GatewareRenderer, RightEye};
use crate::gesture::Gesture;
use crate::interrupts::{self, Present, UART};
use crate::machine::{Devices, Identity, Machine};
use crate::memory::{self, Memory};
use crate::models::Models;
use crate::names::MachineNames;
use crate::renderer::Renderer;
use crate::scenes::Library;
use crate::transfer::Downloads;

/// Build id of the gateware that the firmware was built for. Tools find this value by the name of the symbol.
#[unsafe(no_mangle)]
static GLINT_BUILD_ID: u32 = BUILD_ID;

/// Reason why the machine cannot start.
pub enum StartError {
    /// The machine was started before.
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
    /// The built-in cube is not a valid mesh.
    Cube(Deviation),
    /// The built-in program is not a valid wireframe program.
    Program(ProgramError<'static>),
    /// The initial camera is out of range.
    Camera(ViewError),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Started => f.write_str("the machine was started before"),
            Self::Frequency(error) => error.fmt(f),
            Self::MainRam { needed, found } => write!(
                f,
                "main memory: this firmware expects at least {} MB, the board has {} MB; \
                 build the firmware of this board with `cargo xtask firmware --board BOARD`",
                needed >> 20,
                found >> 20
            ),
            Self::Clock(stopped) => stopped.fmt(f),
            Self::Cube(error) if MESH.is_built => write!(f, "the built-in cube: {error}"),
            Self::Cube(_) => f.write_str("the built-in cube"),
            Self::Program(error) if WIREFRAME.is_built => write!(f, "the built-in {error}"),
            Self::Program(_) => f.write_str("the built-in wireframe program"),
            Self::Camera(error) => write!(f, "the first camera: {error}"),
        }
    }
}

/// Starts the machine.
///
/// The banner is printed first and needs only the UART, so that later errors are visible. If the build ids of gateware and firmware
/// differ, only the console is started, and the clock is assumed to have its default frequency.
///
/// # Errors
/// The gateware reports an unsupported clock frequency, or less memory than the firmware's memory map needs; or the timer, the built-in
/// cube or program, or the initial camera is faulty.
pub fn machine() -> Result<Machine, StartError> {
    // SAFETY: the UART has no owner yet.
    let mut banner = unsafe { Direct::seize() };
    // Writing fails only if the serial line accepts no text, so an error is ignored.
    let _ = write!(banner, "\r\nGlint {}\r\n", env!("CARGO_PKG_VERSION"));

    memory::load_fast_code();
    let peripherals = Peripherals::take().ok_or(StartError::Started)?;
    let identity = Identity {
        // SAFETY: the pointer refers to a static. The read is volatile, because tools change the value
        // in the program's file.
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

    // Without gateware that draws meshes the soft core draws them, whatever their size.
    let most_triangles = (gateware.as_ref()).map_or(u32::MAX, GatewareRenderer::most_triangles);
    let program = Program::new_checked(CUBE.as_flattened());
    let program = program.map_err(StartError::Program)?;

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
    let mut machine = Machine::new(
        identity,
        clock,
        Scene::new(renderer.defaults()).map_err(StartError::Camera)?,
        Models::new(
            memory.uploads,
            memory.shapes,
            memory.turned,
            program,
            most_triangles,
        )
        .map_err(StartError::Cube)?,
        renderer,
        devices,
        peripherals.ctrl,
    );
    machine.flash = flash;
    machine.library = Library::new(flash.and_then(|flash| flash.get(CONTENTS..)));
    machine.terminal.names = MachineNames::new(machine.library);
    machine.downloads = Downloads::new(memory.copy);
    machine.gesture = gesture.map(|engine| Gesture::new(engine, clock));
    Ok(machine)
}
