//! The state of the machine.

use glint_core::block::Block;
use glint_core::feature::TEXTURE;
use glint_hal::digits::Digits;
use glint_hal::gpio::{InputPort, OutputPort};
use glint_hal::i2c::I2c;
use glint_hal::timer::{Clock, Deadline};
use glint_scene::{Animator, Scene};
use litex_pac::ctrl::Ctrl;

use crate::arena::Loan;
use crate::demo::Demo;
use crate::gesture::Gesture;
use crate::interrupts::UART;
use crate::models::Models;
use crate::panel::Switches;
use crate::picture::Picture;
use crate::renderer::Renderer;
use crate::replay::Replay;
use crate::scenes::Library;
use crate::sensor::Imu;
use crate::terminal::{ConsoleUart, Terminal};
use crate::transfer::Downloads;
use crate::wireframe::Keypad;

/// Build ids of firmware and gateware.
#[derive(Clone, Copy)]
pub struct Identity {
    /// Build id of the gateware that the firmware was built for.
    pub firmware: u32,
    /// Build id of the gateware.
    pub gateware: u32,
    /// Block enable bits of the gateware: one bit for each optional block that it has.
    pub blocks: u32,
}

impl Identity {
    /// Whether the registers of the gateware are those for which the firmware was built.
    pub const fn matches(&self) -> bool {
        self.firmware == self.gateware
    }

    /// Whether the gateware has the block.
    pub const fn has(&self, block: Block) -> bool {
        self.blocks & block.bit() != 0
    }
}

/// Devices that are accessed only on gateware with a matching build id.
pub struct Devices {
    /// The four buttons.
    pub buttons: InputPort<u8>,
    /// The sixteen switches.
    pub switches: InputPort<u16>,
    /// The sixteen LEDs.
    pub leds: OutputPort<u16>,
    /// The displays of digits.
    pub digits: Digits,
    /// Time until which the digits show the pattern of the self-test.
    pub tests_digits: Option<Deadline>,
    /// The I2C bus of the sensor; `None` after the future that reads the sensor has taken it.
    pub i2c: Option<I2c>,
}

/// The state of the machine.
pub struct Machine {
    /// Build ids of firmware and gateware.
    pub identity: Identity,
    /// Time since start.
    pub clock: Clock,
    /// The UART.
    pub uart: &'static ConsoleUart,
    /// The console on the UART.
    pub terminal: Terminal,
    /// The scene: all state that determines the next picture.
    pub scene: Scene,
    /// The time of the scene's animation.
    pub animator: Animator,
    /// The last picture.
    pub picture: Picture,
    /// The meshes and wireframe program, built-in and uploaded, and the staging memory.
    pub models: Models,
    /// The bytes of the flash; `None` if the gateware cannot read it.
    pub flash: Option<&'static [u8]>,
    /// Scenes, lists and meshes of the flash.
    pub library: Library,
    /// The demo.
    pub demo: Demo,
    /// Frame buffers and renderers.
    pub renderer: Renderer,
    /// The sensor's samples, attitude and calibration.
    pub imu: Imu,
    /// Gesture control; `None` without the gesture engine.
    pub gesture: Option<Gesture>,
    /// The devices; `None` if the build ids differ.
    pub devices: Option<Devices>,
    /// The buttons, and the pending requests of the wireframe's keys.
    pub keypad: Keypad,
    /// The switches.
    pub switches: Switches,
    /// The registers that reset the SoC.
    pub ctrl: Ctrl,
    /// Whether the LEDs show the state of the board: true until a command sets them.
    pub heartbeat: bool,
    /// The sender of transfers to the host.
    pub downloads: Downloads,
    /// The replay of the log in the staging memory, if any.
    pub replay: Option<Replay>,
}

impl Machine {
    /// A machine in the state after reset, without flash and gesture engine.
    pub fn new(
        identity: Identity,
        clock: Clock,
        scene: Scene,
        models: Models,
        renderer: Renderer,
        devices: Option<Devices>,
        ctrl: Ctrl,
    ) -> Self {
        Self {
            identity,
            clock,
            uart: &UART,
            terminal: Terminal::new(&UART, clock),
            scene,
            animator: Animator::default(),
            picture: Picture::default(),
            models,
            flash: None,
            library: Library::new(None),
            demo: Demo::default(),
            renderer,
            imu: Imu::default(),
            gesture: None,
            devices,
            keypad: Keypad::default(),
            switches: Switches::default(),
            ctrl,
            heartbeat: true,
            downloads: Downloads::default(),
            replay: None,
        }
    }

    /// Whether a new frame is needed.
    pub fn needs_picture(&self) -> bool {
        self.picture.is_outdated(&self.scene, &self.models)
    }

    /// Prints a note if the scene has a replacement texture that no shown mesh shows.
    pub fn note_texture(&mut self) {
        let Self { scene, models, .. } = self;
        if !TEXTURE.is_built
            || scene.texture.is_none()
            || scene.has_textures(|name| models.known(name))
        {
            return;
        }
        let reason = if scene.options.textures {
            "no shown mesh has faces with a texture, so the picture does not change; `scene crate` shows a mesh that has some"
        } else {
            "textures are off, so the picture does not change, expected `textures on`"
        };
        self.terminal
            .print(format_args!("note: texture: {reason}\n"));
    }

    /// Takes back memory that was lent for a transfer or a replay.
    pub fn give_back(&mut self, memory: Loan) {
        if memory.is_of_arena() {
            self.models.give_back(memory);
        } else {
            self.downloads.give_back(memory);
        }
    }
}
