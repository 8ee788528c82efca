//! Commands for the machine and its devices: help, information, buttons, LEDs, self-test, restart.

use core::fmt;

use glint_core::console::{MachineCommands, write_help};
use glint_core::mesh::Mesh;
use glint_program::gateware::GatewareRenderer;
use glint_program::hardware::Devices;
use litex_pac::{EMULATED, cpu, ctrl};

use crate::error::CommandError;
use crate::job::{CommandResult, Reply};
use crate::machine::Machine;
use crate::selftest;

impl<'l> MachineCommands<'l> for Machine {
    fn help(&mut self, command: Option<&'l str>) -> CommandResult<'l> {
        // Writing fails only if the line accepts no text; an error message would be lost as well.
        let _ = write_help(self.terminal.output(), command);
        Ok(Reply::Done)
    }

    fn info(&mut self, key: Option<&'l str>) -> CommandResult<'l> {
        let Self {
            terminal,
            identity,
            models,
            scene,
            renderer,
            clock,
            uart,
            ..
        } = self;
        let staging = models.staging();
        let (address, room) = (staging.as_ptr().addr(), staging.len());
        let names = scene.objects.iter().map(|object| object.mesh.as_str());
        let objects = names.filter(|_| scene.shows_objects());
        let meshes = objects.filter_map(|name| models.known(name));
        let counts = |mesh: Mesh| (mesh.vertex_count(), mesh.triangle_count());
        let (vertices, triangles) = if scene.shows_objects() {
            // The product is at most 16·2^21.
            meshes
                .map(counts)
                .fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1))
        } else {
            counts(models.mesh(scene))
        };
        let [width, height] = scene.size.pixels();
        let (frame, depth) = (renderer.display.front().as_ptr(), renderer.depth.as_ptr());
        let counters = renderer.display.counters();
        let subjects = renderer.gateware.as_ref();
        let subjects = subjects.map_or("none", GatewareRenderer::subjects);
        let board = match cpu::implementation() {
            EMULATED => "emulated",
            _ => "gateware",
        };
        let most = models.most_triangles();
        let entries: [(&str, fmt::Arguments); 21] = [
            ("version", format_args!("{}", env!("CARGO_PKG_VERSION"))),
            ("firmware_id", format_args!("{:#010x}", identity.firmware)),
            ("gateware_id", format_args!("{:#010x}", identity.gateware)),
            ("board", format_args!("{board}")),
            ("blocks", format_args!("{:#x}", identity.blocks)),
            ("gateware_draws", format_args!("{subjects}")),
            ("clock", format_args!("{}", clock.frequency().hertz())),
            ("scene", format_args!("{}", scene.subject())),
            ("vertices", format_args!("{vertices}")),
            ("triangles", format_args!("{triangles}")),
            ("size", format_args!("{width} {height}")),
            ("shading", format_args!("{}", scene.options.shading)),
            ("backend", format_args!("{}", scene.backend)),
            ("frame", format_args!("{:#010x}", frame.addr())),
            ("depth", format_args!("{:#010x}", depth.addr())),
            ("staging", format_args!("{address:#010x} {room}")),
            ("mesh_triangles", format_args!("{most}")),
            ("video_frames", format_args!("{}", counters.frame_count)),
            (
                "video_underflows",
                format_args!("{}", counters.underflow_count),
            ),
            ("uart_lost", format_args!("{}", uart.lost())),
            ("uptime_ms", format_args!("{}", clock.milliseconds())),
        ];
        let mut found = key.is_none();
        for (name, value) in entries {
            if key.is_none_or(|key| key == name) {
                terminal.print_entry(name, &value);
                found = true;
            }
        }
        match key {
            Some(key) if !found => Err(CommandError::Key(key)),
            _ => Ok(Reply::Done),
        }
    }

    fn selftest(&mut self) -> CommandResult<'l> {
        match selftest::run(self) {
            0 => Ok(Reply::Done),
            failed => Err(CommandError::SelfTest(failed)),
        }
    }

    fn echo(&mut self, word: &'l str) -> CommandResult<'l> {
        self.terminal.print(format_args!("{word}\n"));
        Ok(Reply::Done)
    }

    fn leds(&mut self, value: u16) -> CommandResult<'l> {
        devices(self)?.leds.set(value);
        self.heartbeat = false;
        Ok(Reply::Done)
    }

    fn buttons(&mut self) -> CommandResult<'l> {
        let devices = devices(self)?;
        let (buttons, switches) = (devices.buttons.read(), devices.switches.read());
        self.terminal.print(format_args!(
            "buttons {buttons:#x}\nswitches {switches:#06x}\n"
        ));
        Ok(Reply::Done)
    }

    // Tests of the trap handler find this function by its symbol and patch its code with instructions that cause a trap.
    #[inline(never)]
    fn reboot(&mut self) -> CommandResult<'l> {
        self.terminal.print(format_args!("ok\n"));
        self.terminal.flush();
        self.ctrl
            .reset()
            .write(ctrl::Reset::default().with_soc_rst(true));
        // The program continues for some cycles until the reset takes effect.
        loop {
            core::hint::spin_loop();
        }
    }
}

/// The devices, which are available only if the build ids of firmware and gateware match.
fn devices<'l>(machine: &mut Machine) -> Result<&mut Devices, CommandError<'l>> {
    machine.devices.as_mut().ok_or(CommandError::Mismatch)
}
