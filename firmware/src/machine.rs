//! The state of the machine.

use glint_core::feature::TEXTURE;
use glint_hal::timer::Clock;
use glint_program::gesture::Gesture;
use glint_program::hardware::{Devices, Identity};
use glint_program::renderer::Renderer;
use glint_program::sensor::Imu;
use glint_program::serial::{ConsoleUart, UART};
use glint_scene::{Animator, Scene};
use litex_pac::ctrl::Ctrl;

use crate::arena::Loan;
use crate::demo::Demo;
use crate::models::Models;
use crate::panel::Switches;
use crate::picture::Picture;
use crate::replay::Replay;
use crate::scenes::Library;
use crate::terminal::Terminal;
use crate::transfer::Downloads;
use crate::wireframe::Keypad;

/// The state of the machine.
pub struct Machine {
    /// Build ids of firmware and gateware.
    pub identity: Identity,
    /// The time source: clock cycles since reset, and timers.
    pub clock: Clock,
    /// The UART, which the console and transfers share.
    pub uart: &'static ConsoleUart,
    /// The console on the UART.
    pub terminal: Terminal,
    /// The scene: all state that determines the next picture.
    pub scene: Scene,
    /// Computes the scene's motion from the time of each frame.
    pub animator: Animator,
    /// The last picture, and requests for the next picture.
    pub picture: Picture,
    /// The meshes, textures and wireframe programs, built-in and uploaded, and the staging memory.
    pub models: Models,
    /// The bytes of the flash; `None` if the gateware cannot read the flash.
    pub flash: Option<&'static [u8]>,
    /// Scenes, lists and meshes of the flash.
    pub library: Library,
    /// The demo, which shows scenes in turn.
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
    /// The state of the switches at the last poll.
    pub switches: Switches,
    /// The registers that reset the SoC.
    pub ctrl: Ctrl,
    /// Whether the LEDs show the state of the board: true until a command sets the LEDs.
    pub heartbeat: bool,
    /// The sender of transfers to the host.
    pub downloads: Downloads,
    /// The replay of the log in the staging memory, if any.
    pub replay: Option<Replay>,
}

impl Machine {
    /// A machine in the state after reset, with neither flash nor gesture engine.
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

    /// Prints a note if the scene has a replacement texture that is not visible on any mesh.
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
