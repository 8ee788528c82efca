//! Start of the machine after reset.

use core::fmt;

use glint_core::camera::ViewError;
use glint_core::feature::WIREFRAME;
use glint_core::flash::CONTENTS;
use glint_core::wireframe::{CUBE, Program, ProgramError};
use glint_program::gateware::GatewareRenderer;
use glint_program::hardware::{self, Hardware};
use glint_scene::Scene;

use crate::arena::Arena;
use crate::machine::Machine;
use crate::models::Models;
use crate::names::MachineNames;
use crate::scenes::Library;
use crate::transfer::Downloads;

/// Reason why the machine cannot start.
pub enum StartError {
    /// The start of the hardware failed.
    Hardware(hardware::StartError),
    /// The built-in program is not a valid wireframe program.
    Program(ProgramError<'static>),
    /// The initial camera is out of range.
    Camera(ViewError),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Hardware(error) => error.fmt(f),
            Self::Program(error) if WIREFRAME.is_built => write!(f, "the built-in {error}"),
            Self::Program(_) => f.write_str("the built-in wireframe program is invalid"),
            Self::Camera(error) => write!(f, "the initial camera: {error}"),
        }
    }
}

/// Starts the hardware, and creates the machine with its initial scene.
///
/// # Errors
/// The hardware cannot start, or the built-in program or the initial camera is invalid.
pub fn machine() -> Result<Machine, StartError> {
    let Hardware {
        identity,
        clock,
        devices,
        gesture,
        flash,
        renderer,
        spare,
        ctrl,
    } = Hardware::start().map_err(StartError::Hardware)?;
    // Without gateware that draws meshes, the number of triangles is not limited, because the soft core draws them.
    let gateware = renderer.gateware.as_ref();
    let most_triangles = gateware.map_or(u32::MAX, GatewareRenderer::most_triangles);
    let program = Program::new_checked(CUBE.as_flattened());
    let program = program.map_err(StartError::Program)?;
    let mut machine = Machine::new(
        identity,
        clock,
        Scene::new(renderer.defaults()).map_err(StartError::Camera)?,
        Models::new(
            Arena::new(spare.uploads),
            spare.shapes,
            Arena::new(spare.turned),
            program,
            most_triangles,
        ),
        renderer,
        devices,
        ctrl,
    );
    machine.flash = flash;
    machine.library = Library::new(flash.and_then(|flash| flash.get(CONTENTS..)));
    machine.terminal.names = MachineNames::new(machine.library);
    machine.downloads = Downloads::new(spare.copy);
    machine.gesture = gesture;
    Ok(machine)
}
